#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/sha256.h"
#include "core/io/mesh_io.h"
#include "tests/regression/command_line.h"

namespace curvewright::testing {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string without_run(std::string html) {
    const std::size_t begin = html.find("<section id=\"run\">"), end = html.find("</section>", begin);
    EXPECT_NE(end, html.npos);
    return html.erase(begin, end - begin);
}

TEST_F(CommandLine, UntangleReports) {
    make_tangled();
    const std::string out = folder / "valid.msh", report = folder / "report", trace = folder / "trace.jsonl";
    const ProcessResult result =
        cli({"untangle", tangled, "-o", out, "--report", report, "--trace", trace, "--json", "--threads", "1"});
    ASSERT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(names_in(report), (std::vector<std::string>{"report.html", "report.json"}));
    const Json told = Json::parse(result.output), json = Json::parse(read(folder / "report/report.json"));
    EXPECT_EQ(told["report"], report);
    EXPECT_EQ(json["after"]["scaled_jacobian"], told["scaled_jacobian"]);
    EXPECT_EQ(json["before"]["scaled_jacobian"], told["before"]["scaled_jacobian"]);
    EXPECT_EQ(json["after"]["shape"], told["shape"]);
    EXPECT_EQ(json["input"]["file"], "tangled.msh");
    EXPECT_EQ(json["input"]["sha256"], sha256_of_file(tangled));
    EXPECT_EQ(json["certificate"]["all_valid"], true);
    EXPECT_GT(json["convergence"]["rounds"]["count"], 0);
    EXPECT_EQ(json["run"]["timings"]["untangle"], told["timings"]["untangle"]);
    EXPECT_GT(read(trace).size(), 0u);
    // The mesh is the same without anybody who listens, and so is the report on more threads.
    const std::string plain = folder / "plain.msh", other = folder / "other";
    ASSERT_EQ(cli({"untangle", tangled, "-o", plain}).status, 0);
    EXPECT_EQ(read(plain), read(out));
    ASSERT_EQ(cli({"untangle", tangled, "-o", plain, "--report", other, "--threads", "3"}).status, 0);
    Json again = Json::parse(read(folder / "other/report.json")), first = json;
    again.erase("run");
    first.erase("run");
    EXPECT_EQ(again, first);
    EXPECT_EQ(without_run(read(folder / "other/report.html")), without_run(read(folder / "report/report.html")));
    // Neither a folder nor a machine is named in it.
    for (const char* name : {"report/report.html", "report/report.json"})
        EXPECT_EQ(read(folder / name).find(folder.path().string()), std::string::npos);
    // A folder that is there gets the new report.
    ASSERT_EQ(cli({"untangle", tangled, "-o", plain, "--beta", "0.7", "--report", other}).status, 0);
    EXPECT_EQ(Json::parse(read(folder / "other/report.json"))["method"]["name"], "signed-angle");
    EXPECT_EQ(names_in(other), (std::vector<std::string>{"report.html", "report.json"}));
}

TEST_F(CommandLine, UntangleReportsEveryMethod) {
    make_tangled();
    const std::string out = folder / "valid.msh", report = folder / "report";
    const std::vector<std::vector<std::string>> methods{{"--beta", "auto"},
                                                        {"--beta", "0.7", "--warp-first", "elastic"},
                                                        {"--method", "unsigned-angle", "--literal"},
                                                        {"--boundary", "slide"},
                                                        {"--valid-only"}};
    for (const auto& options : methods) {
        std::vector<std::string> arguments{"untangle", tangled, "-o", out, "--json", "--report", report};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = cli(arguments);
        ASSERT_TRUE(result.status == 0 || result.status == 3) << result.errors;
        const Json told = Json::parse(result.output), json = Json::parse(read(folder / "report/report.json"));
        EXPECT_EQ(json["method"]["name"], told["method"]);
        EXPECT_EQ(json["after"]["scaled_jacobian"], told["scaled_jacobian"]);
        EXPECT_EQ(json["outcome"]["stopped"], told["stopped"]);
        EXPECT_EQ(json["outcome"]["passes"], told.value("passes", Json()));
        EXPECT_EQ(json["outcome"].value("boundary", Json()), told.value("boundary", Json()));
        EXPECT_EQ(json["certificate"]["all_valid"], result.status == 0);
        // What the report says does it again.
        const std::string command = json["method"]["command"];
        EXPECT_EQ(command.find("curvewright-cli untangle tangled.msh -o untangled.vtu"), 0u) << command;
        for (const std::string& option : options) EXPECT_NE(command.find(option), std::string::npos) << command;
    }
}

TEST_F(CommandLine, UntangleReportsWhatIsNotMended) {
    // A triangle with one side pushed through it: none of its nodes may move.
    const std::string mesh = folder / "stuck.msh";
    write(mesh,
          "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0.5 0.6 0\n5 0.5 0.5 0\n"
          "6 0 0.5 0\n$EndNodes\n$Elements\n1\n7 9 2 0 1 1 2 3 4 5 6\n$EndElements\n");
    const ProcessResult result =
        cli({"untangle", mesh, "-o", folder / "out.msh", "--report", folder / "report", "--quiet"});
    EXPECT_EQ(result.status, 3) << result.errors;
    const Json json = Json::parse(read(folder / "report/report.json"));
    EXPECT_EQ(json["certificate"]["not_valid"][0]["element"], 7);
    EXPECT_EQ(json["certificate"]["proved_impossible"], 1);
    EXPECT_NE(read(folder / "report/report.html").find("could not be made valid"), std::string::npos);
}

TEST_F(CommandLine, UntangleRefusesABadFolderForItsReport) {
    make_tangled();
    const std::string out = folder / "valid.msh", trace = folder / "trace.jsonl";
    write(folder / "file", "x");
    fs::create_directories(fs::path(folder / "odd") / "report.html");
    fs::create_symlink(folder / "nowhere", folder / "link");
    const auto refuse = [&](const std::string& report, const std::string& fragment) {
        expect_bad_input({"untangle", tangled, "-o", out, "--report", report, "--trace", trace}, fragment);
        EXPECT_FALSE(exists(out) || exists(trace)) << report;
    };
    refuse(folder / "no/such", "there is no folder");
    refuse(folder / "file", "something else");
    refuse(folder / "file/report", "there is no folder");
    refuse(folder / "odd", "there is a folder of that name");
    refuse(folder / "link", "something else");
    refuse(out, "at the same time");
    refuse(trace, "at the same time");
    refuse(tangled, "something else");
    expect_bad_input({"untangle", tangled, "-o", folder / "x/report.json", "--format", "vtu", "--report", folder / "x"},
                     "there is no folder");
    // What fails later leaves no report either.
    expect_bad_input({"untangle", tangled, "-o", out, "--boundary", "lid=slide", "--report", folder / "new"}, "'lid'");
    expect_bad_input({"untangle", folder / "none.msh", "-o", out, "--report", folder / "new"}, "none.msh");
    EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"file", "link", "odd", "tangled.msh"}));
}

TEST_F(CommandLine, ReportsAreSafeFromNames) {
    const std::string mesh = folder / "<b>&\"it's\" \xC3\xBC.msh";
    make_tangled();
    std::string text = read(tangled);
    const std::size_t name = text.find("\"inner\"");
    ASSERT_NE(name, text.npos);
    text.replace(name, 7, "\"<script>&\xff\"");
    write(mesh, text);
    const ProcessResult result = cli({"untangle", mesh, "-o", folder / "out.msh", "--report", folder / "report"});
    ASSERT_EQ(result.status, 0) << result.errors;
    const std::string html = read(folder / "report/report.html");
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("<b>"), std::string::npos);
    EXPECT_NE(html.find("<h1>&lt;b&gt;&amp;&quot;it&#39;s&quot; \xC3\xBC.msh</h1>"), std::string::npos);
    EXPECT_NE(html.find("&lt;script&gt;&amp;\xEF\xBF\xBD"), std::string::npos);
    EXPECT_EQ(Json::parse(read(folder / "report/report.json"))["input"]["file"], "<b>&\"it's\" \xC3\xBC.msh");
}

}  // namespace
}  // namespace curvewright::testing
