#include "app/cli/progress.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace curvewright::cli {

ProgressBar::ProgressBar(bool is_quiet) : is_quiet_(is_quiet), is_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
    if (is_shown_) fmt::print(stderr, "\r\033[K");
}

ProgressCallback ProgressBar::callback() {
    if (is_quiet_) return {};
    return [this](std::string_view phase, double fraction) { update(phase, fraction); };
}

void ProgressBar::update(std::string_view phase, double fraction) {
    const bool is_new_phase = phase != phase_;
    if (!is_terminal_) {
        if (!is_new_phase || since_start_.seconds() < 1.0) return;
        phase_ = phase;
        fmt::print(stderr, "{}\n", phase);
        return;
    }
    if (since_start_.seconds() < 0.3 || (!is_new_phase && since_update_.seconds() < 0.1)) return;
    since_update_ = {};
    phase_ = phase;
    constexpr int width = 30;
    const int filled = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * width);
    fmt::print(stderr, "\r\033[K[{}{}] {:3.0f} %  {}", std::string(filled, '#'), std::string(width - filled, '.'),
               100 * fraction, phase);
    std::fflush(stderr);
    is_shown_ = true;
}

}  // namespace curvewright::cli
