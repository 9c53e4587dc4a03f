#include "app/cli/target.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "app/cli/command.h"

namespace curvewright::cli {

CLI::Option* add_target_option(CLI::App& command, double& target, const std::string& description) {
    return command.add_option("--target", target, description)
        ->type_name("Q")
        ->check([](const std::string& text) {
            const double value = std::strtod(text.c_str(), nullptr);
            return value > 0.0 && value <= 1.0 ? std::string() : "the target must be greater than 0 and at most 1";
        })
        ->capture_default_str();
}

TargetOutcome compare(const Target& target, const std::vector<double>& values) {
    TargetOutcome outcome;
    if (!values.empty()) outcome.least = *std::min_element(values.begin(), values.end());
    outcome.below = static_cast<Index>(
        std::count_if(values.begin(), values.end(), [&](double value) { return value < target.value; }));
    return outcome;
}

std::vector<double> scaled_jacobians(const QualityReport& report) {
    std::vector<double> values;
    for (const ElementQuality& quality : report.elements) values.push_back(quality.scaled_jacobian);
    return values;
}

const char* measure_name(ImproveGoal goal) {
    return goal == ImproveGoal::jacobian ? "scaled Jacobian" : "mean ratio";
}

int note_target(const Target& target, const TargetOutcome& outcome, Work& work) {
    if (outcome.is_reached()) return exit_done;
    work.note(fmt::format("The {}target {:g} was not reached: {} {} below it, and the least {} is {:.4g}.",
                          target.is_explicit ? "" : "default ", target.value, outcome.below,
                          outcome.below == 1 ? "element is" : "elements are", measure_name(target.goal),
                          outcome.least));
    return target.is_explicit ? exit_less_than_asked : exit_done;
}

bool note_cancelled(const QualityReport& best, const std::filesystem::path& output, Work& work) {
    const Index not_valid = best.summary.invalid + best.summary.undecided;
    if (not_valid == 0) {
        work.note(fmt::format("Cancelled; the best valid mesh so far was written to {}.", output.string()));
        return true;
    }
    fmt::print(stderr,
               "Cancelled; nothing was written, as no valid mesh had been found: {} {} not valid in the best.\n",
               not_valid, not_valid == 1 ? "element is" : "elements are");
    return false;
}

}  // namespace curvewright::cli
