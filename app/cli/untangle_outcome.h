#pragma once

#include <string>

#include "app/cli/output.h"
#include "core/report/untangle_run.h"

namespace curvewright::cli {

/// What an untangling has to say about itself, for --json: "method" and what goes with it.
Json run_json(const MeshTopology& topology, const UntangleOptions& options, const std::string& warped_first,
              const UntangleRun& run);
/// The same in lines for people. timings: in seconds by name.
std::string run_text(const UntangleOptions& options, const UntangleRun& run, const Json& timings);
/// Notes which elements were not mended and why; of many the first.
void note_unmended(const MeshTopology& topology, const UntangleRun& run, Work& work);

}  // namespace curvewright::cli
