// Boundaries that slide or are free, and elements that nothing can mend.

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/quality/quality.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/unmendable.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

QualitySummary summary_of(const CurvedMesh& mesh, const Coordinates& x) {
    QualityOptions options;
    options.orientation_sign = assess_quality(mesh).orientation_sign;
    return assess_quality(mesh.with_coordinates(x), options).summary;
}

Index node_at(const CurvedMesh& mesh, double x, double y) {
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if (mesh.coordinates()(node, 0) == x && mesh.coordinates()(node, 1) == y) return node;
    throw InvalidInput("no such node");
}

/// The middle of an edge on the bottom pushed along the bottom, so that the edge folds back at its end.
CurvedMesh folded_square() {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    Coordinates x = mesh.coordinates();
    x(node_at(mesh, 0.25, 0.0), 0) = 0.05;
    return mesh.with_coordinates(x);
}

/// A cube bent smoothly, with the nodes of its faces and edges pushed along them.
CurvedMesh badly_parametrised_cube(int order, double amplitude, std::mt19937& random) {
    const CurvedMesh mesh = testing::cube_mesh(2, order);
    std::uniform_real_distribution<double> shift(-amplitude, amplitude);
    Coordinates x = mesh.coordinates();
    for (const Index node : mesh.topology().boundary_nodes())
        for (int d = 0; d < 3; ++d) {
            const double lattice = x(node, d) * 2;
            if (lattice != std::round(lattice)) x(node, d) += shift(random);
        }
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const Eigen::RowVector3d p = x.row(i);
        for (int d = 0; d < 3; ++d) x(i, d) += 0.05 * std::sin(std::numbers::pi * p[(d + 1) % 3]);
    }
    return mesh.with_coordinates(x);
}

TEST(GuaranteedBoundary, ANodeThatFoldsAnEdgeSlidesBackAlongIt) {
    const CurvedMesh mesh = folded_square();
    ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
    GuaranteedOptions options;
    options.boundary.add("slide");
    const GuaranteedResult result = untangle_guaranteed(mesh, options);
    EXPECT_TRUE(result.unmended.empty());
    EXPECT_EQ(summary_of(mesh, result.coordinates).valid, mesh.topology().element_count());
    EXPECT_GT(summary_of(mesh, result.coordinates).min, 0.8);
    EXPECT_LT(result.largest_boundary_distance, 1e-12);
    EXPECT_EQ(result.free_nodes, 0);
    for (const Index node : mesh.topology().boundary_nodes()) {
        const double x = mesh.coordinates()(node, 0), y = mesh.coordinates()(node, 1);
        if (x == 0.0 || x == 1.0) {
            EXPECT_NEAR(result.coordinates(node, 0), x, 1e-14);
        }
        if (y == 0.0 || y == 1.0) {
            EXPECT_NEAR(result.coordinates(node, 1), y, 1e-14);
        }
        if ((x == 0.0 || x == 1.0) && (y == 0.0 || y == 1.0)) {
            EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node)) << "a corner moved";
        }
    }
}

TEST(GuaranteedBoundary, WhatIsNotNamedStaysBitForBit) {
    const CurvedMesh mesh = folded_square();
    GuaranteedOptions options;
    options.boundary.add("bottom=slide");
    const GuaranteedResult result = untangle_guaranteed(mesh, options);
    EXPECT_TRUE(result.unmended.empty());
    for (const Index node : mesh.topology().boundary_nodes())
        if (mesh.coordinates()(node, 1) != 0.0 || mesh.coordinates()(node, 0) == 0.0 ||
            mesh.coordinates()(node, 0) == 1.0) {
            EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node));
        }
    EXPECT_NE(result.coordinates(node_at(testing::square_mesh(2, 2), 0.25, 0.0), 0), 0.05);
    options.boundary.add("roof=slide");
    EXPECT_THROW(untangle_guaranteed(mesh, options), InvalidInput);
}

TEST(GuaranteedBoundary, FreeNodesMoveLikeInteriorOnes) {
    // An edge pushed through the opposite corner: nothing but leaving the boundary helps.
    CurvedMesh mesh = testing::square_mesh(1, 2);
    Coordinates x = mesh.coordinates();
    x(node_at(mesh, 0.5, 0.0), 1) = 0.9;
    mesh = mesh.with_coordinates(x);
    GuaranteedOptions options;
    options.boundary.add("bottom=free");
    const GuaranteedResult result = untangle_guaranteed(mesh, options);
    EXPECT_TRUE(result.unmended.empty());
    EXPECT_GT(result.free_nodes, 0);
    EXPECT_GT(result.largest_boundary_distance, 0.1);
}

TEST(GuaranteedBoundary, SlidesOnBadlyParametrisedSurfaces) {
    std::mt19937 random(1);
    Index tangled = 0;
    for (const int order : {2, 3})
        for (int trial = 0; trial < 3; ++trial) {
            const CurvedMesh mesh = badly_parametrised_cube(order, order == 2 ? 0.15 : 0.09, random);
            tangled += assess_quality(mesh).summary.invalid;
            GuaranteedOptions options;
            options.boundary.add("slide");
            const GuaranteedResult result = untangle_guaranteed(mesh, options);
            const QualitySummary after = summary_of(mesh, result.coordinates);
            EXPECT_EQ(after.valid, mesh.topology().element_count()) << "order " << order << ", trial " << trial;
            EXPECT_GT(result.sliding_nodes, 50);
            EXPECT_LT(result.largest_boundary_distance, 0.2);
        }
    EXPECT_GT(tangled, 50);
}

TEST(GuaranteedBoundary, ElementsWithAConstantJacobianAtACornerAreProvedImpossible) {
    // Two triangles of order 3, each with two edges on the boundary. One edge folds back where it meets the other.
    const CurvedMesh start = testing::square_mesh(1, 3);
    Coordinates x = start.coordinates();
    for (const Index node : start.topology().boundary_nodes())
        if (x(node, 1) == 0.0 && x(node, 0) > 0.5 && x(node, 0) < 1.0) x(node, 0) = 1.2;
    const CurvedMesh mesh = start.with_coordinates(x);
    ASSERT_EQ(assess_quality(mesh).summary.invalid, 1);
    const GuaranteedResult result = untangle_guaranteed(mesh);
    EXPECT_EQ(result.rounds, 0) << "iterated in vain";
    ASSERT_EQ(result.unmended.size(), 1u);
    EXPECT_TRUE(result.unmended[0].is_proved);
    EXPECT_LT(result.unmended[0].bound, 0.0);
    EXPECT_NE(result.unmended[0].reason.find("corner at node"), std::string::npos) << result.unmended[0].reason;
}

TEST(GuaranteedBoundary, NeighboursOfImpossibleElementsAreMended) {
    std::mt19937 random(2);
    const CurvedMesh start = testing::square_mesh(4, 2);
    Coordinates x = testing::shaken(start, 0.09, random).coordinates();
    x(node_at(start, 0.375, 0.0), 0) = 0.485;  // an edge of the bottom folds back in its middle joint
    const CurvedMesh mesh = start.with_coordinates(x);
    ASSERT_GT(assess_quality(mesh).summary.invalid, 8);
    const GuaranteedResult result = untangle_guaranteed(mesh);
    ASSERT_EQ(result.unmended.size(), 1u);
    EXPECT_TRUE(result.unmended[0].is_proved) << result.unmended[0].reason;
    EXPECT_EQ(summary_of(mesh, result.coordinates).valid, mesh.topology().element_count() - 1);
}

/// One tetrahedron of order 2; node 4 is the middle of its edge from corner 0 to corner 1.
CurvedMesh tetrahedron(const auto& change) {
    const CurvedMesh cube = testing::cube_mesh(1, 2);
    Eigen::MatrixX3d x = cube.element_coordinates(0);
    change(x);
    return testing::single_element({Shape::tetrahedron, 2}, x);
}

std::optional<Impossibility> impossibility_of(const CurvedMesh& mesh, const std::function<bool(Index)>& may_move) {
    const OrientationSigns sign = assess_quality(tetrahedron([](Eigen::MatrixX3d&) {})).orientation_sign;
    return find_impossibility(mesh, 0, sign, elements_of_nodes(mesh.topology()), may_move);
}

TEST(Unmendable, TwoElementsCannotBothHaveTheEdgeBetweenThem) {
    // The bottom's first edge folds back at its end, where it meets an edge that goes inside: the elements on the
    // two sides of that want it on opposite sides of the bottom.
    const CurvedMesh start = testing::square_mesh(2, 2);
    Coordinates x = start.coordinates();
    x(node_at(start, 0.25, 0.0), 0) = 0.45;
    const GuaranteedResult result = untangle_guaranteed(start.with_coordinates(x));
    EXPECT_EQ(result.rounds, 0);
    ASSERT_EQ(result.unmended.size(), 1u);
    EXPECT_TRUE(result.unmended[0].is_proved) << result.unmended[0].reason;
    EXPECT_NE(result.unmended[0].reason.find("shares the edge"), std::string::npos) << result.unmended[0].reason;
}

TEST(Unmendable, ASingleNodeCannotBeInTwoPlacesAtOnce) {
    // The middles of two edges that end in the free edge's ends turn the element over at both ends: at either the free
    // node could put that right, but by going to opposite sides.
    const auto first_node_may_move = [](Index node) { return node == 4; };
    const CurvedMesh straight = tetrahedron([](Eigen::MatrixX3d&) {});
    EXPECT_FALSE(impossibility_of(straight, first_node_may_move));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.45, 0.45), anywhere(-2.0, 3.0);
    int proved = 0, invalid = 0, by_program = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const CurvedMesh mesh = tetrahedron([&](Eigen::MatrixX3d& x) {
            for (Eigen::Index i = 5; i < x.rows(); ++i)
                for (int d = 0; d < 3; ++d) x(i, d) += shift(random);
        });
        const OrientationSigns sign = assess_quality(straight).orientation_sign;
        QualityOptions options;
        options.orientation_sign = sign;
        const QualityReport report = assess_quality(mesh, options);
        if (report.summary.invalid == 0) continue;
        ++invalid;
        const auto impossibility = impossibility_of(mesh, first_node_may_move);
        if (!impossibility) continue;
        ++proved;
        by_program += impossibility->reason.find("wherever node") != std::string::npos;
        const double largest = std::max(std::abs(report.elements[0].max_upper), std::abs(report.elements[0].min_lower));
        for (int place = 0; place < 50; ++place) {
            Coordinates x = mesh.coordinates();
            for (int d = 0; d < 3; ++d) x(4, d) = anywhere(random);
            const ElementQuality quality = assess_quality(mesh.with_coordinates(x), options).elements[0];
            EXPECT_NE(quality.validity, Validity::valid);
            EXPECT_LE(quality.min_lower, std::max(0.0, impossibility->bound * largest) + 1e-9);
        }
    }
    EXPECT_GT(proved, invalid / 2);
    EXPECT_GT(by_program, 5);
}

TEST(Unmendable, SaysNothingOfElementsThatCanBeMended) {
    // Tangled by moving one node only: moving it back is a proof that it can be mended.
    std::mt19937 random(4);
    std::uniform_real_distribution<double> shift(-0.8, 0.8);
    int tangled = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const CurvedMesh mesh = tetrahedron([&](Eigen::MatrixX3d& x) {
            for (int d = 0; d < 3; ++d) x(4, d) += shift(random);
        });
        QualityOptions options;
        options.orientation_sign = assess_quality(tetrahedron([](Eigen::MatrixX3d&) {})).orientation_sign;
        if (assess_quality(mesh, options).summary.invalid == 0) continue;
        ++tangled;
        EXPECT_FALSE(impossibility_of(mesh, [](Index node) { return node == 4; }).has_value());
    }
    EXPECT_GT(tangled, 30);
}

}  // namespace
}  // namespace curvewright
