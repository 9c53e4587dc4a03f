// Phases of a warp by mesh size: neighbours, weights, solve.

#include <benchmark/benchmark.h>

#include "core/warp/warp.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

void warp_mesh(benchmark::State& state, const CurvedMesh& mesh) {
    Coordinates target = mesh.coordinates();
    for (Index node : mesh.topology().boundary_nodes()) target(node, 0) += 0.1 * target(node, 1) * target(node, 1);
    WarpReport report;
    double neighbours = 0.0, weights = 0.0, solve = 0.0;
    for (auto _ : state) {
        report = warp(mesh, target).report;
        neighbours += report.neighbours_seconds;
        weights += report.weights_seconds;
        solve += report.solve_seconds;
    }
    const auto runs = static_cast<double>(state.iterations());
    state.counters["nodes"] = report.interior_nodes;
    state.counters["iterations"] = report.iterations;
    state.counters["neighbours_ms"] = 1e3 * neighbours / runs;
    state.counters["weights_ms"] = 1e3 * weights / runs;
    state.counters["solve_ms"] = 1e3 * solve / runs;
}

void warp_triangles_p3(benchmark::State& state) {
    warp_mesh(state, testing::square_mesh(static_cast<int>(state.range(0)), 3));
}
void warp_tetrahedra_p3(benchmark::State& state) {
    warp_mesh(state, testing::cube_mesh(static_cast<int>(state.range(0)), 3));
}

BENCHMARK(warp_triangles_p3)->RangeMultiplier(2)->Range(8, 64)->Unit(benchmark::kMillisecond);
BENCHMARK(warp_tetrahedra_p3)->DenseRange(4, 12, 4)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace curvewright
