#pragma once

#include "benchmarks/thesis/peers.h"
#include "benchmarks/thesis/settings.h"
#include "benchmarks/thesis/thesis_report.h"

namespace curvewright::benchmarks {

/// Figure 2.1: where the matrix of the third example has entries, before and after reordering.
void measure_sparsity(const Settings& settings, ThesisReport& report);
/// Tables 2.1 and 2.2: counts of the families.
void count_families(const Settings& settings, ThesisReport& report);
/// Figures 2.2 and 2.3: times of the families.
void measure_families(const Settings& settings, ThesisReport& report);
/// Tables 2.3, 2.4 and 2.5: the warps.
void measure_warps(const Settings& settings, const Peers& peers, ThesisReport& report);
/// Table 3.1 and figures 3.4 to 3.9: untangling by unsigned angles.
void measure_unsigned_angles(const Settings& settings, const Peers& peers, ThesisReport& report);
/// Table 4.1 and figures 4.6 to 4.12: untangling by signed angles.
void measure_signed_angles(const Settings& settings, const Peers& peers, ThesisReport& report);
/// Figure 4.2: one run of the simplex method.
void measure_convergence(const Settings& settings, ThesisReport& report);

}  // namespace curvewright::benchmarks
