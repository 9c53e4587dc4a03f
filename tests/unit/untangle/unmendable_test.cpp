/// What is called impossible has to be: meshes with a known valid position of the nodes that may move, some of them
/// stretched layers, are tangled, and no element of them may ever be called so.

#include "core/untangle/unmendable.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/quality/quality.h"
#include "core/untangle/guaranteed.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using Random = std::mt19937;

double uniform(Random& random, double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random);
}

bool is_valid_mesh(const CurvedMesh& mesh) {
    return assess_quality(mesh).summary.valid == mesh.topology().element_count();
}

/// A valid mesh of curved simplices, squeezed in y (3D: and a little in z) and turned: layers of the given aspect.
CurvedMesh witness(bool is_3d, int order, double aspect, Random& random) {
    const CurvedMesh linear = is_3d ? testing::cube_mesh(2, 1) : testing::square_mesh(3, 1);
    for (double amplitude = 0.1;; amplitude /= 2) {
        const CurvedMesh straight = testing::with_shaken_corners(linear, amplitude, order, random);
        Coordinates x = straight.coordinates();
        // The boundary is bent, too.
        for (Index node = 0; node < straight.topology().node_count(); ++node)
            for (int d = 0; d < straight.topology().dimension(); ++d)
                x(node, d) += 0.3 * amplitude / order * uniform(random, -1.0, 1.0);
        x.col(1) /= aspect;
        if (is_3d) x.col(2) /= std::sqrt(aspect);
        const double angle = uniform(random, 0.0, 6.0);
        Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        if (is_3d) turn = turn * Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
        if (random() % 2 == 0) x = (x * turn.transpose()).eval();
        const CurvedMesh curved = straight.with_coordinates(x);
        if (is_valid_mesh(curved)) return curved;
    }
}

/// Interior nodes moved: by a share of the thickness of the layers, or by far more than that.
CurvedMesh tangled(const CurvedMesh& mesh, double amplitude, Random& random) {
    Coordinates x = mesh.coordinates();
    for (const Index node : mesh.topology().interior_nodes())
        for (int d = 0; d < mesh.topology().dimension(); ++d) x(node, d) += amplitude * uniform(random, -1.0, 1.0);
    return mesh.with_coordinates(x);
}

TEST(Unmendable, NothingThatHasAValidPositionIsCalledImpossible) {
    int looked_at = 0;
    for (unsigned seed = 0; seed < 120; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const bool is_3d = seed % 3 == 0;
        const int order = 1 + static_cast<int>(random() % (is_3d ? 3 : 4));
        const double aspect = std::pow(10.0, uniform(random, 0.0, 6.0));
        const CurvedMesh valid = witness(is_3d, order, aspect, random);
        const CurvedMesh mesh =
            tangled(valid, std::pow(10.0, uniform(random, -1.5, 0.5)) / (random() % 2 == 0 ? aspect : 1.0), random);
        const MeshTopology& topology = mesh.topology();
        // Besides the boundary, any nodes that are where the witness has them may have to stay.
        std::vector<char> may_move(static_cast<std::size_t>(topology.node_count()), 0);
        Coordinates x = mesh.coordinates();
        const double share = uniform(random, 0.2, 1.2);
        for (const Index node : topology.interior_nodes()) {
            may_move[node] = uniform(random, 0.0, 1.0) < share ? 1 : 0;
            if (!may_move[node]) x.row(node) = valid.coordinates().row(node);
        }
        const CurvedMesh start = mesh.with_coordinates(x);
        const QualityReport report = assess_quality(start);
        const NodeElements node_elements = elements_of_nodes(topology);
        for (Index element = 0; element < topology.element_count(); ++element) {
            if (report.elements[element].validity == Validity::valid) continue;
            ++looked_at;
            const auto impossible = find_impossibility(start, element, assess_quality(valid).orientation_sign,
                                                       node_elements, [&](Index node) { return may_move[node] != 0; });
            EXPECT_FALSE(impossible && impossible->is_proved)
                << "element " << element << ", aspect " << aspect << ": " << impossible->reason;
        }
    }
    EXPECT_GT(looked_at, 800);
}

/// Layers under a wall of aspect 1e4 whose curvature the nodes inside have not followed; the witness is where they
/// have.
TEST(Unmendable, StretchedLayersUnderACurvedWallAreNotCalledImpossible) {
    for (const bool is_simplicial : {true, false}) {
        const CurvedMesh flat = is_simplicial ? testing::square_mesh(6, 3) : testing::quad_mesh(6, 3);
        constexpr double thickness = 1e-4;
        Coordinates straight = flat.coordinates(), followed = straight;
        for (Index node = 0; node < flat.topology().node_count(); ++node) {
            straight(node, 1) *= thickness;
            followed(node, 1) = straight(node, 1) + 0.05 * std::sin(3.0 * straight(node, 0));
        }
        const CurvedMesh witness = flat.with_coordinates(followed);
        ASSERT_TRUE(is_valid_mesh(witness));
        Coordinates x = straight;
        for (const Index node : flat.topology().boundary_nodes()) x.row(node) = followed.row(node);
        const CurvedMesh mesh = flat.with_coordinates(x);
        ASSERT_GT(assess_quality(mesh).summary.invalid, 10);
        GuaranteedOptions options;
        options.improves = false;
        options.max_rounds = 5;  // whether it is mended does not matter here
        for (const UnmendedElement& element : untangle_guaranteed(mesh, options).unmended)
            EXPECT_FALSE(element.is_proved) << element.reason;
    }
}

TEST(Unmendable, ProofsThatNeedANodeFarAwayAreNoneIfTheBoundaryMayMove) {
    CurvedMesh mesh = testing::square_mesh(1, 1);
    Coordinates x = mesh.coordinates();
    x.row(0) << 1.2, 1.2, 0.0;  // a corner beyond the one opposite
    mesh = mesh.with_coordinates(x);
    const QualityReport report = assess_quality(testing::square_mesh(1, 1));
    int impossible = 0;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        const auto found = find_impossibility(mesh, element, report.orientation_sign,
                                              elements_of_nodes(mesh.topology()), [](Index) { return false; });
        if (!found) continue;
        ++impossible;
        EXPECT_TRUE(found->is_proved);
        EXPECT_LE(found->bound, 0.0);
        // A corner of the boundary that may move can go where all is well.
        const auto free = find_impossibility(mesh, element, report.orientation_sign, elements_of_nodes(mesh.topology()),
                                             [](Index node) { return node == 0; });
        EXPECT_FALSE(free && free->is_proved);
    }
    EXPECT_GT(impossible, 0);
}

}  // namespace
}  // namespace curvewright
