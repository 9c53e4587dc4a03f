// One frame of a drag without rasterising: response, certificates of the elements that move, histogram, tessellation.
// Targets (two threads): 20,000 P3 triangles 12 ms, 120,000 70 ms; 20,000 P3 tetrahedra positions 10 ms.

#include <cmath>
#include <map>
#include <memory>

#include <benchmark/benchmark.h>

#include "core/edit/drag.h"
#include "core/tessellate/tessellation.h"
#include "tests/support/mesh_factory.h"

namespace {

using namespace curvewright;

struct Subject {
    CurvedMesh mesh;
    std::shared_ptr<const QualityReport> report;
    std::unique_ptr<Drag> drag;
    std::unique_ptr<Tessellation> tessellation;
};

/// A square of 2 n^2 triangles or a cube of 6 n^3 tetrahedra, slightly bent, its lid in hand.
Subject& subject(bool is_solid, int n, int order) {
    static std::map<std::tuple<bool, int, int>, std::unique_ptr<Subject>> subjects;
    auto& entry = subjects[{is_solid, n, order}];
    if (entry) return *entry;
    CurvedMesh mesh = is_solid ? testing::cube_mesh(n, order) : testing::square_mesh(n, order);
    Coordinates x = mesh.coordinates();
    for (Eigen::Index node = 0; node < x.rows(); ++node)
        x(node, 1) += 0.05 * std::sin(2.0 * x(node, 0)) * x(node, 1) / (is_solid ? 4.0 : 1.0);
    mesh = mesh.with_coordinates(x);
    entry = std::make_unique<Subject>(Subject{mesh, nullptr, nullptr, nullptr});
    entry->report = std::make_shared<const QualityReport>(assess_quality(mesh));
    const DraggedSet set{mesh.topology().find_group_nodes(is_solid ? "z1" : "top").value(), {}};
    entry->drag = std::make_unique<Drag>(std::make_shared<const Warper>(mesh), set, ResponseKind::affine,
                                         Eigen::Vector3d(0.5, 0.5, 0.5), mesh, entry->report);
    entry->tessellation = std::make_unique<Tessellation>(mesh);
    return *entry;
}

AffineMotion motion_of(int frame) {
    AffineMotion motion = AffineMotion::rotation(Eigen::Vector3d::UnitZ(), 0.05 * std::sin(0.3 * frame));
    motion.shift = {0.02 * std::sin(0.2 * frame), 0.03 * std::cos(0.17 * frame), 0.0};
    return motion;
}

void positions(benchmark::State& state, bool is_solid, int n, int order) {
    Subject& its = subject(is_solid, n, order);
    int frame = 0;
    for (auto _ : state) {
        its.drag->move(motion_of(frame++));
        its.tessellation->move(its.drag->positions());
    }
    state.counters["elements"] = its.mesh.topology().element_count();
}

void certificates(benchmark::State& state, bool is_solid, int n, int order) {
    Subject& its = subject(is_solid, n, order);
    QualityReport report = *its.report;
    int frame = 0;
    for (auto _ : state) {
        its.drag->move(motion_of(frame++));
        its.drag->certify(its.drag->positions(), report);
        benchmark::DoNotOptimize(make_histogram(report, -1.0, 1.0, 80));
    }
    state.counters["elements"] = its.mesh.topology().element_count();
}

void frame(benchmark::State& state, bool is_solid, int n, int order) {
    Subject& its = subject(is_solid, n, order);
    QualityReport report = *its.report;
    int number = 0;
    for (auto _ : state) {
        its.drag->move(motion_of(number++));
        its.tessellation->move(its.drag->positions());
        its.drag->certify(its.drag->positions(), report);
        benchmark::DoNotOptimize(make_histogram(report, -1.0, 1.0, 80));
    }
    state.counters["elements"] = its.mesh.topology().element_count();
    state.counters["invalid"] = report.summary.invalid;
}

void begin(benchmark::State& state, bool is_solid, int n, int order) {
    Subject& its = subject(is_solid, n, order);
    const auto warper = std::make_shared<const Warper>(its.mesh);
    const DraggedSet set{its.mesh.topology().find_group_nodes(is_solid ? "z1" : "top").value(), {}};
    for (auto _ : state)
        benchmark::DoNotOptimize(
            Drag(warper, set, ResponseKind::translation, Eigen::Vector3d::Zero(), its.mesh, its.report));
}

#define DRAG_BENCHMARKS(name, is_solid, n)                                                               \
    BENCHMARK_CAPTURE(frame, name, is_solid, n, 3)->Unit(benchmark::kMillisecond)->UseRealTime();        \
    BENCHMARK_CAPTURE(positions, name, is_solid, n, 3)->Unit(benchmark::kMillisecond)->UseRealTime();    \
    BENCHMARK_CAPTURE(certificates, name, is_solid, n, 3)->Unit(benchmark::kMillisecond)->UseRealTime(); \
    BENCHMARK_CAPTURE(begin, name, is_solid, n, 3)->Unit(benchmark::kMillisecond)->UseRealTime()

DRAG_BENCHMARKS(P3_triangles_20k, false, 100);
DRAG_BENCHMARKS(P3_triangles_120k, false, 245);
DRAG_BENCHMARKS(P3_tetrahedra_20k, true, 15);

}  // namespace

namespace {

void tessellate_anew(benchmark::State& state, bool is_solid, int n, int order) {
    Subject& its = subject(is_solid, n, order);
    for (auto _ : state) benchmark::DoNotOptimize(Tessellation(its.mesh));
}
void check_fineness(benchmark::State& state, bool is_solid, int n, int order) {
    Subject& its = subject(is_solid, n, order);
    for (auto _ : state) benchmark::DoNotOptimize(its.tessellation->is_fine_enough(its.drag->positions()));
}
BENCHMARK_CAPTURE(tessellate_anew, P3_triangles_20k, false, 100, 3)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(check_fineness, P3_triangles_20k, false, 100, 3)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(tessellate_anew, P3_triangles_120k, false, 245, 3)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(check_fineness, P3_triangles_120k, false, 245, 3)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
