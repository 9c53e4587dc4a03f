#include <array>

#include <sys/wait.h>
#include <unistd.h>

#include "benchmarks/warp_tables/measure.h"
#include "benchmarks/warp_tables/measurements.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"

namespace curvewright::benchmarks {
namespace {

struct Measured {
    Index elements = 0, nodes = 0, interior_nodes = 0;
    int iterations = 0;
    double read_seconds = 0.0, seconds = 0.0, neighbours_seconds = 0.0, weights_seconds = 0.0, solve_seconds = 0.0;
    double residual = 0.0;
    double start_mb = 0.0, peak_mb = 0.0;  ///< resident memory: peak before and after the warp
};

Measured measure(const Settings& settings, Weighting weighting) {
    set_thread_count(settings.threads);
    const Stopwatch reading;
    WarpCase problem = family_case(settings, 2, settings.million_level(), 3);
    problem.options.weighting = weighting;
    Measured measured;
    measured.read_seconds = reading.seconds();
    measured.start_mb = peak_memory_mb();
    const TimedWarp timed = timed_warp(problem);
    const WarpReport& report = timed.result.report;
    measured.peak_mb = peak_memory_mb();
    measured.elements = problem.mesh.topology().element_count();
    measured.nodes = problem.mesh.topology().node_count();
    measured.interior_nodes = report.interior_nodes;
    measured.iterations = report.iterations;
    measured.residual = report.residual;
    measured.seconds = timed.seconds;
    measured.neighbours_seconds = report.neighbours_seconds;
    measured.weights_seconds = report.weights_seconds;
    measured.solve_seconds = report.solve_seconds;
    return measured;
}

/// Calls measure in a child process, which hands its numbers back through a pipe.
Measured measure_apart(const Settings& settings, Weighting weighting) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw SolverFailure("No pipe can be made.");
    const pid_t child = fork();
    if (child < 0) throw SolverFailure("No process can be started.");
    if (child == 0) {
        int status = 1;
        try {
            const Measured measured = measure(settings, weighting);
            status = write(ends[1], &measured, sizeof measured) == sizeof measured ? 0 : 1;
        } catch (const std::exception& error) {
            tell(error.what());
        }
        _exit(status);
    }
    close(ends[1]);
    Measured measured;
    const bool is_complete = read(ends[0], &measured, sizeof measured) == sizeof measured;
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (!is_complete || status != 0) throw SolverFailure("The warp of a million nodes failed.");
    return measured;
}

}  // namespace

void measure_million(const Settings& settings, Report& report) {
    Table table{
        "million",
        "A million nodes",
        "The unit disc with cubic triangles, in a process of its own. Total: the wall clock of the warp, everything "
        "included; \"rest\" is numbering, condensation and the way back to the mesh. Peak: resident memory of the "
        "process, mesh and reading included; \"before\" is the peak when the warp begins.",
        {"weights", "triangles", "nodes", "interior nodes", "read and raise, s", "neighbours, s", "weights, s",
         "solve, s", "rest, s", "total, s", "iterations", "residual", "before, MB", "peak, MB"},
        {}};
    for (const Weighting weighting : {Weighting::convex, Weighting::affine, Weighting::elastic}) {
        tell(fmt::format("million: {}", to_string(weighting)));
        const Measured m = measure_apart(settings, weighting);
        table.add({to_string(weighting), m.elements, m.nodes, m.interior_nodes, m.read_seconds, m.neighbours_seconds,
                   m.weights_seconds, m.solve_seconds,
                   m.seconds - m.neighbours_seconds - m.weights_seconds - m.solve_seconds, m.seconds, m.iterations,
                   formatted(m.residual, "{:.1e}"), formatted(m.start_mb, "{:.0f}"), formatted(m.peak_mb, "{:.0f}")});
        if (weighting != Weighting::convex || settings.is_quick) continue;
        report.add(Target{fmt::format("{} interior nodes (2D, P3), convex: time", Cell(m.interior_nodes).shown),
                          "≤ 10 s", fmt::format("{:.2f} s", m.seconds), m.seconds <= 10.0});
        report.add(Target{"the same: peak of memory", "≤ 4 GB", fmt::format("{:.2f} GB", m.peak_mb * 1.048576e-3),
                          m.peak_mb * 1.048576 <= 4000.0});
    }
    report.add(table);
}

}  // namespace curvewright::benchmarks
