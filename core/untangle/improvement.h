#pragma once

#include <vector>

#include "core/untangle/improve.h"
#include "core/untangle/patch_work.h"

namespace curvewright {

/// How the second stage of the guaranteed method works; the fields as in GuaranteedOptions and ImproveOptions.
struct ImprovementOptions {
    ImproveGoal goal = ImproveGoal::jacobian;
    double target = 0.9;
    int layers = 2;
    double work = 4e6;
    double shape_weight = 0.034, mean_weight = 0.006, shape_floor = 0.0;
    /// Go on until every element below the target has been worked on, however many; otherwise only the worst that the
    /// work allows are, in a few passes.
    bool is_thorough = false;
};

/// The second stage of the guaranteed method: raises the quality of a valid mesh, or of what is valid of it.
class Improvement {
  public:
    /// work must be assessed.
    Improvement(PatchWork& work, const ImprovementOptions& options) : work_(work), options_(options) {}

    /// Leaves every patch in the best state seen, also when it throws Cancelled: no patch has more elements that are
    /// not valid, or a lower least value of what the goal raises, than before.
    void run();

  private:
    void run_within_work();
    void run_thoroughly();
    /// One pass over the worst elements below the target that have not been worked on; false if there are none.
    bool run_on_worst(std::vector<char>& is_done);
    void improve(const std::vector<FreePatch>& patches, std::string_view phase);
    /// The least of what the goal raises.
    double least() const;
    std::vector<double> values() const;
    /// Below the target, the worst first.
    std::vector<Index> elements_to_improve() const;
    std::vector<FreePatch> patches_to_improve(const std::vector<Index>& seeds) const;
    /// As many of the seeds, from the first, as may be improved together; at least one.
    std::vector<Index> worst_within_limit(const std::vector<Index>& seeds) const;

    PatchWork& work_;
    const ImprovementOptions options_;
};

}  // namespace curvewright
