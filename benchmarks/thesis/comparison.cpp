#include "benchmarks/thesis/comparison.h"

#include <algorithm>
#include <utility>

namespace curvewright::benchmarks {

const char* to_string(By by) {
    switch (by) {
        case By::thesis:
            return "thesis";
        case By::here:
            return "here";
        case By::literal:
            return "literal";
        case By::best:
            return "best";
        case By::peer:
            return "peer";
    }
    return "";
}

Comparison::Comparison(TableId id, std::string title, std::string note, std::string what,
                       std::vector<std::string> columns)
    : id_(std::move(id)) {
    std::string name = id_.text();
    name.front() = static_cast<char>(name.front() - 'a' + 'A');
    table_.name = id_.file_name();
    table_.title = name + ": " + title;
    table_.note = std::move(note);
    table_.columns = {std::move(what), "by", "method"};
    table_.columns.insert(table_.columns.end(), columns.begin(), columns.end());
    table_.columns.push_back("remark");
}

void Comparison::add(By by, const std::string& what, const std::string& method, std::vector<Cell> values,
                     const std::string& remark) {
    if (by == By::thesis) expected_.insert(what);
    if (by != By::thesis && by != By::peer) measured_.insert(what);
    std::vector<Cell> row{what, to_string(by), method};
    row.insert(row.end(), std::make_move_iterator(values.begin()), std::make_move_iterator(values.end()));
    row.resize(table_.columns.size() - 1);
    row.emplace_back(remark);
    table_.add(std::move(row));
}

void Comparison::leave_out(const std::string& what, const std::string& reason) {
    std::vector<Cell> row(table_.columns.size());
    row.front() = what;
    row[1] = "not run";
    row.back() = reason;
    table_.add(std::move(row));
}

Table Comparison::table() const {
    return table_;
}

Target Comparison::completeness() const {
    std::string missing;
    for (const std::string& what : expected_)
        if (!measured_.contains(what)) missing += (missing.empty() ? "; not run: " : ", ") + what;
    const auto done = std::count_if(expected_.begin(), expected_.end(),
                                    [&](const std::string& what) { return measured_.contains(what); });
    return {id_.text() + ": everything in it was run", fmt::format("{} of {}", expected_.size(), expected_.size()),
            fmt::format("{} of {}{}", done, expected_.size(), missing), missing.empty()};
}

void add_if_wanted(const Settings& settings, Report& report, const Comparison& comparison,
                   std::vector<Picture> pictures) {
    if (!settings.wants(comparison.id().kind, comparison.id().number)) return;
    report.add(comparison.table(), std::move(pictures));
    report.add(comparison.completeness());
}

void add_if_wanted(const Settings& settings, Report& report, const Comparison& comparison,
                   const std::vector<Plot>& plots) {
    if (!settings.wants(comparison.id().kind, comparison.id().number)) return;
    report.add(comparison.table(), plots);
    report.add(comparison.completeness());
}

void Tally::add(bool holds, const std::string& name) {
    ++all_;
    held_ += holds;
    if (!holds) others_ += (others_.empty() ? "; not " : ", ") + name;
}

void Tally::tell_in(Report& report, const std::string& what, const std::string& promised) const {
    if (all_) report.add(Target{what, promised, fmt::format("{} of {}{}", held_, all_, others_), held_ == all_});
}

Cell fixed(double number) {
    return formatted(number, "{:.3f}");
}

}  // namespace curvewright::benchmarks
