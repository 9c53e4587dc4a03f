// Valid means the mesh as a whole: what the commands say of boundaries that cross themselves.

#include <nlohmann/json.hpp>

#include "core/io/mesh_io.h"
#include "tests/regression/command_line.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace testing;
using Json = nlohmann::json;

struct Bulge {
    CurvedMesh mesh;
    const char* motion;  ///< of one side through the opposite one
};

std::vector<Bulge> bulges() {
    return {{square_mesh(4, 2),
             R"json({"operations": [{"group": "bottom", "type": "expression", "y": "1.5*sin(pi*x)"}]})json"},
            {cube_mesh(2, 2),
             R"json({"operations": [{"group": "z0", "type": "expression", "z": "1.5*sin(pi*x)*sin(pi*y)"}]})json"}};
}

TEST_F(CommandLine, AMeshIsToldToBeValidAsAWhole) {
    for (const Bulge& bulge : bulges()) {
        const std::string file = folder / "mesh.msh";
        write_mesh(file, bulge.mesh);
        const ProcessResult result = cli({"quality", file, "--json"});
        EXPECT_EQ(result.status, 0) << result.errors;
        const Json json = Json::parse(result.output);
        EXPECT_EQ(json["globally_valid"], "yes");
        EXPECT_EQ(json["crossing_facet_pairs"], 0);
        EXPECT_NE(cli({"quality", file}).output.find("globally valid: yes"), std::string::npos);
    }
}

TEST_F(CommandLine, ABoundaryThatCrossesItselfEndsWithStatus3) {
    for (const Bulge& bulge : bulges()) {
        const std::string file = folder / "mesh.msh", motion = folder / "motion.json", out = folder / "out.msh";
        write_mesh(file, bulge.mesh);
        write(motion, bulge.motion);
        for (const char* command : {"deform", "warp"}) {
            const ProcessResult result = cli({command, file, "--deformation", motion, "-o", out, "--json", "--quiet"});
            EXPECT_EQ(result.status, 3) << command << result.errors;
            const Json json = Json::parse(result.output);
            EXPECT_EQ(json["globally_valid"], "no");
            EXPECT_GT(json["crossing_facet_pairs"].get<int>(), 0) << command;
            ASSERT_FALSE(json["crossing_facets"].empty());
            EXPECT_TRUE(
                bulge.mesh.topology().find_element({json["crossing_facets"][0][0]["element"].get<std::int64_t>()}));
            EXPECT_FALSE(json["notes"].empty());
            EXPECT_TRUE(exists(out));
        }
    }
}

TEST_F(CommandLine, ATangledInteriorDoesNotChangeTheStatusOfDeform) {
    make_tangled();
    const ProcessResult result =
        cli({"deform", annulus, "--deformation", annulus_deformation, "-o", folder / "again.msh", "--json"});
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(Json::parse(result.output)["globally_valid"], "no");
}

}  // namespace
}  // namespace curvewright
