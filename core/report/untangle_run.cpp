#include "core/report/untangle_run.h"

#include "core/base/stopwatch.h"

namespace curvewright {
namespace {

UntangleRun run(const CurvedMesh& mesh, const GuaranteedOptions& options, UntangleObserver* observer,
                const TaskContext& context) {
    GuaranteedResult result = untangle_guaranteed(mesh, options, observer, context);
    UntangleRun run;
    run.reason = result.reason;
    run.rounds = result.rounds;
    run.unmended = std::move(result.unmended);
    run.sliding_nodes = result.sliding_nodes;
    run.free_nodes = result.free_nodes;
    run.largest_boundary_distance = result.largest_boundary_distance;
    run.timings = {{"untangle", result.valid_seconds}, {"improve", result.improve_seconds}};
    run.coordinates = std::move(result.coordinates);
    return run;
}

UntangleRun in_passes(const auto& untangle) {
    const Stopwatch watch;
    UntangleResult result = untangle();
    UntangleRun run;
    run.reason = result.reason;
    run.passes = result.passes;
    run.timings = {{"untangle", watch.seconds()}};
    run.coordinates = std::move(result.coordinates);
    return run;
}

UntangleRun run(const CurvedMesh& mesh, const SignedAngleOptions& options, UntangleObserver* observer,
                const TaskContext& context) {
    return in_passes([&] { return untangle_signed_angles(mesh, options, observer, context); });
}

UntangleRun run(const CurvedMesh& mesh, const UnsignedAngleOptions& options, UntangleObserver* observer,
                const TaskContext& context) {
    return in_passes([&] { return untangle_unsigned_angles(mesh, options, observer, context); });
}

}  // namespace

UntangleRun run_untangling(const CurvedMesh& mesh, const UntangleOptions& options, UntangleObserver* observer,
                           const TaskContext& context) {
    return std::visit([&](const auto& of_method) { return run(mesh, of_method, observer, context); }, options);
}

}  // namespace curvewright
