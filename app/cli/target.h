#pragma once

#include <string>
#include <vector>

#include "app/cli/output.h"
#include "core/untangle/improve.h"

namespace curvewright::cli {

/// A quality that all elements should have.
struct Target {
    double value = 0.9;
    bool is_explicit = false;  ///< the user asked for it
    ImproveGoal goal = ImproveGoal::jacobian;
};

/// Adds --target, which the text explains.
CLI::Option* add_target_option(CLI::App& command, double& target, const std::string& description);

/// How a valid result stands to the target. values: of the elements, what the goal raises.
struct TargetOutcome {
    double least = 1.0;
    Index below = 0;  ///< elements
    bool is_reached() const { return below == 0; }
};
TargetOutcome compare(const Target& target, const std::vector<double>& values);
std::vector<double> scaled_jacobians(const QualityReport& report);
/// Notes that the target was missed, if it was. The status that follows from it: exit_less_than_asked if it was asked
/// for, else exit_done.
int note_target(const Target& target, const TargetOutcome& outcome, Work& work);

/// "scaled Jacobian", "mean ratio".
const char* measure_name(ImproveGoal goal);

/// After a run with --keep-best that was cancelled: says that the best valid mesh is written, or, where the best mesh
/// is not valid, that nothing is. Whether it is to be written.
bool note_cancelled(const QualityReport& best, const std::filesystem::path& output, Work& work);

}  // namespace curvewright::cli
