#include "ui/scene/mesh_drawing.h"

#include <algorithm>
#include <atomic>

#include <vtkActor.h>

#include "ui/scene/element_spacing.h"
#include "ui/scene/mesh_numbers.h"

namespace curvewright {
namespace {

/// Some of the lines of a tessellation.
struct LineRange {
    std::size_t begin = 0, end = 0;
};

LineRange all_lines(const Tessellation& tessellation) {
    return {0, tessellation.line_elements().size()};
}

/// What one of several actors draws of them; few are all the first one's.
LineRange part_of_lines(const Tessellation& tessellation, std::size_t part, std::size_t parts) {
    constexpr std::size_t few = 20000;
    const std::size_t count = tessellation.line_elements().size();
    const std::size_t each = std::max(few, (count + parts - 1) / parts);
    return {std::min(count, part * each), std::min(count, (part + 1) * each)};
}

/// Lines that are drawn by actors of their own.
enum class LineKind {
    inside,     ///< not on the boundary of a flat mesh
    boundary,   ///< on it
    interface,  ///< of those inside, and on a solid's surface, the edges of interfaces
};

bool is_of_kind(const Tessellation& tessellation, std::size_t line, LineKind kind) {
    if (kind == LineKind::interface) return tessellation.line_is_interface()[line] != 0;
    return (tessellation.line_is_boundary()[line] != 0) == (kind == LineKind::boundary);
}

/// The lines of a kind.
Polylines select_lines(const Tessellation& tessellation, LineRange range, const std::vector<float>& spacing,
                       LineKind kind) {
    Polylines lines;
    const auto& offsets = tessellation.line_offsets();
    for (std::size_t line = range.begin; line < range.end; ++line) {
        if (!is_of_kind(tessellation, line, kind)) continue;
        const auto begin = tessellation.edge_points().begin();
        lines.points.insert(lines.points.end(), begin + 3 * offsets[line], begin + 3 * offsets[line + 1]);
        lines.offsets.push_back(static_cast<Index>(lines.points.size() / 3));
        lines.spacing.push_back(spacing[line]);
    }
    return lines;
}

/// The lines with a flag.
Polylines select_lines(const Tessellation& tessellation, const std::vector<std::uint8_t>& flags) {
    Polylines lines;
    const auto& offsets = tessellation.line_offsets();
    const auto begin = tessellation.edge_points().begin();
    for (std::size_t line = 0; line < flags.size(); ++line) {
        if (flags[line] == 0) continue;
        lines.points.insert(lines.points.end(), begin + 3 * offsets[line], begin + 3 * offsets[line + 1]);
        lines.offsets.push_back(static_cast<Index>(lines.points.size() / 3));
    }
    return lines;
}

/// Their points alone, in the same order.
std::vector<float> select_points(const Tessellation& tessellation, LineRange range, LineKind kind) {
    std::vector<float> points;
    const auto& offsets = tessellation.line_offsets();
    points.reserve(3 * static_cast<std::size_t>(offsets[range.end] - offsets[range.begin]));
    const auto begin = tessellation.edge_points().begin();
    for (std::size_t line = range.begin; line < range.end; ++line)
        if (is_of_kind(tessellation, line, kind))
            points.insert(points.end(), begin + 3 * offsets[line], begin + 3 * offsets[line + 1]);
    return points;
}

/// Pieces per curved side of so many faces. Where they are many they are small on the screen, and the chord tolerance
/// alone is enough: pieces are what a frame costs. Few are cut finer, so that they stay smooth when one comes close.
int least_subdivisions(std::size_t faces) {
    return faces <= 8000 ? 4 : faces <= 40000 ? 2 : 1;
}

}  // namespace

MeshDrawing::MeshDrawing() = default;

MeshDrawing::MeshDrawing(std::shared_ptr<const CurvedMesh> mesh, std::shared_ptr<const QualityReport> quality,
                         const std::optional<WorldFrame>& frame)
    : mesh_(std::move(mesh)), quality_(std::move(quality)) {
    if (frame) {
        frame_ = *frame;
        return;
    }
    const auto box = bounding_box(*mesh_);
    const double diagonal = (box.row(1) - box.row(0)).norm();
    frame_ = {0.5 * (box.row(0) + box.row(1)), diagonal > 0.0 ? diagonal : 1.0};
}

std::vector<vtkActor*> MeshDrawing::actors() const {
    std::vector<vtkActor*> actors = surface_.actors();
    actors.push_back(section_.actors()[0]);
    for (const StrokeActor& edges : edges_) actors.push_back(edges.actor());
    for (vtkActor* actor : {boundary_.actor(), interfaces_.actor(), section_.actors()[1]}) actors.push_back(actor);
    for (vtkActor* actor : marks_.actors()) actors.push_back(actor);
    for (vtkActor* actor : nodes_.actors()) actors.push_back(actor);
    for (vtkActor* actor : {highlight_halo_.actor(), highlight_.actor()}) actors.push_back(actor);
    return actors;
}

TessellationOptions MeshDrawing::tessellation_options() const {
    const MeshTopology& topology = mesh_->topology();
    TessellationOptions its;
    its.element_size = options.element_size;
    const std::size_t faces = topology.dimension() == 3 ? topology.boundary_facets().size()
                                                        : static_cast<std::size_t>(topology.element_count());
    its.min_subdivisions = least_subdivisions(faces);
    its.chord_tolerance /= std::max(1.0, options.magnification);
    // Numbers on nodes are to be seen between them.
    if (painter.is_on_nodes()) {
        const int whole = 2 * topology.order();
        its.field_subdivisions = std::max(2, faces <= 2000 ? whole : faces <= 8000 ? (whole + 1) / 2 : 2);
    }
    return its;
}

void MeshDrawing::take_pieces(const MeshDrawing& other) {
    tessellation_ = other.tessellation_;
    visible_ = other.visible_;
}

void MeshDrawing::make(bool may_move) {
    std::vector<bool> now_visible = find_visible(*mesh_, options);
    const bool moves =
        may_move && tessellation_ && now_visible == visible_ && tessellation_->is_fine_enough(mesh_->coordinates());
    const bool is_new = !moves || surface_.is_empty();
    visible_ = std::move(now_visible);
    if (moves)
        move_pieces();
    else
        tessellation_ = std::make_shared<Tessellation>(*mesh_, visible_, tessellation_options());
    surface_.set_lit(!is_flat());
    surface_.set_surface(*tessellation_, is_new);
    section_.forget();  // of another state; make_cut() makes it anew
    paint();
    surface_.place(frame_, tessellation_->origin());
    const std::vector<float> spacing = line_spacing(*mesh_, *tessellation_);
    typical_spacing_ = median(spacing) / frame_.size;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        const LineRange range = part_of_lines(*tessellation_, i, edges_.size());
        edges_[i].set_lines(select_lines(*tessellation_, range, spacing, LineKind::inside), 1.0 / frame_.size);
        frame_.place(edges_[i].actor(), tessellation_->origin());
    }
    const LineRange all = all_lines(*tessellation_);
    boundary_.set_lines(select_lines(*tessellation_, all, spacing, LineKind::boundary), 1.0 / frame_.size);
    interfaces_.set_lines(select_lines(*tessellation_, all, spacing, LineKind::interface), 1.0 / frame_.size);
    for (const StrokeActor* stroke : {&boundary_, &interfaces_}) frame_.place(stroke->actor(), tessellation_->origin());
    nodes_.set_nodes(*mesh_, *tessellation_, frame_);
    make_cut();
}

void MeshDrawing::move_pieces() {
    if (tessellation_.use_count() > 1)
        tessellation_ = std::make_shared<Tessellation>(*tessellation_);
    else
        std::atomic_thread_fence(std::memory_order_acquire);  // after whoever has read it last
    tessellation_->move(mesh_->coordinates());
}

void MeshDrawing::make_cut() {
    const bool is_cut = options.clip && options.clip->style == ClipStyle::cut;
    const std::optional<CuttingPlane> plane = is_cut ? find_plane(*mesh_, options.clip) : std::nullopt;
    section_.forget();
    if (plane) find_section(*plane);
    draw_section();
    if (quality_)
        marks_.set_mesh(*mesh_, *quality_, visible_, *tessellation_, section_.cut(), frame_);
    else
        marks_.clear();
    make_highlight();
    apply_styles();
}

void MeshDrawing::find_section(const CuttingPlane& plane) {
    PlaneCutOptions its;
    const TessellationOptions outside = tessellation_options();
    its.min_subdivisions = std::max(2, outside.min_subdivisions);
    its.chord_tolerance = outside.chord_tolerance;
    its.element_size = options.element_size;
    section_.find(*mesh_, plane, visible_, its);
}

/// The section, and what its plane leaves of surface, edges and nodes.
void MeshDrawing::draw_section() {
    const std::optional<CuttingPlane> plane = cutting_plane();
    surface_.set_cut(plane, tessellation_->origin(), frame_.size);
    for (StrokeActor& edges : edges_) edges.set_cut(plane, tessellation_->origin(), frame_.size);
    interfaces_.set_cut(plane, tessellation_->origin(), frame_.size);
    nodes_.set_cut(plane, tessellation_->origin(), frame_.size);
    section_.draw(*mesh_, painter, frame_);
    section_.show_edges(options.show_edges);
}

void MeshDrawing::paint() {
    painter.paint(surface_, *tessellation_, *mesh_, quality_.get());
    if (section_.cut()) painter.paint_section(section_.surface(), *section_.cut());
}

void MeshDrawing::make_highlight() {
    Polylines lines;
    Eigen::RowVector3d origin = frame_.origin;
    std::vector<bool> flags(mesh_ ? static_cast<std::size_t>(mesh_->topology().element_count()) : 0, false);
    std::size_t count = 0;
    for (Index element : highlighted)
        if (element >= 0 && static_cast<std::size_t>(element) < flags.size()) {
            flags[static_cast<std::size_t>(element)] = true;
            ++count;
        }
    if (count > 0) {
        // The sides between two of them are drawn as well, unless they are so many that nothing else would be seen.
        TessellationOptions its;
        its.min_subdivisions = least_subdivisions(count);
        its.chord_tolerance = tessellation_options().chord_tolerance;
        const Tessellation outline(*mesh_, flags, its);
        if (count > (is_flat() ? most_outlined_singly : most_solids_outlined_singly))
            lines = select_lines(outline, is_flat() ? outline.line_is_boundary() : outline.line_is_rim());
        if (lines.count() == 0) {  // all of a closed surface has no rim, nor has what is all inside
            lines.points = outline.edge_points();
            lines.offsets = outline.line_offsets();
        }
        origin = outline.origin();
        if (const PlaneCut* section = section_.cut())
            lines.add_section(*section, origin, [&](std::size_t line) {
                return flags[static_cast<std::size_t>(section->line_elements()[line])];
            });
    }
    for (StrokeActor* stroke : {&highlight_halo_, &highlight_}) {
        stroke->set_cut(cutting_plane(), origin, frame_.size);
        stroke->set_lines(lines, 1.0 / frame_.size);
        frame_.place(stroke->actor(), origin);
    }
}

void MeshDrawing::apply_styles() {
    const StrokeStyle edge_style{
        .color = options.edge_color, .opacity = 0.75, .width = 1.1, .depth_bias = 4e-4, .fades = true};
    for (StrokeActor& edges : edges_) edges.set_style(edge_style);
    section_.set_edge_style(edge_style);
    boundary_.set_style({.color = options.edge_color, .width = 1.6, .depth_bias = 5e-4});
    // Dotted: told from the boundary, and from an edge that is no more than that.
    interfaces_.set_style({.color = options.edge_color, .width = 2.6, .dash = 6.0, .depth_bias = 5e-4});
    show_edges(options.show_edges);
    section_.show_edges(options.show_edges);
    boundary_.actor()->SetVisibility(tessellation_ && is_flat());
    interfaces_.actor()->SetVisibility(tessellation_ && !interfaces_.is_empty());
    highlight_halo_.set_style({.color = options.background, .width = 6.5, .cap = 1.0, .is_on_top = true});
    // Nearer than the halo of every other side of the element.
    highlight_.set_style({.color = options.accent, .width = 3.0, .cap = 1.0, .depth_bias = 0.011, .is_on_top = true});
    nodes_.set_colors(options.edge_color, options.background, options.edge_color);
    nodes_.set_visible(options.show_nodes && tessellation_);
}

void MeshDrawing::show_edges(bool is_wanted) {
    for (StrokeActor& edges : edges_) edges.actor()->SetVisibility(is_wanted && !edges.is_empty());
}

bool MeshDrawing::move(const Coordinates& positions, std::shared_ptr<const QualityReport> quality,
                       double pixels_per_unit) {
    // Quality that follows a moment later comes with the positions that are shown already.
    const bool has_moved = positions.rows() != mesh_->coordinates().rows() || positions != mesh_->coordinates();
    if (has_moved) mesh_ = std::make_shared<const CurvedMesh>(mesh_->with_coordinates(positions));
    const bool has_new_quality = quality != nullptr;
    if (quality) quality_ = std::move(quality);
    // Telling whether a side bends too much for its chords costs as much as moving all of them: a part per frame.
    constexpr int parts = 12;
    fineness_part_ = (fineness_part_ + 1) % parts;
    if (has_moved && !tessellation_->is_fine_enough(mesh_->coordinates(), fineness_part_, parts)) {
        make(false);
        return false;
    }
    if (has_moved) move_pieces();
    // Lines between very small elements are many and hardly seen: not while things move.
    constexpr double seen_spacing = 6.0;  // units of the pixel ratio
    constexpr std::size_t many_lines = 20000;
    const bool are_too_many = tessellation_->line_elements().size() > many_lines &&
                              typical_spacing_ * pixels_per_unit < seen_spacing * options.pixel_ratio;
    show_edges(options.show_edges && !are_too_many);
    if (has_moved) surface_.set_surface(*tessellation_, false);
    const bool is_quality = painter.coloring().source == Coloring::Source::scaled_jacobian;
    if ((has_moved && painter.follows_motion()) || (has_new_quality && is_quality)) paint();
    for (std::size_t i = 0; has_moved && !are_too_many && i < edges_.size(); ++i)
        edges_[i].move_lines(
            select_points(*tessellation_, part_of_lines(*tessellation_, i, edges_.size()), LineKind::inside));
    if (has_moved) {
        const LineRange all = all_lines(*tessellation_);
        boundary_.move_lines(select_points(*tessellation_, all, LineKind::boundary));
        if (!interfaces_.is_empty()) interfaces_.move_lines(select_points(*tessellation_, all, LineKind::interface));
    }
    if (has_moved && options.show_nodes) nodes_.set_nodes(*mesh_, *tessellation_, frame_);
    // The section follows in every frame if that is quick, else in a part of the time, and with every new report.
    const auto now = std::chrono::steady_clock::now();
    if (section_.cut() && (has_new_quality || now >= next_section_)) {
        find_section(CuttingPlane(section_.cut()->plane()));
        draw_section();
        const auto end = std::chrono::steady_clock::now();
        constexpr auto quick = std::chrono::milliseconds(25);
        next_section_ = end - now <= quick ? end : end + 2 * (end - now);
    }
    if (quality_ && has_new_quality)
        marks_.set_mesh(*mesh_, *quality_, visible_, *tessellation_, section_.cut(), frame_);
    if (has_moved && !highlighted.empty()) make_highlight();
    return true;
}

std::vector<float> MeshDrawing::camera_content() const {
    std::vector<float> points;
    if (!tessellation_) return points;
    const PlaneCut* section = section_.cut();
    const Eigen::RowVector3d offset = frame_.to_world(tessellation_->origin());
    const auto add = [&](const std::vector<float>& source, const Eigen::RowVector3d& its_offset, bool is_cut) {
        for (std::size_t i = 0; i + 2 < source.size(); i += 3) {
            const Eigen::RowVector3d at(source[i], source[i + 1], source[i + 2]);
            if (is_cut && section->plane().distance(at + tessellation_->origin()) > 0.0) continue;
            for (Eigen::Index d = 0; d < 3; ++d)
                points.push_back(static_cast<float>(at[d] / frame_.size + its_offset[d]));
        }
    };
    for (const auto* source : {&tessellation_->surface_points(), &tessellation_->edge_points()})
        add(*source, offset, section != nullptr);
    if (section) add(section->points(), frame_.to_world(section->origin()), false);
    return points;
}

std::vector<NumberLabel> MeshDrawing::number_labels() const {
    return tessellation_ ? find_number_labels(*mesh_, drawn(), frame_, options) : std::vector<NumberLabel>();
}

void MeshDrawing::update(const ViewMetrics& view, double focal_distance) {
    surface_.update(view);
    section_.update(view);
    for (StrokeActor& edges : edges_) edges.update(view);
    for (StrokeActor* stroke : {&boundary_, &interfaces_, &highlight_halo_, &highlight_}) stroke->update(view);
    nodes_.update(view, typical_spacing_, focal_distance);
    marks_.update(view);
}

std::optional<Pick> MeshDrawing::pick(const ViewMetrics& view, double x, double y) const {
    if (!tessellation_) return std::nullopt;
    return pick_surface(drawn(), frame_, view, x, y, [this](Index element) {
        return quality_ && quality_->elements[static_cast<std::size_t>(element)].validity == Validity::invalid ? 1 : 0;
    });
}

}  // namespace curvewright
