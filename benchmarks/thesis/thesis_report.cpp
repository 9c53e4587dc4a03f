#include "benchmarks/thesis/thesis_report.h"

#include <utility>

namespace curvewright::benchmarks {

bool ThesisReport::begin(const Comparison& comparison) {
    const TableId& id = comparison.id();
    if (!settings_.wants(id.kind, id.number)) return false;
    complete_.add(comparison.is_complete(), id.text());
    if (comparison.lacks_meshes()) lacking_.push_back(id.text());
    return true;
}

void ThesisReport::add(const Comparison& comparison, std::vector<Picture> pictures) {
    if (begin(comparison)) report_.add(comparison.table(), std::move(pictures));
}

void ThesisReport::add(const Comparison& comparison, const std::vector<Plot>& plots) {
    if (begin(comparison)) report_.add(comparison.table(), plots);
}

void ThesisReport::finish(const Page& page, const std::filesystem::path& folder) {
    if (!complete_.is_empty()) report_.add(complete_.target("tables and figures of which every row was run", "all"));
    for (const Target& target : targets_) report_.add(target);
    report_.finish(page, folder);
}

}  // namespace curvewright::benchmarks
