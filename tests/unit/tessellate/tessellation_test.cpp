#include "core/tessellate/tessellation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"
#include "core/mesh/elevate.h"

#include "tests/support/mesh_factory.h"
#include "tests/support/region_meshes.h"

namespace curvewright {
namespace {

/// A mesh of one block.
CurvedMesh make_mesh(ElementType type, const std::vector<std::array<double, 3>>& points,
                     const std::vector<std::vector<Index>>& elements) {
    MeshData data;
    Coordinates x(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        data.node_tags.push_back({static_cast<std::int64_t>(i) + 1});
        x.row(static_cast<Eigen::Index>(i)) << points[i][0], points[i][1], points[i][2];
    }
    ElementBlock block{type, 0, {}, {}};
    for (std::size_t e = 0; e < elements.size(); ++e) {
        block.nodes.insert(block.nodes.end(), elements[e].begin(), elements[e].end());
        block.tags.push_back({static_cast<std::int64_t>(e) + 1});
    }
    data.blocks.push_back(block);
    return {std::make_shared<MeshTopology>(std::move(data)), std::move(x)};
}

/// One element whose nodes stand on their reference positions.
CurvedMesh make_element(ElementType type) {
    std::vector<std::array<double, 3>> points;
    std::vector<Index> nodes;
    for (const LatticePoint& point : reference_element(type).lattice) {
        nodes.push_back(static_cast<Index>(points.size()));
        points.push_back({point[0] / double(type.order), point[1] / double(type.order), point[2] / double(type.order)});
    }
    return make_mesh(type, points, {nodes});
}

/// n × n squares of [0, 1]^2, two triangles each, raised to the order.
CurvedMesh make_triangles(int n, int order) {
    std::vector<std::array<double, 3>> points;
    std::vector<std::vector<Index>> triangles;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) points.push_back({double(i) / n, double(j) / n, 0.0});
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Index a = j * (n + 1) + i;
            triangles.push_back({a, a + 1, a + n + 2});
            triangles.push_back({a, a + n + 2, a + n + 1});
        }
    return elevate(make_mesh({Shape::triangle, 1}, points, triangles), order);
}

/// n^3 cubes of [0, 1]^3, six tetrahedra each around the main diagonal, raised to the order.
CurvedMesh make_tetrahedra(int n, int order) {
    std::vector<std::array<double, 3>> points;
    const auto at = [n](int i, int j, int k) { return static_cast<Index>((k * (n + 1) + j) * (n + 1) + i); };
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) points.push_back({double(i) / n, double(j) / n, double(k) / n});
    std::vector<std::vector<Index>> tetrahedra;
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                std::array<int, 3> axes{0, 1, 2};
                do {
                    std::array<int, 3> corner{i, j, k};
                    std::vector<Index> nodes{at(i, j, k)};
                    for (int axis : axes) {
                        ++corner[axis];
                        nodes.push_back(at(corner[0], corner[1], corner[2]));
                    }
                    const bool is_even =
                        axes == std::array{0, 1, 2} || axes == std::array{1, 2, 0} || axes == std::array{2, 0, 1};
                    if (!is_even) std::swap(nodes[1], nodes[2]);
                    tetrahedra.push_back(nodes);
                } while (std::next_permutation(axes.begin(), axes.end()));
            }
    return elevate(make_mesh({Shape::tetrahedron, 1}, points, tetrahedra), order);
}

template <class Map>
CurvedMesh mapped(const CurvedMesh& mesh, Map map) {
    Coordinates x = mesh.coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i) x.row(i) = map(Eigen::RowVector3d(x.row(i)));
    return mesh.with_coordinates(x);
}

Eigen::RowVector3d to_quarter_ring(const Eigen::RowVector3d& x) {
    const double angle = 0.5 * std::numbers::pi * (1.0 - x[0]), radius = 1.0 + x[1];
    return {radius * std::cos(angle), radius * std::sin(angle), x[2]};
}

Eigen::RowVector3d point(const std::vector<float>& points, const Tessellation& tessellation, Index i) {
    return Eigen::RowVector3d(points[3 * i], points[3 * i + 1], points[3 * i + 2]) + tessellation.origin();
}

/// Twice the area of the drawn triangles in the x-y plane, with sign.
double drawn_area(const Tessellation& t) {
    double area = 0.0;
    for (std::size_t k = 0; k < t.triangles().size(); k += 3) {
        const Eigen::RowVector3d a = point(t.surface_points(), t, t.triangles()[k]);
        const Eigen::RowVector3d b = point(t.surface_points(), t, t.triangles()[k + 1]);
        const Eigen::RowVector3d c = point(t.surface_points(), t, t.triangles()[k + 2]);
        area += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    return area;
}

/// Volume inside the drawn triangles (divergence theorem), positive if they are oriented outward.
double drawn_volume(const Tessellation& t) {
    double volume = 0.0;
    for (std::size_t k = 0; k < t.triangles().size(); k += 3) {
        const Eigen::Vector3d a = point(t.surface_points(), t, t.triangles()[k]).transpose();
        const Eigen::Vector3d b = point(t.surface_points(), t, t.triangles()[k + 1]).transpose();
        const Eigen::Vector3d c = point(t.surface_points(), t, t.triangles()[k + 2]).transpose();
        volume += a.dot(b.cross(c)) / 6.0;
    }
    return volume;
}

TEST(Tessellation, StraightMeshIsDrawnByItsOwnTriangles) {
    for (int order : {1, 2, 3, 5}) {
        const CurvedMesh mesh = make_triangles(3, order);
        const Tessellation t(mesh);
        EXPECT_EQ(t.triangle_elements().size(), 18u) << order;
        EXPECT_EQ(t.line_elements().size(), 33u) << order;  // Euler: 16 - E + (18 + 1) = 2
        EXPECT_EQ(std::count(t.line_is_boundary().begin(), t.line_is_boundary().end(), 1), 12);
        EXPECT_EQ(t.edge_points().size(), 3u * 2u * 33u);
        EXPECT_EQ(static_cast<Index>(t.nodes().size()), mesh.topology().node_count());
        EXPECT_NEAR(drawn_area(t), 1.0, 1e-6);
    }
}

TEST(Tessellation, PointsLieOnTheLagrangeMap) {
    for (const Shape shape : {Shape::triangle, Shape::quadrilateral})
        for (int order : {2, 3, 4}) {
            const ElementType type{shape, order};
            const CurvedMesh mesh = mapped(make_element(type), to_quarter_ring);
            const int n = 6;
            const Tessellation t(mesh, {}, {.chord_tolerance = 1.0, .min_subdivisions = n, .max_subdivisions = n});
            std::vector<std::array<double, 2>> lattice;
            for (int j = 0; j <= n; ++j)
                for (int i = 0; i <= (shape == Shape::triangle ? n - j : n); ++i)
                    lattice.push_back({double(i) / n, double(j) / n});
            ASSERT_EQ(t.surface_points().size(), 3 * lattice.size());
            Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(lattice.size()), 3);
            for (std::size_t i = 0; i < lattice.size(); ++i) {
                u(static_cast<Eigen::Index>(i), 0) = lattice[i][0];
                u(static_cast<Eigen::Index>(i), 1) = lattice[i][1];
            }
            const Eigen::MatrixX3d expected = lagrange_basis(type, u).values * mesh.element_coordinates(0);
            // The order of the points is the tessellation's own affair: compare as sets.
            for (Eigen::Index i = 0; i < expected.rows(); ++i) {
                double nearest = 1.0;
                for (Index k = 0; k < static_cast<Index>(lattice.size()); ++k)
                    nearest = std::min(nearest, (point(t.surface_points(), t, k) - expected.row(i)).norm());
                EXPECT_LT(nearest, 1e-6) << name(type) << " point " << i;
            }
        }
}

TEST(Tessellation, ChordsOfAnArcKeepTheTolerance) {
    for (double tolerance : {1e-3, 2e-4}) {
        // One layer of P4 triangles around a quarter of a ring: its inner and outer sides are very nearly circles.
        const CurvedMesh mesh = mapped(make_triangles(2, 4), to_quarter_ring);
        const Tessellation t(mesh, {}, {.chord_tolerance = tolerance});
        const auto box = bounding_box(mesh);
        const double limit = tolerance * (box.row(1) - box.row(0)).norm();
        double worst = 0.0;
        for (std::size_t line = 0; line + 1 < t.line_offsets().size(); ++line) {
            const auto radius = [&](Index i) { return point(t.edge_points(), t, i).norm(); };
            const Index first = t.line_offsets()[line], last = t.line_offsets()[line + 1] - 1;
            const bool is_outer = std::abs(radius(first) - 2.0) < 1e-6 && std::abs(radius(last) - 2.0) < 1e-6;
            if (!is_outer) continue;
            EXPECT_EQ(t.line_is_boundary()[line], 1);
            for (Index i = first; i < last; ++i) {
                const Eigen::RowVector3d middle =
                    0.5 * (point(t.edge_points(), t, i) + point(t.edge_points(), t, i + 1));
                worst = std::max(worst, std::abs(2.0 - middle.norm()));
            }
        }
        EXPECT_GT(worst, 0.0);
        // Single precision and the P4 arc's own distance from the circle (below 2e-5) come on top.
        EXPECT_LT(worst, limit + 2.1e-5);
    }
}

TEST(Tessellation, FinerToleranceGivesMorePieces) {
    const CurvedMesh mesh = mapped(make_triangles(1, 3), to_quarter_ring);
    const Tessellation coarse(mesh, {}, {.chord_tolerance = 1e-2}), fine(mesh, {}, {.chord_tolerance = 1e-5});
    EXPECT_LT(coarse.triangle_elements().size(), fine.triangle_elements().size());
    EXPECT_EQ(fine.triangle_elements().size(), 2u * 24u * 24u);  // the bound
}

/// The half of a cube's tetrahedra below z = 0.5 has a rim of 8 sides at that height (two per side of the square).
TEST(Tessellation, PartOfASolidHasARimOnItsSurface) {
    for (int order : {1, 3}) {
        const CurvedMesh mesh = make_tetrahedra(2, order);
        std::vector<bool> is_below;
        for (Index element = 0; element < mesh.topology().element_count(); ++element)
            is_below.push_back(mesh.element_center(element)[2] < 0.5);
        const Tessellation part(mesh, is_below);
        EXPECT_EQ(std::count(part.line_is_rim().begin(), part.line_is_rim().end(), 1), 8);
        for (std::size_t line = 0; line < part.line_is_rim().size(); ++line)
            for (Index i = part.line_offsets()[line]; part.line_is_rim()[line] && i < part.line_offsets()[line + 1];
                 ++i) {
                const Eigen::RowVector3d at = point(part.edge_points(), part, i);
                EXPECT_NEAR(at[2], 0.5, 1e-6);
                EXPECT_NEAR((at.head<2>().array() - 0.5).abs().maxCoeff(), 0.5, 1e-6);
            }
        const Tessellation whole(mesh, std::vector<bool>(is_below.size(), true));
        EXPECT_EQ(std::count(whole.line_is_rim().begin(), whole.line_is_rim().end(), 1), 0);
        EXPECT_EQ(whole.line_is_rim().size(), whole.line_elements().size());
    }
}

TEST(Tessellation, SkinOfTetrahedraIsClosedAndLooksOutward) {
    for (int order : {1, 2, 3}) {
        const CurvedMesh mesh = make_tetrahedra(2, order);
        const Tessellation t(mesh);
        EXPECT_EQ(t.triangle_elements().size(), 48u);
        EXPECT_EQ(t.line_elements().size(), 72u);  // Euler: 26 - 72 + 48 = 2
        EXPECT_EQ(std::count(t.line_is_boundary().begin(), t.line_is_boundary().end(), 1), 0);
        EXPECT_NEAR(drawn_volume(t), 1.0, 1e-5);
        for (std::size_t i = 0; i < t.surface_points().size() / 3; ++i) {
            const Eigen::RowVector3d x = point(t.surface_points(), t, static_cast<Index>(i));
            const Eigen::RowVector3d normal(t.surface_normals()[3 * i], t.surface_normals()[3 * i + 1],
                                            t.surface_normals()[3 * i + 2]);
            EXPECT_NEAR(normal.norm(), 1.0, 1e-6);
            EXPECT_GT(normal.dot(x - Eigen::RowVector3d::Constant(0.5)), 0.4);
        }
    }
}

TEST(Tessellation, NormalsOfACurvedFaceArePerpendicularToIt) {
    // The ring's outer cylinder: normals point along the radius.
    const CurvedMesh mesh = mapped(make_tetrahedra(2, 4), to_quarter_ring);
    const Tessellation t(mesh);
    int on_cylinder = 0;
    for (std::size_t i = 0; i < t.surface_points().size() / 3; ++i) {
        const Eigen::RowVector3d x = point(t.surface_points(), t, static_cast<Index>(i));
        const Eigen::RowVector2d radial = x.head<2>().normalized();
        const bool is_inside = x[2] > 0.05 && x[2] < 0.95 && std::min(radial[0], radial[1]) > 0.05;
        if (!is_inside || std::abs(x.head<2>().norm() - 2.0) > 1e-3) continue;
        ++on_cylinder;
        EXPECT_NEAR(radial[0] * t.surface_normals()[3 * i] + radial[1] * t.surface_normals()[3 * i + 1], 1.0, 2e-3);
    }
    EXPECT_GT(on_cylinder, 50);
}

TEST(Tessellation, HiddenElementsOpenTheFacesBehindThem) {
    const CurvedMesh mesh = make_tetrahedra(3, 2);
    std::vector<bool> visible(static_cast<std::size_t>(mesh.topology().element_count()));
    double expected_volume = 0.0;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        visible[element] = mesh.element_center(element)[0] < 0.5;
        if (visible[element]) expected_volume += 1.0 / 162.0;
    }
    const Tessellation t(mesh, visible);
    for (Index element : t.triangle_elements()) EXPECT_TRUE(visible[element]);
    EXPECT_NEAR(drawn_volume(t), expected_volume, 1e-5);
    EXPECT_LT(t.nodes().size(), Tessellation(mesh).nodes().size());

    const Tessellation nothing(mesh, std::vector<bool>(visible.size(), false));
    EXPECT_TRUE(nothing.triangles().empty());
    EXPECT_TRUE(nothing.line_elements().empty());
    EXPECT_EQ(nothing.line_offsets(), std::vector<Index>{0});
    EXPECT_THROW(Tessellation(mesh, {true, false}), InvalidInput);
}

TEST(Tessellation, MoveGivesWhatANewTessellationWould) {
    const CurvedMesh before = mapped(make_triangles(3, 3), to_quarter_ring);
    const CurvedMesh after = mapped(before, [](const Eigen::RowVector3d& x) {
        // Affine, so that straight sides stay straight and both have the same pieces.
        return Eigen::RowVector3d(x[0] + 0.1 * x[1] + 0.02, 1.1 * x[1], x[2]);
    });
    const TessellationOptions fixed{.chord_tolerance = 1.0, .min_subdivisions = 5, .max_subdivisions = 5};
    Tessellation moved(before, {}, fixed);
    moved.move(after.coordinates());
    const Tessellation made(after, {}, fixed);
    ASSERT_EQ(moved.surface_points().size(), made.surface_points().size());
    ASSERT_EQ(moved.triangles(), made.triangles());
    for (Index i = 0; i < static_cast<Index>(made.surface_points().size() / 3); ++i)
        EXPECT_LT((point(moved.surface_points(), moved, i) - point(made.surface_points(), made, i)).norm(), 5e-7);
    ASSERT_EQ(moved.edge_points().size(), made.edge_points().size());
    for (Index i = 0; i < static_cast<Index>(made.edge_points().size() / 3); ++i)
        EXPECT_LT((point(moved.edge_points(), moved, i) - point(made.edge_points(), made, i)).norm(), 1e-6);
    EXPECT_THROW(moved.move(Coordinates::Zero(3, 3)), InvalidInput);
}

TEST(Tessellation, TellsWhenAMoveNeedsFinerPieces) {
    const CurvedMesh straight = make_triangles(2, 3);
    const Tessellation t(straight);
    EXPECT_TRUE(t.is_fine_enough(straight.coordinates()));
    EXPECT_FALSE(t.is_fine_enough(mapped(straight, to_quarter_ring).coordinates()));
    const auto far =
        mapped(straight, [](const Eigen::RowVector3d& x) { return Eigen::RowVector3d(x[0] + 50, x[1], 0); });
    EXPECT_FALSE(t.is_fine_enough(far.coordinates()));
    EXPECT_FALSE(t.is_fine_enough(Coordinates::Zero(3, 3)));
}

TEST(Tessellation, KeepsItsPrecisionFarFromTheOrigin) {
    const Eigen::RowVector3d offset(1e6, -2e6, 3e6);
    const CurvedMesh near = mapped(make_triangles(2, 3), to_quarter_ring);
    const CurvedMesh far = mapped(near, [&](const Eigen::RowVector3d& x) { return Eigen::RowVector3d(x + offset); });
    const Tessellation a(near), b(far);
    ASSERT_EQ(a.surface_points().size(), b.surface_points().size());
    for (std::size_t i = 0; i < a.surface_points().size(); ++i)
        EXPECT_NEAR(a.surface_points()[i], b.surface_points()[i], 2e-7);
}

TEST(Tessellation, DoesNotDependOnTheUnitOfLength) {
    const CurvedMesh mesh = mapped(make_triangles(3, 3), to_quarter_ring);
    const Tessellation reference(mesh);
    for (double unit : {1e-6, 1e6}) {
        const Tessellation scaled(
            mapped(mesh, [&](const Eigen::RowVector3d& x) { return Eigen::RowVector3d(unit * x); }));
        EXPECT_EQ(scaled.triangles(), reference.triangles());
        EXPECT_NEAR(drawn_area(scaled) / (unit * unit), drawn_area(reference), 1e-5);
    }
}

TEST(Tessellation, DrawsEveryShape) {
    struct Case {
        Shape shape;
        std::size_t faces_as_triangles, edges;
        double measure;
    };
    for (const Case& its : {Case{Shape::quadrilateral, 2, 4, 1.0}, Case{Shape::tetrahedron, 4, 6, 1.0 / 6.0},
                            Case{Shape::hexahedron, 12, 12, 1.0}, Case{Shape::prism, 8, 9, 0.5}})
        for (int order : {1, 2, 3}) {
            const Tessellation t(make_element({its.shape, order}));
            EXPECT_EQ(t.triangle_elements().size(), its.faces_as_triangles) << name(its.shape);
            EXPECT_EQ(t.line_elements().size(), its.edges) << name(its.shape);
            const double measure = dimension(its.shape) == 2 ? drawn_area(t) : drawn_volume(t);
            EXPECT_NEAR(measure, its.measure, 1e-6) << name(its.shape);
        }
    for (int order : {1, 2}) {
        const Tessellation pyramid(make_element({Shape::pyramid, order}));
        EXPECT_EQ(pyramid.triangle_elements().size(), 6u);
        EXPECT_EQ(pyramid.line_elements().size(), 8u);
        EXPECT_NEAR(drawn_volume(pyramid), 1.0 / 3.0, 1e-6);
    }
    const Tessellation line(make_element({Shape::line, 2}));
    EXPECT_TRUE(line.triangles().empty());
    EXPECT_EQ(line.line_elements().size(), 1u);
}

TEST(Tessellation, ShrunkElementsStandAlone) {
    using namespace curvewright::testing;
    for (const CurvedMesh& mesh : {square_mesh(3, 3), hex_mesh(2, 2), prism_mesh(1, 2), cube_mesh(2, 2)}) {
        TessellationOptions options;
        options.element_size = 0.5;
        const Tessellation shrunk(mesh, {}, options), whole(mesh);
        // Every element is drawn, with all of its points half as far from the mean of its corners.
        std::vector<double> extent(static_cast<std::size_t>(mesh.topology().element_count()), 0.0);
        for (std::size_t i = 0; i < shrunk.triangles().size(); ++i) {
            const Index element = shrunk.triangle_elements()[i / 3];
            const float* x = shrunk.surface_points().data() + 3 * shrunk.triangles()[i];
            const Eigen::RowVector3d at = Eigen::RowVector3d(x[0], x[1], x[2]) + shrunk.origin();
            double& largest = extent[static_cast<std::size_t>(element)];
            largest = std::max(largest, (at - mesh.element_center(element)).norm());
        }
        std::size_t edges = 0;
        for (Index element = 0; element < mesh.topology().element_count(); ++element) {
            const Eigen::MatrixX3d x = mesh.element_coordinates(element);
            const double full = (x.rowwise() - mesh.element_center(element)).rowwise().norm().maxCoeff();
            EXPECT_NEAR(extent[static_cast<std::size_t>(element)], 0.5 * full, 1e-6);
            edges += reference_element(mesh.topology().element_type(element)).edges.size();
        }
        EXPECT_EQ(shrunk.line_elements().size(), edges);
        // Moving does the same as making it anew.
        Tessellation moved(mesh, {}, options);
        const Coordinates elsewhere = (1.5 * mesh.coordinates()).eval();
        moved.move(elsewhere);
        const float* point = moved.surface_points().data();
        const float* before = shrunk.surface_points().data();
        const Eigen::RowVector3d a = Eigen::RowVector3d(point[0], point[1], point[2]) + moved.origin();
        const Eigen::RowVector3d b = Eigen::RowVector3d(before[0], before[1], before[2]) + shrunk.origin();
        EXPECT_LT((a - 1.5 * b).norm(), 1e-5);
    }
    TessellationOptions wrong;
    wrong.element_size = 0.0;
    EXPECT_THROW(Tessellation(square_mesh(2, 2), {}, wrong), InvalidInput);
}

TEST(Tessellation, MixedShapesShareTheirFace) {
    // A cube and a pyramid on top of it.
    MeshData data;
    const std::vector<std::array<double, 3>> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},    {0, 0, 1},
                                                    {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.5, 0.5, 2}};
    Coordinates x(9, 3);
    for (int i = 0; i < 9; ++i) {
        data.node_tags.push_back({i + 1});
        x.row(i) << points[i][0], points[i][1], points[i][2];
    }
    data.blocks.push_back({{Shape::hexahedron, 1}, 0, {0, 1, 2, 3, 4, 5, 6, 7}, {{1}}});
    data.blocks.push_back({{Shape::pyramid, 1}, 0, {4, 5, 6, 7, 8}, {{2}}});
    const CurvedMesh mesh(std::make_shared<MeshTopology>(std::move(data)), x);
    const Tessellation t(mesh);
    EXPECT_EQ(t.triangle_elements().size(), 5u * 2u + 4u);
    EXPECT_EQ(t.line_elements().size(), 16u);
    EXPECT_NEAR(drawn_volume(t), 1.0 + 1.0 / 3.0, 1e-6);
}

TEST(Tessellation, WarpedAndFoldedQuadrilateralsAreCutFiner) {
    const std::vector<std::vector<Index>> one{{0, 1, 2, 3}};
    const Tessellation plain(make_mesh({Shape::quadrilateral, 1}, {{0, 0, 0}, {2, 0, 0}, {1.5, 1, 0}, {0, 1, 0}}, one));
    EXPECT_EQ(plain.triangle_elements().size(), 2u);
    const Tessellation folded(
        make_mesh({Shape::quadrilateral, 1}, {{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}}, one));
    EXPECT_GE(folded.triangle_elements().size(), 32u);
}

// ---------------------------------------------------------------------------------------------------- fields

/// A cubic polynomial and its gradient's first entry, as two components.
std::vector<double> cubic_field(const Coordinates& x) {
    std::vector<double> values;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        values.push_back(std::pow(x(i, 0), 3) - 2.0 * x(i, 0) * x(i, 1) * x(i, 1) + x(i, 2));
        values.push_back(3.0 * x(i, 0) * x(i, 0) - 2.0 * x(i, 1) * x(i, 1));
    }
    return values;
}

/// Surface points in mesh coordinates.
Coordinates surface_of(const Tessellation& drawn) {
    const auto count = static_cast<Eigen::Index>(drawn.surface_points().size() / 3);
    Coordinates x(count, 3);
    for (Eigen::Index i = 0; i < count; ++i)
        for (int d = 0; d < 3; ++d)
            x(i, d) = drawn.surface_points()[static_cast<std::size_t>(3 * i + d)] + drawn.origin()[d];
    return x;
}

TEST(Fields, PolynomialsOfTheElementsOrderAreExactAtThePoints) {
    for (const CurvedMesh& mesh : {testing::square_mesh(3, 3), testing::quad_mesh(2, 3), testing::cube_mesh(2, 3),
                                   testing::hex_mesh(1, 3), testing::prism_mesh(1, 3)}) {
        TessellationOptions options;
        options.field_subdivisions = 5;
        const Tessellation drawn(mesh, {}, options);
        const std::vector<double> values = drawn.evaluate(cubic_field(mesh.coordinates()), 2);
        const std::vector<double> expected = cubic_field(surface_of(drawn));
        ASSERT_EQ(values.size(), expected.size());
        for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], expected[i], 2e-6);
    }
}

TEST(Fields, StraightElementsAreCutFinerForThem) {
    const CurvedMesh cubic = testing::square_mesh(2, 3), linear = testing::square_mesh(2, 1);
    TessellationOptions options;
    EXPECT_EQ(Tessellation(cubic, {}, options).triangles().size(), 3u * 8);
    options.field_subdivisions = 6;
    EXPECT_EQ(Tessellation(cubic, {}, options).triangles().size(), 3u * 8 * 36);
    EXPECT_EQ(Tessellation(linear, {}, options).triangles().size(), 3u * 8);  // nothing to see between their corners
    // Moving keeps them as they are.
    EXPECT_TRUE(Tessellation(cubic, {}, options).is_fine_enough(cubic.coordinates()));
}

TEST(Fields, MissingValuesSpreadOverTheirElementOnly) {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    const Tessellation drawn(mesh);
    std::vector<double> values(static_cast<std::size_t>(mesh.topology().node_count()), 1.0);
    const Index inside = mesh.topology().element_nodes(3)[4];
    values[static_cast<std::size_t>(inside)] = std::nan("");
    const std::vector<double> at_points = drawn.evaluate(values, 1);
    for (std::size_t triangle = 0; triangle < drawn.triangle_elements().size(); ++triangle) {
        const auto nodes = mesh.topology().element_nodes(drawn.triangle_elements()[triangle]);
        const bool has_it = std::find(nodes.begin(), nodes.end(), inside) != nodes.end();
        for (std::size_t corner = 0; corner < 3; ++corner)
            EXPECT_EQ(std::isnan(at_points[static_cast<std::size_t>(drawn.triangles()[3 * triangle + corner])]),
                      has_it);
    }
    EXPECT_THROW(drawn.evaluate(values, 2), InvalidInput);
    EXPECT_THROW(drawn.evaluate({1.0}, 1), InvalidInput);
}

TEST(Tessellation, TellsWhichLinesAreEdgesOfInterfaces) {
    // Every line has both ends where the plane x = 0.5 has gone, and there are as many as there are edges in it.
    const auto flagged = [](const CurvedMesh& mesh, double height) {
        const CurvedMesh drawn = height == 0.0 ? mesh : testing::with_bent_middle(mesh, height);
        std::set<std::vector<double>> on_it;  // of the drawn mesh, where the nodes of the plane x = 0.5 have gone
        for (Index node = 0; node < mesh.topology().node_count(); ++node)
            if (std::abs(mesh.coordinates()(node, 0) - 0.5) < 1e-12)
                on_it.insert(
                    {drawn.coordinates()(node, 0), drawn.coordinates()(node, 1), drawn.coordinates()(node, 2)});
        const auto is_on_it = [&](const Tessellation& of, Index point) {
            return std::any_of(on_it.begin(), on_it.end(), [&](const std::vector<double>& x) {
                double distance = 0.0;
                for (std::size_t d = 0; d < 3; ++d)
                    distance = std::max(distance, std::abs(of.edge_points()[3 * static_cast<std::size_t>(point) + d] +
                                                           of.origin()[static_cast<Eigen::Index>(d)] - x[d]));
                return distance < 1e-6;
            });
        };
        const Tessellation tessellation(drawn);
        std::size_t count = 0;
        for (std::size_t line = 0; line < tessellation.line_elements().size(); ++line) {
            if (tessellation.line_is_interface()[line] == 0) continue;
            ++count;
            EXPECT_TRUE(is_on_it(tessellation, tessellation.line_offsets()[line]));
            EXPECT_TRUE(is_on_it(tessellation, tessellation.line_offsets()[line + 1] - 1));
        }
        return count;
    };
    using testing::InterfaceCells;
    EXPECT_EQ(flagged(testing::square_mesh(4, 3), 0.0), 0U);
    // Curved, so that lines are cut into different numbers of pieces.
    for (const double height : {0.0, 0.1}) {
        EXPECT_EQ(flagged(testing::with_regions(testing::square_mesh(4, 3), InterfaceCells::none), height), 4U);
        EXPECT_EQ(flagged(testing::with_regions(testing::quad_mesh(4, 2), InterfaceCells::named), height), 4U);
        // Of a solid, where the interface comes to the surface.
        EXPECT_EQ(flagged(testing::with_regions(testing::cube_mesh(2, 2), InterfaceCells::none), height), 8U);
        EXPECT_EQ(flagged(testing::with_regions(testing::hex_mesh(2, 3), InterfaceCells::named), height), 8U);
    }
}

}  // namespace
}  // namespace curvewright
