#include "core/edit/drag.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace curvewright::testing;

struct Case {
    const char* name;
    CurvedMesh mesh;
    std::string side;
};

std::vector<Case> cases() {
    return {{"P3 triangles", square_mesh(5, 3), "top"},
            {"P2 quadrilaterals", quad_mesh(4, 2), "top"},
            {"P2 tetrahedra", cube_mesh(3, 2), "z1"}};
}

TEST(Drag, AFrameIsTheWarpOfItsBoundary) {
    for (const auto& [name, mesh, side] : cases()) {
        const auto warper = std::make_shared<const Warper>(mesh);
        const auto report = std::make_shared<const QualityReport>(assess_quality(mesh));
        const Index fixed = mesh.topology().boundary_nodes().front();
        DraggedSet set{mesh.topology().find_group_nodes(side).value(), {}};
        std::erase(set.nodes, fixed);
        Drag drag(warper, set, ResponseKind::affine, Eigen::Vector3d(0.5, 0.5, 0.0), mesh, report);
        AffineMotion motion = AffineMotion::rotation(Eigen::Vector3d::UnitZ(), 0.1);
        motion.shift = {0.02, 0.05, 0.0};
        const Coordinates moved = drag.move(motion);
        const WarpResult direct = warper->move(moved);
        EXPECT_LT((direct.coordinates - moved).cwiseAbs().maxCoeff(), 1e-10) << name;
        EXPECT_GT((moved - mesh.coordinates()).cwiseAbs().maxCoeff(), 0.04) << name;

        QualityReport live = *report;
        drag.certify(moved, live);
        const QualityReport fresh =
            assess_quality(mesh.with_coordinates(moved), {.orientation_sign = report->orientation_sign});
        ASSERT_EQ(live.elements.size(), fresh.elements.size());
        for (std::size_t i = 0; i < live.elements.size(); ++i) {
            EXPECT_EQ(live.elements[i].scaled_jacobian, fresh.elements[i].scaled_jacobian) << name << " " << i;
            EXPECT_EQ(live.elements[i].min_lower, fresh.elements[i].min_lower);
            EXPECT_EQ(live.elements[i].validity, fresh.elements[i].validity);
        }
        EXPECT_EQ(live.summary.min, fresh.summary.min);
        EXPECT_EQ(live.summary.mean, fresh.summary.mean);
        EXPECT_EQ(live.summary.invalid, fresh.summary.invalid);

        // Back to where it began: the report of the start.
        drag.move({});
        drag.certify(drag.positions(), live);
        EXPECT_EQ(drag.positions(), mesh.coordinates()) << name;
        EXPECT_EQ(live.summary.min, report->summary.min);
    }
}

TEST(Drag, BeginsAtAnyStateOfTheMesh) {
    std::mt19937 random(7);
    const CurvedMesh mesh = square_mesh(5, 3), state = shaken(mesh, 0.004, random);
    const auto warper = std::make_shared<const Warper>(mesh);
    const DraggedSet set{mesh.topology().find_group_nodes("top").value(), {}};
    Drag drag(warper, set, ResponseKind::affine, Eigen::Vector3d::Zero(), state, nullptr);
    const AffineMotion motion = AffineMotion::scaling({1.1, 0.9, 1.0});
    const Coordinates& moved = drag.move(motion);
    for (Index node : set.nodes) {
        EXPECT_NEAR(moved(node, 0), 1.1 * state.coordinates()(node, 0), 1e-12);
        EXPECT_NEAR(moved(node, 1), 0.9 * state.coordinates()(node, 1), 1e-12);
    }
    // The interior takes the response of the warper's weights to the boundary's displacement on top of where it was.
    Coordinates boundary = mesh.coordinates();
    for (Index node : mesh.topology().boundary_nodes())
        boundary.row(node) += moved.row(node) - state.coordinates().row(node);
    const Coordinates response = warper->move(boundary).coordinates - mesh.coordinates();
    EXPECT_LT((moved - state.coordinates() - response).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Drag, OnlyElementsThatMoveAreCertifiedAnew) {
    // Prescribing everything but one corner's surroundings leaves the rest still.
    const CurvedMesh mesh = square_mesh(6, 2);
    WarpOptions options;
    options.prescribed_nodes = mesh.topology().interior_nodes();
    const auto warper = std::make_shared<const Warper>(mesh, options);
    const Index node = mesh.topology().interior_nodes().front();
    Drag drag(warper, {{node}, {}}, ResponseKind::translation, Eigen::Vector3d::Zero(), mesh, nullptr);
    for (Index element : drag.moving_elements()) {
        const auto nodes = mesh.topology().element_nodes(element);
        EXPECT_NE(std::find(nodes.begin(), nodes.end(), node), nodes.end());
    }
    EXPECT_FALSE(drag.moving_elements().empty());
    EXPECT_LE(drag.moving_elements().size(), 8u);
}

TEST(Drag, RefusesAnotherMesh) {
    const CurvedMesh mesh = square_mesh(3, 2), other = square_mesh(3, 2);
    const auto warper = std::make_shared<const Warper>(mesh);
    EXPECT_THROW(Drag(warper, {}, ResponseKind::translation, Eigen::Vector3d::Zero(), other, nullptr), InvalidInput);
    QualityReport report = assess_quality(mesh);
    report.elements.pop_back();
    EXPECT_THROW(update_quality(report, mesh.topology(), mesh.coordinates(), {}), InvalidInput);
}

}  // namespace
}  // namespace curvewright
