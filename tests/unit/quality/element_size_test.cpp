#include "core/quality/element_size.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace testing;

double total(const CurvedMesh& mesh) {
    const std::vector<double> sizes = element_sizes(mesh);
    EXPECT_EQ(sizes.size(), static_cast<std::size_t>(mesh.topology().element_count()));
    return std::accumulate(sizes.begin(), sizes.end(), 0.0);
}

TEST(ElementSize, PartsOfAUnitAreEqualAndSumUp) {
    for (const CurvedMesh& mesh :
         {square_mesh(3, 4), quad_mesh(3, 3), cube_mesh(2, 3), hex_mesh(2, 2), prism_mesh(2, 3)}) {
        EXPECT_NEAR(total(mesh), 1.0, 1e-12);
        const double part = 1.0 / static_cast<double>(mesh.topology().element_count());
        for (const double size : element_sizes(mesh)) EXPECT_NEAR(size, part, 1e-13);
    }
}

// Moving nodes inside a domain with fixed boundary shares its area otherwise among valid elements: the sum stays. What
// bends the boundary by a polynomial adds that polynomial's integral.
TEST(ElementSize, CurvedElementsAreMeasuredExactly) {
    std::mt19937 random(3);
    EXPECT_NEAR(total(shaken(square_mesh(3, 4), 0.005, random)), 1.0, 1e-13);
    EXPECT_NEAR(total(shaken(cube_mesh(2, 3), 0.01, random)), 1.0, 1e-13);
    EXPECT_NEAR(total(shaken(hex_mesh(2, 3), 0.01, random)), 1.0, 1e-13);
    const CurvedMesh flat = quad_mesh(2, 3);
    Coordinates x = flat.coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 1) *= 1.0 + std::pow(x(i, 0), 3);
    EXPECT_NEAR(total(flat.with_coordinates(x)), 1.25, 1e-13);
}

TEST(ElementSize, NumberingTheOtherWayRoundChangesNothing) {
    Coordinates x = square_mesh(2, 3).coordinates();
    x.col(0) *= -1.0;
    EXPECT_NEAR(total(square_mesh(2, 3).with_coordinates(x)), 1.0, 1e-12);
}

TEST(ElementSize, FoldedPartsCountTwice) {
    std::mt19937 random(4);
    EXPECT_GT(total(shaken(square_mesh(2, 3), 0.3, random)), 1.05);
}

TEST(ElementSize, SurfacesAndPyramids) {
    // A square tilted into space: flat elements need not lie in a plane of constant z.
    Coordinates x = quad_mesh(2, 2).coordinates();
    x.col(2) = x.col(0);
    EXPECT_NEAR(total(quad_mesh(2, 2).with_coordinates(x)), std::numbers::sqrt2, 1e-12);
    for (const double size : element_sizes(pyramid_mesh(1))) EXPECT_TRUE(std::isnan(size));
    std::stop_source stopped;
    stopped.request_stop();
    EXPECT_THROW(element_sizes(square_mesh(2, 2), {stopped.get_token(), {}}), Cancelled);
}

}  // namespace
}  // namespace curvewright
