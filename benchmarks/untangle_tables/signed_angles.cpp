#include "core/untangle/signed_angles.h"

#include "benchmarks/cases/timed.h"
#include "benchmarks/untangle_tables/measurements.h"

namespace curvewright::benchmarks {
namespace {

struct BestBeta {
    double beta = 0.0, min = -1e300;
    Index invalid = 0;
};

/// The beta, the same for all edges, with the fewest invalid elements and then the highest minimum.
BestBeta best_beta(const UntangleCase& problem, DisplacementUnit unit) {
    BestBeta best;
    for (double beta : {0.9, 0.7, 0.5, 0.3, 0.1, 0.06, 0.03, 0.01, 0.003, 0.001, 1e-4, 1e-5}) {
        SignedAngleOptions options;
        options.beta = beta;
        options.displacement = unit;
        const Judgement result = judge(problem, untangle_signed_angles(problem.mesh, options).coordinates);
        if (best.beta == 0.0 || result.invalid < best.invalid ||
            (result.invalid == best.invalid && result.min > best.min))
            best = {beta, result.min, result.invalid};
    }
    return best;
}

}  // namespace

void measure_signed_angles(const Settings& settings, Report& report) {
    Table table{
        "untangle_signed_angles",
        "Signed angles",
        "Literal: Algorithm 6 with the displacement in the mesh's unit; normalised: in edge lengths. Both with the "
        "best of twelve beta between .9 and 1e-5, the same for all edges. Auto: beta chosen edge by edge.",
        {"case", "chapter", "P", "elements", "thesis, least", "literal, beta", "literal, invalid", "literal, least",
         "normalised, beta", "normalised, invalid", "normalised, least", "auto, invalid", "auto, least", "auto, mean",
         "auto, worst shape", "auto, s"},
        {}};
    int cases = 0, valid = 0, above_single = 0, above_thesis = 0;
    std::string times;
    bool is_quick_enough = true;
    for (const ThesisCase& entry : thesis_cases(settings)) {
        tell("signed angles: " + entry.name);
        const UntangleCase problem = load_case(settings, entry.name);
        const BestBeta literal = best_beta(problem, DisplacementUnit::mesh_unit);
        const BestBeta normalised = best_beta(problem, DisplacementUnit::edge_length);
        const auto automatic = best_of([&] {
            SignedAngleOptions options;
            options.beta_choice = BetaChoice::automatic;
            return timed([&] { return untangle_signed_angles(problem.mesh, options); });
        });
        const Judgement result = judge(problem, automatic.result.coordinates);
        table.add({entry.name, entry.chapter, problem.mesh.topology().order(), problem.mesh.topology().element_count(),
                   entry.chapter == 4 ? Cell(entry.minimum) : Cell(), formatted(literal.beta, "{:g}"), literal.invalid,
                   literal.min, formatted(normalised.beta, "{:g}"), normalised.invalid, normalised.min, result.invalid,
                   result.min, result.mean, result.shape_min, automatic.seconds});
        if (entry.chapter != 4) continue;
        ++cases;
        valid += result.invalid == 0;
        above_single += result.min >= std::max(literal.min, normalised.min) - 5e-4;
        above_thesis += result.min >= entry.minimum;
        if (entry.name == "brake_rotor" || entry.name == "bl_airfoil") {
            times += fmt::format("{}{} {:.3f} s", times.empty() ? "" : ", ", entry.name, automatic.seconds);
            is_quick_enough = is_quick_enough && automatic.seconds < 0.5;
        }
    }
    report.add(table);
    const auto share = [&](int count) { return fmt::format("{} of {}", count, cases); };
    report.add({"signed angles, beta auto: chapter 4 certified valid", "all cases", share(valid), valid == cases});
    report.add({"signed angles, beta auto: least scaled Jacobian", "at least the best single beta's (to 5e-4)",
                share(above_single), above_single == cases});
    report.add({"signed angles, beta auto: least scaled Jacobian", "at least the thesis's, where a case allows",
                share(above_thesis), above_thesis == cases});
    if (!times.empty()) report.add({"signed angles, beta auto: time", "< 0.5 s", times, is_quick_enough});
}

}  // namespace curvewright::benchmarks
