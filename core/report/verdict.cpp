#include <fmt/format.h>

#include "core/report/report_markup.h"
#include "core/report/run_report.h"

namespace curvewright {
namespace {

std::string counted(Index count, const char* one, const char* many) {
    return fmt::format("{} {}", count_text(count), count == 1 ? one : many);
}

/// "3 tangled elements and 1 undecided element".
std::string describe_not_valid(const QualitySummary& summary) {
    const std::string tangled = counted(summary.invalid, "tangled element", "tangled elements");
    const std::string undecided = counted(summary.undecided, "undecided element", "undecided elements");
    if (summary.undecided == 0) return tangled;
    return summary.invalid == 0 ? undecided : tangled + " and " + undecided;
}

/// "every one of the 30 elements is proved valid".
std::string proved_valid(const QualitySummary& summary) {
    std::string text =
        fmt::format("every one of the {} is proved valid", counted(summary.assessed(), "element", "elements"));
    if (summary.not_assessed > 0)
        text += fmt::format(" (but for {} that {} not assessed)", counted(summary.not_assessed, "pyramid", "pyramids"),
                            summary.not_assessed == 1 ? "was" : "were");
    return text;
}

std::string what_happened(const RunReport& report) {
    const QualitySummary &before = report.before.scaled_jacobian, &after = report.after.scaled_jacobian;
    const Index at_first = before.invalid + before.undecided, now = after.invalid + after.undecided;
    const std::string all = counted(report.elements(), "element", "elements");
    if (report.elements() == 0) return "The mesh has no elements.";
    const std::string proved = proved_valid(after);
    if (now == 0 && at_first == 0) return fmt::format("No element was tangled, and {}.", proved);
    if (now == 0)
        return fmt::format("{} {} made valid; {}.", describe_not_valid(before), at_first == 1 ? "was" : "were", proved);
    std::string text;
    if (at_first == 0)
        text = fmt::format("All elements were valid before; of {} there {} {} now.", all, now == 1 ? "is" : "are",
                           describe_not_valid(after));
    else if (report.mended == 0)
        text = fmt::format("{} could not be made valid; of {} there {} {} now.", describe_not_valid(before), all,
                           now == 1 ? "is" : "are", describe_not_valid(after));
    else
        text = fmt::format("{} of {} became valid; of {} there {} {} now.", count_text(report.mended),
                           describe_not_valid(before), all, now == 1 ? "is" : "are", describe_not_valid(after));
    if (report.impossible > 0)
        text += fmt::format(" Of {} it is proved that nothing can mend {} while the boundary stays as it is.",
                            report.impossible == now ? (now == 1 ? std::string("this one") : std::string("all these"))
                                                     : count_text(report.impossible),
                            report.impossible == 1 ? "it" : "them");
    return text;
}

}  // namespace

std::string verdict(const RunReport& report) {
    std::string text = what_happened(report);
    if (report.elements() > 0)
        text += fmt::format(" Least scaled Jacobian {} → {}.", number_text(report.before.scaled_jacobian.min),
                            number_text(report.after.scaled_jacobian.min));
    return text;
}

}  // namespace curvewright
