#include "ui/scene/element_spacing.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

double element_spacing(const CurvedMesh& mesh, Index element) {
    const auto nodes = mesh.topology().element_nodes(element);
    const ElementType type = mesh.topology().element_type(element);
    const auto position = [&](int corner) {
        return Eigen::Vector3d(mesh.coordinates().row(nodes[corner]).transpose());
    };
    double shortest = -1.0, longest = 0.0;
    for (const SubElement& side : reference_element(type).edges) {
        const double length = (position(side.nodes[1]) - position(side.nodes[0])).norm();
        shortest = shortest < 0.0 ? length : std::min(shortest, length);
        longest = std::max(longest, length);
    }
    if (dimension(type.shape) != 2) return std::max(shortest, 0.0);
    const bool is_triangle = corner_count(type.shape) == 3;
    const double area = (position(is_triangle ? 1 : 2) - position(0))
                            .cross(is_triangle ? Eigen::Vector3d(position(2) - position(0))
                                               : Eigen::Vector3d(position(3) - position(1)))
                            .norm();
    return longest > 0.0 ? area / longest : 0.0;
}

}  // namespace

std::vector<float> line_spacing(const CurvedMesh& mesh, const Tessellation& tessellation) {
    return line_spacing(mesh, tessellation.line_elements());
}

std::vector<float> line_spacing(const CurvedMesh& mesh, const std::vector<Index>& elements) {
    std::vector<float> spacing;
    spacing.reserve(elements.size());
    for (Index element : elements) spacing.push_back(static_cast<float>(element_spacing(mesh, element)));
    return spacing;
}

double median(std::vector<float> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace curvewright
