#include "core/linear/solver_options.h"

namespace curvewright {

const char* to_string(SolverChoice solver) {
    switch (solver) {
        case SolverChoice::automatic:
            return "auto";
        case SolverChoice::direct:
            return "direct";
        case SolverChoice::iterative:
            return "iterative";
    }
    return "";
}

}  // namespace curvewright
