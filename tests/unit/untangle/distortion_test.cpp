#include "core/untangle/distortion.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

FreePatch whole(const CurvedMesh& mesh) {
    FreePatch patch;
    patch.elements.resize(static_cast<std::size_t>(mesh.topology().element_count()));
    std::iota(patch.elements.begin(), patch.elements.end(), 0);
    patch.nodes = mesh.topology().interior_nodes();
    return patch;
}

std::vector<CurvedMesh> meshes(std::mt19937& random, double amplitude) {
    std::vector<CurvedMesh> result;
    for (const int order : {1, 2, 3, 4})
        result.push_back(testing::shaken(testing::square_mesh(3, order), amplitude, random));
    for (const int order : {2, 3}) result.push_back(testing::shaken(testing::cube_mesh(2, order), amplitude, random));
    // General ideals, whose Jacobian varies.
    const double corners = 0.03;
    for (const int order : {1, 2, 3})
        for (const CurvedMesh& linear : {testing::quad_mesh(3, 1), testing::mixed_square_mesh(2, 1)})
            result.push_back(
                testing::shaken(testing::with_shaken_corners(linear, corners, order, random), amplitude, random));
    for (const CurvedMesh& linear :
         {testing::hex_mesh(2, 1), testing::prism_mesh(2, 1), testing::mixed_cube_mesh(2, 1)})
        result.push_back(testing::shaken(testing::with_shaken_corners(linear, corners, 2, random), amplitude, random));
    return result;
}

TEST(PatchObjective, GradientIsThatOfTheValue) {
    std::mt19937 random(1);
    for (const double amplitude : {0.01, 0.2})  // the larger one tangles
        for (const CurvedMesh& mesh : meshes(random, amplitude)) {
            PatchObjective objective(mesh.topology(), mesh.coordinates(), mesh.coordinates(), 1.0, whole(mesh));
            for (const double sharpness : {0.0, 20.0}) {
                if (sharpness > 0.0 && amplitude > 0.1) continue;  // the evenness is for valid elements
                DistortionOptions options;
                options.eps = 0.3;
                options.sharpness = sharpness;
                options.energy_weight = 0.7;
                options.mean_weight = 0.2;
                Eigen::VectorXd x = objective.variables(mesh.coordinates()), gradient, unused;
                objective.evaluate(x, options, gradient);
                ASSERT_GT(gradient.norm(), 0.0);
                Eigen::VectorXd direction = Eigen::VectorXd::Random(x.size()).normalized();
                const double h = 1e-6;
                const double up = objective.evaluate(x + h * direction, options, unused);
                const double down = objective.evaluate(x - h * direction, options, unused);
                EXPECT_NEAR((up - down) / (2 * h), gradient.dot(direction), 2e-6 * (1.0 + gradient.norm()));
            }
        }
}

TEST(PatchObjective, IdealElementsHaveNoEnergyAndFullEvenness) {
    for (const CurvedMesh& mesh :
         {testing::square_mesh(3, 3), testing::cube_mesh(2, 2), testing::quad_mesh(3, 3), testing::hex_mesh(2, 2),
          testing::prism_mesh(2, 2), testing::mixed_square_mesh(2, 2), testing::mixed_cube_mesh(2, 1)}) {
        PatchObjective objective(mesh.topology(), mesh.coordinates(), mesh.coordinates(), 1.0, whole(mesh));
        Eigen::VectorXd gradient;
        DistortionOptions options;
        options.eps = 1e-9;
        EXPECT_NEAR(objective.evaluate(objective.variables(mesh.coordinates()), options, gradient), 0.0, 1e-10);
        EXPECT_LT(gradient.norm(), 1e-10);
        EXPECT_NEAR(objective.least_determinant(), 1.0, 1e-12);
        options.sharpness = 100.0;
        options.energy_weight = 0.0;
        const double count = static_cast<double>(mesh.topology().element_count());
        EXPECT_NEAR(objective.evaluate(objective.variables(mesh.coordinates()), options, gradient),
                    std::log(count) / 100.0 - 1.0, 1e-10);
    }
}

TEST(PatchObjective, MultilinearIdealsHaveNoEnergyButTheEvennessOfTheirJacobian) {
    // Two trapezoids of widths 2 and 1 (and 1 and 2), so that J is between 1 and 2.
    Coordinates x = testing::quad_mesh(2, 2).coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 0) = (x(i, 0) - 0.5) * (2.0 - x(i, 1));
    const CurvedMesh mesh = testing::quad_mesh(2, 2).with_coordinates(x);
    PatchObjective objective(mesh.topology(), x, x, 1.0, whole(mesh));
    Eigen::VectorXd gradient;
    DistortionOptions options;
    options.eps = 1e-9;
    EXPECT_NEAR(objective.evaluate(objective.variables(x), options, gradient), 0.0, 1e-10);
    EXPECT_NEAR(objective.least_determinant(), 1.0, 1e-12);
    options.energy_weight = 0.0;
    options.sharpness = 2000.0;
    // The lower row's widths go from 2 to 1.5, the upper row's from 1.5 to 1: its two elements are the least even.
    EXPECT_NEAR(objective.evaluate(objective.variables(x), options, gradient), -1.0 / 1.5, 5e-3);
}

/// Where the straight-sided element is folded, a regular one takes its place: energies are finite and least at squares.
TEST(PatchObjective, FoldedIdealsAreReplacedByRegularElements) {
    for (const CurvedMesh& mesh : {testing::quad_mesh(2, 2), testing::hex_mesh(2, 1), testing::prism_mesh(2, 1)}) {
        Coordinates folded = mesh.coordinates();
        for (const Index node : mesh.topology().interior_nodes())
            for (int d = 0; d < mesh.topology().dimension(); ++d) folded(node, d) += 0.6;
        for (const double sign : {1.0, -1.0}) {
            const CurvedMesh turned = sign > 0.0 ? mesh : flip_orientation(mesh);
            PatchObjective objective(turned.topology(), turned.coordinates(), folded, sign, whole(turned));
            Eigen::VectorXd gradient;
            EXPECT_TRUE(std::isfinite(objective.evaluate(objective.variables(turned.coordinates()), {}, gradient)));
            EXPECT_GT(objective.least_determinant(), 0.0);
            objective.add_sample(0, {0.3, 0.2, 0.1});
            objective.evaluate(objective.variables(turned.coordinates()), {}, gradient);
            EXPECT_GT(objective.least_determinant(), 0.0);
        }
    }
}

TEST(PatchObjective, DoesNotDependOnTheUnitOfLengthOrTheOrigin) {
    std::mt19937 random(2);
    const CurvedMesh mesh = testing::shaken(testing::square_mesh(3, 3), 0.1, random);
    Eigen::VectorXd gradient, moved_gradient;
    PatchObjective objective(mesh.topology(), mesh.coordinates(), mesh.coordinates(), 1.0, whole(mesh));
    const double value = objective.evaluate(objective.variables(mesh.coordinates()), {}, gradient);
    for (const double unit : {1e-6, 1e6}) {
        Coordinates x = unit * mesh.coordinates();
        x.leftCols(2).array() += 100.0 * unit;
        PatchObjective moved(mesh.topology(), x, x, 1.0, whole(mesh));
        EXPECT_NEAR(moved.evaluate(moved.variables(x), {}, moved_gradient), value, 1e-8 * value);
        EXPECT_LT((gradient - moved_gradient).norm(), 1e-7 * gradient.norm());
    }
}

TEST(PatchObjective, SameBitsForEveryThreadCount) {
    std::mt19937 random(3);
    const CurvedMesh mesh = testing::shaken(testing::square_mesh(12, 3), 0.01, random);
    DistortionOptions options;
    options.sharpness = 40.0;
    Eigen::VectorXd one, four;
    PatchObjective objective(mesh.topology(), mesh.coordinates(), mesh.coordinates(), 1.0, whole(mesh));
    const Eigen::VectorXd x = objective.variables(mesh.coordinates());
    set_thread_count(1);
    const double value = objective.evaluate(x, options, one);
    set_thread_count(4);
    EXPECT_EQ(objective.evaluate(x, options, four), value);
    set_thread_count(0);
    EXPECT_EQ(one, four);
}

TEST(PatchObjective, AnAddedSampleCounts) {
    std::mt19937 random(4);
    for (const CurvedMesh& linear : {testing::square_mesh(2, 1), testing::quad_mesh(2, 1), testing::hex_mesh(2, 1)}) {
        const CurvedMesh straight = testing::with_shaken_corners(linear, 0.02, 2, random);
        const CurvedMesh mesh = testing::shaken(straight, 0.02, random);
        PatchObjective objective(mesh.topology(), mesh.coordinates(), straight.coordinates(), 1.0, whole(mesh));
        const Eigen::VectorXd x = objective.variables(mesh.coordinates());
        Eigen::VectorXd gradient;
        const double before = objective.evaluate(x, {}, gradient);
        objective.add_sample(0, {0.2, 0.3, 0.0});
        EXPECT_NE(objective.evaluate(x, {}, gradient), before);
        // At the straight-sided elements themselves the new sample has no energy either.
        DistortionOptions options;
        options.eps = 1e-9;
        EXPECT_NEAR(objective.evaluate(objective.variables(straight.coordinates()), options, gradient), 0.0, 1e-8);
    }
}

}  // namespace
}  // namespace curvewright
