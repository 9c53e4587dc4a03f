// Elements that are numbered against their neighbours, and pyramids, on the way through the commands.

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/io/mesh_io.h"
#include "core/mesh/renumbering.h"
#include "tests/regression/command_line.h"
#include "tests/support/mesh_factory.h"
#include "tests/support/pyramid_layer.h"

namespace curvewright {
namespace {

using namespace testing;
using Json = nlohmann::json;

Json parse(const ProcessResult& result) {
    EXPECT_TRUE(Json::accept(result.output)) << result.output << result.errors;
    return Json::parse(result.output, nullptr, false);
}

bool has_note(const Json& json, const std::string& fragment) {
    for (const Json& note : json["notes"])
        if (note.get<std::string>().find(fragment) != std::string::npos) return true;
    return false;
}

class WindingOnTheCommandLine : public CommandLine {
  protected:
    /// Every fourth element is numbered the other way round.
    static CurvedMesh turned(const CurvedMesh& mesh) {
        return renumbered(mesh, [](Index element) { return element % 4 == 1; });
    }
    static std::vector<CurvedMesh> meshes() { return {square_mesh(3, 2), cube_mesh(2, 2), mixed_cube_mesh(2, 1)}; }
    std::string plain = folder / "plain.msh", reversed = folder / "reversed.msh", motion = folder / "motion.json";

    void write_both(const CurvedMesh& mesh) {
        write_mesh(plain, mesh);
        write_mesh(reversed, turned(mesh));
    }
    /// The element numbers are those of the mesh, and those of the cells on its boundary.
    static void expect_same_blocks(const MeshTopology& found, const MeshTopology& expected) {
        ASSERT_EQ(found.blocks().size(), expected.blocks().size());
        for (std::size_t b = 0; b < found.blocks().size(); ++b) {
            EXPECT_EQ(found.blocks()[b].nodes, expected.blocks()[b].nodes);
            EXPECT_EQ(found.blocks()[b].tags, expected.blocks()[b].tags);
            EXPECT_EQ(found.blocks()[b].entity_tag, expected.blocks()[b].entity_tag);
        }
        EXPECT_EQ(found.data().node_tags, expected.data().node_tags);
    }
};

TEST_F(WindingOnTheCommandLine, ReversedElementsAreCountedAndNotTangled) {
    for (const CurvedMesh& mesh : meshes()) {
        write_both(mesh);
        const Index count = turned(mesh).topology().reversed_count();
        ASSERT_GT(count, 0);
        const ProcessResult looked_at = cli({"quality", reversed, "--json", "--quiet"});
        EXPECT_EQ(looked_at.status, 0) << looked_at.errors;
        const Json quality = parse(looked_at), expected = parse(cli({"quality", plain, "--json", "--quiet"}));
        EXPECT_EQ(quality["scaled_jacobian"]["reversed"], count);
        EXPECT_EQ(quality["scaled_jacobian"]["invalid"], 0);
        EXPECT_EQ(quality["scaled_jacobian"]["valid"], mesh.topology().element_count());
        EXPECT_EQ(quality["scaled_jacobian"]["min"], expected["scaled_jacobian"]["min"]);
        EXPECT_EQ(quality["orientation"], "positive");
        EXPECT_EQ(quality["globally_valid"], "yes");
        EXPECT_TRUE(has_note(quality, "--reorient")) << quality["notes"];
        EXPECT_EQ(expected["scaled_jacobian"]["reversed"], 0);
        EXPECT_FALSE(has_note(expected, "--reorient")) << expected["notes"];

        const Json info = parse(cli({"info", reversed, "--json"}));
        EXPECT_EQ(info["reversed"], count);
        EXPECT_TRUE(has_note(info, "--reorient")) << info["notes"];
    }
}

TEST_F(WindingOnTheCommandLine, ReorientRenumbersThemAndKeepsTheRest) {
    for (const CurvedMesh& mesh : meshes()) {
        write_both(mesh);
        const Index count = turned(mesh).topology().reversed_count();
        for (const std::string suffix : {".msh", ".vtu", ".vtk"}) {
            const std::string out = folder / ("out" + suffix);
            const ProcessResult converted = cli({"convert", reversed, out, "--reorient", "--json"});
            EXPECT_EQ(converted.status, 0) << converted.errors;
            EXPECT_TRUE(has_note(parse(converted), std::to_string(count) + " elements were renumbered."))
                << converted.output;
            expect_same_blocks(read_mesh(out).mesh.topology(), read_mesh(plain).mesh.topology());
            // Without being asked, nothing is renumbered.
            EXPECT_EQ(cli({"convert", reversed, out}).status, 0);
            expect_same_blocks(read_mesh(out).mesh.topology(), read_mesh(reversed).mesh.topology());
        }
        const Json quality = parse(cli({"quality", reversed, "--reorient", "--json"}));
        EXPECT_EQ(quality["scaled_jacobian"]["reversed"], 0);
        EXPECT_FALSE(has_note(quality, "--reorient")) << quality["notes"];
    }
}

TEST_F(WindingOnTheCommandLine, NothingIsFoldedToMendThem) {
    const std::string out = folder / "out.msh", expected = folder / "expected.msh";
    write(motion, R"({"operations": [{"group": "boundary", "type": "expression", "x": "x + 0.1*y*y"}]})");
    for (const CurvedMesh& mesh : meshes()) {
        write_both(mesh);
        for (const std::string method : {"guaranteed", "signed-angle"}) {
            if (method == "signed-angle" && mesh.topology().dimension() == 3) continue;
            const ProcessResult untangled = cli({"untangle", reversed, "-o", out, "--method", method});
            EXPECT_EQ(untangled.status, 0) << untangled.errors;
            EXPECT_EQ(read_mesh(out).mesh.coordinates(), mesh.coordinates());
        }
        EXPECT_EQ(cli({"warp", reversed, "--deformation", motion, "-o", out}).status, 0);
        EXPECT_EQ(cli({"warp", plain, "--deformation", motion, "-o", expected}).status, 0);
        EXPECT_EQ(read_mesh(out).mesh.coordinates(), read_mesh(expected).mesh.coordinates());
        EXPECT_EQ(read_mesh(out).mesh.topology().reversed_count(), turned(mesh).topology().reversed_count());
    }
}

TEST_F(WindingOnTheCommandLine, TangledElementsAreMendedAmongThem) {
    const std::string out = folder / "out.msh", expected = folder / "expected.msh";
    std::mt19937 random(2);
    for (const CurvedMesh& whole : {square_mesh(3, 2), cube_mesh(2, 2)}) {
        write_both(shaken(whole, 0.14, random));
        EXPECT_EQ(cli({"quality", reversed, "--quiet"}).status, 3);
        const ProcessResult one = cli({"untangle", reversed, "-o", out}),
                            other = cli({"untangle", plain, "-o", expected});
        EXPECT_EQ(one.status, other.status) << one.errors << other.errors;
        EXPECT_EQ(read_mesh(out).mesh.coordinates(), read_mesh(expected).mesh.coordinates());
        EXPECT_NE(read_mesh(out).mesh.coordinates(), read_mesh(reversed).mesh.coordinates());
    }
}

TEST_F(WindingOnTheCommandLine, PyramidsAmongOthersAreToldAsNotAssessed) {
    const std::string mesh = folder / "layer.msh", out = folder / "layer.vtk", table = folder / "layer.csv";
    write_mesh(mesh, pyramid_layer_mesh());
    const Json quality = parse(cli({"quality", mesh, "--json", "--csv", table}));
    EXPECT_EQ(quality["scaled_jacobian"]["valid"], 12);
    EXPECT_EQ(quality["scaled_jacobian"]["not_assessed"], 5);
    EXPECT_TRUE(has_note(quality, "5 pyramids were not assessed")) << quality["notes"];
    // What was not assessed is not known to have any quality.
    const ProcessResult least = cli({"quality", mesh, "--json", "--min", "0.01"});
    EXPECT_EQ(least.status, 3);
    EXPECT_TRUE(has_note(parse(least), "5 of 17 elements were not assessed")) << least.output;
    const std::string rows = read(table);
    EXPECT_NE(rows.find("\n113,nan,not assessed,-inf,inf,-inf,inf\n"), std::string::npos) << rows;
    // The text of a legacy file, by its cells: 8 hexahedra, 4 tetrahedra, 5 pyramids.
    ASSERT_EQ(cli({"convert", mesh, out}).status, 0);
    std::istringstream text(read(out));
    std::string word;
    while (text >> word && word != "Validity") {
    }
    ASSERT_EQ(word, "Validity");
    int components = 0, count = 0;
    text >> components >> count >> word;
    ASSERT_EQ(count, 17);
    for (int i = 0; i < 17; ++i) {
        int state = -7;
        text >> state;
        EXPECT_EQ(state, i < 12 ? 1 : 3) << i;
    }
}

}  // namespace
}  // namespace curvewright
