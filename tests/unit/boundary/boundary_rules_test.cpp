#include "core/boundary/boundary_rules.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

TEST(BoundaryRules, ReadsModesAndGroups) {
    BoundaryRules rules;
    EXPECT_TRUE(rules.is_all_fixed());
    rules.add("inlet=fixed");
    EXPECT_TRUE(rules.is_all_fixed());
    rules.add("slide");
    rules.add("a=b=free");  // a group's name may contain the sign
    EXPECT_EQ(rules.otherwise, BoundaryMode::slide);
    ASSERT_EQ(rules.groups.size(), 2u);
    EXPECT_EQ(rules.groups[1].group, "a=b");
    EXPECT_EQ(rules.groups[1].mode, BoundaryMode::free);
    EXPECT_FALSE(rules.is_all_fixed());
    for (const char* wrong : {"", "slid", "wall=", "=slide", "wall=loose"})
        EXPECT_THROW(rules.add(wrong), InvalidInput) << wrong;
}

TEST(BoundaryRules, TheStricterModeWinsWhereGroupsMeet) {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    BoundaryRules rules;
    rules.add("bottom=slide");
    rules.add("right=free");
    const BoundaryModes modes = resolve(rules, mesh.topology());
    for (Index node = 0; node < mesh.topology().node_count(); ++node) {
        const double x = mesh.coordinates()(node, 0), y = mesh.coordinates()(node, 1);
        BoundaryMode expected = BoundaryMode::free;
        if (y == 0.0) expected = BoundaryMode::slide;
        if (x == 0.0 || y == 1.0) expected = BoundaryMode::fixed;
        EXPECT_EQ(modes.nodes[node], expected) << x << ", " << y;
    }
}

TEST(BoundaryRules, AGroupOfElementsNamesTheirFacets) {
    const CurvedMesh mesh = testing::square_mesh(2, 1);
    BoundaryRules rules;
    rules.add("domain=slide");
    const BoundaryModes modes = resolve(rules, mesh.topology());
    for (const Index node : mesh.topology().boundary_nodes()) EXPECT_EQ(modes.nodes[node], BoundaryMode::slide);
}

TEST(BoundaryRules, AnUnknownGroupIsNamedTogetherWithTheKnownOnes) {
    BoundaryRules rules;
    rules.add("roof=slide");
    try {
        resolve(rules, testing::square_mesh(1, 1).topology());
        FAIL() << "no error";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("'roof'"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("bottom"), std::string::npos) << error.what();
    }
    rules = {};
    rules.feature_angle = 180.0;
    EXPECT_THROW(resolve(rules, testing::square_mesh(1, 1).topology()), InvalidInput);
}

}  // namespace
}  // namespace curvewright
