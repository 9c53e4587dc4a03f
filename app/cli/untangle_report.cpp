#include "app/cli/untangle_report.h"

#include <fmt/format.h>

#include "core/base/sha256.h"
#include "ui/scene/report_painter.h"

namespace curvewright::cli {

std::unique_ptr<ReportFiles> write_report(const std::filesystem::path& folder, const UntangleFacts& facts,
                                          const Invocation& invocation, const TaskContext& context, Json& timings) {
    const Stopwatch watch;
    ReportSource source{{facts.file.filename().string(), sha256_of_file(facts.file), {}, {}},
                        facts.before,
                        facts.quality_before,
                        facts.after,
                        facts.quality_after,
                        facts.options,
                        facts.warped_first,
                        facts.run,
                        facts.log,
                        {}};
    for (const auto& [name, seconds] : timings.items()) source.timings.emplace_back(name, seconds.get<double>());
    const RunReport report = collect_report(source, context);
    ReportPainter painter(facts.before, facts.quality_before, facts.after, facts.quality_after);
    const ReportPictures pictures = draw_pictures(
        report, [&painter](const PictureWish& wish) { return painter.paint(wish); }, context);
    if (!pictures.note.empty() && !invocation.common.quiet)
        fmt::print(stderr, "The report has no pictures: {}\n", pictures.note);
    auto files = std::make_unique<ReportFiles>(folder, report, pictures, report_colors());
    timings["report"] = watch.seconds();
    return files;
}

}  // namespace curvewright::cli
