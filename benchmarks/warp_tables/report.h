#pragma once

#include <string>
#include <vector>

#include "benchmarks/warp_tables/plot.h"
#include "benchmarks/warp_tables/settings.h"
#include "benchmarks/warp_tables/table.h"

namespace curvewright::benchmarks {

/// Something that was promised, and what was measured.
struct Target {
    std::string what, promised, measured;
    bool is_met = false;
};

/// What the measurements of a run leave behind.
class Report {
  public:
    /// Prints the table on standard output and keeps it.
    void add(const Table& table, const std::vector<Plot>& plots = {});
    void add(const Target& target) { targets_.push_back(target); }

    /// Prints the targets. Writes warp.md, and a CSV file per table and an SVG file per plot beside it; folders are
    /// made as needed.
    void finish(const Settings& settings, const std::filesystem::path& folder);

  private:
    std::vector<std::pair<Table, std::vector<Plot>>> sections_;
    std::vector<Target> targets_;
};

}  // namespace curvewright::benchmarks
