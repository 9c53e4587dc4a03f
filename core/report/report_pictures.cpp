#include "core/report/report_pictures.h"

#include <algorithm>

#include "core/base/error.h"

namespace curvewright {
namespace {

constexpr std::size_t shown_before = 5, shown_after = 3;
/// Elements above this are nothing to look at.
constexpr double good_enough = 0.99;

}  // namespace

std::vector<PictureWish> picture_wishes(const RunReport& report) {
    std::vector<PictureWish> wishes;
    if (report.elements() == 0) return wishes;
    const auto add = [&](std::optional<Index> element, int width, int height) {
        for (const bool is_result : {false, true}) wishes.push_back({element, is_result, width, height});
    };
    add({}, 800, 600);
    std::vector<Index> shown;
    const auto add_worst = [&](const std::vector<ReportElement>& list, std::size_t most, auto quality_of) {
        for (const ReportElement& entry : list) {
            if (most == 0 || quality_of(entry).scaled_jacobian > good_enough) return;
            if (std::find(shown.begin(), shown.end(), entry.element) != shown.end()) continue;
            shown.push_back(entry.element);
            add(entry.element, 480, 320);
            --most;
        }
    };
    add_worst(report.worst_before, shown_before, [](const ReportElement& entry) { return entry.before; });
    add_worst(report.worst_after, shown_after, [](const ReportElement& entry) { return entry.after; });
    return wishes;
}

ReportPictures draw_pictures(const RunReport& report, const std::function<std::string(const PictureWish&)>& draw,
                             const TaskContext& context) {
    ReportPictures pictures;
    const std::vector<PictureWish> wishes = picture_wishes(report);
    try {
        for (const PictureWish& wish : wishes) {
            context.report("Drawing pictures",
                           static_cast<double>(pictures.png.size()) / static_cast<double>(wishes.size()));
            pictures.png.push_back(draw(wish));
        }
    } catch (const Unsupported& problem) {
        pictures.png.clear();
        pictures.note = problem.what();
    }
    return pictures;
}

}  // namespace curvewright
