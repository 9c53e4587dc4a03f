#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/io/mesh_io.h"
#include "core/quality/quality.h"
#include "tests/regression/command_line.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using namespace testing;
using Json = nlohmann::json;

TEST_F(CommandLine, WarpReportsBeforeAfterAndSolver) {
    const std::string out = folder / "warped.vtu";
    for (const char* weights : {"convex", "affine"})
        for (const char* solver : {"auto", "direct", "iterative"}) {
            const ProcessResult result = cli({"warp", circle, "--deformation", circle_deformation, "-o", out,
                                              "--weights", weights, "--solver", solver, "--json"});
            ASSERT_EQ(result.status, 0) << result.errors;
            const Json json = Json::parse(result.output);
            EXPECT_GT(json["scaled_jacobian"]["min"].get<double>(), 0.5);
            EXPECT_EQ(json["scaled_jacobian"]["invalid"], 0);
            EXPECT_NEAR(json["before"]["scaled_jacobian"]["min"].get<double>(), 1.0, 1e-6);
            EXPECT_EQ(json["solver"]["name"], std::string(solver) == "direct" ? "direct" : "iterative");
            for (const char* phase : {"read", "neighbours", "weights", "solve", "certify", "write", "total"})
                EXPECT_TRUE(json["timings"].contains(phase)) << phase;
            EXPECT_EQ(read_mesh(out).mesh.topology().element_count(), 1660);
        }
}

TEST_F(CommandLine, WarpTellsTheOptionsOfItsWeights) {
    const std::string out = folder / "out.msh";
    const auto warp_json = [&](const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"warp", circle, "--deformation", circle_deformation, "-o", out, "--json"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, 0) << result.errors;
        return Json::parse(result.output);
    };
    Json json = warp_json({"--neighbours", "edge", "--distance-power", "1.5"});
    EXPECT_EQ(json["weights"], "convex");
    EXPECT_EQ(json["neighbours"], "edge");
    EXPECT_EQ(json["distance_power"], 1.5);
    EXPECT_FALSE(json.contains("poisson_ratio") || json.contains("stiffening") || json.contains("increments"));
    EXPECT_GE(json["condensed_nodes"].get<int>(), 0);
    const Coordinates edge = read_mesh(out).mesh.coordinates();
    json = warp_json({"--weights", "affine", "--neighbours", "high-order", "--distance-power", "1.5"});
    EXPECT_EQ(json["neighbours"], "high-order");
    EXPECT_GT((read_mesh(out).mesh.coordinates() - edge).cwiseAbs().maxCoeff(), 1e-4);
    json = warp_json({"--solver", "direct", "--ordering", "minimum-degree"});
    const Coordinates minimum_degree = read_mesh(out).mesh.coordinates();
    EXPECT_EQ(json["solver"]["name"], "direct");
    warp_json({"--solver", "direct", "--ordering", "nested-dissection", "--neighbours", "all"});
    EXPECT_LT((read_mesh(out).mesh.coordinates() - minimum_degree).cwiseAbs().maxCoeff(), 1e-10);

    json = warp_json({"--weights", "elastic", "--poisson-ratio", "-0.4", "--stiffening", "0.5"});
    EXPECT_EQ(json["weights"], "elastic");
    EXPECT_EQ(json["poisson_ratio"], -0.4);
    EXPECT_EQ(json["stiffening"], 0.5);
    EXPECT_FALSE(json.contains("distance_power") || json.contains("neighbours"));
    EXPECT_GT(json["scaled_jacobian"]["min"].get<double>(), 0.5);
    const ProcessResult idle = cli({"warp", annulus, "--deformation", annulus_deformation, "-o", out, "--weights",
                                    "elastic", "--distance-power", "1", "--quiet"});
    EXPECT_TRUE(idle.errors.empty()) << idle.errors;
    const ProcessResult told = cli({"warp", annulus, "--deformation", annulus_deformation, "-o", out, "--weights",
                                    "elastic", "--distance-power", "1"});
    EXPECT_NE(told.errors.find("--distance-power has no effect with --weights elastic."), std::string::npos);
}

TEST_F(CommandLine, WarpRefusesNodesOutsideTheHullWhenAsked) {
    const std::string out = folder / "out.msh";
    const std::vector<std::string> warp{"warp", circle, "--deformation", circle_deformation,
                                        "-o",   out,    "--neighbours",  "high-order"};
    std::vector<std::string> lenient = warp, strict = warp;
    lenient.insert(lenient.end(), {"--json", "--outside-hull", "affine"});
    const ProcessResult result = cli(lenient);
    ASSERT_EQ(result.status, 0) << result.errors;
    ASSERT_FALSE(Json::parse(result.output)["outside_hull"].empty());
    std::filesystem::remove(out);
    strict.insert(strict.end(), {"--quiet", "--outside-hull", "fail"});
    expect_bad_input(strict, "no convex weights");
    EXPECT_FALSE(exists(out));
}

TEST_F(CommandLine, ElasticBodyGoesOntoTheAnnulus) {
    const std::string out = folder / "out.msh";
    const ProcessResult result =
        cli({"warp", annulus, "--deformation", annulus_deformation, "-o", out, "--weights", "elastic", "--json"});
    ASSERT_EQ(result.status, 0) << result.errors << result.output;
    const Json json = Json::parse(result.output);
    EXPECT_EQ(json["scaled_jacobian"]["valid"], 30);
    EXPECT_EQ(json["condensed_nodes"], 30);  // the node in the middle of every P3 triangle
    const CurvedMesh mesh = read_mesh(out).mesh;
    const auto inner = mesh.topology().find_group_nodes("inner").value();
    for (Index node : inner) EXPECT_NEAR(mesh.coordinates().row(node).norm(), 0.4, 1e-14);
}

TEST_F(CommandLine, WarpInIncrementsTellsItsSteps) {
    const std::string out = folder / "out.msh", at_once = folder / "at_once.msh";
    ASSERT_EQ(cli({"warp", circle, "--deformation", circle_deformation, "-o", at_once}).status, 0);
    const Coordinates direct_way = read_mesh(at_once).mesh.coordinates();
    for (const char* asked : {"4", "auto"})
        for (const bool keeps_weights : {false, true}) {
            std::vector<std::string> arguments{
                "warp", circle, "--deformation", circle_deformation, "-o", out, "--json", "--increments", asked};
            if (keeps_weights) arguments.push_back("--keep-weights");
            const ProcessResult result = cli(arguments);
            ASSERT_EQ(result.status, 0) << result.errors;
            const Json json = Json::parse(result.output), increments = json["increments"];
            const bool is_automatic = std::string(asked) == "auto";
            EXPECT_EQ(increments["asked"], is_automatic ? Json("auto") : Json(4));
            EXPECT_EQ(increments["tried"], increments["steps"].size());
            EXPECT_EQ(increments["fraction"], 1.0);
            EXPECT_EQ(increments["complete"], true);
            EXPECT_TRUE(increments["failed"].is_null());
            const Json& last = increments["steps"].back();
            EXPECT_EQ(last["fraction"], 1.0);
            EXPECT_EQ(last["min"], json["scaled_jacobian"]["min"]);
            EXPECT_EQ(last["accepted"], true);
            EXPECT_EQ(last["invalid"], 0);
            EXPECT_EQ(last["undecided"], 0);
            if (!is_automatic) {
                EXPECT_EQ(increments["accepted"], 4);
                EXPECT_EQ(increments["steps"][0]["fraction"], 0.25);
            }
            // With the weights of the first mesh the end is the same, however one gets there.
            const double difference = (read_mesh(out).mesh.coordinates() - direct_way).cwiseAbs().maxCoeff();
            if (keeps_weights) {
                EXPECT_LT(difference, 1e-9);
            } else if (!is_automatic) {
                EXPECT_GT(difference, 1e-4);
            }
        }
    const ProcessResult text =
        cli({"warp", circle, "--deformation", circle_deformation, "-o", out, "--increments", "2"});
    EXPECT_NE(text.output.find("The whole motion in 2 steps."), std::string::npos) << text.output;
}

TEST_F(CommandLine, IncompleteIncrementsEndWithThreeAtTheLastValidState) {
    const std::string out = folder / "out.msh", far = folder / "far.json";
    write(far, R"({"operations": [{"group": "circle", "type": "translate", "vector": [0.8, 0, 0]}]})");
    const CurvedMesh start = read_mesh(circle).mesh;
    const auto moving = start.topology().find_group_nodes("circle").value();
    for (const std::string weights : {"convex", "elastic"})
        for (const std::string asked : {"auto", "4", "1"}) {
            const ProcessResult result = cli({"warp", circle, "--deformation", far, "-o", out, "--weights", weights,
                                              "--increments", asked, "--json"});
            EXPECT_EQ(result.status, 3) << result.errors;
            EXPECT_NE(result.errors.find(" of the motion"), std::string::npos) << result.errors;
            const Json json = Json::parse(result.output), increments = json["increments"];
            const double fraction = increments["fraction"];
            EXPECT_EQ(increments["complete"], false);
            EXPECT_LT(fraction, 1.0);
            if (asked == "1") {
                EXPECT_EQ(fraction, 0.0);
                EXPECT_EQ(increments["accepted"], 0);
            } else {
                EXPECT_GT(fraction, 0.0);
            }
            EXPECT_GT(increments["failed"]["fraction"].get<double>(), fraction);
            EXPECT_LE(increments["failed"]["scaled_jacobian"].get<double>(), 0.0);
            EXPECT_TRUE(start.topology().find_element(ElementTag{increments["failed"]["element"].get<long>()}));
            EXPECT_EQ(json["scaled_jacobian"]["valid"], 1660);
            const CurvedMesh mesh = read_mesh(out).mesh;
            EXPECT_EQ(assess_quality(mesh).summary.valid, 1660);
            for (Index node : moving) {
                EXPECT_NEAR(mesh.coordinates()(node, 0), start.coordinates()(node, 0) + 0.8 * fraction, 1e-14);
                EXPECT_EQ(mesh.coordinates()(node, 1), start.coordinates()(node, 1));
            }
        }
    const ProcessResult text = cli({"warp", circle, "--deformation", far, "-o", out, "--increments", "4"});
    EXPECT_EQ(text.status, 3);
    EXPECT_NE(text.output.find("the last state without tangled elements"), std::string::npos) << text.output;
    make_tangled();
    expect_bad_input({"warp", tangled, "--deformation", annulus_deformation, "-o", folder / "no.msh", "--increments",
                      "2", "--quiet"},
                     "not valid to begin with");
    EXPECT_FALSE(exists(folder / "no.msh"));
}

TEST_F(CommandLine, MeshesWithoutQualityAreWarped) {
    const std::string in = folder / "in.msh", out = folder / "out.msh", curl = folder / "curl.json";
    // Harmonic and free of divergence, so that it solves the equations of elasticity.
    write(curl, R"json({"operations": [{"group": "boundary", "type": "expression", "x": "x + 0.1*(x^2 - y^2)",
                                        "y": "y - 0.2*x*y"}]})json");
    for (const CurvedMesh& mesh : {quad_mesh(3, 2), hex_mesh(2, 2), prism_mesh(2, 3), quad_mesh(3, 1)}) {
        write_mesh(in, mesh);
        const bool is_exact = mesh.topology().order() > 1;
        bool is_assessable = true;
        try {
            require_assessable(mesh);
        } catch (const Unsupported&) {
            is_assessable = false;
        }
        for (const std::string weights : {"convex", "affine", "elastic"}) {
            const ProcessResult result =
                cli({"warp", in, "--deformation", curl, "-o", out, "--weights", weights, "--json"});
            ASSERT_EQ(result.status, 0) << result.errors;
            const Json json = Json::parse(result.output);
            for (const Json& state : {json, json["before"]}) {
                EXPECT_EQ(state["scaled_jacobian"].is_null(), !is_assessable);
                EXPECT_EQ(state.contains("quality_note"), !is_assessable);
            }
            if (!is_exact || weights != "elastic") continue;
            const Coordinates moved = read_mesh(out).mesh.coordinates();
            const auto x = mesh.coordinates().col(0).array(), y = mesh.coordinates().col(1).array();
            EXPECT_LT((moved.col(0).array() - (x + 0.1 * (x * x - y * y))).abs().maxCoeff(), 1e-12);
            EXPECT_LT((moved.col(1).array() - (y - 0.2 * x * y)).abs().maxCoeff(), 1e-12);
        }
        if (is_assessable) continue;
        const ProcessResult text = cli({"warp", in, "--deformation", curl, "-o", out});
        EXPECT_EQ(text.status, 0);
        EXPECT_NE(text.output.find("quality not assessed yet"), std::string::npos) << text.output;
        std::filesystem::remove(out);
        expect_bad_input({"warp", in, "--deformation", curl, "-o", out, "--increments", "2"}, "scaled Jacobian");
        EXPECT_FALSE(exists(out));
    }
}

TEST_F(CommandLine, HostileWarpOptionsEndWithTwo) {
    const std::string out = folder / "out.msh";
    const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
        {"--increments",
         {"0", "-3", "2.5", "many", "auto4", "1e3", "+2", " 2", "0x2", "100001", "99999999999999999999"}},
        {"--poisson-ratio", {"0.5", "-1", "nan", "inf", "soft", "0.3x", "1e999"}},
        {"--stiffening", {"4.5", "-5", "nan", "-inf", "hard"}},
        {"--distance-power", {"-1", "9", "nan"}},
        {"--neighbours", {"some", "ALL"}},
        {"--outside-hull", {"maybe"}},
        {"--ordering", {"best"}}};
    for (const auto& [name, values] : cases)
        for (const std::string& value : values) {
            const ProcessResult result =
                cli({"warp", annulus, "--deformation", annulus_deformation, "-o", out, name, value});
            EXPECT_EQ(result.status, 2) << name << ' ' << value;
            EXPECT_EQ(result.errors.find(name + ": "), 0u) << result.errors;
        }
    const ProcessResult alone =
        cli({"warp", annulus, "--deformation", annulus_deformation, "-o", out, "--keep-weights"});
    EXPECT_EQ(alone.status, 2);
    EXPECT_NE(alone.errors.find("--keep-weights requires --increments"), std::string::npos) << alone.errors;
    EXPECT_FALSE(exists(out));
}

}  // namespace
}  // namespace curvewright
