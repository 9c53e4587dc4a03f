#include "core/untangle/unsigned_angles.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/quality/quality.h"
#include "core/untangle/standing.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::bulged_square_mesh;
using testing::shaken;
using testing::square_mesh;

QualitySummary quality_of(const CurvedMesh& mesh, const Coordinates& x) {
    return assess_quality(mesh.with_coordinates(x)).summary;
}

TEST(UnsignedAngles, UntangleABulgedBoundary) {
    for (const int order : {2, 3, 4}) {
        const CurvedMesh mesh = bulged_square_mesh(3, order, 0.1);
        ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
        const UntangleResult result = untangle_unsigned_angles(mesh);
        EXPECT_EQ(quality_of(mesh, result.coordinates).invalid, 0) << "P" << order;
        EXPECT_EQ(result.reason, StopReason::untangled);
    }
}

TEST(UnsignedAngles, TheLiteralMethodUntanglesShallowBulges) {
    const CurvedMesh mesh = bulged_square_mesh(3, 2, 0.1);
    ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
    const UntangleResult literal = untangle_unsigned_angles(mesh, UnsignedAngleOptions::literal());
    EXPECT_EQ(quality_of(mesh, literal.coordinates).invalid, 0);
    // The exact gradient leads to the same mesh: the differences err by rounding only.
    UnsignedAngleOptions exact = UnsignedAngleOptions::literal();
    exact.gradient = AngleGradient::exact;
    const UntangleResult other = untangle_unsigned_angles(mesh, exact);
    EXPECT_LT((literal.coordinates - other.coordinates).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(UnsignedAngles, LiteralMovesNothingButNodesOfInteriorEdges) {
    const CurvedMesh mesh = bulged_square_mesh(3, 3, 0.1);
    const UntangleResult result = untangle_unsigned_angles(mesh, UnsignedAngleOptions::literal());
    const MeshTopology& topology = mesh.topology();
    int moved = 0;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto nodes = topology.element_nodes(element);
        for (const int local : {0, 1, 2, 9})
            EXPECT_EQ(result.coordinates.row(nodes[local]), mesh.coordinates().row(nodes[local]));
    }
    for (const Index node : topology.boundary_nodes())
        EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node));
    for (Index node = 0; node < topology.node_count(); ++node)
        moved += result.coordinates.row(node) != mesh.coordinates().row(node) ? 1 : 0;
    EXPECT_GT(moved, 0);
}

TEST(UnsignedAngles, LeaveGoodMeshesAlone) {
    const CurvedMesh mesh = square_mesh(3, 3);
    const UntangleResult result = untangle_unsigned_angles(mesh);
    EXPECT_EQ(result.coordinates, mesh.coordinates());
    EXPECT_EQ(result.passes, 0);
    EXPECT_EQ(result.reason, StopReason::untangled);
}

TEST(UnsignedAngles, NeverReturnAWorseMesh) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> amplitude(0.02, 0.3);
    int tangled = 0, mended = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const int order = 2 + trial % 4;
        const CurvedMesh mesh = shaken(square_mesh(4, order), amplitude(random) / order, random);
        const QualityReport before = assess_quality(mesh);
        const Coordinates x = untangle_unsigned_angles(mesh).coordinates;
        QualityOptions judged;
        judged.orientation_sign = before.orientation_sign;
        const QualityReport after = assess_quality(mesh.with_coordinates(x), judged);
        const Standing was(before.elements), is(after.elements);
        EXPECT_FALSE(was.is_better_than(is)) << trial;
        for (const Index node : mesh.topology().boundary_nodes()) EXPECT_EQ(x.row(node), mesh.coordinates().row(node));
        tangled += was.not_valid > 0 ? 1 : 0;
        mended += was.not_valid > 0 && is.not_valid == 0 ? 1 : 0;
    }
    EXPECT_GT(tangled, 20);
    EXPECT_GT(mended, 0);
}

TEST(UnsignedAngles, DoNotDependOnTheUnitOrTheOrigin) {
    const CurvedMesh mesh = bulged_square_mesh(3, 3, 0.1);
    const double expected = quality_of(mesh, untangle_unsigned_angles(mesh).coordinates).min;
    ASSERT_GT(expected, 0.0);
    for (const double scale : {1e-6, 1e6}) {
        const CurvedMesh scaled = mesh.with_coordinates(scale * mesh.coordinates());
        EXPECT_NEAR(quality_of(scaled, untangle_unsigned_angles(scaled).coordinates).min, expected, 1e-6);
    }
    Coordinates shifted = mesh.coordinates();
    shifted.leftCols<2>().array() += 1024.0 * 1024.0;
    const CurvedMesh elsewhere = mesh.with_coordinates(shifted);
    EXPECT_NEAR(quality_of(elsewhere, untangle_unsigned_angles(elsewhere).coordinates).min, expected, 1e-6);
}

class Checker : public UntangleObserver {
  public:
    void on_event(const UntangleEvent& event) override {
        using namespace untangle_event;
        if (const auto* began = std::get_if<PatchBegan>(&event)) {
            EXPECT_FALSE(in_patch);
            EXPECT_EQ(began->nodes.size(), began->positions.size());
            EXPECT_EQ(began->elements.size(), 2u);
            in_patch = true;
        } else if (const auto* step = std::get_if<BfgsStep>(&event)) {
            EXPECT_TRUE(in_patch);
            if (step->iteration > 0) {
                EXPECT_LT(step->objective, last_objective);
                EXPECT_GT(step->step, 0.0);
            }
            last_objective = step->objective;
            EXPECT_NEAR(step->angles[0] + step->angles[1] + step->angles[2] + step->angles[3], step->objective, 1e-12);
            ++steps;
        } else if (const auto* ended = std::get_if<PatchEnded>(&event)) {
            EXPECT_TRUE(in_patch);
            in_patch = false;
            EXPECT_EQ(ended->nodes.size(), ended->positions.size());
            ++patches;
        } else if (const auto* pass = std::get_if<PassEnded>(&event)) {
            last = *pass->coordinates;
            minimum = pass->min_scaled_jacobian;
        } else if (const auto* end = std::get_if<Finished>(&event)) {
            passes = end->passes;
        }
    }
    bool in_patch = false;
    double last_objective = 0.0, minimum = 0.0;
    int steps = 0, patches = 0, passes = -1;
    Coordinates last;
};

TEST(UnsignedAngles, TellTheObserverEveryStep) {
    const CurvedMesh mesh = bulged_square_mesh(3, 3, 0.1);
    Checker checker;
    const UntangleResult result = untangle_unsigned_angles(mesh, UnsignedAngleOptions::literal(), &checker);
    EXPECT_GT(checker.patches, 0);
    EXPECT_GE(checker.steps, checker.patches);
    EXPECT_EQ(checker.passes, result.passes);
    EXPECT_EQ(checker.last, result.coordinates);
    EXPECT_DOUBLE_EQ(checker.minimum, quality_of(mesh, result.coordinates).min);
    EXPECT_EQ(untangle_unsigned_angles(mesh, UnsignedAngleOptions::literal()).coordinates, result.coordinates);
}

TEST(UnsignedAngles, RefuseWhatTheyCannotDo) {
    EXPECT_THROW(untangle_unsigned_angles(square_mesh(2, 1)), Unsupported);
    EXPECT_THROW(untangle_unsigned_angles(testing::quad_mesh(2, 2)), Unsupported);
    EXPECT_THROW(untangle_unsigned_angles(testing::cube_mesh(1, 2)), Unsupported);
    const CurvedMesh mesh = square_mesh(2, 2);
    UnsignedAngleOptions options;
    for (const double step : {0.0, -1.0, std::nan(""), 1e9}) {
        options.first_steps = {step};
        EXPECT_THROW(untangle_unsigned_angles(mesh, options), InvalidInput) << step;
    }
    options.first_steps.clear();
    EXPECT_THROW(untangle_unsigned_angles(mesh, options), InvalidInput);
    options = {};
    options.max_passes = 0;
    EXPECT_THROW(untangle_unsigned_angles(mesh, options), InvalidInput);
    options = {};
    options.difference_step = 0.0;
    EXPECT_THROW(untangle_unsigned_angles(mesh, options), InvalidInput);
    options = {};
    options.target = 1.5;
    EXPECT_THROW(untangle_unsigned_angles(mesh, options), InvalidInput);
}

TEST(UnsignedAngles, CanBeCancelled) {
    std::stop_source source;
    source.request_stop();
    TaskContext context;
    context.stop = source.get_token();
    EXPECT_THROW(untangle_unsigned_angles(bulged_square_mesh(3, 2, 0.1), {}, nullptr, context), Cancelled);
}

}  // namespace
}  // namespace curvewright
