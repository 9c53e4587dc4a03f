#pragma once

#include <filesystem>
#include <optional>

#include "core/io/mesh_io.h"

namespace curvewright {

/// Looks for places where the elements of a mesh that was read touch without being connected, and connects what it may:
/// - tolerance given: nodes closer than that, relative to the diagonal of the mesh's box, are merged. Throws
///   InvalidInput that names an element which would get the same node twice.
/// - not given: nodes at one place are merged if no two elements share a node (files of discontinuous methods, where
///   every cell has its own points), and are only told otherwise, since they may be a slit.
/// Hanging nodes and neighbours of different orders are told; require_conforming refuses them. Bodies that touch are
/// told. Arrays follow. What was
/// done and found is added to the notes. The result does not depend on the number of threads. Throws Cancelled.
void match_nodes(ReadResult& read, std::optional<double> tolerance = {}, const TaskContext& context = {});

/// read_mesh, then match_nodes: what programs that work on meshes open. Throws like both.
ReadResult read_matched_mesh(const std::filesystem::path& file, std::optional<double> tolerance = {},
                             const TaskContext& context = {});

}  // namespace curvewright
