#include "core/untangle/unsigned_angles.h"

#include "benchmarks/cases/timed.h"
#include "benchmarks/untangle_tables/measurements.h"

namespace curvewright::benchmarks {

void measure_unsigned_angles(const Settings& settings, Report& report) {
    Table table{
        "untangle_unsigned_angles",
        "Unsigned angles",
        "Literal: Algorithms 4 and 5, BFGS with central differences. Default: exact gradients, several starts and "
        "first steps, face nodes follow, moves are kept only where the least certified scaled Jacobian around the "
        "edge rises. On its own meshes the thesis reports what stands in its column.",
        {"case", "chapter", "P", "elements", "invalid at the start", "least at the start", "thesis, least",
         "literal, invalid", "literal, least", "literal, s", "invalid", "least", "mean", "worst shape", "s", "wanted"},
        {}};
    int cases = 0, met = 0, valid = 0, all = 0;
    for (const ThesisCase& entry : thesis_cases(settings)) {
        tell("unsigned angles: " + entry.name);
        const UntangleCase problem = load_case(settings, entry.name);
        const Judgement start = judge(problem, problem.mesh.coordinates());
        const auto run = [&](const UnsignedAngleOptions& options) {
            return best_of([&] { return timed([&] { return untangle_unsigned_angles(problem.mesh, options); }); });
        };
        const auto literal = run(UnsignedAngleOptions::literal());
        const auto usual = run({});
        const Judgement by_literal = judge(problem, literal.result.coordinates);
        const Judgement by_default = judge(problem, usual.result.coordinates);
        table.add({entry.name, entry.chapter, problem.mesh.topology().order(), problem.mesh.topology().element_count(),
                   start.invalid, start.min, entry.chapter == 3 ? Cell(entry.minimum) : Cell(), by_literal.invalid,
                   by_literal.min, literal.seconds, by_default.invalid, by_default.min, by_default.mean,
                   by_default.shape_min, usual.seconds, entry.wanted ? Cell(*entry.wanted) : Cell()});
        ++all;
        valid += by_default.invalid == 0;
        if (!entry.wanted) continue;
        ++cases;
        met += by_default.invalid == 0 && by_default.min >= *entry.wanted;
    }
    report.add(table);
    report.add({"unsigned angles, default: certified valid", "as many as can be", fmt::format("{} of {}", valid, all),
                valid == all});
    if (cases)
        report.add({"unsigned angles: mech_ch3, plate2, plate2_p2, beam", "≥ .14, .08, .30, .11",
                    fmt::format("{} of {}", met, cases), met == cases});
}

}  // namespace curvewright::benchmarks
