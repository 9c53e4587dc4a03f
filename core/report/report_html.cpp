#include "core/report/report_html.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/report/report_course.h"
#include "core/report/report_markup.h"
#include "core/report/report_style.h"

namespace curvewright {
namespace {

std::string swatch(const ElementQuality& quality, const ReportColors& colors) {
    if (quality.validity == Validity::not_assessed) return {};
    const bool is_tangled = quality.validity == Validity::invalid || quality.scaled_jacobian <= 0.0;
    const std::string color = quality.validity == Validity::undecided ? colors.undecided
                              : is_tangled                            ? colors.tangled
                                                                      : colors.of(quality.scaled_jacobian);
    return fmt::format("<span class=\"swatch\" style=\"background:{}\"></span>", color);
}

const char* validity_text(Validity validity) {
    return validity == Validity::valid ? "proved valid" : validity == Validity::invalid ? "tangled" : "undecided";
}

std::string quality_text(const ElementQuality& quality, const ReportColors& colors) {
    if (quality.validity == Validity::not_assessed) return to_string(quality.validity);
    return fmt::format("{}{}, {}", swatch(quality, colors), number_text(quality.scaled_jacobian),
                       validity_text(quality.validity));
}

std::string fact(const char* name, const std::string& value) {
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, value);
}

std::string head_section(const RunReport& report) {
    const bool is_good = report.is_all_valid();
    const QualitySummary &before = report.before.scaled_jacobian, &after = report.after.scaled_jacobian;
    std::string html =
        fmt::format("<p class=\"kicker\">Untangling report</p>\n<h1>{}</h1>\n", escaped(report.input.file));
    html += fmt::format(
        "<div class=\"verdict {}\"><span class=\"mark\" aria-hidden=\"true\">{}</span><p id=\"verdict\">{}</p></div>\n",
        is_good ? "good" : "bad", is_good ? "✓" : "✕", escaped(verdict(report)));
    html += "<dl class=\"facts\">";
    html += fact("Elements not valid", fmt::format("{} → {}", count_text(before.invalid + before.undecided),
                                                   count_text(after.invalid + after.undecided)));
    html += fact("Least scaled Jacobian", number_text(before.min) + " → " + number_text(after.min));
    html += fact("Mean scaled Jacobian", number_text(before.mean) + " → " + number_text(after.mean));
    html += fact("Nodes moved",
                 fmt::format("{} of {}", count_text(report.moved_interior_nodes + report.moved_boundary_nodes),
                             count_text(report.nodes)));
    html += "</dl>\n";
    html +=
        "<p class=\"note\">The scaled Jacobian of an element is the least of its Jacobian determinant divided by the "
        "greatest: 1 where the element is stretched evenly, 0 or less where it folds over itself. Such an element is "
        "tangled, and a solver cannot use it. <em>Proved valid</em> means that a lower bound of the determinant, "
        "rounding included, is positive all over the element, not only where it was sampled.</p>\n";
    return html;
}

std::string legend(const ReportColors& colors) {
    std::string ramp;
    for (const double at : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0})
        ramp += fmt::format("{}{}", ramp.empty() ? "" : ",", colors.of(at));
    return fmt::format(
        "<p class=\"legend\"><span><span class=\"swatch\" style=\"background:repeating-linear-gradient(45deg,{0},{0} "
        "3px,#ffffff 3px,#ffffff 4px)\"></span>tangled</span>"
        "<span><span class=\"swatch\" style=\"background:{1}\"></span>undecided</span>"
        "<span>0 <span class=\"swatch ramp\" style=\"background:linear-gradient(to right,{2})\"></span>1, scaled "
        "Jacobian of valid elements</span></p>\n",
        colors.tangled, colors.undecided, ramp);
}

std::string picture(const std::string& png, const std::string& text) {
    return fmt::format("<figure><img src=\"data:image/png;base64,{}\" alt=\"{}\"/><figcaption>{}</figcaption></figure>",
                       base64(png), escaped(text), escaped(text));
}

std::string table_row(const char* what, const std::string& before, const std::string& after) {
    return fmt::format("<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>", what, before,
                       after);
}

std::string quality_section(const RunReport& report, const ReportPictures& pictures, const ReportColors& colors) {
    const ReportQuality &before = report.before, &after = report.after;
    const QualitySummary &b = before.scaled_jacobian, &a = after.scaled_jacobian;
    std::string html = "<h2>Before and after</h2>\n";
    if (pictures.png.size() >= 2)
        html += fmt::format("<div class=\"pair\">{}{}</div>\n", picture(pictures.png[0], "Before"),
                            picture(pictures.png[1], "After, from the same place"));
    if (!pictures.note.empty())
        html += fmt::format("<p class=\"note\">There are no pictures: {}</p>\n", escaped(pictures.note));
    html += legend(colors);
    html +=
        "<table><thead><tr><th></th><th class=\"number\">before</th><th class=\"number\">after</th></tr></thead>"
        "<tbody>";
    html += table_row("Elements proved valid", count_text(b.valid), count_text(a.valid));
    html += table_row("Elements tangled", count_text(b.invalid), count_text(a.invalid));
    html += table_row("Elements undecided", count_text(b.undecided), count_text(a.undecided));
    if (b.not_assessed > 0)
        html += table_row("Elements not assessed (pyramids)", count_text(b.not_assessed), count_text(a.not_assessed));
    if (b.reversed > 0)
        html += table_row("Elements numbered against their neighbours (reversed)", count_text(b.reversed),
                          count_text(a.reversed));
    html += table_row("Valid as a whole", to_string(before.globally_valid), to_string(after.globally_valid));
    if (before.crossing_count + after.crossing_count > 0)
        html += table_row("Pairs of boundary facets that cross", count_text(before.crossing_count),
                          count_text(after.crossing_count));
    html += table_row("Scaled Jacobian, least", number_text(b.min), number_text(a.min));
    html += table_row("Scaled Jacobian, mean", number_text(b.mean), number_text(a.mean));
    html += table_row("Scaled Jacobian, greatest", number_text(b.max), number_text(a.max));
    html += table_row("Shape, least mean ratio (1 = like the straight-sided element)", number_text(before.shape.min),
                      number_text(after.shape.min));
    html += table_row("Shape, mean of it", number_text(before.shape.mean), number_text(after.shape.mean));
    html += "</tbody></table>\n";
    if (after.globally_valid != GlobalValidity::yes)
        html += fmt::format("<p class=\"note\">The result as a whole: {}</p>\n", escaped(after.global_reason));
    const Index highest = std::max(before.histogram.highest(), after.histogram.highest());
    if (highest > 0)
        html += fmt::format(
            "<h3>How many elements have which scaled Jacobian</h3>\n<div class=\"pair\"><figure>{}<figcaption>Before"
            "</figcaption></figure><figure>{}<figcaption>After</figcaption></figure></div>\n"
            "<p class=\"note\">Same bins and same scale in both; counts are drawn logarithmically.</p>\n",
            histogram_svg(before.histogram, highest, colors, "Histogram of the scaled Jacobian before"),
            histogram_svg(after.histogram, highest, colors, "Histogram of the scaled Jacobian after"));
    const double extent = std::sqrt(std::pow(report.bounding_box[3] - report.bounding_box[0], 2) +
                                    std::pow(report.bounding_box[4] - report.bounding_box[1], 2) +
                                    std::pow(report.bounding_box[5] - report.bounding_box[2], 2));
    html += fmt::format(
        "<p>{} of {} interior nodes and {} of {} boundary nodes were moved, none farther than {} units of length",
        count_text(report.moved_interior_nodes), count_text(report.interior_nodes),
        count_text(report.moved_boundary_nodes), count_text(report.boundary_nodes), number_text(report.largest_move));
    if (extent > 0.0)
        html += fmt::format(" ({} % of the mesh’s diagonal)", short_number_text(100.0 * report.largest_move / extent));
    html += report.moved_boundary_nodes == 0 ? ". The boundary is bit for bit what it was.</p>\n" : ".</p>\n";
    return html;
}

std::string group_section(const RunReport& report) {
    if (report.groups.empty()) return {};
    std::string html =
        "<h2>By physical group</h2>\n<p class=\"note\">Of a group on the boundary, the elements that touch it with a "
        "whole cell of the group are counted.</p>\n"
        "<table><thead><tr><th>group</th><th class=\"number\">dimension</th><th class=\"number\">elements</th>"
        "<th class=\"number\">not valid</th><th class=\"number\">least</th><th class=\"number\">mean</th></tr></thead>"
        "<tbody>";
    for (const ReportGroup& group : report.groups)
        html += fmt::format(
            "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{} → {}</td>"
            "<td class=\"number\">{} → {}</td><td class=\"number\">{} → {}</td></tr>",
            group.name.empty() ? "<em>in no group</em>" : escaped(group.name), group.dimension,
            count_text(group.after.elements()), count_text(group.before.invalid + group.before.undecided),
            count_text(group.after.invalid + group.after.undecided), number_text(group.before.min),
            number_text(group.after.min), number_text(group.before.mean), number_text(group.after.mean));
    return html + "</tbody></table>\n";
}

std::string element_table(const std::vector<ReportElement>& list, const ReportColors& colors) {
    std::string html =
        "<table><thead><tr><th class=\"number\">element</th><th>type</th><th>groups</th><th>centre</th><th>before</th>"
        "<th>after</th></tr></thead><tbody>";
    for (const ReportElement& entry : list) {
        // What rounding leaves of a zero would be told as a number.
        double size = 0.0;
        for (const double x : entry.center) size = std::max(size, std::abs(x));
        const auto place = [&](std::size_t i) {
            return short_number_text(std::abs(entry.center[i]) < 1e-12 * size ? 0.0 : entry.center[i]);
        };
        std::string groups;
        for (const std::string& group : entry.groups) groups += (groups.empty() ? "" : ", ") + escaped(group);
        html += fmt::format(
            "<tr><td class=\"number tag\">{}</td><td>{}</td><td>{}</td><td>({}, {}, "
            "{})</td><td>{}</td><td>{}</td></tr>",
            entry.tag, name(entry.type), groups, place(0), place(1), place(2), quality_text(entry.before, colors),
            quality_text(entry.after, colors));
    }
    return html + "</tbody></table>\n";
}

std::string worst_section(const RunReport& report, const ReportPictures& pictures, const ReportColors& colors) {
    if (report.worst_before.empty()) return {};
    std::string html = "<h2>Worst elements</h2>\n<h3>The worst before</h3>\n" +
                       element_table(report.worst_before, colors) + "<h3>The worst after</h3>\n" +
                       element_table(report.worst_after, colors);
    const std::vector<PictureWish> wishes = picture_wishes(report);
    if (pictures.png.size() != wishes.size() || wishes.size() <= 2) return html;
    html +=
        "<h3>From near</h3>\n<p class=\"note\">Each element, outlined, among its neighbours, before and after from "
        "the same place";
    html += report.dimension == 3 ? "; neighbours in front of it are left out.</p>\n" : ".</p>\n";
    const auto entry_of = [&](Index element) {
        for (const auto* list : {&report.worst_before, &report.worst_after})
            for (const ReportElement& entry : *list)
                if (entry.element == element) return entry;
        return ReportElement{};
    };
    for (std::size_t i = 2; i + 1 < wishes.size(); i += 2) {
        const ReportElement entry = entry_of(*wishes[i].element);
        const auto text = [&](const char* when, const ElementQuality& quality) {
            return fmt::format("Element {} {}: {}, {}", entry.tag, when, number_text(quality.scaled_jacobian),
                               validity_text(quality.validity));
        };
        html +=
            fmt::format("<div class=\"pair card\">{}{}</div>\n", picture(pictures.png[i], text("before", entry.before)),
                        picture(pictures.png[i + 1], text("after", entry.after)));
    }
    return html;
}

std::string certificate_section(const RunReport& report, const ReportColors& colors) {
    std::string html = "<h2>Certificate</h2>\n";
    if (report.is_all_valid()) {
        html += fmt::format("<p>All {} elements are proved valid.", count_text(report.elements()));
        if (report.proved_least)
            html += fmt::format(
                " It is also proved that no element’s least determinant is below {} times its greatest; the least "
                "scaled "
                "Jacobian in the tables, {}, is attained.",
                number_text(*report.proved_least), number_text(report.after.scaled_jacobian.min));
        html += "</p>\n";
    } else {
        html += fmt::format("<p>{} of {} elements are not proved valid: {} are proved tangled, {} are undecided.",
                            count_text(static_cast<long long>(report.not_valid.size())), count_text(report.elements()),
                            count_text(report.after.scaled_jacobian.invalid),
                            count_text(report.after.scaled_jacobian.undecided));
        if (report.impossible > 0)
            html += fmt::format(" Of {} it is proved that no position of the nodes that may move would do.",
                                count_text(report.impossible));
        html += "</p>\n";
        constexpr std::size_t listed = 50;
        html +=
            "<table><thead><tr><th class=\"number\">element</th><th>scaled "
            "Jacobian</th><th>why</th></tr></thead><tbody>";
        for (std::size_t i = 0; i < std::min(listed, report.not_valid.size()); ++i) {
            const ReportUnproved& entry = report.not_valid[i];
            html += fmt::format(
                "<tr><td class=\"number tag\">{}</td><td>{}</td><td>{}{}</td></tr>", entry.tag,
                quality_text(entry.quality, colors), escaped(entry.reason),
                entry.is_impossible ? fmt::format(" (proved: at most {})", number_text(entry.bound)) : std::string());
        }
        html += "</tbody></table>\n";
        if (report.not_valid.size() > listed)
            html += fmt::format("<p class=\"note\">And {} more: report.json lists them all.</p>\n",
                                count_text(static_cast<long long>(report.not_valid.size() - listed)));
    }
    html += fmt::format(
        "<p class=\"note\">The determinant in Bernstein-Bézier form bounds it from below and above; elements are cut "
        "until the bounds are within {} of the greatest determinant, in at most {} cuts. Rounding errors are part of "
        "the bounds (Johnen, Remacle, Geuzaine, J. Comput. Phys. 233, 2013).</p>\n",
        short_number_text(report.certificate.tolerance), count_text(report.certificate.max_subdivisions));
    if (report.moves_boundary)
        html += fmt::format(
            "<p>Of the boundary, {} nodes could slide and {} were free; it is at most {} away from the "
            "boundary that was read.</p>\n",
            count_text(report.sliding_nodes), count_text(report.free_nodes),
            number_text(report.largest_boundary_distance));
    return html;
}

struct ValueText {
    std::string operator()(bool value) const { return value ? "yes" : "no"; }
    std::string operator()(int value) const { return count_text(value); }
    std::string operator()(double value) const { return short_number_text(value); }
    std::string operator()(const std::string& value) const { return escaped(value); }
    template <class Item>
    std::string operator()(const std::vector<Item>& values) const {
        std::string text;
        for (const Item& value : values) text += (text.empty() ? "" : ", ") + (*this)(value);
        return text;
    }
};

std::string method_section(const RunReport& report) {
    std::string html = fmt::format("<h2>Method</h2>\n<p><strong>{}.</strong> {}</p>\n", report.method_title,
                                   report.method_description);
    html += "<table><thead><tr><th>parameter</th><th>value</th><th>meaning</th></tr></thead><tbody>";
    for (const ReportParameter& parameter : report.parameters)
        html += fmt::format("<tr><td class=\"mono\">{}</td><td>{}</td><td>{}</td></tr>", escaped(parameter.name),
                            std::visit(ValueText(), parameter.value), escaped(parameter.meaning));
    html += "</tbody></table>\n";
    if (!report.command.empty())
        html += fmt::format("<p>The same again:</p>\n<pre>{}</pre>\n", escaped(report.command));
    return html;
}

std::string property(const char* what, const std::string& value) {
    return fmt::format("<tr><td>{}</td><td>{}</td></tr>", what, value);
}

std::string input_section(const RunReport& report) {
    std::string html = "<h2>Input</h2>\n<table><tbody>";
    html += property("File", escaped(report.input.file));
    html += property("SHA-256 of the file", report.input.sha256.empty()
                                                ? escaped(report.input.note)
                                                : "<span class=\"mono\">" + report.input.sha256 + "</span>");
    std::string types;
    for (const auto& [type, count] : report.types)
        types += fmt::format("{}{} × {}", types.empty() ? "" : ", ", count_text(count), escaped(type));
    html += property("Elements", types.empty() ? "none" : types);
    html += property("Nodes", fmt::format("{}: {} interior, {} on the boundary", count_text(report.nodes),
                                          count_text(report.interior_nodes), count_text(report.boundary_nodes)));
    const auto& box = report.bounding_box;
    std::string extents;
    for (std::size_t i = 0; i < 3; ++i)
        extents +=
            fmt::format("{}{} … {}", i == 0 ? "" : ", ", short_number_text(box[i]), short_number_text(box[i + 3]));
    html += property("Bounding box x, y, z", extents);
    html += property("Orientation", to_string(report.orientation));
    html += property("SHA-256 of its coordinates", "<span class=\"mono\">" + report.input_coordinates + "</span>");
    html += property("SHA-256 of the result’s coordinates",
                     "<span class=\"mono\">" + report.result_coordinates + "</span>");
    std::string versions;
    for (const auto& [name, version] : report.versions)
        versions += fmt::format("{}{} {}", versions.empty() ? "" : ", ", escaped(name), escaped(version));
    html += property("Versions", versions);
    html += "</tbody></table>\n";
    if (!report.input.steps.empty()) {
        html += "<p>Before it was untangled, this was done to the mesh of the file (lines of a session):</p>\n<pre>";
        for (const std::string& line : report.input.steps) html += escaped(line) + "\n";
        html += "</pre>\n";
    }
    return html;
}

std::string run_section(const RunReport& report) {
    std::string html = fmt::format("<section id=\"run\">\n<h2>This run</h2>\n<p>Written {}.</p>\n", report.written);
    if (!report.made_by.empty())
        html += fmt::format("<p>Made by <span class=\"mono\">{}</span></p>\n", escaped(report.made_by));
    for (const std::string& remark : report.remarks) html += fmt::format("<p>{}</p>\n", escaped(remark));
    html += "<table><tbody>";
    for (const auto& [name, seconds] : report.timings)
        html += fmt::format("<tr><td>{}</td><td class=\"number\">{}</td></tr>", escaped(name), seconds_text(seconds));
    return html + "</tbody></table>\n</section>\n";
}

}  // namespace

std::string to_html(const RunReport& report, const ReportPictures& pictures, const ReportColors& colors) {
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta "
        "charset=\"utf-8\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{}: untangling "
        "report</title>\n"
        "<style>{}</style>\n</head>\n<body>\n{}\n<main>\n",
        escaped(report.input.file), report_style, hatch_svg(colors));
    html += head_section(report);
    html += quality_section(report, pictures, colors);
    html += group_section(report);
    html += worst_section(report, pictures, colors);
    html += course_section(report);
    html += certificate_section(report, colors);
    html += method_section(report);
    html += input_section(report);
    html += run_section(report);
    html += "<footer>Written by Curvewright. The same numbers with all their digits are in report.json.</footer>\n";
    return html + "</main>\n</body>\n</html>\n";
}

}  // namespace curvewright
