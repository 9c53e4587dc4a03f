// Elements certified per second and core, for elements that need no subdivision and for curved ones.

#include <benchmark/benchmark.h>

#include "core/quality/jacobian_bounds.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

void certify(benchmark::State& state, Shape shape, double amplitude) {
    const ElementType type{shape, static_cast<int>(state.range(0))};
    std::mt19937 random(1);
    std::vector<Eigen::MatrixX3d> elements;
    for (int i = 0; i < 64; ++i) elements.push_back(testing::random_element(type, amplitude, random));
    JacobianBounds bounds(type);
    std::size_t next = 0;
    for (auto _ : state) benchmark::DoNotOptimize(bounds.bound(elements[next++ % elements.size()], 1.0, {}));
    state.SetItemsProcessed(state.iterations());
}

void straight_triangles(benchmark::State& state) {
    certify(state, Shape::triangle, 0.0);
}
void curved_triangles(benchmark::State& state) {
    certify(state, Shape::triangle, 0.1);
}
void straight_tetrahedra(benchmark::State& state) {
    certify(state, Shape::tetrahedron, 0.0);
}
void curved_tetrahedra(benchmark::State& state) {
    certify(state, Shape::tetrahedron, 0.1);
}

void affine_quadrilaterals(benchmark::State& state) {
    certify(state, Shape::quadrilateral, 0.0);
}
void curved_quadrilaterals(benchmark::State& state) {
    certify(state, Shape::quadrilateral, 0.1);
}
void affine_hexahedra(benchmark::State& state) {
    certify(state, Shape::hexahedron, 0.0);
}
void curved_hexahedra(benchmark::State& state) {
    certify(state, Shape::hexahedron, 0.1);
}
void affine_prisms(benchmark::State& state) {
    certify(state, Shape::prism, 0.0);
}
void curved_prisms(benchmark::State& state) {
    certify(state, Shape::prism, 0.1);
}

BENCHMARK(straight_triangles)->DenseRange(1, 6)->Arg(10);
BENCHMARK(curved_triangles)->DenseRange(2, 6);
BENCHMARK(straight_tetrahedra)->DenseRange(1, 4)->Arg(6);
BENCHMARK(curved_tetrahedra)->DenseRange(2, 4);
BENCHMARK(affine_quadrilaterals)->DenseRange(1, 4)->Arg(6);
BENCHMARK(curved_quadrilaterals)->DenseRange(1, 4);
BENCHMARK(affine_hexahedra)->DenseRange(1, 4);
BENCHMARK(curved_hexahedra)->DenseRange(1, 3);
BENCHMARK(affine_prisms)->DenseRange(1, 4);
BENCHMARK(curved_prisms)->DenseRange(1, 3);

}  // namespace
}  // namespace curvewright
