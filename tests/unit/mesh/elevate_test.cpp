#include "core/mesh/elevate.h"

#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/basis/lagrange.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::square_mesh;

TEST(Elevate, NodeCountsAndSharingForEveryOrder) {
    for (int order = 1; order <= max_order; ++order) {
        const CurvedMesh square = square_mesh(2, order);
        EXPECT_EQ(square.topology().node_count(), (2 * order + 1) * (2 * order + 1));
        EXPECT_EQ(square.topology().boundary_nodes().size(), 8u * order);
        if (order > 6) continue;
        const CurvedMesh cube = cube_mesh(1, order);
        EXPECT_EQ(cube.topology().node_count(), (order + 1) * (order + 1) * (order + 1));
        EXPECT_EQ(cube.topology().interior_nodes().size(),
                  static_cast<std::size_t>((order - 1) * (order - 1) * (order - 1)));
    }
}

TEST(Elevate, NodesLieAtTheirLatticePoints) {
    for (const CurvedMesh& mesh : {square_mesh(2, 4), cube_mesh(1, 4)})
        for (Index element = 0; element < mesh.topology().element_count(); ++element) {
            const ElementType type = mesh.topology().element_type(element);
            const Eigen::MatrixX3d x = mesh.element_coordinates(element);
            const Eigen::MatrixX3d straight =
                lagrange_basis({type.shape, 1}, reference_nodes(type)).values * x.topRows(corner_count(type.shape));
            EXPECT_LT((x - straight).cwiseAbs().maxCoeff(), 1e-14);
        }
}

TEST(Elevate, KeepsCornersTagsAndGroups) {
    const CurvedMesh low = square_mesh(3, 1), high = elevate(low, 5), back = elevate(high, 1);
    for (Index node = 0; node < low.topology().node_count(); ++node) {
        const auto found = high.topology().find_node(low.topology().node_tag(node));
        ASSERT_TRUE(found);
        EXPECT_EQ(high.coordinates().row(*found), low.coordinates().row(node));
    }
    std::set<std::int64_t> tags;
    for (Index node = 0; node < high.topology().node_count(); ++node) tags.insert(high.topology().node_tag(node).value);
    EXPECT_EQ(tags.size(), static_cast<std::size_t>(high.topology().node_count()));
    EXPECT_EQ(high.topology().find_group_nodes("top")->size(), 16u);
    ASSERT_EQ(back.topology().node_count(), low.topology().node_count());
    EXPECT_EQ(back.coordinates(), low.coordinates());
    for (std::size_t b = 0; b < low.topology().blocks().size(); ++b) {
        EXPECT_EQ(back.topology().blocks()[b].nodes, low.topology().blocks()[b].nodes);
        EXPECT_EQ(back.topology().blocks()[b].tags, low.topology().blocks()[b].tags);
    }
}

TEST(Elevate, QuadrilateralsHexahedraAndPrisms) {
    for (const Shape shape : {Shape::quadrilateral, Shape::hexahedron, Shape::prism}) {
        const CurvedMesh low = testing::single_element({shape, 1}, reference_nodes({shape, 1}));
        const CurvedMesh high = elevate(low, 3);
        const Eigen::MatrixX3d x = high.element_coordinates(0);
        EXPECT_EQ(x.rows(), node_count({shape, 3}));
        EXPECT_LT((x - reference_nodes({shape, 3})).cwiseAbs().maxCoeff(), 1e-14) << name(shape);
    }
}

TEST(Elevate, RefusesOtherOrders) {
    EXPECT_THROW(elevate(square_mesh(1, 1), 0), Unsupported);
    EXPECT_THROW(elevate(square_mesh(1, 1), 11), Unsupported);
    Eigen::MatrixX3d x(5, 3);
    x << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, .5, .5, 1;
    EXPECT_THROW(elevate(testing::single_element({Shape::pyramid, 1}, x), 2), Unsupported);
}

}  // namespace
}  // namespace curvewright
