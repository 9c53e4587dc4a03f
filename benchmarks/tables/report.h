#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/tables/plot.h"
#include "benchmarks/tables/table.h"

namespace curvewright::benchmarks {

/// Something that was promised, and what was measured.
struct Target {
    std::string what, promised, measured;
    bool is_met = false;
};

/// An SVG picture beside a table.
struct Picture {
    std::string name;  ///< of the SVG file, without suffix
    std::string title;
    std::string svg;
};

/// A page of docs/benchmarks.
struct Page {
    std::string name;          ///< of the Markdown file, without suffix
    std::string introduction;  ///< Markdown: title, how it was measured, how to repeat it
};

/// Model name of the processor.
std::string processor();
/// Processes that wanted a processor in the last minute. Warns on standard error if there were any.
double load_before_run();
/// A sentence for the page if other programs were busy during the run.
std::string load_remark(double load);

/// What the measurements of a run leave behind.
class Report {
  public:
    /// Prints the table on standard output and keeps it.
    void add(const Table& table, const std::vector<Plot>& plots = {});
    void add(const Table& table, std::vector<Picture> pictures);
    void add(const Target& target) { targets_.push_back(target); }

    /// Prints the targets. Writes the page, and a CSV file per table and an SVG file per plot beside it; folders are
    /// made as needed, nothing is written if `folder` is empty.
    void finish(const Page& page, const std::filesystem::path& folder);

  private:
    std::vector<std::pair<Table, std::vector<Picture>>> sections_;
    std::vector<Target> targets_;
};

}  // namespace curvewright::benchmarks
