#include "core/untangle/improve.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/boundary/boundary_shape.h"
#include "core/quality/quality.h"
#include "core/quality/shape_quality.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/unsigned_angles.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

QualitySummary summary_of(const CurvedMesh& mesh, const Coordinates& x) {
    QualityOptions options;
    options.orientation_sign = assess_quality(mesh).orientation_sign;
    return assess_quality(mesh.with_coordinates(x), options).summary;
}

/// A valid mesh of low quality: interior nodes moved at random as far as all elements stay valid.
CurvedMesh poor(const CurvedMesh& mesh, double amplitude, unsigned seed) {
    for (;; amplitude *= 0.8) {
        std::mt19937 random(seed);
        const CurvedMesh moved = testing::shaken(mesh, amplitude, random);
        if (assess_quality(moved).summary.valid == moved.topology().element_count()) return moved;
    }
}

/// The same with a boundary that bulges.
CurvedMesh poor_with_bulge(unsigned seed) {
    return poor(testing::bulged_square_mesh(4, 3, 0.03), 0.05, seed);
}

double largest_move(const CurvedMesh& mesh, const Coordinates& x) {
    return (x - mesh.coordinates()).rowwise().norm().maxCoeff();
}

void expect_same_rows(const std::vector<Index>& nodes, const CurvedMesh& mesh, const Coordinates& x) {
    for (const Index node : nodes) ASSERT_EQ(x.row(node), mesh.coordinates().row(node)) << node;
}

std::vector<CurvedMesh> poor_meshes() {
    return {poor(testing::square_mesh(4, 3), 0.05, 1), poor(testing::quad_mesh(3, 2), 0.1, 2),
            poor(testing::cube_mesh(2, 2), 0.08, 3), poor(testing::hex_mesh(2, 2), 0.1, 4),
            poor(testing::prism_mesh(2, 2), 0.08, 5)};
}

TEST(Improve, RaisesTheLeastScaledJacobianAndKeepsTheBoundary) {
    for (const CurvedMesh& mesh : poor_meshes()) {
        const ImproveResult result = improve(mesh);
        const QualitySummary before = assess_quality(mesh).summary, after = summary_of(mesh, result.coordinates);
        EXPECT_EQ(after.valid, after.elements());
        EXPECT_GT(after.min, before.min + 0.1);
        EXPECT_EQ(result.reason, StopReason::converged);
        EXPECT_EQ(result.largest_move, largest_move(mesh, result.coordinates));
        expect_same_rows(mesh.topology().boundary_nodes(), mesh, result.coordinates);
    }
}

TEST(Improve, GoesOnUntilEveryElementHasBeenWorkedOn) {
    // With as little work as this, only a few elements at once.
    const CurvedMesh mesh = poor(testing::square_mesh(8, 3), 0.02, 6);
    ImproveOptions options;
    options.improve_work = 2e4;
    const auto below = [&](const Coordinates& x) {
        QualityReport report = assess_quality(mesh.with_coordinates(x));
        return std::count_if(report.elements.begin(), report.elements.end(),
                             [&](const auto& quality) { return quality.scaled_jacobian < options.target; });
    };
    const auto at_first = below(mesh.coordinates());
    ASSERT_GT(at_first, 60);
    EXPECT_LT(below(improve(mesh, options).coordinates), at_first / 3);
}

TEST(Improve, RaisesTheWorstMeanRatio) {
    for (const CurvedMesh& mesh : poor_meshes()) {
        ImproveOptions options;
        options.goal = ImproveGoal::shape;
        const Coordinates x = improve(mesh, options).coordinates;
        const QualitySummary after = summary_of(mesh, x);
        EXPECT_EQ(after.valid, after.elements());
        EXPECT_GT(assess_shape(mesh.with_coordinates(x), mesh.coordinates()).min,
                  assess_shape(mesh, mesh.coordinates()).min + 0.1);
        expect_same_rows(mesh.topology().boundary_nodes(), mesh, x);
    }
}

TEST(Improve, NoNodeGoesBeyondTheLimit) {
    for (const CurvedMesh& mesh : poor_meshes()) {
        const double free_move = improve(mesh).largest_move, size = mesh_size(mesh);
        for (const double share : {0.5, 0.1, 0.01}) {
            ImproveOptions options;
            options.max_move = share * free_move / size;
            const ImproveResult result = improve(mesh, options);
            const double limit = *options.max_move * size;
            EXPECT_LE(largest_move(mesh, result.coordinates), limit);
            EXPECT_GT(largest_move(mesh, result.coordinates), 0.5 * limit);  // it is made use of
            const QualitySummary before = assess_quality(mesh).summary, after = summary_of(mesh, result.coordinates);
            EXPECT_EQ(after.valid, after.elements());
            EXPECT_GE(after.min, before.min);
        }
    }
}

TEST(Improve, NoSlidingNodeGoesBeyondTheLimit) {
    std::vector<CurvedMesh> meshes{poor_with_bulge(7), poor(testing::cube_mesh(2, 2), 0.08, 8)};
    for (const CurvedMesh& start : meshes) {
        // Nodes of the boundary are moved along it, so that sliding pays.
        Coordinates x = start.coordinates();
        std::mt19937 random(9);
        std::uniform_real_distribution<double> shift(-0.02, 0.02);
        const BoundaryShape shape(start, {BoundaryMode::slide, {}, 40.0});
        for (const Index node : start.topology().boundary_nodes())
            if (shape.slides(node)) {
                const auto tangents = shape.tangents(shape.foot(node));
                for (Eigen::Index c = 0; c < tangents.cols(); ++c)
                    x.row(node) += shift(random) * tangents.col(c).transpose();
            }
        const CurvedMesh mesh = start.with_coordinates(x);
        ASSERT_EQ(assess_quality(mesh).summary.valid, mesh.topology().element_count());
        for (const double limit : {0.02, 0.002}) {
            ImproveOptions options;
            options.boundary.otherwise = BoundaryMode::slide;
            options.max_move = limit;
            const ImproveResult result = improve(mesh, options);
            EXPECT_GT(result.sliding_nodes, 0);
            EXPECT_LE(largest_move(mesh, result.coordinates), limit * mesh_size(mesh));
            const auto slid =
                std::count_if(mesh.topology().boundary_nodes().begin(), mesh.topology().boundary_nodes().end(),
                              [&](Index n) { return result.coordinates.row(n) != mesh.coordinates().row(n); });
            EXPECT_GT(slid, 0);
            EXPECT_GE(summary_of(mesh, result.coordinates).min, assess_quality(mesh).summary.min);
        }
    }
}

TEST(Improve, SameResultForEveryThreadCountAndWithAnObserver) {
    struct Counter : UntangleObserver {
        void on_event(const UntangleEvent&) override { ++events; }
        int events = 0;
    };
    for (const CurvedMesh& mesh : {poor(testing::square_mesh(6, 3), 0.03, 10), poor(testing::cube_mesh(2, 2), 0.08, 3)})
        for (const ImproveGoal goal : {ImproveGoal::jacobian, ImproveGoal::shape}) {
            ImproveOptions options;
            options.goal = goal;
            options.max_move = 0.02;
            set_thread_count(1);
            const Coordinates one = improve(mesh, options).coordinates;
            set_thread_count(4);
            EXPECT_EQ(improve(mesh, options).coordinates, one);
            Counter counter;
            EXPECT_EQ(improve(mesh, options, &counter).coordinates, one);
            EXPECT_GT(counter.events, 10);
            set_thread_count(0);
        }
}

TEST(Improve, LeavesAloneWhatReachesTheTarget) {
    const CurvedMesh mesh = poor(testing::square_mesh(4, 3), 0.05, 1);
    ImproveOptions options;
    options.target = assess_quality(mesh).summary.min;
    EXPECT_EQ(improve(mesh, options).coordinates, mesh.coordinates());
}

TEST(Improve, RefusesAMeshThatIsNotValid) {
    const CurvedMesh mesh = testing::bulged_square_mesh(3, 2, 0.3);
    const Index tangled = assess_quality(mesh).summary.invalid;
    ASSERT_GT(tangled, 1);
    try {
        improve(mesh);
        FAIL();
    } catch (const InvalidInput& problem) {
        EXPECT_NE(std::string(problem.what()).find(std::to_string(tangled) + " tangled elements"), std::string::npos)
            << problem.what();
    }
}

TEST(Improve, RefusesWrongOptions) {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    const auto refuses = [&](const auto& change) {
        ImproveOptions options;
        change(options);
        EXPECT_THROW(improve(mesh, options), InvalidInput);
    };
    refuses([](ImproveOptions& o) { o.target = 0.0; });
    refuses([](ImproveOptions& o) { o.max_move = 0.0; });
    refuses([](ImproveOptions& o) { o.max_move = 1.5; });
    refuses([](ImproveOptions& o) { o.layers = 0; });
    refuses([](ImproveOptions& o) { o.improve_work = 0.0; });
    refuses([](ImproveOptions& o) { o.shape_floor = 1.0; });
    refuses([](ImproveOptions& o) { o.nodes.fixed_nodes = {NodeTag{1}}; });
    refuses([](ImproveOptions& o) { o.nodes.fixed_groups = {"lid"}; });
    refuses([](ImproveOptions& o) { o.boundary.add("lid=slide"); });
}

TEST(Improve, CancelledItKeepsTheBestSoFar) {
    const CurvedMesh mesh = poor(testing::square_mesh(8, 3), 0.02, 6);
    ImproveOptions options;
    options.improve_work = 2e4;  // many passes
    const auto run = [&](bool keeps_best) {
        std::stop_source source;
        int reports = 0;
        options.keeps_best_on_cancel = keeps_best;
        return improve(mesh, options, nullptr, {source.get_token(), [&](std::string_view phase, double) {
                                                    if (phase.starts_with("Improving") && ++reports == 6)
                                                        source.request_stop();
                                                }});
    };
    EXPECT_THROW(run(false), Cancelled);
    const ImproveResult result = run(true);
    EXPECT_EQ(result.reason, StopReason::cancelled);
    const QualitySummary before = assess_quality(mesh).summary, after = summary_of(mesh, result.coordinates);
    EXPECT_EQ(after.valid, after.elements());
    EXPECT_GE(after.min, before.min);
    EXPECT_NE(result.coordinates, mesh.coordinates());
}

// ------------------------------------------------------------------------------------------ a valid mesh stays as it
// is

TEST(ValidMesh, ComesBackBitForBitFromEveryMethod) {
    for (const CurvedMesh& mesh : poor_meshes()) {
        ASSERT_LT(assess_quality(mesh).summary.min, 0.5);  // improving would have much to do
        EXPECT_EQ(untangle_guaranteed(mesh).coordinates, mesh.coordinates());
        GuaranteedOptions sliding;
        sliding.boundary.otherwise = BoundaryMode::slide;
        EXPECT_EQ(untangle_guaranteed(mesh, sliding).coordinates, mesh.coordinates());
        if (mesh.topology().element_type(0).shape != Shape::triangle) continue;
        for (const BetaChoice choice : {BetaChoice::given, BetaChoice::automatic}) {
            SignedAngleOptions options;
            options.beta_choice = choice;
            EXPECT_EQ(untangle_signed_angles(mesh, options).coordinates, mesh.coordinates());
        }
        EXPECT_EQ(untangle_unsigned_angles(mesh).coordinates, mesh.coordinates());
        EXPECT_EQ(untangle_unsigned_angles(mesh, UnsignedAngleOptions::literal()).coordinates, mesh.coordinates());
    }
}

// ------------------------------------------------------------------------------------------------- nodes that must
// stay

/// Interior nodes of high order moved so that elements tangle; corners stay.
CurvedMesh tangled(const CurvedMesh& mesh, double amplitude, unsigned seed) {
    const KeptNodes vertices({true, {}, {}}, mesh.topology());
    std::mt19937 random(seed);
    Coordinates x = testing::shaken(mesh, amplitude, random).coordinates();
    for (const Index node : vertices.nodes()) x.row(node) = mesh.coordinates().row(node);
    return mesh.with_coordinates(x);
}

/// Every third interior node, and some of the boundary.
NodeRules some_nodes(const MeshTopology& topology) {
    NodeRules rules;
    for (std::size_t i = 0; i < topology.interior_nodes().size(); i += 3)
        rules.fixed_nodes.push_back(topology.node_tag(topology.interior_nodes()[i]));
    for (std::size_t i = 0; i < topology.boundary_nodes().size(); i += 2)
        rules.fixed_nodes.push_back(topology.node_tag(topology.boundary_nodes()[i]));
    return rules;
}

void expect_kept(const NodeRules& rules, const CurvedMesh& mesh, const Coordinates& x) {
    expect_same_rows(KeptNodes(rules, mesh.topology()).nodes(), mesh, x);
    EXPECT_NE(x, mesh.coordinates());  // others moved
}

TEST(KeptNodes, StayInEveryMethod) {
    for (const CurvedMesh& mesh :
         {tangled(testing::bulged_square_mesh(4, 3, 0.03), 0.08, 11), tangled(testing::square_mesh(4, 2), 0.12, 12),
          tangled(testing::cube_mesh(2, 2), 0.2, 13)}) {
        ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
        NodeRules vertices;
        vertices.keeps_vertices = true;
        for (const NodeRules& rules : {vertices, some_nodes(mesh.topology())}) {
            for (const BoundaryMode mode : {BoundaryMode::fixed, BoundaryMode::slide, BoundaryMode::free}) {
                GuaranteedOptions options;
                options.nodes = rules;
                options.boundary.otherwise = mode;
                expect_kept(rules, mesh, untangle_guaranteed(mesh, options).coordinates);
            }
            if (mesh.topology().dimension() == 3) continue;
            for (const BetaChoice choice : {BetaChoice::given, BetaChoice::automatic}) {
                SignedAngleOptions options;
                options.beta_choice = choice;
                options.max_passes = 3;
                options.nodes = rules;
                expect_kept(rules, mesh, untangle_signed_angles(mesh, options).coordinates);
            }
            for (UnsignedAngleOptions options : {UnsignedAngleOptions(), UnsignedAngleOptions::literal()}) {
                options.nodes = rules;
                const Coordinates x = untangle_unsigned_angles(mesh, options).coordinates;
                expect_same_rows(KeptNodes(rules, mesh.topology()).nodes(), mesh, x);
            }
        }
    }
}

TEST(KeptNodes, StayWhileAMeshIsImproved) {
    for (const CurvedMesh& mesh : {poor_with_bulge(14), poor(testing::cube_mesh(2, 2), 0.08, 15)}) {
        NodeRules vertices;
        vertices.keeps_vertices = true;
        for (const NodeRules& rules : {vertices, some_nodes(mesh.topology())})
            for (const BoundaryMode mode : {BoundaryMode::fixed, BoundaryMode::slide}) {
                ImproveOptions options;
                options.nodes = rules;
                options.boundary.otherwise = mode;
                expect_kept(rules, mesh, improve(mesh, options).coordinates);
            }
    }
}

TEST(KeptNodes, AreNamedByTagOrGroup) {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    const MeshTopology& topology = mesh.topology();
    EXPECT_EQ(KeptNodes({false, {}, {"left"}}, topology).nodes(), topology.find_group_nodes("left").value());
    EXPECT_EQ(KeptNodes({false, {topology.node_tag(3)}, {}}, topology).nodes(), std::vector<Index>{3});
    EXPECT_EQ(KeptNodes({true, {}, {}}, topology).nodes().size(), 9u);  // 3 × 3 corners
    EXPECT_TRUE(KeptNodes({}, topology).nodes().empty());
    EXPECT_THROW(KeptNodes({false, {NodeTag{5}}, {}}, topology), InvalidInput);
    EXPECT_THROW(KeptNodes({false, {}, {"lid"}}, topology), InvalidInput);
}

}  // namespace
}  // namespace curvewright
