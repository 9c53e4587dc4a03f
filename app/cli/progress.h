#pragma once

#include <string>

#include "core/base/stopwatch.h"
#include "core/base/task.h"

namespace curvewright::cli {

/// Progress on standard error: a bar that rewrites itself where that is a terminal, else one line per phase of tasks
/// that have been running for a second. The destructor clears the bar.
class ProgressBar {
  public:
    explicit ProgressBar(bool is_quiet);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    ProgressCallback callback();

  private:
    void update(std::string_view phase, double fraction);

    bool is_quiet_, is_terminal_, is_shown_ = false;
    Stopwatch since_start_, since_update_;
    std::string phase_;
};

}  // namespace curvewright::cli
