#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/basis/element_type.h"

namespace curvewright {

/// Gmsh's numbers of the full Lagrange elements of one shape, from order 1 upward.
struct MshFamily {
    Shape shape;
    std::vector<int> numbers;
};

/// Gmsh's numbers of all shapes.
inline const std::array<MshFamily, 8>& msh_families() {
    static const std::array<MshFamily, 8> families = {{
        {Shape::vertex, {15}},
        {Shape::line, {1, 8, 26, 27, 28, 62, 63, 64, 65, 66}},
        {Shape::triangle, {2, 9, 21, 23, 25, 42, 43, 44, 45, 46}},
        {Shape::quadrilateral, {3, 10, 36, 37, 38, 47, 48, 49, 50, 51}},
        {Shape::tetrahedron, {4, 11, 29, 30, 31, 71, 72, 73, 74, 75}},
        {Shape::hexahedron, {5, 12, 92, 93, 94, 95, 96, 97, 98}},
        {Shape::prism, {6, 13, 90, 91, 106, 107, 108, 109, 110}},
        {Shape::pyramid, {7, 14, 118, 119, 120, 121, 122, 123, 124}},
    }};
    return families;
}

/// None for numbers of incomplete (serendipity) elements and of anything else that is no full Lagrange element.
inline std::optional<ElementType> element_of_msh_type(long long number) {
    for (const MshFamily& family : msh_families()) {
        const auto found = std::find(family.numbers.begin(), family.numbers.end(), number);
        if (found != family.numbers.end())
            return ElementType{family.shape, static_cast<int>(found - family.numbers.begin()) + 1};
    }
    return std::nullopt;
}

/// None where Gmsh has no such element (hexahedra, prisms and pyramids end at order 9).
inline std::optional<int> msh_type_of(ElementType type) {
    for (const MshFamily& family : msh_families())
        if (family.shape == type.shape && type.order >= 1 && type.order <= static_cast<int>(family.numbers.size()))
            return family.numbers[static_cast<std::size_t>(type.order) - 1];
    return std::nullopt;
}

}  // namespace curvewright
