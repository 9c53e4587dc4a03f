// apply_deformation on its way: a fraction of a deformation.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/deform/deformation.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::square_mesh;
using Point = Eigen::RowVector3d;

const std::vector<OperationKind>& every_kind() {
    static const std::vector<OperationKind> kinds{Translate{{0.1, -0.3, 0.0}},
                                                  Rotate{{0.3, -0.7, 0.2}, 71.0, {0, 0, 1}},
                                                  Scale{{0.1, 0.9, 0.0}, {1.3, 0.6, 1.0}},
                                                  Shear{0, 1, 0.7, 0.15},
                                                  Expression{{"x + 0.1*sin(7*y)", std::nullopt, std::nullopt}},
                                                  SnapToCircle{{0.45, 0.55, 0.0}, 0.8},
                                                  SnapToSphere{{0.45, 0.55, 0.0}, 0.8},
                                                  SnapToCylinder{{0.45, 0.55, 0.0}, {0, 0, 1}, 0.8},
                                                  SnapToRevolution{0, {{0, 1}, {1, 2}}},
                                                  SnapToEllipse{{0.45, 0.55, 0.0}, 1.0, 0.7},
                                                  SnapToNaca{{0.0, 0.5, 0.0}, 1.0, 0.12}};
    return kinds;
}

Coordinates apply(const CurvedMesh& mesh, std::vector<Operation> operations, std::optional<double> fraction) {
    const Deformation deformation{OperationList{std::move(operations)}, "d.json"};
    return fraction ? apply_deformation(mesh, deformation, *fraction) : apply_deformation(mesh, deformation);
}

TEST(PartialDeformation, NothingDoneIsTheStartAndAllDoneIsTheWhole) {
    const CurvedMesh mesh = square_mesh(4, 2);
    for (const OperationKind& kind : every_kind()) {
        const std::vector<Operation> operations{{"top", kind}, {"top", kind}};
        EXPECT_EQ(apply(mesh, operations, 0.0), mesh.coordinates()) << kind.index();
        const Coordinates whole = apply(mesh, operations, {});
        EXPECT_EQ(apply(mesh, operations, 1.0), whole) << kind.index();
        EXPECT_GT((whole - mesh.coordinates()).norm(), 0.01) << kind.index();
    }
}

TEST(PartialDeformation, RotationsTurnByPartOfTheirAngle) {
    const CurvedMesh mesh = square_mesh(3, 2);
    const Point center(0.3, -0.7, 0.0);
    const Coordinates half = apply(mesh, {{"all", Rotate{{0.3, -0.7, 0.0}, 90.0, {0, 0, 1}}}}, 0.5);
    EXPECT_EQ(half, apply(mesh, {{"all", Rotate{{0.3, -0.7, 0.0}, 45.0, {0, 0, 1}}}}, {}));
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const Point from = mesh.coordinates().row(node) - center, to = half.row(node) - center;
        EXPECT_NEAR(to.norm(), from.norm(), 1e-14);
        EXPECT_NEAR(std::atan2(from[0] * to[1] - from[1] * to[0], from.dot(to)), std::numbers::pi / 4, 1e-13);
    }
}

TEST(PartialDeformation, EverythingElseGoesStraight) {
    const CurvedMesh mesh = square_mesh(4, 2);
    for (const OperationKind& kind : every_kind()) {
        if (std::holds_alternative<Rotate>(kind)) continue;
        const Coordinates whole = apply(mesh, {{"top", kind}}, {}), part = apply(mesh, {{"top", kind}}, 0.3);
        const Coordinates expected = mesh.coordinates() + 0.3 * (whole - mesh.coordinates());
        EXPECT_LT((part - expected).cwiseAbs().maxCoeff(), 1e-15) << kind.index();
    }
}

TEST(PartialDeformation, OperationsFollowEachOther) {
    // A quarter turn after a shift: at one half, half a shift and then half the turn of what came of it.
    const CurvedMesh mesh = square_mesh(3, 1);
    const Operation shift{"all", Translate{{1.0, 0.0, 0.0}}}, turn{"all", Rotate{{0, 0, 0}, 90.0, {0, 0, 1}}};
    const Coordinates half = apply(mesh, {shift, turn}, 0.5);
    const double c = std::sqrt(0.5);
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const Point p = mesh.coordinates().row(node);
        EXPECT_LT((half.row(node) - Point(c * (p[0] + 0.5 - p[1]), c * (p[0] + 0.5 + p[1]), 0.0)).norm(), 1e-14);
    }
}

TEST(PartialDeformation, TheWayIsContinuousAndEndsWhereTheWholeEnds) {
    const CurvedMesh mesh = square_mesh(4, 2);
    const std::vector<Operation> operations{
        {"top", every_kind()[1]}, {"top", every_kind()[5]}, {"right", every_kind()[3]}};
    Coordinates last = apply(mesh, operations, 0.0);
    for (int step = 1; step <= 200; ++step) {
        const Coordinates next = apply(mesh, operations, step / 200.0);
        EXPECT_LT((next - last).rowwise().norm().maxCoeff(), 0.05);
        last = next;
    }
    EXPECT_EQ(last, apply(mesh, operations, {}));
}

TEST(PartialDeformation, TablesGoStraightToo) {
    const CurvedMesh mesh = square_mesh(2, 2);
    const NodeTag tag = mesh.topology().node_tag(3);
    const Deformation table{NodeTable{{{tag, {7, 8, 0}}}, false}, "t.csv"};
    EXPECT_EQ(apply_deformation(mesh, table, 0.0), mesh.coordinates());
    EXPECT_EQ(apply_deformation(mesh, table, 1.0), apply_deformation(mesh, table));
    const Coordinates x = apply_deformation(mesh, table, 0.25);
    const Point from = mesh.coordinates().row(3);
    EXPECT_LT((x.row(3) - (0.75 * from + 0.25 * Point(7, 8, 0))).norm(), 1e-15);
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if (node != 3) {
            EXPECT_EQ(x.row(node), mesh.coordinates().row(node));
        }
    NodeTable whole{{}, true};
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        whole.rows.push_back({mesh.topology().node_tag(node), {mesh.coordinates()(node, 0) + 1, 5, 0}});
    const Coordinates part = apply_deformation(mesh, {whole, "m.msh"}, 0.5);
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        EXPECT_NEAR(part(node, 0), mesh.coordinates()(node, 0) + (mesh.topology().is_boundary_node(node) ? 0.5 : 0.0),
                    1e-15);
}

TEST(PartialDeformation, RotationsOfAPlaneMeshKeepItsPlaneToTheBit) {
    // A warp of a 2D mesh takes no other z than the one that a node has.
    for (const double height : {0.1, -0.7, 1.0 / 3.0, 1e6 + 0.3})
        for (const double center : {0.0, 0.1, 0.3, -2.7}) {
            const CurvedMesh flat = square_mesh(3, 2);
            Coordinates x = flat.coordinates();
            x.col(2).setConstant(height);
            const CurvedMesh mesh = flat.with_coordinates(x);
            for (const double fraction : {0.3, 1.0}) {
                const Coordinates turned =
                    apply(mesh, {{"top", Rotate{{0.2, 0.1, center}, 33.0, {0, 0, 1}}}}, fraction);
                EXPECT_TRUE((turned.col(2).array() == height).all()) << height << " " << center;
            }
        }
}

TEST(PartialDeformation, FractionsOutOfRangeAreRefused) {
    const CurvedMesh mesh = square_mesh(2, 1);
    for (const double fraction : {-1e-9, 1.0 + 1e-9, -1.0, 2.0, std::nan("")})
        EXPECT_THROW(apply(mesh, {{"all", Translate{}}}, fraction), InvalidInput) << fraction;
}

TEST(PartialDeformation, FaultsAreFoundHoweverLittleIsDone) {
    const CurvedMesh mesh = square_mesh(2, 1);
    EXPECT_THROW(apply(mesh, {{"wing", Translate{}}}, 0.0), InvalidInput);
    EXPECT_THROW(apply(mesh, {{"all", Expression{{"1/x", {}, {}}}}}, 0.5), InvalidInput);
    EXPECT_THROW(apply_deformation(mesh, {NodeTable{{{{999}, {7, 8, 9}}}, false}, "t.csv"}, 0.0), InvalidInput);
}

}  // namespace
}  // namespace curvewright
