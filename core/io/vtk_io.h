#pragma once

#include <filesystem>
#include <string>

#include "core/io/mesh_io.h"

namespace curvewright {

/// Reads a VTU or legacy VTK file that lies in memory; `file` is its name, for messages. Throws like read_mesh.
ReadResult read_vtk(std::string text, const std::string& file, MeshFormat format, const TaskContext& context);

/// Writes VTU or legacy VTK to `path`; `target` is the name for messages. Adds to the notes what write_mesh returns.
/// Throws like write_mesh.
void write_vtk(const std::filesystem::path& path, const std::string& target, const CurvedMesh& mesh, MeshFormat format,
               const WriteOptions& options, std::vector<std::string>& notes);

}  // namespace curvewright
