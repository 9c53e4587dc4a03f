#include "core/report/run_report.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/report/report_html.h"
#include "core/report/report_json.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using Json = nlohmann::json;

/// A run with all that a report of it needs.
struct Untangled {
    CurvedMesh before;
    UntangleOptions options;
    ConvergenceLog log;
    UntangleRun run = run_untangling(before, options, &log);
    CurvedMesh after = before.with_coordinates(run.coordinates);
    QualityReport quality_before = assess_quality(before), quality_after = assess_after();

    explicit Untangled(CurvedMesh mesh, UntangleOptions of_method = GuaranteedOptions())
        : before(std::move(mesh)), options(std::move(of_method)) {}
    QualityReport assess_after() const {
        QualityOptions sign;
        sign.orientation_sign = quality_before.orientation_sign;
        return assess_quality(after, sign);
    }
    RunReport report(ReportInput input = {"part.msh", "12ab", {}, {}}) const {
        return collect_report(
            {std::move(input), before, quality_before, after, quality_after, options, {}, run, log, run.timings});
    }
};

const ReportColors colors{[](double) { return std::string("#123456"); }, "#d6006c", "#7a68a8"};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

TEST(RunReport, HasTheNumbersOfTheCertificates) {
    const Untangled it(testing::bulged_square_mesh(4, 3, 0.12));
    ASSERT_GT(it.quality_before.summary.invalid, 0);
    const RunReport report = it.report();
    const Json json = Json::parse(to_json(report, {}));
    for (const auto& [key, quality, mesh] :
         {std::tuple("before", &it.quality_before, &it.before), std::tuple("after", &it.quality_after, &it.after)}) {
        const Json& told = json[key];
        EXPECT_EQ(told["scaled_jacobian"]["min"].get<double>(), quality->summary.min);
        EXPECT_EQ(told["scaled_jacobian"]["mean"].get<double>(), quality->summary.mean);
        EXPECT_EQ(told["scaled_jacobian"]["invalid"].get<Index>(), quality->summary.invalid);
        const ShapeSummary shape = assess_shape(*mesh, it.before.coordinates());
        EXPECT_EQ(told["shape"]["min"].get<double>(), shape.min);
        Index total = told["histogram"]["tangled"].get<Index>();
        EXPECT_EQ(total, quality->summary.invalid);
        for (const char* part : {"valid", "undecided"})
            for (const Json& count : told["histogram"][part]) total += count.get<Index>();
        EXPECT_EQ(total, quality->summary.elements());
        const Json& worst = json["worst"][key];
        const std::vector<Index> expected = quality->worst(10);
        ASSERT_EQ(worst.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const auto element = static_cast<std::size_t>(expected[i]);
            EXPECT_EQ(worst[i]["element"], it.before.topology().element_tag(expected[i]).value);
            EXPECT_EQ(worst[i]["before"]["scaled_jacobian"].get<double>(),
                      it.quality_before.elements[element].scaled_jacobian);
            EXPECT_EQ(worst[i]["after"]["scaled_jacobian"].get<double>(),
                      it.quality_after.elements[element].scaled_jacobian);
        }
    }
    EXPECT_EQ(report.mended, it.quality_before.summary.invalid + it.quality_before.summary.undecided);
    EXPECT_EQ(report.spoiled, 0);
    EXPECT_EQ(report.moved_boundary_nodes, 0);
    EXPECT_GT(report.moved_interior_nodes, 0);
    double largest = 0.0;
    for (Index node = 0; node < it.before.topology().node_count(); ++node)
        largest = std::max(largest, (it.after.coordinates().row(node) - it.before.coordinates().row(node)).norm());
    EXPECT_EQ(report.largest_move, largest);
    // What is proved is below what is attained, by the tolerance at most.
    ASSERT_TRUE(report.proved_least);
    EXPECT_LE(*report.proved_least, it.quality_after.summary.min);
    EXPECT_GT(*report.proved_least, it.quality_after.summary.min - 5.0 * QualityOptions().tolerance);
    EXPECT_EQ(json["convergence"]["passes"]["listed"].back()["min_scaled_jacobian"].get<double>(),
              it.quality_after.summary.min);
}

TEST(RunReport, TellsGroupsApart) {
    const Untangled it(testing::bulged_square_mesh(4, 3, 0.12));
    const RunReport report = it.report();
    ASSERT_EQ(report.groups.size(), 5u);
    EXPECT_EQ(report.groups[0].name, "domain");
    EXPECT_EQ(report.groups[0].after.elements(), 32);
    EXPECT_EQ(report.groups[0].after.min, it.quality_after.summary.min);
    EXPECT_EQ(report.groups[0].after.mean, it.quality_after.summary.mean);
    const auto bottom = std::find_if(report.groups.begin(), report.groups.end(),
                                     [](const ReportGroup& group) { return group.name == "bottom"; });
    ASSERT_NE(bottom, report.groups.end());
    EXPECT_EQ(bottom->dimension, 1);
    // Four edges, each of one triangle; all that is tangled is there.
    EXPECT_EQ(bottom->before.elements(), 4);
    EXPECT_EQ(bottom->before.invalid, it.quality_before.summary.invalid);
    EXPECT_EQ(bottom->before.min, it.quality_before.summary.min);
    for (const ReportElement& element : report.worst_before)
        EXPECT_EQ(element.groups, (std::vector<std::string>{"domain"}));
    // Faces of tetrahedra.
    const RunReport solid = Untangled(testing::cube_mesh(2, 2)).report();
    for (const ReportGroup& group : solid.groups) {
        if (group.dimension == 2) {
            EXPECT_EQ(group.after.elements(), 8) << group.name;
        }
    }
}

TEST(RunReport, IsTheSameForAnyNumberOfThreads) {
    std::string first;
    for (const int threads : {1, 2, 3}) {
        set_thread_count(threads);
        RunReport report = Untangled(testing::bulged_square_mesh(4, 3, 0.12)).report();
        report.timings.clear();
        report.written.clear();
        const std::string text = to_json(report, {}) + to_html(report, {}, colors);
        if (first.empty()) first = text;
        EXPECT_EQ(text, first);
    }
    set_thread_count(0);
}

TEST(RunReport, NamesEveryParameter) {
    SignedAngleOptions signed_angles;
    signed_angles.beta = 0.25;
    UnsignedAngleOptions unsigned_angles = UnsignedAngleOptions::literal();
    GuaranteedOptions guaranteed;
    guaranteed.boundary.add("slide");
    guaranteed.boundary.add("bottom=fixed");
    const CurvedMesh mesh = testing::bulged_square_mesh(3, 3, 0.1);
    const auto method_of_run = [&](const UntangleOptions& options) {
        return Json::parse(to_json(Untangled(mesh, options).report(), {}))["method"];
    };
    Json method = method_of_run(signed_angles);
    EXPECT_EQ(method["name"], "signed-angle");
    EXPECT_EQ(method["parameters"]["beta"], 0.25);
    EXPECT_EQ(method["parameters"]["max_passes"], 50);
    EXPECT_EQ(method["command"],
              "curvewright-cli untangle part.msh -o untangled.vtu --method signed-angle --beta 0.25 --max-passes 50");
    signed_angles.beta_choice = BetaChoice::automatic;
    EXPECT_EQ(method_of_run(signed_angles)["parameters"]["beta"], "auto");
    method = method_of_run(unsigned_angles);
    EXPECT_EQ(method["parameters"]["is_guarded"], false);
    EXPECT_EQ(method["parameters"]["first_steps"], Json(unsigned_angles.first_steps));
    method = method_of_run(guaranteed);
    EXPECT_EQ(method["parameters"]["boundary"], (Json{"slide", "bottom=fixed"}));
    EXPECT_EQ(method["parameters"]["target"], 0.9);
}

TEST(RunReport, SaysWhatCouldNotBeMended) {
    // One triangle of order 2 whose side is pushed through it: all of its nodes are on the boundary.
    Eigen::MatrixX3d x(6, 3);
    x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.5, 0.6, 0, 0.5, 0.5, 0, 0, 0.5, 0;
    const Untangled it(testing::single_element({Shape::triangle, 2}, x));
    const RunReport report = it.report();
    ASSERT_EQ(report.not_valid.size(), 1u);
    EXPECT_FALSE(report.is_all_valid());
    EXPECT_FALSE(report.proved_least);
    EXPECT_TRUE(report.not_valid[0].is_impossible);
    EXPECT_EQ(report.not_valid[0].reason, it.run.unmended[0].reason);
    EXPECT_EQ(report.impossible, 1);
    EXPECT_TRUE(contains(verdict(report), "1 tangled element could not be made valid")) << verdict(report);
    EXPECT_TRUE(contains(verdict(report), "nothing can mend it while the boundary stays")) << verdict(report);
    const std::string html = to_html(report, {}, colors);
    EXPECT_TRUE(contains(html, "class=\"verdict bad\""));
    EXPECT_TRUE(contains(html, it.run.unmended[0].reason));
    const Json json = Json::parse(to_json(report, {}));
    EXPECT_EQ(json["certificate"]["all_valid"], false);
    EXPECT_EQ(json["certificate"]["not_valid"][0]["proved_impossible"], true);
}

RunReport made_up(Index was_tangled, Index is_tangled, Index is_undecided, Index mended, double from, double to) {
    RunReport report;
    const Index all = 1338;
    report.before.scaled_jacobian = {from, 0.9, 1.0, all - was_tangled, was_tangled, 0};
    report.after.scaled_jacobian = {to, 0.9, 1.0, all - is_tangled - is_undecided, is_tangled, is_undecided};
    report.mended = mended;
    report.not_valid.resize(static_cast<std::size_t>(is_tangled + is_undecided));
    return report;
}

TEST(Verdict, SaysInASentenceWhatBecameOfTheMesh) {
    EXPECT_EQ(verdict(made_up(8, 0, 0, 8, -0.122, 0.68)),
              "8 tangled elements were made valid; every one of the 1,338 elements is proved valid. Least scaled "
              "Jacobian −0.1220 → 0.6800.");
    EXPECT_EQ(
        verdict(made_up(1, 0, 0, 1, -1.0, 0.5)),
        "1 tangled element was made valid; every one of the 1,338 elements is proved valid. Least scaled Jacobian "
        "−1.000 → 0.5000.");
    EXPECT_EQ(verdict(made_up(0, 0, 0, 0, 0.5, 0.75)),
              "No element was tangled, and every one of the 1,338 elements is proved valid. Least scaled Jacobian "
              "0.5000 → 0.7500.");
    EXPECT_EQ(verdict(made_up(8, 2, 1, 5, -0.5, -0.25)),
              "5 of 8 tangled elements became valid; of 1,338 elements there are 2 tangled elements and 1 undecided "
              "element now. Least scaled Jacobian −0.5000 → −0.2500.");
    EXPECT_EQ(verdict(made_up(0, 1, 0, 0, 0.5, -0.5)),
              "All elements were valid before; of 1,338 elements there is 1 tangled element now. Least scaled Jacobian "
              "0.5000 → −0.5000.");
    EXPECT_EQ(verdict(RunReport()), "The mesh has no elements.");
}

TEST(RunReport, IsSafeFromNames) {
    const Untangled it(testing::bulged_square_mesh(3, 3, 0.15));
    RunReport report = it.report({"<script>alert('x')</script>&\xff.msh", {}, "no <file>", {R"({"action":"<flip>"})"}});
    report.groups[0].name = "<b>\"wall\"</b>\x02";
    const std::string html = to_html(report, {{}, "no <screen>"}, colors);
    for (const char* bad : {"<script", "<b>", "<file>", "<flip>", "<screen>", "\x02", "\xff"})
        EXPECT_FALSE(contains(html, bad)) << bad;
    EXPECT_TRUE(contains(html, "There are no pictures: no &lt;screen&gt;"));
    const Json json = Json::parse(to_json(report, {}));
    EXPECT_EQ(json["groups"][0]["name"], report.groups[0].name);
    EXPECT_TRUE(json["input"]["sha256"].is_null());
    EXPECT_TRUE(json["method"]["command"].is_null());  // there were steps before
    EXPECT_EQ(json["input"]["steps"][0]["action"], "<flip>");
}

TEST(ReportPictures, AreTheWholeMeshAndTheWorst) {
    const Untangled it(testing::bulged_square_mesh(4, 3, 0.12));
    const RunReport report = it.report();
    const std::vector<PictureWish> wishes = picture_wishes(report);
    ASSERT_GT(wishes.size(), 4u);
    ASSERT_LE(wishes.size(), 18u);
    EXPECT_FALSE(wishes[0].element || wishes[1].element);
    EXPECT_EQ(wishes[2].element, report.worst_before[0].element);
    for (std::size_t i = 0; i < wishes.size(); ++i) {
        EXPECT_EQ(wishes[i].is_result, i % 2 == 1);
        EXPECT_EQ(wishes[i].element, wishes[i ^ 1u].element);
    }
    ReportPictures pictures =
        draw_pictures(report, [](const PictureWish& wish) { return wish.is_result ? "after" : "before"; });
    EXPECT_EQ(pictures.png.size(), wishes.size());
    const std::string html = to_html(report, pictures, colors);
    EXPECT_TRUE(contains(html, "data:image/png;base64,YmVmb3Jl\"") &&
                contains(html, "data:image/png;base64,YWZ0ZXI=\""));
    // What cannot be drawn after all is left out altogether.
    int drawn = 0;
    pictures = draw_pictures(report, [&](const PictureWish&) -> std::string {
        if (++drawn == 3) throw Unsupported("no graphics");
        return "x";
    });
    EXPECT_TRUE(pictures.png.empty());
    EXPECT_EQ(pictures.note, "no graphics");
}

}  // namespace
}  // namespace curvewright
