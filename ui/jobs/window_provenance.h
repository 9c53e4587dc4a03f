#pragma once

#include <string>
#include <vector>

#include "core/io/provenance.h"
#include "core/session/action.h"

namespace curvewright {

/// Who makes a file that the window writes: the window, with the names of what was done since the mesh was opened.
/// way: the opening first, as MeshDocument::way_here gives it. sha256: of the file that was opened, "" = unknown.
Provenance window_provenance(const std::vector<Action>& way, const std::string& sha256);

}  // namespace curvewright
