#include "core/untangle/observer.h"

namespace curvewright {

const char* to_string(StopReason reason) {
    switch (reason) {
        case StopReason::converged:
            return "converged";
        case StopReason::untangled:
            return "untangled";
        case StopReason::pass_limit:
            return "pass limit";
        case StopReason::no_progress:
            return "no progress";
        case StopReason::cancelled:
            return "cancelled";
    }
    return "";
}

}  // namespace curvewright
