#include "benchmarks/untangle_tables/cases.h"

#include <vector>

namespace curvewright::benchmarks {
namespace {

const std::vector<ThesisCase> all_cases{
    {"annulus", 4, 0.472, {}},        {"mech_ch4", 4, 0.228, {}}, {"bike_gear", 4, 0.211, {}},
    {"pressure_plate", 4, 0.345, {}}, {"gear", 4, 0.092, {}},     {"brake_rotor", 4, 0.346, {}},
    {"bl_airfoil", 4, 0.053, {}},     {"naca_le", 3, 0.05, {}},   {"mech_ch3", 3, 0.008, 0.14},
    {"plate1", 3, 0.027, {}},         {"plate2", 3, 0.042, 0.08}, {"plate2_p2", 3, 0.042, 0.30},
    {"beam", 3, 0.032, 0.11},
};

}  // namespace

std::span<const ThesisCase> thesis_cases(const Settings& settings) {
    const std::span<const ThesisCase> cases(all_cases);
    return settings.is_quick ? cases.first(2) : cases;
}

}  // namespace curvewright::benchmarks
