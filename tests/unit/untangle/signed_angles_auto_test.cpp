// The choice of beta for every edge, the length-normalised variant and the orders above 3.

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/node_elements.h"
#include "core/quality/quality.h"
#include "core/untangle/edge_angles.h"
#include "core/untangle/signed_angles.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/untangle/bulged_mesh.h"

namespace curvewright {
namespace {

using testing::bulged;
using testing::square_mesh;

SignedAngleOptions automatic() {
    SignedAngleOptions options;
    options.beta_choice = BetaChoice::automatic;
    return options;
}

SignedAngleOptions normalised(double beta) {
    SignedAngleOptions options;
    options.beta = beta;
    options.displacement = DisplacementUnit::edge_length;
    return options;
}

QualitySummary summary(const CurvedMesh& mesh, const UntangleResult& result) {
    return assess_quality(mesh.with_coordinates(result.coordinates)).summary;
}

TEST(AutomaticBeta, IsAtLeastAsGoodAsTheBestSingleBeta) {
    for (const int order : {2, 3}) {
        const CurvedMesh mesh = bulged(3, order, 0.1);
        ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
        const QualitySummary chosen = summary(mesh, untangle_signed_angles(mesh, automatic()));
        EXPECT_EQ(chosen.valid, chosen.elements()) << "P" << order;
        for (const double beta : {0.03, 0.1, 0.3, 0.7, 0.95}) {
            SignedAngleOptions literal;
            literal.beta = beta;
            EXPECT_GE(chosen.min, std::min(0.5, summary(mesh, untangle_signed_angles(mesh, literal)).min))
                << "P" << order << " beta " << beta;
            EXPECT_GE(chosen.min, std::min(0.5, summary(mesh, untangle_signed_angles(mesh, normalised(beta))).min))
                << "P" << order << " beta " << beta << " length-normalised";
        }
    }
}

TEST(AutomaticBeta, NeverMakesAMeshWorseAndNeverMovesTheBoundary) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> amplitude(0.0, 1.0);
    int tangled = 0, untangled = 0;
    for (int round = 0; round < 60; ++round) {
        const int order = 2 + round % 5, n = 2 + round % 3;
        CurvedMesh mesh = testing::with_shaken_corners(square_mesh(n, 1), 0.25 / n, order, random);
        mesh = testing::shaken(mesh, 0.5 * amplitude(random) / (n * order), random);
        if (round % 7 == 0) mesh = flip_orientation(mesh);
        const QualitySummary before = assess_quality(mesh).summary;
        const UntangleResult result = untangle_signed_angles(mesh, automatic());
        const QualitySummary after = summary(mesh, result);
        const Index bad_before = before.elements() - before.valid, bad_after = after.elements() - after.valid;
        EXPECT_LE(bad_after, bad_before) << round;
        if (bad_after == bad_before) {
            EXPECT_GE(after.min, before.min) << round;
        }
        tangled += bad_before > 0;
        untangled += bad_before > 0 && bad_after == 0;
        for (const Index node : mesh.topology().boundary_nodes())
            EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node));
        for (Index element = 0; element < mesh.topology().element_count(); ++element)
            for (int corner = 0; corner < 3; ++corner) {
                const Index node = mesh.topology().element_nodes(element)[corner];
                EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node));
            }
    }
    EXPECT_GT(tangled, 20);
    EXPECT_GT(untangled, tangled * 3 / 4);
}

TEST(AutomaticBeta, LeavesWhatIsGoodEnoughBitForBit) {
    std::mt19937 random(4);
    const CurvedMesh good = testing::shaken(square_mesh(6, 3), 0.003, random);
    SignedAngleOptions options = automatic();
    options.target = 0.9 * assess_quality(good).summary.min;
    // One edge is tangled; what shares no node with the triangles around it stays.
    const MeshTopology& topology = good.topology();
    const NodeElements node_elements = elements_of_nodes(topology);
    const EdgeNode edge_node = find_interior_edge_nodes(topology).front();
    Coordinates x = good.coordinates();
    x.row(edge_node.node).head<2>().array() += 0.2;
    const CurvedMesh mesh = good.with_coordinates(x);
    ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
    const UntangleResult result = untangle_signed_angles(mesh, options);
    std::vector<char> is_near(static_cast<std::size_t>(topology.node_count()), 0);
    for (const Index triangle : edge_node.triangles)
        for (const Index corner : topology.element_nodes(triangle))
            for (const Index around : node_elements.of(corner))
                for (const Index node : topology.element_nodes(around)) is_near[node] = 1;
    int stayed = 0;
    for (Index node = 0; node < topology.node_count(); ++node) {
        if (is_near[node]) continue;
        ++stayed;
        EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node));
    }
    EXPECT_GT(stayed, 50);
    options.target = 1.0;
    EXPECT_GT(summary(mesh, untangle_signed_angles(mesh, options)).min, summary(mesh, result).min);
}

TEST(AutomaticBeta, StopsAtThePassLimit) {
    SignedAngleOptions options = automatic();
    options.max_passes = 1;
    const UntangleResult result = untangle_signed_angles(bulged(3, 3, 0.1), options);
    EXPECT_EQ(result.passes, 1);
    EXPECT_EQ(result.reason, StopReason::pass_limit);
}

TEST(LengthNormalised, DoesNotDependOnTheUnitOfLength) {
    for (const int order : {2, 3}) {
        const CurvedMesh mesh = bulged(3, order, 0.1);
        for (const SignedAngleOptions& options : {automatic(), normalised(0.3)}) {
            const Coordinates x = untangle_signed_angles(mesh, options).coordinates;
            const double least = assess_quality(mesh.with_coordinates(x)).summary.min;
            // A power of two changes no rounding.
            for (const double scale : {std::ldexp(1.0, -20), std::ldexp(1.0, 20)}) {
                const CurvedMesh scaled = mesh.with_coordinates(scale * mesh.coordinates());
                EXPECT_EQ(untangle_signed_angles(scaled, options).coordinates, scale * x) << "P" << order;
            }
            for (const double scale : {1e-6, 1e6})
                for (const double shift : {0.0, 1e6}) {
                    Coordinates moved = scale * mesh.coordinates();
                    moved.leftCols<2>().array() += shift * scale;
                    const CurvedMesh other = mesh.with_coordinates(moved);
                    EXPECT_NEAR(summary(other, untangle_signed_angles(other, options)).min, least,
                                shift > 0.0 ? 2e-2 : 2e-3)
                        << "P" << order << " scale " << scale << " shift " << shift;
                }
        }
    }
}

TEST(SignedAngles, AreTheSameForEveryNumberOfThreads) {
    for (const int order : {2, 3, 4}) {
        const CurvedMesh mesh = bulged(12, order, 0.03);
        ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
        for (const SignedAngleOptions& options : {automatic(), SignedAngleOptions{}, normalised(0.3)}) {
            set_thread_count(1);
            const UntangleResult one = untangle_signed_angles(mesh, options);
            set_thread_count(4);
            const UntangleResult four = untangle_signed_angles(mesh, options);
            UntangleObserver* const nobody = nullptr;
            EXPECT_EQ(one.coordinates, untangle_signed_angles(mesh, options, nobody).coordinates);
            set_thread_count(0);
            EXPECT_EQ(one.coordinates, four.coordinates) << "P" << order;
            EXPECT_EQ(one.passes, four.passes);
        }
    }
}

/// Checks that the events of the automatic choice nest and tell the truth.
class Checker : public UntangleObserver {
  public:
    explicit Checker(const CurvedMesh& mesh) : x(mesh.coordinates()) {}
    void on_event(const UntangleEvent& event) override {
        using namespace untangle_event;
        if (std::holds_alternative<PassBegan>(event)) {
            EXPECT_FALSE(in_pass || in_patch);
            EXPECT_FALSE(was_put_back) << "only the last pass may end elsewhere than its patches did";
            in_pass = true;
        } else if (const auto* began = std::get_if<PatchBegan>(&event)) {
            EXPECT_TRUE(in_pass && !in_patch);
            in_patch = true;
            steps_of_patch = 0;
            for (std::size_t i = 0; i < began->nodes.size(); ++i)
                EXPECT_EQ(began->positions[i][0], x(began->nodes[i], 0));
        } else if (const auto* step = std::get_if<SimplexStep>(&event)) {
            EXPECT_TRUE(in_patch);
            EXPECT_TRUE(step->iteration == 0 || step->iteration == last_iteration + 1);
            EXPECT_NEAR(step->displacement_term + step->angle_term, step->objective[0], 1e-12 * step->objective[0]);
            last_iteration = step->iteration;
            steps_of_patch += step->iteration > 0;
        } else if (const auto* ended = std::get_if<PatchEnded>(&event)) {
            EXPECT_TRUE(in_patch);
            EXPECT_EQ(ended->iterations, steps_of_patch);
            EXPECT_EQ(ended->beta > 0.0, ended->iterations > 0);
            if (ended->min_scaled_jacobian_before > 0.0) {
                EXPECT_GE(ended->min_scaled_jacobian_after, ended->min_scaled_jacobian_before);
            }
            for (std::size_t i = 0; i < ended->nodes.size(); ++i)
                for (int d = 0; d < 3; ++d) x(ended->nodes[i], d) = ended->positions[i][d];
            moved += ended->beta > 0.0;
            in_patch = false;
        } else if (const auto* pass = std::get_if<PassEnded>(&event)) {
            EXPECT_FALSE(in_patch);
            was_put_back = *pass->coordinates != x;
            x = *pass->coordinates;
            in_pass = false;
            EXPECT_EQ(pass->pass, ++passes);
        } else if (const auto* finished = std::get_if<Finished>(&event)) {
            EXPECT_FALSE(in_pass);
            EXPECT_EQ(finished->passes, passes);
            is_finished = true;
        }
    }
    Coordinates x;  ///< the mesh as the events tell it
    bool in_pass = false, in_patch = false, was_put_back = false, is_finished = false;
    int passes = 0, moved = 0, last_iteration = 0, steps_of_patch = 0;
};

TEST(AutomaticBeta, ObserverCanFollowEveryMoveAndChangesNothing) {
    for (const int order : {2, 3}) {
        const CurvedMesh mesh = bulged(5, order, 0.08);
        Checker checker(mesh);
        const UntangleResult watched = untangle_signed_angles(mesh, automatic(), &checker);
        EXPECT_EQ(watched.coordinates, untangle_signed_angles(mesh, automatic()).coordinates);
        EXPECT_EQ(checker.x, watched.coordinates);
        // The best state of all passes is returned; at order 3 it is an earlier one than the last.
        EXPECT_EQ(checker.was_put_back, order == 3);
        EXPECT_TRUE(checker.is_finished);
        EXPECT_GT(checker.moved, 0);
    }
}

TEST(AutomaticBeta, RefusesTargetsOutOfRangeAndDoesNotReadBeta) {
    SignedAngleOptions options = automatic();
    options.beta = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NO_THROW(untangle_signed_angles(square_mesh(2, 2), options));
    for (const double target : {0.0, -1.0, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
        options.target = target;
        EXPECT_THROW(untangle_signed_angles(square_mesh(2, 2), options), InvalidInput);
    }
    options = automatic();
    options.max_passes = 0;
    EXPECT_THROW(untangle_signed_angles(square_mesh(2, 2), options), InvalidInput);
    EXPECT_THROW(untangle_signed_angles(testing::quad_mesh(2, 2), automatic()), Unsupported);
}

TEST(AutomaticBeta, TakesCornersThatCoincide) {
    // Some interior edges have no length, and their triangles no area.
    CurvedMesh mesh = bulged(4, 3, 0.08);
    Coordinates x = mesh.coordinates();
    Index first = -1;
    for (Index element = 0; element < mesh.topology().element_count() && first < 0; ++element) {
        const auto nodes = mesh.topology().element_nodes(element);
        if (!mesh.topology().is_interior_node(nodes[0]) || !mesh.topology().is_interior_node(nodes[1])) continue;
        first = nodes[0];
        x.row(nodes[1]) = x.row(nodes[0]);
    }
    ASSERT_GE(first, 0);
    mesh = mesh.with_coordinates(x);
    const QualitySummary before = assess_quality(mesh).summary;
    for (const SignedAngleOptions& options : {automatic(), normalised(0.3), SignedAngleOptions{}}) {
        const Coordinates result = untangle_signed_angles(mesh, options).coordinates;
        EXPECT_TRUE(result.allFinite());
        if (options.beta_choice == BetaChoice::automatic) {
            EXPECT_LE(before.valid, assess_quality(mesh.with_coordinates(result)).summary.valid);
        }
    }
}

TEST(AutomaticBeta, IsCancelledBetweenPatches) {
    std::stop_source source;
    class Stopper : public UntangleObserver {
      public:
        explicit Stopper(std::stop_source& s) : source(s) {}
        void on_event(const UntangleEvent& event) override {
            if (std::holds_alternative<untangle_event::PatchEnded>(event) && ++patches == 2) source.request_stop();
        }
        std::stop_source& source;
        int patches = 0;
    } stopper(source);
    EXPECT_THROW(untangle_signed_angles(bulged(4, 3, 0.1), automatic(), &stopper, {source.get_token(), {}}), Cancelled);
    EXPECT_EQ(stopper.patches, 2);
    source = {};
    source.request_stop();
    EXPECT_THROW(untangle_signed_angles(bulged(4, 3, 0.1), automatic(), nullptr, {source.get_token(), {}}), Cancelled);
}

}  // namespace
}  // namespace curvewright
