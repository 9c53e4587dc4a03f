#include "tests/support/mesh_factory.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include <Eigen/LU>

#include "core/basis/lagrange.h"
#include "core/mesh/elevate.h"

namespace curvewright::testing {
namespace {

/// Collects cells of order 1 by entity and makes a mesh of them.
class Builder {
  public:
    void add_group(int dimension, int tag, const std::string& name) {
        data_.groups.push_back({dimension, tag, name});
        data_.entities.push_back({dimension, tag, {tag}, {}, {}});
    }
    void add_cell(Shape shape, int entity, const std::vector<Index>& nodes) {
        ElementBlock& block = blocks_[{dimension(shape), entity, shape}];
        block.type = {shape, 1};
        block.entity_tag = entity;
        block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
        block.tags.push_back({next_tag_++});
    }
    CurvedMesh finish(const Coordinates& x) {
        for (Eigen::Index i = 0; i < x.rows(); ++i) data_.node_tags.push_back({11 + i});
        for (auto& [key, block] : blocks_) data_.blocks.push_back(std::move(block));
        return {std::make_shared<const MeshTopology>(std::move(data_)), x};
    }

  private:
    MeshData data_;
    std::map<std::tuple<int, int, Shape>, ElementBlock> blocks_;
    std::int64_t next_tag_ = 101;
};

/// Corners of n × n × n cubes (size points per direction) and their numbers.
struct Grid {
    explicit Grid(int n) : size(n + 1), x(size * size * size, 3) {
        for (int k = 0; k <= n; ++k)
            for (int j = 0; j <= n; ++j)
                for (int i = 0; i <= n; ++i) x.row(id(i, j, k)) << double(i) / n, double(j) / n, double(k) / n;
    }
    Index id(int i, int j, int k) const { return (k * size + j) * size + i; }
    /// Corners of the cube at (i, j, k) in the order of a hexahedron.
    std::array<Index, 8> cube(int i, int j, int k) const {
        return {id(i, j, k),     id(i + 1, j, k),     id(i + 1, j + 1, k),     id(i, j + 1, k),
                id(i, j, k + 1), id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)};
    }
    int size;
    Coordinates x;
};

void add_square_boundary(Builder& builder, int n) {
    const auto id = [n](int i, int j) { return j * (n + 1) + i; };
    const std::array<const char*, 4> names{"bottom", "right", "top", "left"};
    for (int side = 0; side < 4; ++side) builder.add_group(1, side + 1, names[static_cast<std::size_t>(side)]);
    for (int i = 0; i < n; ++i) {
        builder.add_cell(Shape::line, 1, {id(i, 0), id(i + 1, 0)});
        builder.add_cell(Shape::line, 2, {id(n, i), id(n, i + 1)});
        builder.add_cell(Shape::line, 3, {id(i + 1, n), id(i, n)});
        builder.add_cell(Shape::line, 4, {id(0, i + 1), id(0, i)});
    }
}

/// The (n + 1)² points of a grid on the unit square, row by row from below.
Coordinates square_points(int n) {
    Coordinates x((n + 1) * (n + 1), 3);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) x.row(j * (n + 1) + i) << double(i) / n, double(j) / n, 0.0;
    return x;
}

}  // namespace

CurvedMesh single_element(ElementType type, const Eigen::MatrixX3d& x) {
    MeshData data;
    ElementBlock block{type, 0, {}, {{1}}};
    for (Index i = 0; i < x.rows(); ++i) {
        data.node_tags.push_back({i + 1});
        block.nodes.push_back(i);
    }
    data.blocks.push_back(block);
    return {std::make_shared<const MeshTopology>(std::move(data)), x};
}

CurvedMesh square_mesh(int n, int order) {
    Builder builder;
    add_square_boundary(builder, n);
    builder.add_group(2, 1, "domain");
    const auto id = [n](int i, int j) { return j * (n + 1) + i; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Index a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1);
            // Alternate the diagonal, so that no triangle has two sides on the boundary.
            if ((i < n / 2) == (j < n / 2)) {
                builder.add_cell(Shape::triangle, 1, {a, b, c});
                builder.add_cell(Shape::triangle, 1, {a, c, d});
            } else {
                builder.add_cell(Shape::triangle, 1, {a, b, d});
                builder.add_cell(Shape::triangle, 1, {b, c, d});
            }
        }
    return elevate(builder.finish(square_points(n)), order);
}

CurvedMesh cube_mesh(int n, int order) {
    Builder builder;
    const std::array<const char*, 6> names{"x0", "x1", "y0", "y1", "z0", "z1"};
    for (int i = 0; i < 6; ++i) builder.add_group(2, i + 1, names[i]);
    builder.add_group(3, 1, "domain");
    const auto id = [n](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
    Coordinates x((n + 1) * (n + 1) * (n + 1), 3);
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) x.row(id(i, j, k)) << double(i) / n, double(j) / n, double(k) / n;
    std::vector<std::array<Index, 4>> tetrahedra;
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                // Kuhn's six: one per order in which the three axes are walked.
                std::array<int, 3> axes{0, 1, 2};
                do {
                    std::array<int, 3> at{i, j, k};
                    std::array<Index, 4> tetrahedron{};
                    tetrahedron[0] = id(at[0], at[1], at[2]);
                    for (int step = 0; step < 3; ++step) {
                        ++at[axes[step]];
                        tetrahedron[step + 1] = id(at[0], at[1], at[2]);
                    }
                    Eigen::Matrix3d edges;
                    for (int c = 0; c < 3; ++c) edges.row(c) = x.row(tetrahedron[c + 1]) - x.row(tetrahedron[0]);
                    if (edges.determinant() < 0) std::swap(tetrahedron[2], tetrahedron[3]);
                    tetrahedra.push_back(tetrahedron);
                } while (std::next_permutation(axes.begin(), axes.end()));
            }
    constexpr std::array<std::array<int, 3>, 4> faces{{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}}};
    for (const auto& tetrahedron : tetrahedra)
        for (const auto& face : faces)
            for (int side = 0; side < 6; ++side) {
                const bool is_on_side = std::all_of(
                    face.begin(), face.end(), [&](int corner) { return x(tetrahedron[corner], side / 2) == side % 2; });
                if (is_on_side)
                    builder.add_cell(Shape::triangle, side + 1,
                                     {tetrahedron[face[0]], tetrahedron[face[1]], tetrahedron[face[2]]});
            }
    for (const auto& tetrahedron : tetrahedra)
        builder.add_cell(Shape::tetrahedron, 1, {tetrahedron.begin(), tetrahedron.end()});
    return elevate(builder.finish(x), order);
}

CurvedMesh bulged_square_mesh(int n, int order, double height) {
    const CurvedMesh mesh = square_mesh(n, order);
    Coordinates x = mesh.coordinates();
    const std::vector<Index> bottom = mesh.topology().find_group_nodes("bottom").value();
    for (const Index node : bottom) {
        const double t = x(node, 0) * n - std::floor(x(node, 0) * n);
        x(node, 1) += height * 4.0 * t * (1.0 - t);
    }
    return mesh.with_coordinates(std::move(x));
}

CurvedMesh quad_mesh(int n, int order) {
    Builder builder;
    add_square_boundary(builder, n);
    builder.add_group(2, 1, "domain");
    const auto id = [n](int i, int j) { return j * (n + 1) + i; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            builder.add_cell(Shape::quadrilateral, 1, {id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
    return elevate(builder.finish(square_points(n)), order);
}

CurvedMesh hex_mesh(int n, int order) {
    Builder builder;
    builder.add_group(3, 1, "domain");
    const Grid grid(n);
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const auto c = grid.cube(i, j, k);
                builder.add_cell(Shape::hexahedron, 1, {c.begin(), c.end()});
            }
    return elevate(builder.finish(grid.x), order);
}

CurvedMesh prism_mesh(int n, int order) {
    Builder builder;
    builder.add_group(3, 1, "domain");
    const Grid grid(n);
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const auto c = grid.cube(i, j, k);
                builder.add_cell(Shape::prism, 1, {c[0], c[1], c[2], c[4], c[5], c[6]});
                builder.add_cell(Shape::prism, 1, {c[0], c[2], c[3], c[4], c[6], c[7]});
            }
    return elevate(builder.finish(grid.x), order);
}

CurvedMesh mixed_square_mesh(int n, int order) {
    Builder builder;
    add_square_boundary(builder, n);
    builder.add_group(2, 1, "domain");
    const auto id = [n](int i, int j) { return j * (n + 1) + i; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Index a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1);
            if (i < n / 2) {
                builder.add_cell(Shape::quadrilateral, 1, {a, b, c, d});
                continue;
            }
            builder.add_cell(Shape::triangle, 1, {a, b, c});
            builder.add_cell(Shape::triangle, 1, {a, c, d});
        }
    return elevate(builder.finish(square_points(n)), order);
}

CurvedMesh mixed_cube_mesh(int n, int order) {
    Builder builder;
    builder.add_group(3, 1, "domain");
    const Grid grid(n);
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const auto c = grid.cube(i, j, k);
                if (i < n / 2) {
                    builder.add_cell(Shape::hexahedron, 1, {c.begin(), c.end()});
                    continue;
                }
                builder.add_cell(Shape::prism, 1, {c[0], c[1], c[2], c[4], c[5], c[6]});
                builder.add_cell(Shape::prism, 1, {c[0], c[2], c[3], c[4], c[6], c[7]});
            }
    return elevate(builder.finish(grid.x), order);
}

CurvedMesh pyramid_mesh(int n) {
    Builder builder;
    builder.add_group(3, 1, "domain");
    const Grid grid(n);
    Coordinates x(grid.x.rows() + n * n * n, 3);
    x.topRows(grid.x.rows()) = grid.x;
    auto apex = static_cast<Index>(grid.x.rows());
    // Faces of a hexahedron with their normal into it.
    constexpr std::array<std::array<std::size_t, 4>, 6> faces{
        {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}};
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i, ++apex) {
                const auto c = grid.cube(i, j, k);
                x.row(apex) << (i + 0.5) / n, (j + 0.5) / n, (k + 0.5) / n;
                for (const auto& face : faces)
                    builder.add_cell(Shape::pyramid, 1, {c[face[0]], c[face[1]], c[face[2]], c[face[3]], apex});
            }
    return builder.finish(x);
}

CurvedMesh with_shaken_corners(const CurvedMesh& linear, double amplitude, int order, std::mt19937& random) {
    std::uniform_real_distribution<double> shift(-amplitude, amplitude);
    Coordinates x = linear.coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i)
        for (int d = 0; d < linear.topology().dimension(); ++d) x(i, d) += shift(random);
    return elevate(linear.with_coordinates(x), order);
}

CurvedMesh shaken(const CurvedMesh& mesh, double amplitude, std::mt19937& random) {
    std::uniform_real_distribution<double> shift(-amplitude, amplitude);
    Coordinates x = mesh.coordinates();
    for (Index node : mesh.topology().interior_nodes())
        for (int d = 0; d < mesh.topology().dimension(); ++d) x(node, d) += shift(random);
    return mesh.with_coordinates(x);
}

Eigen::MatrixX3d random_element(ElementType type, double amplitude, std::mt19937& random) {
    std::normal_distribution<double> normal;
    const int dim = dimension(type.shape);
    Eigen::Matrix3d map = Eigen::Matrix3d::Zero();
    do {
        for (int r = 0; r < dim; ++r)
            for (int c = 0; c < dim; ++c) map(r, c) = normal(random);
    } while (map.topLeftCorner(dim, dim).determinant() < 0.2);
    Eigen::MatrixX3d x = reference_nodes(type) * map.transpose();
    if (type.order > 1 || !is_simplex(type.shape))
        for (Eigen::Index i = 0; i < x.rows(); ++i)
            for (int d = 0; d < dim; ++d) x(i, d) += amplitude / (type.order * type.order) * normal(random);
    return x;
}

}  // namespace curvewright::testing
