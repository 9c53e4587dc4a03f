#pragma once

#include <iosfwd>
#include <string>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/untangle/observer.h"

namespace curvewright {

/// Reads what a TraceWriter wrote and tells the observer every event, Started with the mesh as the trace has it: with
/// the trace's positions, whatever those of the mesh given are. mesh: of the same nodes and elements. Throws
/// InvalidInput (name:line) if a line is no event, names nodes or elements that the mesh does not have, or does not fit
/// what came before; Cancelled. A trace that ends early, because its writer was stopped, is read as far as it goes.
void read_trace(std::istream& stream, const std::string& name, const CurvedMesh& mesh, UntangleObserver& observer,
                const TaskContext& context = {});

}  // namespace curvewright
