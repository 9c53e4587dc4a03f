#include "core/report/report_course.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "core/report/report_charts.h"
#include "core/report/report_markup.h"

namespace curvewright {
namespace {

using convergence::Pass;
using convergence::Patch;
using convergence::Round;

constexpr std::size_t listed_passes = 24, listed_patches = 12, drawn_patches = 80, drawn_passes = 4;

std::string stop_text(const RunReport& report) {
    switch (report.reason) {
        case StopReason::converged:
            return report.passes
                       ? "It ended because a pass hardly moved the nodes any more."
                       : "It ended by itself: what it was after is reached, or nothing more was to be gained.";
        case StopReason::untangled:
            return "It ended because every element was proved valid.";
        case StopReason::pass_limit:
            return "It ended at the limit of passes.";
        case StopReason::no_progress:
            return "It ended because no further progress was made.";
        case StopReason::cancelled:
            return "It was stopped; the best state is kept.";
    }
    return {};
}

std::string pass_table(const RunReport& report) {
    std::string html = fmt::format(
        "<table><thead><tr><th class=\"number\">after pass</th><th class=\"number\">{}</th>"
        "<th class=\"number\">minimisations</th><th class=\"number\">iterations</th><th class=\"number\">objective, "
        "sum</th><th class=\"number\">not valid</th><th class=\"number\">least scaled Jacobian</th>"
        "<th class=\"number\">relative change</th></tr></thead><tbody>",
        report.rounds ? "patches" : "edges or nodes");
    const QualitySummary& start = report.before.scaled_jacobian;
    html += fmt::format(
        "<tr><td class=\"number\">start</td><td></td><td></td><td></td><td></td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td></td></tr>",
        count_text(start.invalid + start.undecided), number_text(start.min));
    const std::vector<Pass>& list = report.pass_list;
    for (std::size_t i = 0; i < list.size(); ++i) {
        // Of many passes the first ones and the last.
        if (list.size() > listed_passes && i >= listed_passes - 1 && i + 1 < list.size()) continue;
        const Pass& pass = list[i];
        html += fmt::format(
            "<tr><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
            "<td class=\"number\">{}</td><td class=\"number\">{} → {}</td><td class=\"number\">{}</td>"
            "<td class=\"number\">{}</td><td class=\"number\">{}</td></tr>",
            pass.pass, count_text(pass.patches), count_text(pass.minimisations), count_text(pass.iterations),
            number_text(pass.objective_before), number_text(pass.objective_after),
            count_text(pass.invalid + pass.undecided), number_text(pass.min_scaled_jacobian),
            number_text(pass.relative_change));
    }
    return html + "</tbody></table>\n";
}

/// Two or three beside each other.
std::string figures(std::vector<Chart> charts) {
    std::string html;
    for (Chart& chart : charts) {
        chart.width = charts.size() == 3 ? 300.0 : 440.0;
        if (const std::string svg = chart_svg(chart); !svg.empty()) html += "<figure>" + svg + "</figure>";
    }
    return html.empty() ? html
                        : fmt::format("<div class=\"{}\">{}</div>\n", charts.size() == 3 ? "triple" : "pair", html);
}

std::string pass_charts(const RunReport& report) {
    if (report.pass_list.size() < 2) return {};
    const QualitySummary& start = report.before.scaled_jacobian;
    ChartLine least{{{0.0, start.min}}, true};
    ChartLine not_valid{{{0.0, static_cast<double>(start.invalid + start.undecided)}}, true};
    ChartLine objective{{}, true};
    for (const Pass& pass : report.pass_list) {
        least.points.emplace_back(pass.pass, pass.min_scaled_jacobian);
        not_valid.points.emplace_back(pass.pass, pass.invalid + pass.undecided);
        objective.points.emplace_back(pass.pass, pass.objective_after);
    }
    std::vector<Chart> charts{{"Least scaled Jacobian", "after pass", {least}, false, false, true},
                              {"Elements not valid", "after pass", {not_valid}, false, true, false}};
    // Passes of the guaranteed method have different patches, so the sums cannot be compared.
    if (report.passes) charts.push_back({"Objective, sum", "after pass", {objective}, false, false, false});
    return figures(std::move(charts));
}

/// The patches of a pass, the worst at its beginning first.
std::vector<Patch> patches_of(const RunReport& report, int pass) {
    std::vector<Patch> patches;
    for (const Patch& patch : report.patch_list)
        if (patch.pass == pass) patches.push_back(patch);
    std::stable_sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
        return a.min_scaled_jacobian_before < b.min_scaled_jacobian_before;
    });
    return patches;
}

std::string patch_table(const std::vector<Patch>& patches) {
    std::string html =
        "<table><thead><tr><th class=\"number\">patch</th><th class=\"number\">elements</th><th class=\"number\">free "
        "nodes</th><th class=\"number\">minimisations</th><th class=\"number\">iterations</th>"
        "<th class=\"number\">objective</th><th class=\"number\">least scaled Jacobian</th></tr></thead><tbody>";
    for (std::size_t i = 0; i < std::min(listed_patches, patches.size()); ++i) {
        const Patch& patch = patches[i];
        html += fmt::format(
            "<tr><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
            "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{} → {}</td>"
            "<td class=\"number\">{} → {}</td></tr>",
            patch.patch, count_text(patch.elements), count_text(patch.nodes), count_text(patch.minimisations),
            count_text(patch.iterations), number_text(patch.objective_before), number_text(patch.objective_after),
            number_text(patch.min_scaled_jacobian_before), number_text(patch.min_scaled_jacobian_after));
    }
    return html + "</tbody></table>\n";
}

/// The rounds of the patches of one pass of the guaranteed method.
std::string round_charts(const RunReport& report, int pass, const std::vector<Patch>& patches) {
    std::map<int, std::array<ChartLine, 3>> lines;  // of patches: least scaled Jacobian, not valid, objective
    for (std::size_t i = 0; i < std::min(drawn_patches, patches.size()); ++i) {
        std::array<ChartLine, 3>& three = lines[patches[i].patch];
        for (ChartLine& line : three) line.is_accent = i == 0;
        three[0].points.emplace_back(0, patches[i].min_scaled_jacobian_before);
    }
    bool has_not_valid = false;
    for (const Round& round : report.round_list) {
        const auto found = lines.find(round.patch);
        if (round.pass != pass || found == lines.end()) continue;
        auto& [least, not_valid, objective] = found->second;
        if (round.min_scaled_jacobian) least.points.emplace_back(round.round, *round.min_scaled_jacobian);
        if (round.not_valid) not_valid.points.emplace_back(round.round, *round.not_valid);
        if (round.objective) objective.points.emplace_back(round.round, *round.objective);
        has_not_valid = has_not_valid || round.not_valid.value_or(0) > 0;
    }
    std::array<std::vector<ChartLine>, 3> of_charts;
    for (auto& [patch, three] : lines)
        for (std::size_t i = 0; i < 3; ++i) of_charts[i].push_back(std::move(three[i]));
    bool is_positive = true;
    for (const ChartLine& line : of_charts[2])
        for (const auto& point : line.points) is_positive = is_positive && point.second > 0.0;
    std::vector<Chart> charts{
        {"Least scaled Jacobian of the patch", "minimisation", std::move(of_charts[0]), false, false, true}};
    if (has_not_valid)
        charts.push_back({"Elements not valid", "minimisation", std::move(of_charts[1]), false, true, false});
    charts.push_back({"Objective at its end", "minimisation", std::move(of_charts[2]), is_positive, false, false});
    return figures(std::move(charts));
}

std::string guaranteed_details(const RunReport& report) {
    std::string html =
        "<p class=\"note\">A patch is a set of elements whose free nodes are moved together. Below, each line is a "
        "patch, the blue one that which began worst. A certificate is asked for when all samples are positive, so the "
        "curves of the scaled Jacobian may jump from the start to the last minimisation. While elements are made "
        "valid, "
        "the objective is the foldover energy, whose penalty is sharpened from one minimisation to the next, so that "
        "it "
        "may rise; while improving, it is first the energy and then a soft minimum that is sharpened likewise.</p>\n";
    std::size_t drawn = 0;
    for (const Pass& pass : report.pass_list) {
        const std::vector<Patch> patches = patches_of(report, pass.pass);
        if (patches.empty() || drawn++ == drawn_passes) continue;
        html += fmt::format("<h3>Pass {}: {} {}</h3>\n", pass.pass, count_text(pass.patches),
                            pass.patches == 1 ? "patch" : "patches");
        html += round_charts(report, pass.pass, patches) + patch_table(patches);
        if (static_cast<std::size_t>(pass.patches) > listed_patches)
            html +=
                fmt::format("<p class=\"note\">The {} that began worst; report.json has more.</p>\n", listed_patches);
    }
    return html;
}

}  // namespace

std::string course_section(const RunReport& report) {
    std::string html = fmt::format("<h2>How it went</h2>\n<p>{}", stop_text(report));
    if (report.passes)
        html += fmt::format(" {} {} {} made.", count_text(*report.passes), *report.passes == 1 ? "pass" : "passes",
                            *report.passes == 1 ? "was" : "were");
    if (report.rounds && *report.rounds > 0)
        html += fmt::format(" {} {} it took to make the elements valid.", count_text(*report.rounds),
                            *report.rounds == 1 ? "minimisation is what" : "minimisations are what");
    html += "</p>\n";
    if (report.pass_list.empty()) return html + "<p>There was nothing to do.</p>\n";
    html += pass_charts(report) + pass_table(report);
    if (report.rounds) html += guaranteed_details(report);
    return html;
}

}  // namespace curvewright
