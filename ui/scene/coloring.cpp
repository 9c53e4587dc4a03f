#include "ui/scene/coloring.h"

#include <algorithm>
#include <cmath>

#include "core/tessellate/plane_cut.h"
#include "core/tessellate/tessellation.h"
#include "ui/palette/quality_colors.h"
#include "ui/scene/surface_parts.h"

namespace curvewright {
namespace {

constexpr Color neutral_color{0.80, 0.84, 0.88};

bool fits(const FieldArray& array, const MeshTopology& topology) {
    const bool is_on_nodes = array.place == FieldArray::Place::nodes;
    const Index count = is_on_nodes ? topology.node_count() : topology.element_count();
    return array.components >= 1 &&
           array.values.size() == static_cast<std::size_t>(count) * static_cast<std::size_t>(array.components);
}

/// nodes × 3.
std::vector<double> displacements(const CurvedMesh& mesh, const Coordinates& reference) {
    const Coordinates moved = mesh.coordinates() - reference;
    return {moved.data(), moved.data() + moved.size()};
}

}  // namespace

bool SurfacePainter::is_on_nodes() const {
    return coloring_.source == Coloring::Source::distance_moved ||
           (coloring_.source == Coloring::Source::array && coloring_.array &&
            coloring_.array->place == FieldArray::Place::nodes);
}

void SurfacePainter::fit(const std::vector<double>& values) {
    const auto range = finite_range(values);
    has_values_ = range.has_value();
    has_missing_ = std::any_of(values.begin(), values.end(), [](double value) { return !std::isfinite(value); });
    if (!range) return;
    auto [lower, upper] = *range;
    if (coloring_.source == Coloring::Source::distance_moved) {
        lower = 0.0;
        if (upper == 0.0) upper = 1.0;  // nothing has moved yet
    }
    scale_ = fitted(scale_, lower, upper);
    if (coloring_.lower) scale_.lower = *coloring_.lower;
    if (coloring_.upper) scale_.upper = *coloring_.upper;
}

void SurfacePainter::find_scale(const CurvedMesh& mesh) {
    scale_ = {coloring_.map, coloring_.is_reversed, coloring_.lower.value_or(0.0), coloring_.upper.value_or(1.0)};
    has_values_ = has_missing_ = false;
    if (coloring_.source == Coloring::Source::distance_moved && coloring_.reference &&
        coloring_.reference->rows() == mesh.coordinates().rows())
        fit(scalar_values(displacements(mesh, *coloring_.reference), 3, -1));
    if (coloring_.source == Coloring::Source::array && coloring_.array && fits(*coloring_.array, mesh.topology()))
        fit(scalar_values(coloring_.array->values, coloring_.array->components, coloring_.component));
}

void SurfacePainter::paint(SurfaceParts& surface, const Tessellation& tessellation, const CurvedMesh& mesh,
                           const QualityReport* quality) {
    find_scale(mesh);
    switch (coloring_.source) {
        case Coloring::Source::scaled_jacobian:
            has_values_ = quality != nullptr;
            paint_elements(surface, tessellation, [quality, scale = scale_](Index element) {
                if (quality == nullptr) return neutral_color;
                const ElementQuality& its = quality->elements[static_cast<std::size_t>(element)];
                return quality_color(its.scaled_jacobian, its.validity, scale);
            });
            return;
        case Coloring::Source::distance_moved:
            if (coloring_.reference && coloring_.reference->rows() == mesh.coordinates().rows()) {
                paint_nodes(surface, tessellation, displacements(mesh, *coloring_.reference), 3, -1);
                return;
            }
            break;
        case Coloring::Source::array:
            if (coloring_.array && fits(*coloring_.array, mesh.topology())) {
                paint_array(surface, tessellation);
                return;
            }
            break;
        case Coloring::Source::plain:
            break;
    }
    paint_elements(surface, tessellation, [](Index) { return neutral_color; });
}

void SurfacePainter::paint_array(SurfaceParts& surface, const Tessellation& tessellation) {
    const FieldArray& array = *coloring_.array;
    if (array.place == FieldArray::Place::nodes) {
        paint_nodes(surface, tessellation, array.values, array.components, coloring_.component);
        return;
    }
    std::vector<double> scalars = scalar_values(array.values, array.components, coloring_.component);
    paint_elements(surface, tessellation, [scalars = std::move(scalars), scale = scale_](Index element) {
        const double value = scalars[static_cast<std::size_t>(element)];
        return std::isfinite(value) ? scale.color_of(value) : no_value_color();
    });
}

void SurfacePainter::paint_elements(SurfaceParts& surface, const Tessellation& tessellation,
                                    std::function<Color(Index)> color_of) {
    color_of_ = std::move(color_of);
    nodal_.clear();
    surface.set_colors(tessellation, color_of_);
}

void SurfacePainter::paint_nodes(SurfaceParts& surface, const Tessellation& tessellation, std::vector<double> values,
                                 int components, int component) {
    nodal_ = std::move(values);
    components_ = components;
    component_ = component;
    surface.set_field(scalar_values(tessellation.evaluate(nodal_, components), components, component), scale_);
}

void SurfacePainter::paint_section(SurfaceActor& surface, const PlaneCut& section) const {
    const auto all = [](Index) { return true; };
    if (nodal_.empty()) {
        surface.set_section(section, all, color_of_);
        return;
    }
    const std::vector<Index> points = surface.set_section(section, all, [](Index) { return neutral_color; });
    const std::vector<double> at_points = scalar_values(section.evaluate(nodal_, components_), components_, component_);
    std::vector<double> values;
    for (const Index point : points) values.push_back(at_points[static_cast<std::size_t>(point)]);
    if (!values.empty()) surface.set_field(values, scale_);
}

}  // namespace curvewright
