#include <cmath>
#include <random>

#include <nlohmann/json.hpp>

#include "core/io/mesh_io.h"
#include "core/quality/quality.h"
#include "core/untangle/improve.h"
#include "tests/regression/command_line.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace testing;
using Json = nlohmann::json;

/// A valid mesh of low quality.
CurvedMesh poor(const CurvedMesh& mesh, double amplitude) {
    for (;; amplitude *= 0.8) {
        std::mt19937 random(1);
        const CurvedMesh moved = shaken(mesh, amplitude, random);
        if (assess_quality(moved).summary.valid == moved.topology().element_count()) return moved;
    }
}

class Improving : public CommandLine {
  protected:
    std::string mesh = folder / "poor.msh", out = folder / "better.msh";
    CurvedMesh input = poor(square_mesh(4, 3), 0.05);

    void SetUp() override { write_mesh(mesh, input); }
    Json run(std::vector<std::string> arguments, int status) {
        arguments.insert(arguments.begin() + 1, {mesh, "-o", out, "--json", "--quiet"});
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, status) << result.errors;
        EXPECT_TRUE(result.errors.empty()) << result.errors;
        return Json::parse(result.output);
    }
    Coordinates coordinates() const { return read_mesh(out).mesh.coordinates(); }
    static bool has_note(const Json& json, const std::string& text) {
        return json["notes"].dump().find(text) != std::string::npos;
    }
};

TEST_F(Improving, RaisesWhatIsAskedForAndSaysWhatWasReached) {
    Json json = run({"improve"}, 0);
    const double before = json["before"]["scaled_jacobian"]["min"], after = json["scaled_jacobian"]["min"];
    EXPECT_GT(after, before + 0.1);
    EXPECT_EQ(coordinates(), improve(input).coordinates);
    EXPECT_EQ(json["goal"], "jacobian");
    EXPECT_EQ(json["scaled_jacobian"]["valid"], 32);

    json = run({"improve", "--target", "1"}, 4);
    EXPECT_TRUE(has_note(json, "The target 1 was not reached")) << json["notes"];
    json = run({"improve", "--target", "0.01"}, 0);
    EXPECT_EQ(coordinates(), input.coordinates());
    EXPECT_TRUE(has_note(json, "Every element has at least the target 0.01; nothing was changed.")) << json["notes"];

    json = run({"improve", "--goal", "shape", "--target", "1"}, 4);
    EXPECT_GT(json["shape"]["min"].get<double>(), json["before"]["shape"]["min"].get<double>() + 0.1);
    EXPECT_TRUE(has_note(json, "mean ratio")) << json["notes"];
}

TEST_F(Improving, KeepsWithinItsLimits) {
    const double size = std::sqrt(2.0);
    const Json json = run({"improve", "--max-move", "0.005", "--keep-vertices"}, 0);
    const Coordinates moved = coordinates() - input.coordinates();
    EXPECT_LE(moved.rowwise().norm().maxCoeff(), 0.005 * size);
    EXPECT_GT(moved.rowwise().norm().maxCoeff(), 0.002 * size);
    EXPECT_EQ(json["largest_move"].get<double>(), moved.rowwise().norm().maxCoeff());
    for (Index element = 0; element < input.topology().element_count(); ++element)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_TRUE(moved.row(input.topology().element_nodes(element)[c]).isZero(0.0));
}

TEST_F(Improving, KeepsNodesOfFilesAndGroups) {
    const MeshTopology& topology = input.topology();
    const Index a = topology.interior_nodes()[3], b = topology.interior_nodes()[7];
    const auto tag = [&](Index node) { return std::to_string(topology.node_tag(node).value); };
    const std::string list = folder / "nodes.txt", table = folder / "nodes.csv", wrong = folder / "wrong.txt";
    write(list, tag(a) + "\n\n  " + tag(b) + "\r\n");
    write(table, "x, tag\n0.5, " + tag(a) + "\n0.25," + tag(b) + "\n");
    for (const std::string& file : {list, table}) {
        run({"improve", "--boundary", "free", "--fix-nodes", file, "--fix-nodes", "left"}, 0);
        const Coordinates x = coordinates();
        EXPECT_EQ(x.row(a), input.coordinates().row(a));
        EXPECT_EQ(x.row(b), input.coordinates().row(b));
        const std::vector<Index> left = topology.find_group_nodes("left").value();
        for (const Index node : left) EXPECT_EQ(x.row(node), input.coordinates().row(node));
        EXPECT_NE(x, input.coordinates());
    }
    expect_bad_input({"improve", mesh, "-o", out, "--quiet", "--fix-nodes", "lid"},
                     "--fix-nodes lid: there is no file of that name, and the mesh has no such group");
    for (const auto& [text, fragment] : std::vector<std::pair<std::string, std::string>>{
             {tag(a) + "\n999999\n", "wrong.txt:2: the mesh has no node 999999"},
             {"node\n1\n", "wrong.txt:1:"},
             {tag(a) + "\nx\n", "wrong.txt:2:"},
             {"\n\n", "names no node"}}) {
        write(wrong, text);
        expect_bad_input({"improve", mesh, "-o", out, "--quiet", "--fix-nodes", wrong}, fragment);
    }
}

TEST_F(Improving, RefusesWhatItCannotDo) {
    make_tangled();
    std::filesystem::remove(out);
    expect_bad_input({"improve", tangled, "-o", out, "--quiet"}, "2 tangled elements");
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{{"--goal", "solver"},
                                                                                         {"--goal", "best"},
                                                                                         {"--max-move", "0"},
                                                                                         {"--max-move", "nan"},
                                                                                         {"--max-move", "2"},
                                                                                         {"--target", "0"}}) {
        std::vector<std::string> arguments{"improve", mesh, "-o", out};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, 2) << options.back();
        EXPECT_NE(result.errors.find(options.front()), std::string::npos) << result.errors;
    }
    EXPECT_FALSE(exists(out));
}

TEST_F(Improving, AValidMeshIsNotUntangled) {
    for (const std::vector<std::string>& method :
         std::vector<std::vector<std::string>>{{},
                                               {"--boundary", "slide"},
                                               {"--method", "signed-angle"},
                                               {"--method", "signed-angle", "--beta", "0.5"},
                                               {"--method", "signed-angle", "--warp-first", "convex"},
                                               {"--method", "unsigned-angle"},
                                               {"--method", "unsigned-angle", "--literal"}}) {
        std::vector<std::string> arguments{"untangle"};
        arguments.insert(arguments.end(), method.begin(), method.end());
        const Json json = run(arguments, 0);
        EXPECT_EQ(coordinates(), input.coordinates());
        EXPECT_TRUE(has_note(json, "No element is tangled; nothing was changed. `improve` raises")) << json["notes"];
    }
    Json json = run({"untangle", "--target", "0.8"}, 4);
    EXPECT_TRUE(has_note(json, "below the target 0.8")) << json["notes"];
    EXPECT_EQ(coordinates(), input.coordinates());
    json = run({"untangle", "--target", "0.01"}, 0);
    EXPECT_TRUE(has_note(json, "all reach the target 0.01")) << json["notes"];
}

TEST_F(Improving, QualityFailsBelowTheLeastThatIsAskedFor) {
    const QualityReport report = assess_quality(input);
    const double middle = 0.5 * (report.summary.min + report.summary.max);
    const auto below = std::count_if(report.elements.begin(), report.elements.end(),
                                     [&](const auto& quality) { return quality.scaled_jacobian < middle; });
    ProcessResult result = cli({"quality", mesh, "--min", std::to_string(middle), "--json", "--quiet"});
    EXPECT_EQ(result.status, 3);
    EXPECT_NE(Json::parse(result.output)["notes"].dump().find(std::to_string(below) + " of 32 elements"),
              std::string::npos)
        << result.output;
    EXPECT_EQ(cli({"quality", mesh, "--min", std::to_string(report.summary.min - 1e-4)}).status, 0);
    EXPECT_EQ(cli({"quality", mesh}).status, 0);
    for (const char* wrong : {"1.5", "nan", "much", ""})
        EXPECT_EQ(cli({"quality", mesh, "--min", wrong}).status, 2) << wrong;
}

// ------------------------------------------------------------------------------------------------------------- Ctrl+C

TEST_F(Improving, OnCtrlCTheBestIsKeptIfAsked) {
    input = poor(square_mesh(120, 3), 0.0016);
    write_mesh(mesh, input);
    const std::vector<std::string> command{CURVEWRIGHT_CLI, "improve", mesh, "-o", out};
    ProcessResult result = interrupt_program(command, "Improving");
    EXPECT_EQ(result.status, 130) << result.errors;
    EXPECT_FALSE(exists(out));
    EXPECT_NE(result.errors.find("nothing was written"), std::string::npos) << result.errors;

    std::vector<std::string> keeping = command;
    keeping.insert(keeping.end(), {"--keep-best", "--json"});
    result = interrupt_program(keeping, "Improving");
    EXPECT_EQ(result.status, 130) << result.errors;
    ASSERT_TRUE(exists(out)) << result.errors;
    const Json json = Json::parse(result.output);
    EXPECT_EQ(json["stopped"], "cancelled");
    EXPECT_TRUE(has_note(json, "Cancelled; the best valid mesh so far was written to " + out)) << json["notes"];
    const QualitySummary after = assess_quality(read_mesh(out).mesh).summary;
    EXPECT_EQ(after.valid, after.elements());
    EXPECT_GE(after.min, assess_quality(input).summary.min);
}

TEST_F(Improving, OnCtrlCAnUntanglingKeepsAValidMesh) {
    const CurvedMesh square = square_mesh(120, 3);
    std::mt19937 random(2);
    Coordinates x = shaken(square, 0.002, random).coordinates();
    for (Index element = 0; element < square.topology().element_count(); ++element)
        for (std::size_t c = 0; c < 3; ++c) {
            const Index node = square.topology().element_nodes(element)[c];
            x.row(node) = square.coordinates().row(node);
        }
    ASSERT_GT(assess_quality(square.with_coordinates(x)).summary.invalid, 100);
    write_mesh(mesh, square.with_coordinates(x));
    const ProcessResult result =
        interrupt_program({CURVEWRIGHT_CLI, "untangle", mesh, "-o", out, "--keep-best", "--json"}, "Improving");
    EXPECT_EQ(result.status, 130) << result.errors;
    ASSERT_TRUE(exists(out)) << result.errors;
    EXPECT_EQ(Json::parse(result.output)["stopped"], "cancelled");
    EXPECT_EQ(assess_quality(read_mesh(out).mesh).summary.invalid, 0);
}

TEST_F(Improving, OnCtrlCAWarpInIncrementsKeepsItsLastValidMesh) {
    const ProcessResult result =
        interrupt_program({CURVEWRIGHT_CLI, "warp", circle, "--deformation", circle_deformation, "-o", out, "--json",
                           "--increments", "100000", "--keep-best"},
                          "Warping");
    EXPECT_EQ(result.status, 130) << result.errors;
    ASSERT_TRUE(exists(out)) << result.errors;
    const Json json = Json::parse(result.output);
    const double fraction = json["increments"]["fraction"];
    EXPECT_GT(fraction, 0.0);
    EXPECT_LT(fraction, 1.0);
    const QualitySummary after = assess_quality(read_mesh(out).mesh).summary;
    EXPECT_EQ(after.valid, after.elements());
    EXPECT_EQ(cli({"warp", circle, "--deformation", circle_deformation, "-o", out, "--keep-best"}).status, 2);
}

// ------------------------------------------------------------------------------------------------------------ timings

TEST_F(Improving, TimingsAddUpToTheTotal) {
    make_tangled();
    const std::string large = folder / "large.msh", session = folder / "session.json", higher = folder / "higher.vtu";
    write_mesh(large, poor(cube_mesh(6, 2), 0.02));
    write(session, "{\"action\": \"open\", \"mesh\": \"" + large +
                       "\"}\n{\"action\": \"untangle\", \"method\": \"guaranteed\"}\n");
    for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
             {"info", large},
             {"quality", large},
             {"histogram", large, "-o", folder / "bars.svg"},
             {"convert", large, higher},
             {"elevate", large, "--order", "3", "-o", higher},
             {"deform", annulus, "--deformation", annulus_deformation, "-o", out},
             {"warp", annulus, "--deformation", annulus_deformation, "-o", out},
             {"warp", annulus, "--deformation", annulus_deformation, "-o", out, "--increments", "4"},
             {"untangle", tangled, "-o", out},
             {"untangle", tangled, "-o", out, "--boundary", "slide"},
             {"untangle", tangled, "-o", out, "--method", "signed-angle"},
             {"untangle", tangled, "-o", out, "--method", "unsigned-angle"},
             {"untangle", large, "-o", higher},
             {"improve", large, "-o", higher, "--target", "0.5"},
             {"improve", large, "-o", higher, "--target", "0.5", "--goal", "shape", "--boundary", "slide"},
             {"replay", session, "-o", higher}}) {
        std::vector<std::string> arguments = command;
        arguments.push_back("--json");
        const ProcessResult result = cli(arguments);
        ASSERT_TRUE(result.status == 0 || result.status == 4) << result.errors;
        const Json timings = Json::parse(result.output)["timings"];
        double sum = 0.0;
        for (const auto& [phase, seconds] : timings.items())
            if (phase != "total") sum += seconds.get<double>();
        const double total = timings["total"];
        EXPECT_LE(std::abs(total - sum), std::max(0.02 * total, 0.002)) << command[0] << " " << timings;
    }
}

}  // namespace
}  // namespace curvewright
