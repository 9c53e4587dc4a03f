#include "app/cli/untangle_report.h"

#include <fmt/format.h>

#include "core/base/sha256.h"
#include "ui/scene/report_painter.h"

namespace curvewright::cli {

std::unique_ptr<ReportFiles> write_report(const std::filesystem::path& folder, const UntangleFacts& facts, Work& work) {
    ReportSource source{{facts.file.filename().string(), sha256_of_file(facts.file), {}, {}},
                        facts.before,
                        facts.quality_before,
                        facts.after,
                        facts.quality_after,
                        facts.options,
                        facts.warped_first,
                        facts.run,
                        facts.log,
                        {},
                        work.command()};
    for (const auto& [name, seconds] : work.timings().items()) source.timings.emplace_back(name, seconds.get<double>());
    const RunReport report = collect_report(source, work.context());
    ReportPainter painter(facts.before, facts.quality_before, facts.after, facts.quality_after);
    const ReportPictures pictures = draw_pictures(
        report, [&painter](const PictureWish& wish) { return painter.paint(wish); }, work.context());
    if (!pictures.note.empty()) work.note(fmt::format("The report has no pictures: {}", pictures.note));
    auto files = std::make_unique<ReportFiles>(folder, report, pictures, report_colors());
    work.end_phase("report");
    return files;
}

}  // namespace curvewright::cli
