#pragma once

#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright::testing {

/// The same cells, each with points of its own, in the order of the blocks.
inline CurvedMesh with_own_points(const CurvedMesh& mesh) {
    MeshData data = mesh.topology().data();
    data.node_tags.clear();
    data.node_entities.clear();
    std::vector<Eigen::RowVector3d> points;
    for (ElementBlock& block : data.blocks)
        for (Index& node : block.nodes) {
            points.emplace_back(mesh.coordinates().row(node));
            node = static_cast<Index>(data.node_tags.size());
            data.node_tags.push_back({node + 1});
        }
    Coordinates x(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = points[i];
    return {std::make_shared<const MeshTopology>(std::move(data)), std::move(x)};
}

/// The mesh with a slit: elements of which `is_behind` holds get nodes of their own where `is_on_slit` holds.
template <class OnSlit, class Behind>
CurvedMesh with_slit(const CurvedMesh& mesh, const OnSlit& is_on_slit, const Behind& is_behind) {
    MeshData data = mesh.topology().data();
    data.node_entities.clear();
    std::vector<Index> twin(data.node_tags.size(), -1);
    std::vector<Eigen::RowVector3d> points;
    for (Eigen::Index i = 0; i < mesh.coordinates().rows(); ++i) points.emplace_back(mesh.coordinates().row(i));
    for (ElementBlock& block : data.blocks) {
        if (dimension(block.type.shape) != mesh.topology().dimension()) continue;
        const auto per_cell = static_cast<std::size_t>(node_count(block.type));
        for (std::size_t first = 0; first < block.nodes.size(); first += per_cell) {
            Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
            for (std::size_t i = 0; i < per_cell; ++i) center += points[block.nodes[first + i]] / double(per_cell);
            if (!is_behind(center)) continue;
            for (std::size_t i = 0; i < per_cell; ++i) {
                Index& node = block.nodes[first + i];
                if (!is_on_slit(points[node])) continue;
                if (twin[node] < 0) {
                    twin[node] = static_cast<Index>(points.size());
                    data.node_tags.push_back({100000 + twin[node]});
                    const Eigen::RowVector3d place = points[node];
                    points.push_back(place);
                }
                node = twin[node];
            }
        }
    }
    Coordinates x(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = points[i];
    return {std::make_shared<const MeshTopology>(std::move(data)), std::move(x)};
}

/// Elements given by their types and nodes (this program's order), one block each; tags 1, 2, ….
struct Cell {
    ElementType type;
    std::vector<Index> nodes;
};
inline CurvedMesh mesh_of_cells(const std::vector<std::array<double, 3>>& points, const std::vector<Cell>& cells) {
    MeshData data;
    Coordinates x(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        data.node_tags.push_back({static_cast<std::int64_t>(i) + 1});
        x.row(static_cast<Eigen::Index>(i)) << points[i][0], points[i][1], points[i][2];
    }
    for (std::size_t i = 0; i < cells.size(); ++i)
        data.blocks.push_back({cells[i].type, 0, cells[i].nodes, {{static_cast<std::int64_t>(i) + 1}}});
    return {std::make_shared<const MeshTopology>(std::move(data)), std::move(x)};
}

/// A quadrilateral with two others of half its height on its right, which meet at node 6.
inline CurvedMesh hanging_square() {
    return mesh_of_cells({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {1, .5, 0}, {2, .5, 0}, {2, 1, 0}},
                         {{{Shape::quadrilateral, 1}, {0, 1, 2, 3}},
                          {{Shape::quadrilateral, 1}, {1, 4, 6, 5}},
                          {{Shape::quadrilateral, 1}, {5, 6, 7, 2}}});
}

/// A hexahedron of side 2 with eight of side 1 on its right, which do not know it.
inline CurvedMesh hanging_cubes() {
    std::vector<std::array<double, 3>> points = {{-2, 0, 0}, {-2, 2, 0}, {-2, 2, 2}, {-2, 0, 2}};
    const auto id = [](int i, int j, int k) { return static_cast<Index>(4 + (k * 3 + j) * 3 + i); };
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) points.push_back({double(i), double(j), double(k)});
    std::vector<Cell> cells = {
        {{Shape::hexahedron, 1}, {0, id(0, 0, 0), id(0, 2, 0), 1, 3, id(0, 0, 2), id(0, 2, 2), 2}}};
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                cells.push_back({{Shape::hexahedron, 1},
                                 {id(i, j, k), id(i + 1, j, k), id(i + 1, j + 1, k), id(i, j + 1, k), id(i, j, k + 1),
                                  id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)}});
    return mesh_of_cells(points, cells);
}

}  // namespace curvewright::testing
