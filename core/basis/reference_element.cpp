#include "core/basis/reference_element.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>

namespace curvewright {
namespace {

struct SubShapes {
    std::vector<std::vector<int>> edges;
    std::vector<std::vector<int>> faces;
};

const SubShapes& sub_shapes(Shape shape) {
    static const SubShapes none;
    static const SubShapes line{{{0, 1}}, {}};
    static const SubShapes triangle{{{0, 1}, {1, 2}, {2, 0}}, {{0, 1, 2}}};
    static const SubShapes quadrilateral{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {{0, 1, 2, 3}}};
    static const SubShapes tetrahedron{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
                                       {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}}};
    static const SubShapes hexahedron{
        {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}},
        {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
    static const SubShapes prism{{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
                                 {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
    static const SubShapes pyramid{{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}},
                                   {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
    switch (shape) {
        case Shape::vertex:
            return none;
        case Shape::line:
            return line;
        case Shape::triangle:
            return triangle;
        case Shape::quadrilateral:
            return quadrilateral;
        case Shape::tetrahedron:
            return tetrahedron;
        case Shape::hexahedron:
            return hexahedron;
        case Shape::prism:
            return prism;
        case Shape::pyramid:
            return pyramid;
    }
    return none;
}

/// The nodes of the sub-element spanned by the given corners of the element. The lattices are affine on every edge and
/// face, so the sub-element's lattice maps to the element's through its first corner and the corners next to it.
SubElement make_sub_element(const ReferenceElement& element, const std::vector<int>& corners, Shape shape) {
    const int p = element.type.order;
    SubElement sub{{shape, shape == Shape::vertex ? 1 : p}, {}};
    const LatticePoint origin = element.lattice[corners[0]];
    std::array<LatticePoint, 2> axes{};
    const int last = static_cast<int>(corners.size()) - 1;
    for (int d = 0; d < 3; ++d) {
        if (last >= 1) axes[0][d] = element.lattice[corners[1]][d] - origin[d];
        if (last >= 2) axes[1][d] = element.lattice[corners[last]][d] - origin[d];
    }
    for (const LatticePoint& point : vtk_node_order(sub.type)) {
        LatticePoint image;
        for (int d = 0; d < 3; ++d) image[d] = origin[d] + (axes[0][d] * point[0] + axes[1][d] * point[1]) / p;
        const int node = element.find_node(image);
        if (node < 0) throw std::logic_error("a face of a " + name(element.type) + " leaves its lattice");
        sub.nodes.push_back(node);
    }
    return sub;
}

std::unique_ptr<const ReferenceElement> build(ElementType type) {
    if (type.order < 1 || type.order > max_order) throw std::logic_error("order out of range: " + name(type));
    auto element = std::make_unique<ReferenceElement>();
    element->type = type;
    element->dimension = dimension(type.shape);
    element->lattice = vtk_node_order(type);
    const SubShapes& shapes = sub_shapes(type.shape);
    for (const auto& corners : shapes.edges) element->edges.push_back(make_sub_element(*element, corners, Shape::line));
    for (const auto& corners : shapes.faces) {
        const Shape shape = corners.size() == 3 ? Shape::triangle : Shape::quadrilateral;
        element->faces.push_back(make_sub_element(*element, corners, shape));
    }
    if (element->dimension == 3) element->facets = element->faces;
    if (element->dimension == 2) element->facets = element->edges;
    if (element->dimension == 1)
        for (int corner : {0, 1}) element->facets.push_back({{Shape::vertex, 1}, {corner}});
    std::vector<bool> on_facet(element->lattice.size(), false);
    for (const auto& facet : element->facets)
        for (int node : facet.nodes) on_facet[node] = true;
    for (int node = 0; node < element->node_count(); ++node)
        if (!on_facet[node]) element->interior_nodes.push_back(node);
    for (LatticePoint point : element->lattice) {
        if (element->dimension == 1)
            point[0] = type.order - point[0];
        else
            std::swap(point[0], point[1]);
        element->mirrored.push_back(element->find_node(point));
    }
    return element;
}

}  // namespace

int ReferenceElement::find_node(LatticePoint point) const {
    const auto found = std::find(lattice.begin(), lattice.end(), point);
    return found == lattice.end() ? -1 : static_cast<int>(found - lattice.begin());
}

const ReferenceElement& reference_element(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, std::unique_ptr<const ReferenceElement>> cache;
    const std::lock_guard lock(mutex);
    auto& entry = cache[type];
    if (!entry) entry = build(type);
    return *entry;
}

}  // namespace curvewright
