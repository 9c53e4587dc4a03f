#include <sstream>

#include <nlohmann/json.hpp>

#include "core/io/mesh_io.h"
#include "core/quality/quality.h"
#include "core/untangle/guaranteed.h"
#include "tests/regression/command_line.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace testing;
using Json = nlohmann::json;

/// A file without the line that says which command made it.
std::string without_command(std::string text) {
    const std::size_t begin = text.find("\nCommand: ");
    EXPECT_NE(begin, std::string::npos);
    return text.erase(begin, text.find('\n', begin + 1) - begin);
}

void expect_same_boundary(const std::string& before_file, const std::string& after_file) {
    const CurvedMesh before = read_mesh(before_file).mesh, after = read_mesh(after_file).mesh;
    for (Index node : before.topology().boundary_nodes())
        EXPECT_EQ(before.coordinates().row(node), after.coordinates().row(node)) << node;
}

TEST_F(CommandLine, UntangleIsGuaranteedUnlessToldOtherwise) {
    make_tangled();
    const std::string out = folder / "valid.msh", trace = folder / "trace.jsonl";
    ProcessResult result = cli({"untangle", tangled, "-o", out, "--json", "--trace", trace});
    ASSERT_EQ(result.status, 0) << result.errors;
    Json json = Json::parse(result.output);
    EXPECT_EQ(json["method"], "guaranteed");
    EXPECT_GE(json["rounds"].get<int>(), 0);
    EXPECT_EQ(json["stopped"], "converged");
    EXPECT_TRUE(json["unmended"].is_array() && json["unmended"].empty());
    EXPECT_FALSE(json.contains("beta") || json.contains("passes"));
    EXPECT_EQ(json["before"]["scaled_jacobian"]["invalid"], 2);
    EXPECT_LT(json["before"]["shape"]["min"].get<double>(), 0.0);
    EXPECT_EQ(json["scaled_jacobian"]["valid"], 30);
    EXPECT_GT(json["scaled_jacobian"]["min"].get<double>(), 0.9);
    EXPECT_GT(json["shape"]["min"].get<double>(), 0.5);
    EXPECT_GT(json["shape"]["mean"].get<double>(), json["shape"]["min"].get<double>());
    for (const char* phase : {"read", "certify", "untangle", "improve", "write", "total"})
        EXPECT_GE(json["timings"][phase].get<double>(), 0.0) << phase;
    expect_same_boundary(tangled, out);
    EXPECT_EQ(read_mesh(out).mesh.coordinates(), untangle_guaranteed(read_mesh(tangled).mesh).coordinates);
    std::istringstream lines(read(trace));
    int events = 0;
    for (std::string line; std::getline(lines, line); ++events) EXPECT_TRUE(Json::accept(line)) << line;
    EXPECT_GT(events, 2);

    const std::string named = folder / "named.msh";
    result = cli({"untangle", tangled, "-o", named, "--method", "guaranteed"});
    ASSERT_EQ(result.status, 0) << result.errors;
    // But for the line that says what was asked for.
    EXPECT_EQ(without_command(read(named)), without_command(read(out)));
    EXPECT_NE(result.output.find("guaranteed method: "), std::string::npos) << result.output;
}

TEST_F(CommandLine, UntangleStopsWhereItIsTold) {
    make_tangled();
    const std::string out = folder / "valid.msh";
    const auto least = [&](const std::vector<std::string>& options, int status = 0) {
        std::vector<std::string> arguments{"untangle", tangled, "-o", out, "--json"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, status) << result.errors;
        expect_same_boundary(tangled, out);
        return Json::parse(result.output)["scaled_jacobian"]["min"].get<double>();
    };
    const double valid_only = least({"--valid-only"});
    EXPECT_GT(valid_only, 0.0);
    EXPECT_LT(valid_only, 0.9);
    GuaranteedOptions options;
    options.improves = false;
    EXPECT_EQ(read_mesh(out).mesh.coordinates(), untangle_guaranteed(read_mesh(tangled).mesh, options).coordinates);
    // Nothing is below a target that is reached already.
    EXPECT_EQ(least({"--target", "1e-6"}), valid_only);
    // One that cannot be reached is less than was asked for.
    EXPECT_GT(least({"--target", "1"}, 4), valid_only);

    for (const char* target : {"0", "-0.5", "1.1", "nan", "inf", "1e400", "much", ""}) {
        const ProcessResult result = cli({"untangle", tangled, "-o", folder / "none.msh", "--target", target});
        EXPECT_EQ(result.status, 2) << target;
        EXPECT_NE(result.errors.find("--target"), std::string::npos) << result.errors;
    }
    EXPECT_FALSE(exists(folder / "none.msh"));
}

TEST_F(CommandLine, UntangleLetsNamedPartsOfTheBoundarySlide) {
    make_tangled();
    const std::string out = folder / "slid.msh";
    const auto boundary_of = [&](const std::vector<std::string>& rules) {
        std::vector<std::string> arguments{"untangle", tangled, "-o", out, "--json"};
        for (const std::string& rule : rules) arguments.insert(arguments.end(), {"--boundary", rule});
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, 0) << result.errors;
        const Json json = Json::parse(result.output);
        EXPECT_EQ(json["scaled_jacobian"]["valid"], 30);
        return json.value("boundary", Json());
    };
    EXPECT_TRUE(boundary_of({"fixed"}).is_null());
    expect_same_boundary(tangled, out);
    const Json both = boundary_of({"slide"}), inner = boundary_of({"inner=slide", "outer=fixed"});
    EXPECT_GT(both["sliding_nodes"].get<int>(), inner["sliding_nodes"].get<int>());
    EXPECT_GT(inner["sliding_nodes"].get<int>(), 0);
    EXPECT_EQ(both["free_nodes"], 0);
    EXPECT_GT(both["largest_distance"].get<double>(), 0.0);
    EXPECT_LT(both["largest_distance"].get<double>(), 0.02);
    EXPECT_GT(boundary_of({"outer=free"})["free_nodes"].get<int>(), 0);

    expect_bad_input({"untangle", tangled, "-o", out, "--boundary", "loose"}, "'loose'");
    expect_bad_input({"untangle", tangled, "-o", out, "--boundary", "lid=slide"}, "'lid'");
}

TEST_F(CommandLine, UntangleRefusesOptionsOfOtherMethods) {
    make_tangled();
    const std::string out = folder / "valid.msh";
    const std::vector<std::vector<std::string>> wrong{
        {"--boundary", "slide", "--beta", "0.7"},
        {"--target", "0.5", "--method", "signed-angle"},
        {"--literal"},
        {"--method", "unsigned-angle", "--beta", "auto"},
        {"--method", "unsigned-angle", "--valid-only"},
        {"--max-passes", "3"},
        {"--beta", "much"},
        {"--beta", "nan"},
        {"--method", "best"},
    };
    for (const auto& options : wrong) {
        std::vector<std::string> arguments{"untangle", tangled, "-o", out};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, 2) << options.back();
        EXPECT_NE(result.errors.find("--"), std::string::npos);
        EXPECT_FALSE(exists(out));
    }
}

TEST_F(CommandLine, UntangleByUnsignedAngles) {
    make_tangled();
    const std::string out = folder / "valid.msh", trace = folder / "trace.jsonl";
    const ProcessResult result =
        cli({"untangle", tangled, "-o", out, "--method", "unsigned-angle", "--json", "--trace", trace});
    ASSERT_EQ(result.status, 0) << result.errors;
    const Json json = Json::parse(result.output);
    EXPECT_EQ(json["method"], "unsigned-angle");
    EXPECT_EQ(json["stopped"], "untangled");
    EXPECT_EQ(json["scaled_jacobian"]["valid"], 30);
    EXPECT_GT(json["scaled_jacobian"]["min"].get<double>(), 0.1);
    expect_same_boundary(tangled, out);
    EXPECT_NE(read(trace).find("bfgs_step"), std::string::npos);
    // To the letter, the sum of the angles is flat here.
    const ProcessResult literal =
        cli({"untangle", tangled, "-o", out, "--method", "unsigned-angle", "--literal", "--json"});
    EXPECT_EQ(literal.status, 3);
    EXPECT_EQ(Json::parse(literal.output)["scaled_jacobian"]["invalid"], 2);
}

TEST_F(CommandLine, UntangleChoosesBetaItself) {
    make_tangled();
    const std::string out = folder / "valid.msh", same = folder / "same.msh";
    const ProcessResult result = cli({"untangle", tangled, "-o", out, "--beta", "auto", "--json"});
    ASSERT_EQ(result.status, 0) << result.errors;
    const Json json = Json::parse(result.output);
    EXPECT_EQ(json["method"], "signed-angle");
    EXPECT_EQ(json["beta"], "auto");
    EXPECT_GT(json["scaled_jacobian"]["min"].get<double>(), 0.5);
    expect_same_boundary(tangled, out);
    EXPECT_EQ(cli({"untangle", tangled, "-o", same, "--method", "signed-angle"}).status, 0);
    EXPECT_EQ(without_command(read(same)), without_command(read(out)));
}

TEST_F(CommandLine, UntangleWithBetaGoesBySignedAngles) {
    make_tangled();
    const std::string out = folder / "valid.msh", named = folder / "named.msh";
    const ProcessResult result = cli({"untangle", tangled, "-o", out, "--beta", "0.7", "--json"});
    ASSERT_EQ(result.status, 0) << result.errors;
    const Json json = Json::parse(result.output);
    EXPECT_EQ(json["method"], "signed-angle");
    EXPECT_EQ(json["beta"], 0.7);
    EXPECT_GT(json["passes"].get<int>(), 0);
    EXPECT_FALSE(json.contains("unmended"));
    EXPECT_EQ(cli({"untangle", tangled, "-o", named, "--method", "signed-angle", "--beta", "0.7"}).status, 0);
    EXPECT_EQ(without_command(read(named)), without_command(read(out)));
}

TEST_F(CommandLine, UntangleKeepsTheBoundaryAndWritesATrace) {
    make_tangled();
    const std::string out = folder / "valid.msh", trace = folder / "trace.jsonl";
    const ProcessResult result =
        cli({"untangle", tangled, "-o", out, "--method", "signed-angle", "--beta", "0.7", "--json", "--trace", trace});
    ASSERT_EQ(result.status, 0) << result.errors;
    const Json json = Json::parse(result.output);
    EXPECT_EQ(json["before"]["scaled_jacobian"]["invalid"], 2);
    EXPECT_EQ(json["scaled_jacobian"]["invalid"], 0);
    EXPECT_NEAR(json["scaled_jacobian"]["min"].get<double>(), 0.456, 5e-3);
    EXPECT_GT(json["shape"]["min"].get<double>(), 0.5);
    EXPECT_TRUE(json["timings"].contains("untangle"));
    const CurvedMesh before = read_mesh(tangled).mesh, after = read_mesh(out).mesh;
    for (Index node : before.topology().boundary_nodes())
        EXPECT_EQ(before.coordinates().row(node), after.coordinates().row(node));
    std::istringstream lines(read(trace));
    int events = 0;
    for (std::string line; std::getline(lines, line); ++events) EXPECT_TRUE(Json::accept(line));
    EXPECT_GT(events, 100);
    // A beta that leaves elements tangled is done, but not valid.
    const std::string part = CURVEWRIGHT_TEST_DATA "/oracle/mech_ch4.msh";
    EXPECT_EQ(cli({"untangle", part, "-o", out, "--beta", "1e-6", "--max-passes", "1"}).status, 3);
}

TEST_F(CommandLine, UntangleMendsTetrahedra) {
    const std::string mesh = folder / "cube.msh", deformation = folder / "dent.json", out = folder / "valid.msh";
    write_mesh(mesh, cube_mesh(3, 2));
    write(deformation, R"json({"operations": [{"group": "z0", "type": "expression",
        "z": "z + 0.15 * (sin(3 * pi * x) * sin(3 * pi * y))^2"}]})json");
    ASSERT_EQ(cli({"deform", mesh, "--deformation", deformation, "-o", tangled}).status, 0);
    ProcessResult result = cli({"untangle", tangled, "-o", out, "--json"});
    ASSERT_EQ(result.status, 0) << result.errors;
    Json json = Json::parse(result.output);
    EXPECT_EQ(json["mesh"]["dimension"], 3);
    EXPECT_GT(json["before"]["scaled_jacobian"]["invalid"].get<int>(), 0);
    EXPECT_EQ(json["scaled_jacobian"]["valid"], 162);
    EXPECT_TRUE(json["unmended"].empty());
    expect_same_boundary(tangled, out);

    // The sphere of the sample alone moved: cubic tetrahedra.
    ASSERT_EQ(cli({"deform", samples + "moving_sphere_small/moving_sphere_small.msh.gz", "--deformation",
                   samples + "moving_sphere_small/deformation.json", "-o", tangled})
                  .status,
              0);
    result = cli({"untangle", tangled, "-o", out, "--valid-only", "--json"});
    ASSERT_EQ(result.status, 0) << result.errors;
    json = Json::parse(result.output);
    EXPECT_GT(json["before"]["scaled_jacobian"]["invalid"].get<int>(), 100);
    EXPECT_EQ(json["scaled_jacobian"]["valid"], 2898);
    EXPECT_GT(json["rounds"].get<int>(), 0);
    expect_same_boundary(tangled, out);
}

TEST_F(CommandLine, UntangleListsWhatCannotBeMended) {
    const std::string mesh = folder / "linear.msh", deformation = folder / "ends.json", out = folder / "out.msh";
    // The bottom's ends pass the corners above them.
    write_mesh(mesh, square_mesh(4, 1));
    write(deformation, R"json({"operations": [{"group": "bottom", "type": "expression",
        "y": "y + 0.3 * (2 * x - 1)^8"}]})json");
    ASSERT_EQ(cli({"deform", mesh, "--deformation", deformation, "-o", tangled}).status, 0);
    ProcessResult result = cli({"untangle", tangled, "-o", out, "--json"});
    EXPECT_EQ(result.status, 3);
    const Json json = Json::parse(result.output);
    EXPECT_NE(json["stopped"], "converged");
    const Json& unmended = json["unmended"];
    ASSERT_GT(unmended.size(), 0u);
    EXPECT_EQ(unmended.size(), json["scaled_jacobian"]["invalid"].get<std::size_t>());
    for (const Json& element : unmended) {
        EXPECT_GE(element["element"].get<int>(), 101);
        EXPECT_FALSE(element["reason"].get<std::string>().empty());
    }
    EXPECT_TRUE(exists(out));
    expect_same_boundary(tangled, out);
    result = cli({"untangle", tangled, "-o", out});
    EXPECT_EQ(result.status, 3);
    const std::string line =
        "Element " + std::to_string(unmended[0]["element"].get<int>()) +
        (unmended[0]["proved"].get<bool>() ? " cannot be mended with the boundary as it is: " : " was not mended: ") +
        unmended[0]["reason"].get<std::string>();
    EXPECT_NE(result.errors.find(line), std::string::npos) << result.errors;
    // Whatever is hidden on standard error is among the notes.
    result = cli({"untangle", tangled, "-o", out, "--json", "--quiet"});
    EXPECT_TRUE(result.errors.empty()) << result.errors;
    EXPECT_NE(Json::parse(result.output)["notes"].dump().find(line), std::string::npos) << result.output;

    // Of two triangles, the one below is turned over; nothing can move.
    write_mesh(mesh, square_mesh(1, 1));
    write(deformation, R"json({"operations": [{"group": "bottom", "type": "expression", "y": "y + 1.2 * x"}]})json");
    // The boundary crosses itself then.
    ASSERT_EQ(cli({"deform", mesh, "--deformation", deformation, "-o", tangled}).status, 3);
    result = cli({"untangle", tangled, "-o", out, "--json"});
    EXPECT_EQ(result.status, 3);
    const Json two = Json::parse(result.output);
    ASSERT_EQ(two["unmended"].size(), 1u);
    EXPECT_EQ(two["unmended"][0]["element"], 105);  // after the four boundary lines
    const std::string why = two["unmended"][0]["reason"];
    EXPECT_NE(why.find("none of the nodes that it depends on may move"), std::string::npos) << why;
    EXPECT_TRUE(two["unmended"][0]["proved"]);
    EXPECT_LE(two["unmended"][0]["bound"].get<double>(), 0.0);
}

TEST_F(CommandLine, UntangleTellsWhichElementsItCannotTake) {
    const std::string mesh = folder / "pyramids.msh", out = folder / "out.msh";
    write_mesh(mesh, pyramid_mesh(1));
    const ProcessResult result = cli({"untangle", mesh, "-o", out, "--json", "--quiet"});
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(read_mesh(out).mesh.coordinates(), pyramid_mesh(1).coordinates());
    const std::string notes = Json::parse(result.output)["notes"].dump();
    EXPECT_NE(notes.find("6 pyramids were not assessed"), std::string::npos) << notes;
    EXPECT_NE(notes.find("No element that was assessed is tangled; nothing was changed."), std::string::npos) << notes;
}

}  // namespace
}  // namespace curvewright
