// A mesh is worked on as if its reversed elements were renumbered: not a bit of the result depends on the numbering.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/basis/lagrange.h"
#include "core/edit/drag.h"
#include "core/mesh/renumbering.h"
#include "core/quality/element_size.h"
#include "core/quality/quality.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/improve.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/unsigned_angles.h"
#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace testing;

CurvedMesh turned(const CurvedMesh& mesh) {
    return renumbered(mesh, [](Index element) { return element % 4 == 1; });
}

TEST(ReversedElements, AreJudgedAsIfTheyWereRenumbered) {
    std::mt19937 random(3);
    for (const CurvedMesh& plain :
         {square_mesh(3, 3), quad_mesh(3, 2), cube_mesh(2, 2), hex_mesh(2, 2), prism_mesh(2, 2)}) {
        const CurvedMesh mesh = shaken(plain, 0.05, random);
        const QualityReport expected = assess_quality(mesh), found = assess_quality(turned(mesh));
        ASSERT_GT(found.summary.reversed, 0);
        EXPECT_EQ(expected.summary.reversed, 0);
        EXPECT_EQ(found.orientation, Orientation::positive);
        for (std::size_t i = 0; i < expected.elements.size(); ++i) {
            EXPECT_EQ(found.elements[i].scaled_jacobian, expected.elements[i].scaled_jacobian);
            EXPECT_EQ(found.elements[i].min_lower, expected.elements[i].min_lower);
            EXPECT_EQ(found.elements[i].min_upper, expected.elements[i].min_upper);
            EXPECT_EQ(found.elements[i].max_lower, expected.elements[i].max_lower);
            EXPECT_EQ(found.elements[i].max_upper, expected.elements[i].max_upper);
            EXPECT_EQ(found.elements[i].validity, expected.elements[i].validity);
            EXPECT_EQ(found.elements[i].is_reversed, i % 4 == 1);
        }
        // Renumbered for good, nothing is left to tell.
        const Reorientation reoriented = reorient(turned(mesh));
        EXPECT_EQ(reoriented.renumbered, found.summary.reversed);
        EXPECT_EQ(assess_quality(reoriented.mesh).summary.reversed, 0);
        EXPECT_EQ(reoriented.mesh.coordinates(), mesh.coordinates());
        EXPECT_EQ(reoriented.mesh.topology().data().node_tags, mesh.topology().data().node_tags);
    }
}

TEST(ReversedElements, DoNotChangeABitOfAnUntangling) {
    std::mt19937 random(5);
    for (const CurvedMesh& plain : {square_mesh(4, 2), square_mesh(4, 3)}) {
        const CurvedMesh mesh = shaken(plain, 0.14, random), other = turned(mesh);
        ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
        EXPECT_EQ(untangle_guaranteed(other).coordinates, untangle_guaranteed(mesh).coordinates);
        EXPECT_EQ(untangle_signed_angles(other).coordinates, untangle_signed_angles(mesh).coordinates);
        EXPECT_EQ(untangle_unsigned_angles(other).coordinates, untangle_unsigned_angles(mesh).coordinates);
    }
    for (const CurvedMesh& plain : {cube_mesh(2, 2), hex_mesh(2, 2), prism_mesh(2, 2)}) {
        const CurvedMesh mesh = shaken(plain, 0.14, random);
        EXPECT_EQ(untangle_guaranteed(turned(mesh)).coordinates, untangle_guaranteed(mesh).coordinates);
    }
}

TEST(ReversedElements, DoNotChangeABitOfAWarpNorOfImproving) {
    std::mt19937 random(7);
    for (const CurvedMesh& plain : {square_mesh(4, 3), cube_mesh(2, 2)}) {
        const CurvedMesh mesh = shaken(plain, 0.004, random), other = turned(mesh);
        ASSERT_EQ(assess_quality(mesh).summary.invalid, 0);
        EXPECT_EQ(improve(other).coordinates, improve(mesh).coordinates);
        Coordinates target = mesh.coordinates();
        for (const Index node : mesh.topology().boundary_nodes())
            target(node, 1) += 0.1 * target(node, 0) * target(node, 0);
        for (const Weighting weighting : {Weighting::convex, Weighting::affine, Weighting::elastic}) {
            WarpOptions options;
            options.weighting = weighting;
            EXPECT_EQ(warp(other, target, options).coordinates, warp(mesh, target, options).coordinates);
        }
    }
}

TEST(ReversedElements, DoNotChangeABitOfADrag) {
    std::mt19937 random(11);
    for (const CurvedMesh& plain : {square_mesh(3, 3), quad_mesh(3, 2), cube_mesh(2, 2), mixed_cube_mesh(2, 1)}) {
        const CurvedMesh mesh = shaken(plain, 0.004, random), other = turned(mesh);
        ASSERT_GT(other.topology().reversed_count(), 0);
        DraggedSet set;
        for (const Index node : mesh.topology().boundary_nodes())
            if (mesh.coordinates()(node, 0) == 1.0) set.nodes.push_back(node);
        AffineMotion motion;
        motion.shift = {0.05, 0.02, 0.0};
        const auto dragged = [&](const CurvedMesh& start) -> Coordinates {
            Drag drag(std::make_shared<const Warper>(start), set, ResponseKind::translation, Eigen::Vector3d::Zero(),
                      start, std::make_shared<const QualityReport>(assess_quality(start)));
            return drag.move(motion);
        };
        EXPECT_EQ(dragged(other), dragged(mesh));
        EXPECT_NE(dragged(mesh), mesh.coordinates());
    }
}

/// Where a point of the reference element is in an element of the mesh.
Eigen::RowVector3d place_of(const CurvedMesh& mesh, Index element, const std::array<double, 3>& point) {
    const MeshTopology& topology = mesh.topology();
    const Eigen::RowVector3d reference(point[0], point[1], point[2]);
    const BasisTable basis = lagrange_basis(topology.element_type(element), reference);
    Eigen::RowVector3d place = Eigen::RowVector3d::Zero();
    const auto nodes = topology.element_nodes(element);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        place += basis.values(0, static_cast<Eigen::Index>(i)) * mesh.coordinates().row(nodes[i]);
    return place;
}

TEST(ReversedElements, AreToldInTheNumberingThatTheyHave) {
    struct Recorder : UntangleObserver {
        void on_event(const UntangleEvent& event) override {
            if (const auto* started = std::get_if<untangle_event::Started>(&event)) mesh = started->mesh;
            if (const auto* certified = std::get_if<untangle_event::PatchCertified>(&event))
                worst.push_back({certified->worst_element, certified->worst_point});
            ++events;
        }
        const CurvedMesh* mesh = nullptr;
        std::vector<std::pair<Index, std::array<double, 3>>> worst;
        int events = 0;
    };
    std::mt19937 random(13);
    std::array<Index, 4> told{};  ///< per dimension: points of reversed elements that exchanging the axes moves
    for (const CurvedMesh& plain : {square_mesh(4, 3), cube_mesh(2, 2), hex_mesh(2, 2), prism_mesh(2, 2)}) {
        const CurvedMesh mesh = shaken(plain, 0.14, random), other = turned(mesh);
        Recorder expected, found;
        untangle_guaranteed(mesh, {}, &expected);
        untangle_guaranteed(other, {}, &found);
        EXPECT_EQ(found.mesh, &other);
        EXPECT_EQ(found.events, expected.events);
        ASSERT_EQ(found.worst.size(), expected.worst.size());
        ASSERT_FALSE(found.worst.empty());
        for (std::size_t i = 0; i < found.worst.size(); ++i) {
            const auto& [element, point] = found.worst[i];
            EXPECT_EQ(element, expected.worst[i].first);
            // The same point in space, whatever the corners are called.
            const Eigen::RowVector3d where = place_of(mesh, element, expected.worst[i].second);
            EXPECT_LT((place_of(other, element, point) - where).norm(), 1e-12);
            if (other.topology().is_reversed(element) && point[0] != point[1]) ++told[mesh.topology().dimension()];
        }
    }
    EXPECT_GT(told[2], 0);
    EXPECT_GT(told[3], 0);
}

TEST(ReversedElements, AreRenumberedWithTheirNegativePartsWhileTheRestStays) {
    for (const CurvedMesh& plain : {square_mesh(3, 2), quad_mesh(3, 3), cube_mesh(2, 2), hex_mesh(2, 2)}) {
        const MeshTopology& as_it_was = plain.topology();
        for (const bool is_negative : {false, true}) {
            const CurvedMesh mesh = is_negative ? flip_orientation(turned(plain)) : turned(plain);
            const Reorientation reoriented = reorient(mesh);
            EXPECT_EQ(reoriented.reversed, mesh.topology().reversed_count());
            EXPECT_EQ(reoriented.renumbered,
                      is_negative ? as_it_was.element_count() - reoriented.reversed : reoriented.reversed);
            const MeshTopology& topology = reoriented.mesh.topology();
            ASSERT_EQ(topology.blocks().size(), as_it_was.blocks().size());
            // Renumbered to what it was at first, boundary cells, their tags and entities included.
            for (std::size_t b = 0; b < topology.blocks().size(); ++b) {
                EXPECT_EQ(topology.blocks()[b].nodes, as_it_was.blocks()[b].nodes);
                EXPECT_EQ(topology.blocks()[b].tags, as_it_was.blocks()[b].tags);
                EXPECT_EQ(topology.blocks()[b].entity_tag, as_it_was.blocks()[b].entity_tag);
            }
            EXPECT_EQ(topology.groups().size(), as_it_was.groups().size());
            for (const ElementQuality& quality : assess_quality(reoriented.mesh).elements)
                EXPECT_GT(quality.min_lower, 0.0);
            EXPECT_EQ(find_orientation(reoriented.mesh), Orientation::positive);
        }
    }
}

TEST(ReversedElements, AreNotFolded) {
    // Half of a rectangle numbered against the other half, as two CAD faces are: perfect, and left alone.
    const CurvedMesh mesh = renumbered(square_mesh(4, 2), [](Index element) { return element >= 16; });
    ASSERT_EQ(mesh.topology().reversed_count(), 16);
    const GuaranteedResult result = untangle_guaranteed(mesh);
    EXPECT_EQ(result.coordinates, mesh.coordinates());
    EXPECT_TRUE(result.unmended.empty());
}

TEST(ReversedElements, PartsOfEitherOrientationAreJudgedByTheirOwn) {
    // The square beside its mirror image.
    const CurvedMesh one = square_mesh(2, 2);
    MeshData data = one.topology().data();
    const auto count = static_cast<Index>(data.node_tags.size());
    for (Index node = 0; node < count; ++node) data.node_tags.push_back({10000 + node});
    const std::size_t blocks = data.blocks.size();
    for (std::size_t b = 0; b < blocks; ++b) {
        ElementBlock block = data.blocks[b];
        for (Index& node : block.nodes) node += count;
        for (ElementTag& tag : block.tags) tag.value += 10000;
        data.blocks.push_back(std::move(block));
    }
    data.node_entities.clear();
    Coordinates x(2 * count, 3);
    x << one.coordinates(), one.coordinates();
    x.bottomRows(count).col(0) *= -1.0;
    x.bottomRows(count).col(0).array() -= 1.0;
    const CurvedMesh both(std::make_shared<const MeshTopology>(std::move(data)), std::move(x));
    const QualityReport report = assess_quality(both);
    EXPECT_EQ(report.orientation, Orientation::mixed);
    EXPECT_EQ(report.summary.valid, 16);
    EXPECT_EQ(report.summary.reversed, 0);
    EXPECT_EQ(reorient(both).renumbered, 8);
    EXPECT_EQ(assess_quality(reorient(both).mesh).orientation, Orientation::positive);
}

}  // namespace
}  // namespace curvewright
