#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace curvewright {

/// Progress of a task: the name of its present phase and the fraction of that phase done, in [0, 1].
using ProgressCallback = std::function<void(std::string_view phase, double fraction)>;

/// What every long-running function takes from its caller: a way to be stopped and a way to tell how far it is.
/// The default never stops and tells nobody. The callback is called on the thread that runs the function.
struct TaskContext {
    std::stop_token stop;
    ProgressCallback progress;

    /// Throws Cancelled when the caller has asked to stop.
    void check() const {
        if (stop.stop_requested()) throw Cancelled();
    }
    /// check(), then tells the caller how far the phase is.
    void report(std::string_view phase, double fraction) const {
        check();
        if (progress) progress(phase, fraction);
    }
};

}  // namespace curvewright
