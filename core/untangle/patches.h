#pragma once

#include <functional>
#include <vector>

#include "core/mesh/node_elements.h"
#include "core/untangle/distortion.h"

namespace curvewright {

/// The elements within some layers of the seeds, cut into patches that share no element, each with the nodes of it that
/// may move and have all of their elements in it. Patches without such nodes are left out. Elements that is_blocked
/// names (none if empty) are in no patch, so that their nodes stay.
std::vector<FreePatch> make_patches(const MeshTopology& topology, const NodeElements& node_elements,
                                    const std::vector<Index>& seeds, int layers,
                                    const std::function<bool(Index node)>& may_move,
                                    const std::function<bool(Index element)>& is_blocked = {});

}  // namespace curvewright
