#include "core/deform/deformation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/deform/shapes.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::square_mesh;
using Point = Eigen::RowVector3d;

Coordinates apply(const CurvedMesh& mesh, std::vector<Operation> operations) {
    return apply_deformation(mesh, {OperationList{std::move(operations)}, "d.json"});
}

std::string failure(const CurvedMesh& mesh, const Deformation& deformation) {
    try {
        apply_deformation(mesh, deformation);
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "accepted";
}

TEST(ApplyDeformation, MovesTheGroupAndNothingElse) {
    const CurvedMesh mesh = square_mesh(3, 2);
    const Coordinates x = apply(mesh, {{"left", Translate{{-0.5, 0.25, 0.125}}}});
    const auto left = *mesh.topology().find_group_nodes("left");
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const bool is_moved = std::find(left.begin(), left.end(), node) != left.end();
        const Point expected = mesh.coordinates().row(node) + (is_moved ? Point(-0.5, 0.25, 0.125) : Point(0, 0, 0));
        EXPECT_EQ(Point(x.row(node)), expected);
    }
}

TEST(ApplyDeformation, OperationsAreAppliedInOrder) {
    const CurvedMesh mesh = square_mesh(2, 1);
    const Operation turn{"all", Rotate{{0, 0, 0}, 90.0, {0, 0, 2}}}, move{"all", Translate{{1, 0, 0}}};
    const Coordinates turned_first = apply(mesh, {turn, move}), moved_first = apply(mesh, {move, turn});
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const Point p = mesh.coordinates().row(node);
        EXPECT_LT((turned_first.row(node) - Point(1 - p[1], p[0], 0)).norm(), 1e-15);
        EXPECT_LT((moved_first.row(node) - Point(-p[1], 1 + p[0], 0)).norm(), 1e-15);
    }
}

TEST(ApplyDeformation, ScaleShearAndExpression) {
    const CurvedMesh mesh = square_mesh(2, 1);
    const Coordinates x = apply(mesh, {{"all", Scale{{1, 1, 0}, {2, 3, 1}}},
                                       {"all", Shear{0, 1, 0.5, 0.25}},
                                       {"all", Expression{{std::nullopt, "y + sin(x)", "x*y"}}}});
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const Point p = mesh.coordinates().row(node);
        const double sx = 1 + (p[0] - 1) * 2, sy = 1 + (p[1] - 1) * 3, tx = sx + 0.5 * (sy - 0.25);
        EXPECT_LT((x.row(node) - Point(tx, sy + std::sin(tx), tx * sy)).norm(), 1e-14);
    }
}

TEST(ApplyDeformation, RotationAboutAnyAxisKeepsDistancesAndTheAxis) {
    const CurvedMesh mesh = testing::cube_mesh(1, 2);
    const Vector3 center{0.2, -0.4, 1.0}, axis{1, 2, -0.5};
    const Coordinates x = apply(mesh, {{"all", Rotate{center, 37.0, axis}}});
    const Point c(center[0], center[1], center[2]), k = Point(axis[0], axis[1], axis[2]).normalized();
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const Point before = mesh.coordinates().row(node) - c, after = x.row(node) - c;
        EXPECT_NEAR(after.norm(), before.norm(), 1e-14);
        EXPECT_NEAR(after.dot(k), before.dot(k), 1e-14);
        const Point u = before - before.dot(k) * k, v = after - after.dot(k) * k;
        if (u.norm() > 1e-6) {
            EXPECT_NEAR(u.dot(v) / (u.norm() * v.norm()), std::cos(37.0 * std::numbers::pi / 180), 1e-12);
        }
    }
}

TEST(Project, RadialShapes) {
    EXPECT_LT((project(SnapToCircle{{1, 1, 5}, 2.0}, Point(1, 4, 7)) - Point(1, 3, 7)).norm(), 1e-15);
    EXPECT_LT((project(SnapToSphere{{0, 0, 1}, 2.0}, Point(0, 0, 4)) - Point(0, 0, 3)).norm(), 1e-15);
    EXPECT_LT((project(SnapToCylinder{{1, 0, 0}, {0, 1, 0}, 2.0}, Point(1, 7, 5)) - Point(1, 7, 2)).norm(), 1e-15);
    const SnapToRevolution cone{2, {{0, 1}, {2, 3}, {4, 3}}};
    EXPECT_LT((project(cone, Point(5, 0, 1)) - Point(2, 0, 1)).norm(), 1e-15);
    EXPECT_LT((project(cone, Point(0, 5, 3)) - Point(0, 3, 3)).norm(), 1e-15);
    EXPECT_LT((project(cone, Point(0, 5, -1)) - Point(0, 1, -1)).norm(), 1e-15);  // held beyond the ends
    EXPECT_LT((project(cone, Point(0, 5, 9)) - Point(0, 3, 9)).norm(), 1e-15);
    EXPECT_THROW(project(cone, Point(0, 0, 3)), InvalidInput);
    EXPECT_EQ(project(SnapToRevolution{2, {{0, 0}, {1, 1}}}, Point(0, 0, 0)), Point(0, 0, 0));
    EXPECT_THROW(project(SnapToCircle{{1, 1, 0}, 2.0}, Point(1, 1, 3)), InvalidInput);
    EXPECT_THROW(project(SnapToSphere{{1, 1, 0}, 2.0}, Point(1, 1, 0)), InvalidInput);
    EXPECT_THROW(project(SnapToCylinder{{1, 0, 0}, {0, 1, 0}, 2.0}, Point(1, 3, 0)), InvalidInput);
}

TEST(Project, EllipseGivesTheClosestPoint) {
    const SnapToEllipse ellipse{{1, 2, 0}, 3.0, 1.0};
    for (const Point& p : {Point(5, 3, 1), Point(1.3, 2.2, 0), Point(-4, 1, 0), Point(1, 9, 0), Point(1, 2, 0)}) {
        const Point q = project(ellipse, p);
        EXPECT_NEAR(std::pow((q[0] - 1) / 3, 2) + std::pow(q[1] - 2, 2), 1.0, 1e-12);
        EXPECT_EQ(q[2], p[2]);
        double best = 1e9;
        for (int i = 0; i < 100000; ++i) {
            const double t = 2 * std::numbers::pi * i / 100000;
            best = std::min(best, (Point(1 + 3 * std::cos(t), 2 + std::sin(t), p[2]) - p).norm());
        }
        EXPECT_NEAR((q - p).norm(), best, 1e-8);
    }
}

TEST(Project, NacaGivesTheClosestPointAndKeepsTheEnds) {
    const SnapToNaca naca{{1, 0, 0}, 2.0, 0.12};
    const auto half_thickness = [](double s) {
        return 0.6 * (0.2969 * std::sqrt(s) - 0.126 * s - 0.3516 * s * s + 0.2843 * s * s * s - 0.1036 * s * s * s * s);
    };
    for (const Point& p : {Point(1.4, 0.1, 0), Point(2.7, -0.06, 0.5), Point(1.01, 0.03, 0), Point(1.0, -0.2, 0)}) {
        const Point q = project(naca, p);
        const double s = (q[0] - 1) / 2, side = p[1] >= 0 ? 1 : -1;
        EXPECT_NEAR(q[1], 2 * side * half_thickness(s), 1e-12);
        double best = 1e9;
        for (int i = 0; i <= 200000; ++i) {
            const double u = static_cast<double>(i) / 200000;
            best = std::min(best, (Point(1 + 2 * u * u, 2 * side * half_thickness(u * u), p[2]) - p).norm());
        }
        EXPECT_NEAR((q - p).norm(), best, 1e-7);
    }
    EXPECT_LT((project(naca, Point(3, 0, 0)) - Point(3, 0, 0)).norm(), 1e-12);
    EXPECT_LT((project(naca, Point(1, 0, 0)) - Point(1, 0, 0)).norm(), 1e-12);
}

TEST(ApplyDeformation, TableMovesNodesByTag) {
    const CurvedMesh mesh = square_mesh(2, 1);
    const Coordinates x = apply_deformation(mesh, {NodeTable{{{{12}, {7, 8, 9}}}, false}, "t.csv"});
    EXPECT_EQ(Point(x.row(1)), Point(7, 8, 9));
    EXPECT_EQ(x.row(0), mesh.coordinates().row(0));
    EXPECT_EQ(failure(mesh, {NodeTable{{{{999}, {7, 8, 9}}}, false}, "t.csv"}),
              "t.csv: there is no node 999 in the mesh.");
}

TEST(ApplyDeformation, WholeMeshMovesTheBoundaryOnlyAndMustBeComplete) {
    const CurvedMesh mesh = square_mesh(2, 2);
    NodeTable table{{}, true};
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        table.rows.push_back(
            {mesh.topology().node_tag(node), {mesh.coordinates()(node, 0) + 1, mesh.coordinates()(node, 1), 0}});
    const Coordinates x = apply_deformation(mesh, {table, "m.msh"});
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        EXPECT_EQ(x(node, 0), mesh.coordinates()(node, 0) + (mesh.topology().is_boundary_node(node) ? 1 : 0));
    table.rows.erase(table.rows.begin() + mesh.topology().boundary_nodes().front());
    EXPECT_NE(failure(mesh, {table, "m.msh"}).find("m.msh: boundary node 11"), std::string::npos);
}

TEST(PrescribedInteriorNodes, AreThoseOfInterfacesAndTables) {
    // A square with a line of cells through its middle, in a group of its own.
    const CurvedMesh square = square_mesh(4, 2);
    MeshData data = square.topology().data();
    std::vector<Index> middle;
    for (Index node = 0; node < square.topology().node_count(); ++node)
        if (square.coordinates()(node, 0) == 0.5) middle.push_back(node);
    std::sort(middle.begin(), middle.end(),
              [&](Index a, Index b) { return square.coordinates()(a, 1) < square.coordinates()(b, 1); });
    ElementBlock block{{Shape::line, 2}, 99, {}, {}};
    for (std::size_t i = 0; i + 2 < middle.size(); i += 2) {
        block.nodes.insert(block.nodes.end(), {middle[i], middle[i + 2], middle[i + 1]});
        block.tags.push_back({static_cast<std::int64_t>(9000 + i)});
    }
    data.blocks.push_back(block);
    data.entities.push_back({1, 99, {99}, {}, {}});
    data.groups.push_back({1, 99, "interface"});
    const CurvedMesh mesh(std::make_shared<const MeshTopology>(data), square.coordinates());
    const auto prescribed = [&](const std::string& group) {
        return prescribed_interior_nodes(mesh, {OperationList{{{group, Translate{}}}}, ""});
    };
    EXPECT_EQ(prescribed("interface").size(), middle.size() - 2);  // its ends are on the boundary
    EXPECT_TRUE(prescribed("left").empty());
    EXPECT_TRUE(prescribed("all").empty());
    EXPECT_TRUE(prescribed("domain").empty());
    EXPECT_TRUE(prescribed("nowhere").empty());
    const NodeTag inside = mesh.topology().node_tag(middle[2]), outside = mesh.topology().node_tag(middle[0]);
    EXPECT_EQ(prescribed_interior_nodes(mesh, {NodeTable{{{inside, {}}, {outside, {}}}, false}, ""}),
              std::vector<Index>{middle[2]});
    EXPECT_TRUE(prescribed_interior_nodes(mesh, {NodeTable{{{inside, {}}}, true}, ""}).empty());
}

TEST(ApplyDeformation, FaultsAreNamed) {
    const CurvedMesh mesh = square_mesh(2, 1);
    const auto of = [&](std::string group, OperationKind kind) {
        return failure(mesh, {OperationList{{{"left", Translate{}}, {std::move(group), std::move(kind)}}}, "d.json"});
    };
    EXPECT_EQ(
        of("wing", Translate{}),
        "d.json: operation 2: there is no group 'wing' (the mesh has bottom, right, top, left, domain, and 'boundary' "
        "and 'all' always exist).");
    EXPECT_NE(of("left", Expression{{"x +", {}, {}}}).find("d.json: operation 2 on group 'left': the expression 'x +'"),
              std::string::npos);
    EXPECT_NE(of("left", Expression{{"1/x", {}, {}}}).find("not finite"), std::string::npos);
    EXPECT_NE(of("left", SnapToCircle{{0, 0, 0}, 1}).find("node 11 cannot be moved: it lies on the centre"),
              std::string::npos);
}

}  // namespace
}  // namespace curvewright
