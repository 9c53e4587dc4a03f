#include "benchmarks/thesis/comparison.h"

#include <algorithm>
#include <map>
#include <utility>

#include "benchmarks/thesis/thesis_report.h"

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

void Comparison::leave_out(const std::string& what, NotRun why, const std::string& explanation) {
    std::vector<Cell> row(table_.columns.size());
    row.front() = what;
    row[1] = "not run";
    row.back() = why == NotRun::quick ? "left out by --quick" : explanation;
    table_.add(std::move(row));
    lacks_meshes_ = lacks_meshes_ || why == NotRun::missing;
}

Table Comparison::table() const {
    Table sorted = table_;
    std::map<std::string, std::size_t> place;
    for (const auto& row : table_.rows) place.emplace(row.front().exact, place.size());
    std::stable_sort(sorted.rows.begin(), sorted.rows.end(), [&](const auto& a, const auto& b) {
        return place.at(a.front().exact) < place.at(b.front().exact);
    });
    return sorted;
}

bool Comparison::is_complete() const {
    return std::includes(measured_.begin(), measured_.end(), expected_.begin(), expected_.end());
}

void Tally::add(bool holds, const std::string& name) {
    ++all_;
    held_ += holds;
    if (!holds) others_ += (others_.empty() ? "; not " : ", ") + name;
}

Target Tally::target(const std::string& what, const std::string& promised) const {
    return {what, promised, fmt::format("{} of {}{}", held_, all_, others_), held_ == all_};
}

void Tally::tell_in(ThesisReport& report, const std::string& what, const std::string& promised) const {
    if (all_) report.add(target(what, promised));
}

Cell fixed(double number) {
    return formatted(number, "{:.3f}");
}

}  // namespace curvewright::benchmarks
