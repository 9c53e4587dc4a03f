#pragma once

#include <string>
#include <vector>

#include "core/io/mesh_io.h"

namespace curvewright {

/// Reads a VTU or legacy VTK file that lies in memory; `file` is its name, for messages. Throws like read_mesh.
ReadResult read_vtk(std::string text, const std::string& file, MeshFormat format, const TaskContext& context);

/// The mesh as VTU or legacy VTK, ready to be written; `target` is the file's name, for messages. Adds to the notes
/// what write_mesh returns. Throws like write_mesh.
std::string vtk_text(const std::string& target, const CurvedMesh& mesh, MeshFormat format, const WriteOptions& options,
                     std::vector<std::string>& notes);

}  // namespace curvewright
