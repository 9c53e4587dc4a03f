#pragma once

#include <string>
#include <utility>

namespace curvewright::benchmarks {

/// How often something is measured: once if that takes more than `once_above` seconds, otherwise 3 to 20 times until
/// `enough` seconds are spent.
struct Repeats {
    double once_above = 10.0, enough = 3.0;
};

/// Calls run, which returns something with a member `seconds`, several times and returns the quickest.
template <class Run>
auto best_of(const Run& run, const Repeats& repeats = {}) {
    auto best = run();
    double spent = best.seconds;
    for (int i = 1; (i < 3 && spent < repeats.once_above) || (i < 20 && spent < repeats.enough); ++i) {
        auto next = run();
        spent += next.seconds;
        if (next.seconds < best.seconds) best = std::move(next);
    }
    return best;
}

/// A line on standard error.
void tell(const std::string& line);

}  // namespace curvewright::benchmarks
