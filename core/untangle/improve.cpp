#include "core/untangle/improve.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/mesh/conformity.h"
#include "core/mesh/renumbering.h"
#include "core/quality/quality.h"
#include "core/untangle/improvement.h"
#include "core/untangle/patch_work.h"

namespace curvewright {
namespace {

void check(const ImproveOptions& options) {
    if (!(options.target > 0.0 && options.target <= 1.0))
        throw InvalidInput(fmt::format("The target is {}; it must be above 0 and at most 1.", options.target));
    if (options.max_move && !(*options.max_move > 0.0 && *options.max_move <= 1.0))
        throw InvalidInput(fmt::format("The largest move is {} of the mesh's size; it must be above 0 and at most 1.",
                                       *options.max_move));
    if (options.layers < 1)
        throw InvalidInput(
            fmt::format("There are {} layers around the elements; at least 1 is needed.", options.layers));
    if (!(options.improve_work > 0.0))
        throw InvalidInput(fmt::format("The work of improving is {}; it must be above 0.", options.improve_work));
    if (!(options.shape_weight > 0.0 && options.shape_weight <= 100.0))
        throw InvalidInput(
            fmt::format("The shape weight is {}; it must be above 0 and at most 100.", options.shape_weight));
    if (!(options.mean_weight >= 0.0 && options.mean_weight <= 100.0))
        throw InvalidInput(fmt::format("The mean weight is {}; it must be from 0 to 100.", options.mean_weight));
    if (!(options.shape_floor >= 0.0 && options.shape_floor < 1.0))
        throw InvalidInput(
            fmt::format("The shape floor is {}; it must be at least 0 and below 1.", options.shape_floor));
}

ImprovementOptions improvement_options(const ImproveOptions& options) {
    ImprovementOptions result;
    result.goal = options.goal;
    result.target = options.target;
    result.layers = options.layers;
    result.work = options.improve_work;
    result.shape_weight = options.shape_weight;
    result.mean_weight = options.mean_weight;
    result.shape_floor = options.shape_floor;
    result.is_thorough = true;
    return result;
}

void require_valid(const std::vector<ElementQuality>& qualities) {
    const auto count = [&](Validity validity) {
        return std::count_if(qualities.begin(), qualities.end(), [&](const auto& q) { return q.validity == validity; });
    };
    const auto invalid = count(Validity::invalid), undecided = count(Validity::undecided);
    if (invalid == 0 && undecided == 0) return;
    const auto counted = [](auto number, const char* what) {
        return fmt::format("{} {} element{}", number, what, number == 1 ? "" : "s");
    };
    std::string what = invalid > 0 ? counted(invalid, "tangled") : counted(undecided, "undecided");
    if (invalid > 0 && undecided > 0) what += " and " + counted(undecided, "undecided");
    throw InvalidInput(fmt::format("The mesh has {}, and only a valid mesh can be improved; untangle it first.", what));
}

}  // namespace

double mesh_size(const CurvedMesh& mesh) {
    const Coordinates& x = mesh.coordinates();
    return x.rows() > 0 ? (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm() : 0.0;
}

ImproveResult improve(const CurvedMesh& mesh, const ImproveOptions& options, UntangleObserver* observer,
                      const TaskContext& context) {
    check(options);
    require_assessable(mesh);
    require_conforming(mesh, context);
    const NumberedAlike alike(mesh);
    GivenNumbering given(mesh, observer);
    PatchWork work(alike.mesh(), options.boundary, options.nodes, given.listener(), context);
    ImproveResult result;
    work.tell(untangle_event::Started{&alike.mesh()});
    try {
        work.assess();
        require_valid(work.state().qualities);
        if (options.max_move) work.set_move_limit(*options.max_move * mesh_size(mesh));
        Improvement(work, improvement_options(options)).run();
    } catch (const Cancelled&) {
        if (!options.keeps_best_on_cancel) throw;
        result.reason = StopReason::cancelled;
    }
    if (const BoundaryShape* boundary = work.boundary()) {
        result.sliding_nodes = boundary->sliding_nodes();
        result.free_nodes = boundary->free_nodes();
        result.largest_boundary_distance = boundary->largest_distance(work.state().coordinates);
    }
    result.coordinates = std::move(work.state().coordinates);
    if (result.coordinates.rows() > 0)
        result.largest_move = (result.coordinates - mesh.coordinates()).rowwise().norm().maxCoeff();
    work.tell(untangle_event::Finished{result.reason, work.pass()});
    return result;
}

}  // namespace curvewright
