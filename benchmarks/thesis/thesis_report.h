#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/tables/report.h"
#include "benchmarks/thesis/comparison.h"
#include "benchmarks/thesis/settings.h"

namespace curvewright::benchmarks {

/// The pages of docs/thesis while they grow.
class ThesisReport {
  public:
    explicit ThesisReport(const Settings& settings) : settings_(settings) {}

    /// Prints and keeps the table if it is wanted.
    void add(const Comparison& comparison, std::vector<Picture> pictures = {});
    void add(const Comparison& comparison, const std::vector<Plot>& plots);
    void add(const Target& target) { targets_.push_back(target); }

    /// Writes everything; see Report::finish.
    void finish(const Page& page, const std::filesystem::path& folder);

    /// Tables with rows that were not run because their meshes are not there.
    const std::vector<std::string>& lacking() const { return lacking_; }

  private:
    bool begin(const Comparison& comparison);

    const Settings& settings_;
    Report report_;
    Tally complete_;
    std::vector<Target> targets_;
    std::vector<std::string> lacking_;
};

}  // namespace curvewright::benchmarks
