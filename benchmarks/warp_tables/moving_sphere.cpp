#include <limits>

#include "benchmarks/cases/reference.h"
#include "benchmarks/warp_tables/measure.h"
#include "benchmarks/warp_tables/measurements.h"
#include "core/quality/quality.h"

namespace curvewright::benchmarks {

void measure_moving_sphere(const Settings& settings, Report& report) {
    WarpCase problem = moving_sphere_case(settings);
    Table table{
        "moving_sphere",
        "Moving sphere",
        "The sample: cubic tetrahedra around a sphere that moves by 30 % of its radius. Columns as above; affine "
        "and convex weights also by the thesis's choice, in which all neighbours count alike. The last column is the "
        "least scaled Jacobian of the result.",
        {"weights", "influence", "interior nodes", "neighbours, s", "weights, s", "solve, s", "rest, s", "total, s",
         "iterations", "residual", "SparseLU, s", "ratio", "difference", "least scaled Jacobian"},
        {}};
    const WarpOptions defaults;
    for (const Weighting weighting : {Weighting::convex, Weighting::affine, Weighting::elastic})
        for (const bool is_thesis : {false, true}) {
            const bool is_elastic = weighting == Weighting::elastic;
            if (is_elastic && is_thesis) continue;
            tell(fmt::format("{}: {}", problem.name, to_string(weighting)));
            problem.options.weighting = weighting;
            problem.options.distance_power = is_thesis ? 0.0 : defaults.distance_power;
            problem.options.sharing_power = is_thesis ? 0.0 : defaults.sharing_power;
            const TimedWarp timed = best_of([&] { return timed_warp(problem); });
            const WarpReport& r = timed.result.report;
            const QualityReport quality = assess_quality(problem.mesh.with_coordinates(timed.result.coordinates));
            Cell reference_seconds, ratio, difference;
            const bool has_reference =
                weighting == Weighting::convex && !is_thesis && settings.runs_reference(3, r.interior_nodes);
            double reference = 0.0;
            if (has_reference) {
                tell("  SparseLU with COLAMD");
                const ReferenceSolve solve = solve_by_sparse_lu(problem, timed.result.coordinates);
                reference = solve.seconds;
                reference_seconds = reference;
                ratio = reference / timed.remaining_seconds();
                difference = formatted(solve.difference, "{:.1e}");
            }
            table.add({to_string(weighting),
                       is_elastic  ? ""
                       : is_thesis ? "thesis"
                                   : "default",
                       r.interior_nodes, r.neighbours_seconds, r.weights_seconds, r.solve_seconds,
                       timed.remaining_seconds() - r.solve_seconds, timed.seconds, r.iterations,
                       formatted(r.residual, "{:.1e}"), reference_seconds, ratio, difference,
                       formatted(quality.summary.min, "{:.3f}")});
            if (settings.is_quick || is_thesis || weighting == Weighting::affine) continue;
            const double promised = is_elastic ? 10.0 : 1.5;
            std::string measured = fmt::format("{:.2f} s", timed.seconds);
            if (has_reference) measured += fmt::format(" (SparseLU {:.0f} s)", reference);
            report.add(Target{fmt::format("moving sphere, {} interior nodes, {}: whole warp",
                                          Cell(r.interior_nodes).shown, to_string(weighting)),
                              fmt::format("≤ {:g} s", promised), measured, timed.seconds <= promised});
        }
    report.add(table);
}

}  // namespace curvewright::benchmarks
