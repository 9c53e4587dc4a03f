#pragma once

#include <string>
#include <utility>

namespace curvewright::benchmarks {

/// Calls run, which returns something with a member `seconds`, several times and returns the quickest: once if it takes
/// more than ten seconds, otherwise 3 to 20 times until three seconds are spent.
template <class Run>
auto best_of(const Run& run) {
    auto best = run();
    double spent = best.seconds;
    for (int i = 1; (i < 3 && spent < 10.0) || (i < 20 && spent < 3.0); ++i) {
        auto next = run();
        spent += next.seconds;
        if (next.seconds < best.seconds) best = std::move(next);
    }
    return best;
}

/// A line on standard error.
void tell(const std::string& line);

}  // namespace curvewright::benchmarks
