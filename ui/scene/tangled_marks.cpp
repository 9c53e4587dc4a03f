#include "ui/scene/tangled_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <vtkActor.h>

#include "ui/scene/element_spacing.h"

namespace curvewright {
namespace {

constexpr double ring_radius = 10.0;        ///< units of the pixel ratio
constexpr double ring_needed_below = 13.0;  ///< radius of an element on the screen, units of the pixel ratio
constexpr std::size_t most_rings = 400;

/// With the curves of the section of the elements that are marked.
Polylines edge_lines(const CurvedMesh& mesh, const Tessellation& tessellation, const PlaneCut* section,
                     const std::vector<bool>& is_marked) {
    Polylines lines;
    lines.points = tessellation.edge_points();
    lines.offsets = tessellation.line_offsets();
    lines.spacing = line_spacing(mesh, tessellation);
    if (section) {
        std::vector<Index> elements;
        lines.add_section(*section, tessellation.origin(), [&](std::size_t line) {
            const Index element = section->line_elements()[line];
            if (is_marked[static_cast<std::size_t>(element)]) elements.push_back(element);
            return is_marked[static_cast<std::size_t>(element)];
        });
        const std::vector<float> spacing = line_spacing(mesh, elements);
        lines.spacing.insert(lines.spacing.end(), spacing.begin(), spacing.end());
    }
    return lines;
}

bool is_tangled(const ElementQuality& quality) {
    return quality.validity == Validity::invalid ||
           (quality.validity == Validity::valid && quality.scaled_jacobian <= 0.0);
}

}  // namespace

std::vector<vtkActor*> TangledMarks::actors() const {
    return {undecided_halo_.actor(), undecided_.actor(), hatched_.actor(), hatched_section_.actor(), halo_.actor(),
            outline_.actor(),        ring_halo_.actor(), ring_.actor(),    inside_ring_.actor()};
}

TangledMarks::TangledMarks() {
    for (SurfaceActor* surface : {&hatched_, &hatched_section_}) surface->actor()->PickableOff();
    // The halo is white on dark backgrounds as well: it has to part the alarm colour from the mesh, which is light.
    constexpr Color white{1.0, 1.0, 1.0};
    const Color alarm = tangled_color();
    Color stripe{}, dark{};
    for (std::size_t c = 0; c < 3; ++c) {
        stripe[c] = 0.25 * alarm[c] + 0.75;
        dark[c] = 0.75 * undecided_color()[c];
    }
    for (SurfaceActor* surface : {&hatched_, &hatched_section_}) surface->set_hatch(stripe);
    halo_.set_style({.color = white, .opacity = 0.9, .width = 5.2, .cap = 1.0, .depth_bias = 1.1e-3, .fades = true});
    outline_.set_style({.color = alarm, .width = 2.4, .cap = 1.0, .depth_bias = 2.0e-3, .fades = true});
    undecided_halo_.set_style(
        {.color = white, .opacity = 0.8, .width = 4.0, .cap = 1.0, .depth_bias = 0.6e-3, .fades = true});
    undecided_.set_style({.color = dark, .width = 2.4, .cap = 0.0, .dash = 6.0, .depth_bias = 0.8e-3});
    ring_halo_.set_style({.color = white, .opacity = 0.85, .width = 4.0, .is_on_top = true, .is_in_pixels = true});
    inside_ring_.set_style({.color = alarm, .width = 1.8, .dash = 5.2, .is_on_top = true, .is_in_pixels = true});
    ring_.set_style({.color = alarm, .width = 1.8, .is_on_top = true, .is_in_pixels = true});
}

void TangledMarks::clear() {
    for (SurfaceActor* surface : {&hatched_, &hatched_section_}) surface->clear();
    for (StrokeActor* stroke : {&halo_, &outline_, &undecided_halo_, &undecided_, &ring_halo_, &ring_, &inside_ring_})
        stroke->clear();
    marks_.clear();
}

void TangledMarks::set_mesh(const CurvedMesh& mesh, const QualityReport& quality, const std::vector<bool>& visible,
                            const Tessellation& drawn, const PlaneCut* section, const WorldFrame& frame) {
    clear();
    std::vector<Index> tangled;
    std::vector<bool> is_drawn_tangled(quality.elements.size(), false),
        is_drawn_undecided(quality.elements.size(), false);
    bool has_undecided = false;
    for (std::size_t i = 0; i < quality.elements.size(); ++i) {
        if (!visible.empty() && !visible[i]) continue;
        if (section && section->sides()[i] == PlaneCut::Side::removed) continue;
        if (is_tangled(quality.elements[i])) {
            is_drawn_tangled[i] = true;
            tangled.push_back(static_cast<Index>(i));
        } else if (quality.elements[i].validity == Validity::undecided) {
            is_drawn_undecided[i] = has_undecided = true;
        }
    }
    const bool is_flat = mesh.topology().dimension() < 3;
    const std::optional<CuttingPlane> plane = section ? std::optional(section->plane()) : std::nullopt;
    if (!tangled.empty()) {
        const Tessellation tessellation(mesh, is_drawn_tangled);
        hatched_.set_lit(!is_flat);
        hatched_.set_depth_bias(is_flat ? 1.0e-3 : 1.0e-5);
        hatched_.set_surface(tessellation, true);
        hatched_.set_colors(tessellation, [](Index) { return tangled_color(); });
        frame.place(hatched_.actor(), tessellation.origin());
        hatched_.set_cut(plane, tessellation.origin(), frame.size);
        if (section) {
            hatched_section_.set_lit(true);
            hatched_section_.set_depth_bias(1.0e-5);
            hatched_section_.set_section(
                *section, [&](Index element) { return is_drawn_tangled[static_cast<std::size_t>(element)]; },
                [](Index) { return tangled_color(); });
            frame.place(hatched_section_.actor(), section->origin());
        }
        const Polylines lines = edge_lines(mesh, tessellation, section, is_drawn_tangled);
        for (StrokeActor* stroke : {&halo_, &outline_}) {
            stroke->set_cut(plane, tessellation.origin(), frame.size);
            stroke->set_lines(lines, 1.0 / frame.size);
            frame.place(stroke->actor(), tessellation.origin());
        }
    }
    if (has_undecided) {
        const Tessellation tessellation(mesh, is_drawn_undecided);
        for (StrokeActor* stroke : {&undecided_halo_, &undecided_}) {
            stroke->set_cut(plane, tessellation.origin(), frame.size);
            stroke->set_lines(edge_lines(mesh, tessellation, section, is_drawn_undecided), 1.0 / frame.size);
            frame.place(stroke->actor(), tessellation.origin());
        }
    }
    std::stable_sort(tangled.begin(), tangled.end(), [&quality](Index a, Index b) {
        return quality.elements[a].scaled_jacobian < quality.elements[b].scaled_jacobian;
    });
    std::vector<bool> is_on_surface(quality.elements.size(), false);
    for (Index element : drawn.triangle_elements()) is_on_surface[element] = true;
    // Of what is cut, the ring is about what shows in the plane.
    std::vector<std::array<Eigen::RowVector3d, 2>> section_boxes(section ? quality.elements.size() : 0);
    if (section) {
        const double infinity = std::numeric_limits<double>::infinity();
        for (auto& box : section_boxes)
            box = {Eigen::RowVector3d::Constant(infinity), Eigen::RowVector3d::Constant(-infinity)};
        for (std::size_t corner = 0; corner < section->triangles().size(); ++corner) {
            const float* x = section->points().data() + 3 * section->triangles()[corner];
            auto& box = section_boxes[static_cast<std::size_t>(section->triangle_elements()[corner / 3])];
            const Eigen::RowVector3d at = Eigen::RowVector3d(x[0], x[1], x[2]) + section->origin();
            box = {box[0].cwiseMin(at), box[1].cwiseMax(at)};
        }
    }
    for (Index element : tangled) {
        const Eigen::MatrixX3d x = mesh.element_coordinates(element);
        const Eigen::RowVector3d center = 0.5 * (x.colwise().minCoeff() + x.colwise().maxCoeff());
        const double radius = (x.rowwise() - center).rowwise().norm().maxCoeff() / frame.size;
        if (section && section->sides()[static_cast<std::size_t>(element)] == PlaneCut::Side::cut) {
            const auto& box = section_boxes[static_cast<std::size_t>(element)];
            marks_.push_back(
                {frame.to_world(0.5 * (box[0] + box[1])), 0.5 * (box[1] - box[0]).norm() / frame.size, false});
            continue;
        }
        marks_.push_back({frame.to_world(center), radius, !is_on_surface[element]});
    }
}

void TangledMarks::update(const ViewMetrics& view) {
    draw_rings(view);
    for (SurfaceActor* surface : {&hatched_, &hatched_section_}) surface->update(view);
    for (StrokeActor* stroke : {&halo_, &outline_, &undecided_halo_, &undecided_, &ring_halo_, &ring_, &inside_ring_})
        stroke->update(view);
}

void TangledMarks::draw_rings(const ViewMetrics& view) {
    const double radius = ring_radius * view.pixel_ratio;
    std::vector<Eigen::Vector2d> centers;
    Polylines rings, inside_rings, all_rings;
    for (const Mark& mark : marks_) {
        if (centers.size() == most_rings) break;
        const Eigen::Vector4d at = view.project(mark.center);
        if (at[3] <= 0.0) continue;
        const Eigen::Vector2d center = at.head<2>();
        if (!mark.is_inside && mark.radius * view.pixels_per_unit(at[3]) > ring_needed_below * view.pixel_ratio)
            continue;
        if (center[0] < -radius || center[1] < -radius || center[0] > view.size[0] + radius ||
            center[1] > view.size[1] + radius)
            continue;
        // Where many are close together the ring of the worst speaks for all.
        const bool is_crowded = std::any_of(centers.begin(), centers.end(), [&](const Eigen::Vector2d& other) {
            return (other - center).norm() < 1.6 * radius;
        });
        if (is_crowded) continue;
        centers.push_back(center);
        std::vector<std::array<double, 3>> line;
        constexpr int pieces = 40;
        for (int i = 0; i <= pieces; ++i) {
            const double angle = 2.0 * std::numbers::pi * (i % pieces) / pieces;
            line.push_back({center[0] + radius * std::cos(angle), center[1] + radius * std::sin(angle), 0.0});
        }
        (mark.is_inside ? inside_rings : rings).add(line);
        all_rings.add(line);
    }
    ring_halo_.set_lines(all_rings, 1.0);
    ring_.set_lines(rings, 1.0);
    inside_ring_.set_lines(inside_rings, 1.0);
}

}  // namespace curvewright
