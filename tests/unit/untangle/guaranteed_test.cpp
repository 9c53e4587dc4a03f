#include "core/untangle/guaranteed.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

QualitySummary summary_of(const CurvedMesh& mesh, const Coordinates& x) {
    QualityOptions options;
    options.orientation_sign = assess_quality(mesh).orientation_sign;
    return assess_quality(mesh.with_coordinates(x), options).summary;
}

void expect_boundary_unmoved(const CurvedMesh& mesh, const Coordinates& x) {
    for (const Index node : mesh.topology().boundary_nodes())
        for (int d = 0; d < 3; ++d) ASSERT_EQ(x(node, d), mesh.coordinates()(node, d));
}

/// High-order interior nodes moved at random, vertices left alone: a valid mesh exists, the straight-sided one.
CurvedMesh tangled(const CurvedMesh& mesh, double amplitude, std::mt19937& random) {
    std::vector<bool> is_vertex(static_cast<std::size_t>(mesh.topology().node_count()), false);
    for (Index element = 0; element < mesh.topology().element_count(); ++element)
        for (int c = 0; c < corner_count(mesh.topology().element_type(element).shape); ++c)
            is_vertex[mesh.topology().element_nodes(element)[static_cast<std::size_t>(c)]] = true;
    const CurvedMesh moved = testing::shaken(mesh, amplitude, random);
    Coordinates x = moved.coordinates();
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if (is_vertex[static_cast<std::size_t>(node)]) x.row(node) = mesh.coordinates().row(node);
    return mesh.with_coordinates(x);
}

TEST(Guaranteed, MendsRandomTanglesOfEveryOrderIn2DAnd3D) {
    std::mt19937 random(1);
    int tangles = 0;
    for (int trial = 0; trial < 12; ++trial) {
        const int order = 2 + trial % 4;
        const bool is_solid = trial % 3 == 2 && order < 4;
        const CurvedMesh mesh = tangled(is_solid ? testing::cube_mesh(2, order) : testing::square_mesh(4, order),
                                        is_solid ? 0.2 : 0.12, random);
        const QualitySummary before = assess_quality(mesh).summary;
        tangles += before.invalid;
        const GuaranteedResult result = untangle_guaranteed(mesh);
        const QualitySummary after = summary_of(mesh, result.coordinates);
        EXPECT_EQ(after.invalid + after.undecided, 0) << "trial " << trial << ", order " << order;
        EXPECT_TRUE(result.unmended.empty());
        expect_boundary_unmoved(mesh, result.coordinates);
    }
    EXPECT_GT(tangles, 100);
}

TEST(Guaranteed, ImprovingRaisesTheLeastScaledJacobian) {
    std::mt19937 random(2);
    const CurvedMesh mesh = tangled(testing::square_mesh(5, 3), 0.06, random);
    GuaranteedOptions options;
    options.improves = false;
    const QualitySummary valid = summary_of(mesh, untangle_guaranteed(mesh, options).coordinates);
    options.improves = true;
    const QualitySummary improved = summary_of(mesh, untangle_guaranteed(mesh, options).coordinates);
    EXPECT_EQ(valid.invalid, 0);
    EXPECT_GT(improved.min, valid.min + 0.1);
    EXPECT_GT(improved.min, 0.9);
}

TEST(Guaranteed, AValidMeshOfStraightElementsStaysAsItIs) {
    const CurvedMesh mesh = testing::square_mesh(4, 3);
    EXPECT_EQ(untangle_guaranteed(mesh).coordinates, mesh.coordinates());
}

TEST(Guaranteed, NamesWhatCannotBeMended) {
    // One triangle of order 2: all nodes on the boundary, one edge pushed through the opposite corner.
    CurvedMesh mesh = testing::square_mesh(1, 2);
    Coordinates x = mesh.coordinates();
    for (const Index node : mesh.topology().boundary_nodes())
        if (x(node, 0) == 0.5 && x(node, 1) == 0.0) x(node, 1) = 0.9;
    mesh = mesh.with_coordinates(x);
    ASSERT_EQ(assess_quality(mesh).summary.invalid, 1);
    const GuaranteedResult result = untangle_guaranteed(mesh);
    ASSERT_EQ(result.unmended.size(), 1u);
    EXPECT_FALSE(result.unmended[0].reason.empty());
    const QualitySummary after = summary_of(mesh, result.coordinates);
    EXPECT_EQ(after.invalid + after.undecided, 1);
    expect_boundary_unmoved(mesh, result.coordinates);
}

TEST(Guaranteed, NeverReturnsAWorseMesh) {
    // Boundary nodes are moved too, so that many of these cannot be mended.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.15, 0.15);
    for (int trial = 0; trial < 12; ++trial) {
        const CurvedMesh start = trial % 2 == 0 ? testing::square_mesh(4, 2 + trial % 3) : testing::cube_mesh(2, 2);
        Coordinates x = tangled(start, 0.08, random).coordinates();
        for (const Index node : start.topology().boundary_nodes())
            for (int d = 0; d < start.topology().dimension(); ++d) x(node, d) += shift(random);
        const CurvedMesh mesh = start.with_coordinates(x);
        const QualitySummary before = assess_quality(mesh).summary;
        const GuaranteedResult result = untangle_guaranteed(mesh);
        const QualitySummary after = summary_of(mesh, result.coordinates);
        EXPECT_LE(after.invalid + after.undecided, before.invalid + before.undecided);
        EXPECT_EQ(result.unmended.size(), static_cast<std::size_t>(after.invalid + after.undecided));
        expect_boundary_unmoved(mesh, result.coordinates);
    }
}

TEST(Guaranteed, SameResultForEveryUnitOriginAndThreadCount) {
    std::mt19937 random(4);
    const CurvedMesh mesh = tangled(testing::square_mesh(5, 3), 0.06, random);
    GuaranteedOptions options;
    options.improves = false;
    set_thread_count(1);
    const Coordinates one = untangle_guaranteed(mesh, options).coordinates;
    set_thread_count(4);
    EXPECT_EQ(untangle_guaranteed(mesh, options).coordinates, one);
    set_thread_count(0);
    for (const double unit : {1e-6, 1e6}) {
        const GuaranteedResult scaled = untangle_guaranteed(mesh.with_coordinates(unit * mesh.coordinates()), options);
        EXPECT_TRUE(scaled.unmended.empty());
        EXPECT_LT((scaled.coordinates / unit - one).cwiseAbs().maxCoeff(), 1e-6);
    }
}

TEST(Guaranteed, TakesMeshesNumberedClockwise) {
    std::mt19937 random(5);
    const CurvedMesh mesh = flip_orientation(tangled(testing::square_mesh(4, 3), 0.08, random));
    const GuaranteedResult result = untangle_guaranteed(mesh);
    EXPECT_TRUE(result.unmended.empty());
    EXPECT_EQ(summary_of(mesh, result.coordinates).invalid, 0);
}

TEST(Guaranteed, CancelsInEveryPhaseAndReportsProgress) {
    std::mt19937 random(6);
    const CurvedMesh mesh = tangled(testing::square_mesh(6, 3), 0.08, random);
    std::vector<std::string> phases;
    untangle_guaranteed(mesh, {}, nullptr, {{}, [&](std::string_view phase, double) {
                                                if (phases.empty() || phases.back() != phase)
                                                    phases.emplace_back(phase);
                                            }});
    ASSERT_GE(phases.size(), 3u);
    for (const std::string& target : phases) {
        std::stop_source source;
        const ProgressCallback stop = [&](std::string_view phase, double) {
            if (phase == target) source.request_stop();
        };
        EXPECT_THROW(untangle_guaranteed(mesh, {}, nullptr, {source.get_token(), stop}), Cancelled) << target;
    }
}

TEST(Guaranteed, TellsItsObserverEveryPass) {
    struct Recorder : UntangleObserver {
        void on_event(const UntangleEvent& event) override {
            started += std::holds_alternative<untangle_event::Started>(event);
            finished += std::holds_alternative<untangle_event::Finished>(event);
            if (const auto* pass = std::get_if<untangle_event::PassEnded>(&event)) last = *pass;
        }
        int started = 0, finished = 0;
        untangle_event::PassEnded last;
    } recorder;
    std::mt19937 random(7);
    const CurvedMesh mesh = tangled(testing::square_mesh(5, 3), 0.06, random);
    const GuaranteedResult result = untangle_guaranteed(mesh, {}, &recorder);
    EXPECT_EQ(recorder.started, 1);
    EXPECT_EQ(recorder.finished, 1);
    EXPECT_GE(recorder.last.pass, 2);
    EXPECT_EQ(recorder.last.invalid, 0);
    EXPECT_NEAR(recorder.last.min_scaled_jacobian, summary_of(mesh, result.coordinates).min, 1e-12);
}

TEST(Guaranteed, RefusesWrongOptions) {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    GuaranteedOptions options;
    options.layers = 0;
    EXPECT_THROW(untangle_guaranteed(mesh, options), InvalidInput);
    options = {};
    options.target = 0.0;
    EXPECT_THROW(untangle_guaranteed(mesh, options), InvalidInput);
    options = {};
    options.shape_weight = -1.0;
    EXPECT_THROW(untangle_guaranteed(mesh, options), InvalidInput);
}

}  // namespace
}  // namespace curvewright
