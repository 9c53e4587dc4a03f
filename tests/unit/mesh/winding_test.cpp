#include "core/mesh/winding.h"

#include <gtest/gtest.h>

#include "core/mesh/renumbering.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/mesh/torn_meshes.h"

namespace curvewright {
namespace {

using namespace testing;

bool is_every_third(Index element) {
    return element % 3 == 0;
}

TEST(Winding, TheMinorityOfAPartIsReversed) {
    for (const CurvedMesh& mesh :
         {square_mesh(3, 1), square_mesh(3, 3), quad_mesh(3, 2), mixed_square_mesh(2, 2), cube_mesh(2, 1),
          cube_mesh(2, 2), hex_mesh(2, 2), prism_mesh(2, 1), mixed_cube_mesh(2, 2)}) {
        EXPECT_EQ(mesh.topology().reversed_count(), 0);
        EXPECT_EQ(mesh.topology().winding().part_count, 1);
        const CurvedMesh turned = renumbered(mesh, is_every_third);
        Index count = 0;
        for (Index element = 0; element < mesh.topology().element_count(); ++element) {
            EXPECT_EQ(turned.topology().is_reversed(element), is_every_third(element)) << element;
            count += is_every_third(element) ? 1 : 0;
        }
        EXPECT_EQ(turned.topology().reversed_count(), count);
        // Where most are turned, the others are the reversed ones.
        const CurvedMesh most = renumbered(mesh, [](Index element) { return !is_every_third(element); });
        EXPECT_EQ(most.topology().reversed_count(), count);
        EXPECT_EQ(numbered_alike(turned).topology().reversed_count(), 0);
        EXPECT_EQ(numbered_alike(turned).coordinates(), mesh.coordinates());
    }
}

TEST(Winding, ATieGoesToThePartOfTheFirstElement) {
    const CurvedMesh two = square_mesh(1, 1);
    for (const Index turned : {0, 1}) {
        const CurvedMesh mesh = renumbered(two, [turned](Index element) { return element == turned; });
        EXPECT_FALSE(mesh.topology().is_reversed(0));
        EXPECT_TRUE(mesh.topology().is_reversed(1));
    }
}

TEST(Winding, EveryPartHasAMajorityOfItsOwn) {
    // Two strips of two quadrilaterals that do not meet, the second numbered the other way round as a whole.
    const ElementType quad{Shape::quadrilateral, 1};
    const CurvedMesh mesh =
        mesh_of_cells({{0, 0, 0},
                       {1, 0, 0},
                       {2, 0, 0},
                       {0, 1, 0},
                       {1, 1, 0},
                       {2, 1, 0},
                       {5, 0, 0},
                       {6, 0, 0},
                       {7, 0, 0},
                       {5, 1, 0},
                       {6, 1, 0},
                       {7, 1, 0}},
                      {{quad, {0, 1, 4, 3}}, {quad, {1, 2, 5, 4}}, {quad, {9, 10, 7, 6}}, {quad, {10, 11, 8, 7}}});
    EXPECT_EQ(mesh.topology().winding().part_count, 2);
    EXPECT_EQ(mesh.topology().reversed_count(), 0);
}

TEST(Winding, AMoebiusStripIsOneSidedAndNothingInItIsReversed) {
    // Nodes 0 .. 4 on one edge, 5 .. 9 on the other; the last quadrilateral joins them crosswise.
    std::vector<std::array<double, 3>> points;
    for (int i = 0; i < 10; ++i) points.push_back({double(i % 5), double(i / 5), 0.1 * i});
    std::vector<Cell> cells;
    const ElementType quad{Shape::quadrilateral, 1};
    for (Index i = 0; i < 4; ++i) cells.push_back({quad, {i, i + 1, i + 6, i + 5}});
    cells.push_back({quad, {4, 5, 0, 9}});
    const CurvedMesh mesh = mesh_of_cells(points, cells);
    EXPECT_EQ(mesh.topology().winding().one_sided_count, 1);
    EXPECT_EQ(mesh.topology().reversed_count(), 0);
}

}  // namespace
}  // namespace curvewright
