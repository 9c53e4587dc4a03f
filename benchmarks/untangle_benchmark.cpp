// Signed angles by mesh size.

#include <benchmark/benchmark.h>

#include "core/untangle/signed_angles.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

void signed_angles(benchmark::State& state) {
    std::mt19937 random(1);
    const int n = static_cast<int>(state.range(0));
    const CurvedMesh mesh = testing::shaken(testing::square_mesh(n, 3), 0.05 / n, random);
    SignedAngleOptions options;
    options.max_passes = 1;
    for (auto _ : state) benchmark::DoNotOptimize(untangle_signed_angles(mesh, options));
    state.SetItemsProcessed(state.iterations() * mesh.topology().element_count());
}
BENCHMARK(signed_angles)->RangeMultiplier(2)->Range(8, 32)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace curvewright
