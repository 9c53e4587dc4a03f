#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <vtkCellType.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>

#include "core/basis/node_ordering.h"
#include "core/basis/reference_element.h"

namespace curvewright {

/// VTK's cell types of one shape: order 1, and orders above it (nodes in this program's order).
struct CellKind {
    Shape shape;
    int linear, lagrange;
};
inline constexpr std::array<CellKind, 8> cell_kinds = {{
    {Shape::vertex, VTK_VERTEX, VTK_VERTEX},
    {Shape::line, VTK_LINE, VTK_LAGRANGE_CURVE},
    {Shape::triangle, VTK_TRIANGLE, VTK_LAGRANGE_TRIANGLE},
    {Shape::quadrilateral, VTK_QUAD, VTK_LAGRANGE_QUADRILATERAL},
    {Shape::tetrahedron, VTK_TETRA, VTK_LAGRANGE_TETRAHEDRON},
    {Shape::hexahedron, VTK_HEXAHEDRON, VTK_LAGRANGE_HEXAHEDRON},
    {Shape::prism, VTK_WEDGE, VTK_LAGRANGE_WEDGE},
    {Shape::pyramid, VTK_PYRAMID, VTK_LAGRANGE_PYRAMID},
}};

/// The one type whose corners VTK has in another order: the base of its linear prism (vtkWedge) looks outward, so that
/// corners 1 and 2, and 4 and 5, change places. That of its prisms of higher order (types 32 and 73) looks inward, as
/// ours does; Gmsh and meshio write them so, too.
inline constexpr ElementType linear_prism{Shape::prism, 1};

/// Between VTK's order of a linear prism and ours, in either direction. pre: six nodes.
template <class Nodes>
void swap_prism_corners(Nodes& nodes) {
    std::swap(nodes[1], nodes[2]);
    std::swap(nodes[4], nodes[5]);
}

/// Complete VTK cells of fixed order whose nodes VTK numbers in its own way.
struct FixedCell {
    int vtk_type;
    ElementType type;
};
inline constexpr std::array<FixedCell, 9> fixed_cells = {{
    {VTK_PIXEL, {Shape::quadrilateral, 1}},
    {VTK_VOXEL, {Shape::hexahedron, 1}},
    {VTK_QUADRATIC_EDGE, {Shape::line, 2}},
    {VTK_CUBIC_LINE, {Shape::line, 3}},
    {VTK_QUADRATIC_TRIANGLE, {Shape::triangle, 2}},
    {VTK_BIQUADRATIC_QUAD, {Shape::quadrilateral, 2}},
    {VTK_QUADRATIC_TETRA, {Shape::tetrahedron, 2}},
    {VTK_TRIQUADRATIC_HEXAHEDRON, {Shape::hexahedron, 2}},
    {VTK_BIQUADRATIC_QUADRATIC_WEDGE, {Shape::prism, 2}},
}};

inline int vtk_type_of(ElementType type) {
    for (const CellKind& kind : cell_kinds)
        if (kind.shape == type.shape) return type.order == 1 ? kind.linear : kind.lagrange;
    return VTK_EMPTY_CELL;
}

/// A VTK cell type that can be read: its element type for a number of points, and permutation[i] = position in the VTK
/// cell of the node that stands at position i in ours (empty: the same order).
struct ReadableCell {
    ElementType type;
    std::vector<vtkIdType> permutation;
    /// A linear VTK cell with the points of a higher order: what Gmsh 4.8 writes above order 2, in its own order.
    bool is_gmsh_export = false;
};

/// From the parametric coordinates that VTK gives the nodes of the cell.
inline std::vector<vtkIdType> permutation_of_fixed_cell(const FixedCell& fixed) {
    vtkNew<vtkGenericCell> cell;
    cell->SetCellType(fixed.vtk_type);
    const double* parametric = cell->GetParametricCoords();
    const ReferenceElement& element = reference_element(fixed.type);
    std::vector<vtkIdType> permutation(element.lattice.size(), -1);
    for (std::size_t i = 0; i < permutation.size(); ++i) {
        LatticePoint point{};
        for (int d = 0; d < element.dimension; ++d) {
            double x = parametric[3 * i + d];
            if (fixed.vtk_type == VTK_CUBIC_LINE) x = (x + 1.0) / 2.0;  // its parameter runs from -1 to 1
            point[d] = static_cast<int>(std::lround(x * fixed.type.order));
        }
        permutation[static_cast<std::size_t>(element.find_node(point))] = static_cast<vtkIdType>(i);
    }
    return permutation;
}

/// Lagrange hexahedra of VTK before version 9 (files before version 2.1): the nodes of the edges that go up from
/// corners 2 and 3 change places.
inline std::vector<vtkIdType> permutation_from_vtk8(int order) {
    std::vector<vtkIdType> permutation(static_cast<std::size_t>(node_count({Shape::hexahedron, order})));
    std::iota(permutation.begin(), permutation.end(), vtkIdType{0});
    const auto edge = permutation.begin() + 8 + 10 * (order - 1);
    std::swap_ranges(edge, edge + (order - 1), edge + (order - 1));
    return permutation;
}

inline std::optional<ReadableCell> readable_cell(int vtk_type, vtkIdType points) {
    for (const CellKind& kind : cell_kinds) {
        if (vtk_type == kind.linear && points == corner_count(kind.shape)) {
            ReadableCell cell{{kind.shape, 1}, {}};
            if (cell.type == linear_prism) cell.permutation = {0, 2, 1, 3, 5, 4};
            return cell;
        }
        for (int order = 3; vtk_type == kind.linear && order <= max_order; ++order) {
            const ElementType type{kind.shape, order};
            // Gmsh cannot write prisms so.
            if (kind.shape == Shape::vertex || kind.shape == Shape::prism || points != node_count(type)) continue;
            const auto& permutation = gmsh_permutation(type);
            return ReadableCell{type, {permutation.begin(), permutation.end()}, true};
        }
        if (vtk_type != kind.lagrange || kind.lagrange == VTK_LAGRANGE_PYRAMID) continue;
        for (int order = 1; order <= max_order; ++order)
            if (points == node_count({kind.shape, order})) return ReadableCell{{kind.shape, order}, {}};
    }
    for (const FixedCell& fixed : fixed_cells)
        if (vtk_type == fixed.vtk_type && points == node_count(fixed.type))
            return ReadableCell{fixed.type, permutation_of_fixed_cell(fixed)};
    return std::nullopt;
}

}  // namespace curvewright
