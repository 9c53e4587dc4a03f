#include <algorithm>
#include <cmath>

#include "benchmarks/warp_tables/measure.h"
#include "benchmarks/warp_tables/measurements.h"
#include "core/base/stopwatch.h"
#include "core/warp/response.h"

namespace curvewright::benchmarks {
namespace {

/// Half of the boundary.
DraggedSet dragged_half(const CurvedMesh& mesh) {
    DraggedSet set;
    for (const Index node : mesh.topology().boundary_nodes())
        if (mesh.coordinates()(node, 0) > 0.0) set.nodes.push_back(node);
    return set;
}

/// Median of the frames of a drag, in milliseconds. The first frames, which touch memory for the first time, count too.
double frame_milliseconds(const ResponseField& field, const CurvedMesh& mesh, ResponseKind kind) {
    Coordinates result;
    std::vector<double> frames;
    for (int frame = 0; frame < 201; ++frame) {
        const double t = 1e-3 * frame;
        AffineMotion motion = AffineMotion::translation({t, 0.5 * t, 0.0});
        if (kind == ResponseKind::affine) motion.linear = AffineMotion::rotation({0.0, 0.0, 1.0}, t).linear;
        const Stopwatch watch;
        field.apply(motion, mesh.coordinates(), result);
        frames.push_back(1e3 * watch.seconds());
    }
    std::nth_element(frames.begin(), frames.begin() + 100, frames.end());
    return frames[100];
}

}  // namespace

void measure_responses(const Settings& settings, Report& report) {
    Table table{"response",
                "Frames of a drag",
                "Half of the boundary is dragged and every interior node follows. Warper: weights, equations and "
                "preconditioner, once per mesh; field: the solves when a drag begins; frame: median of 201 frames, all "
                "coordinates of the mesh written.",
                {"case", "weights", "motion", "nodes", "moving nodes", "warper, s", "field, s", "frame, ms",
                 "ms per 100,000 moving nodes"},
                {}};
    const std::vector<std::pair<int, int>> meshes = settings.is_quick
                                                        ? std::vector<std::pair<int, int>>{{2, 4}, {3, 3}}
                                                        : std::vector<std::pair<int, int>>{{2, 6}, {3, 5}, {3, 6}};
    for (const Weighting weighting : {Weighting::convex, Weighting::elastic})
        for (const auto kind : {ResponseKind::translation, ResponseKind::affine}) {
            double slowest = 0.0;
            const char* motion = kind == ResponseKind::affine ? "affine" : "translation";
            for (const auto& [dimension, level] : meshes) {
                WarpCase problem = family_case(settings, dimension, level, 3);
                tell(fmt::format("response: {}, {}, {}", problem.name, to_string(weighting), motion));
                problem.options.weighting = weighting;
                Stopwatch watch;
                const Warper warper(problem.mesh, problem.options);
                const double warper_seconds = watch.seconds();
                watch = {};
                const ResponseField field(warper, dragged_half(problem.mesh), kind);
                const double field_seconds = watch.seconds();
                const double frame = frame_milliseconds(field, problem.mesh, kind);
                const auto moving = static_cast<Index>(field.moving_nodes().size());
                const double per_100000 = frame * 1e5 / moving;
                slowest = std::max(slowest, per_100000);
                table.add({problem.name, to_string(weighting), motion, problem.mesh.topology().node_count(), moving,
                           warper_seconds, field_seconds, frame, per_100000});
            }
            report.add(Target{
                fmt::format("frame of a drag for 100,000 nodes, {}, {}: slowest mesh", to_string(weighting), motion),
                "≤ 1 ms", fmt::format("{:.2f} ms", slowest), slowest <= 1.0});
        }
    report.add(table);
}

}  // namespace curvewright::benchmarks
