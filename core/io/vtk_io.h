#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/mesh_io.h"
#include "core/io/vtk_grid.h"

namespace curvewright {

/// Reads a VTU or legacy VTK file that lies in memory; `file` is its name, for messages. VTK's part of it is done by
/// another process (vtk_process.h). Throws like read_mesh.
ReadResult read_vtk(std::string text, const std::string& file, MeshFormat format, const TaskContext& context);

/// What of a file is checked before VTK sees it: that it is of the format at all, and some of what VTK takes on trust.
/// Returns what was expected in it, for messages. Throws like read_mesh.
const char* check_vtk_text(std::string_view text, const std::string& file, MeshFormat format);

/// The mesh in the answer of that process (vtk_answer.h), which must begin at a multiple of 8 bytes. order: of the nodes
/// of its Lagrange hexahedra. Throws like read_mesh.
ReadResult mesh_of_vtk_answer(std::span<std::byte> answer, const std::string& file, MeshFormat format,
                              HexahedronOrder order = HexahedronOrder::vtk9);

/// The mesh as VTU or legacy VTK, ready to be written; `target` is the file's name, for messages. Adds to the notes
/// what write_mesh returns. Throws like write_mesh.
std::string vtk_text(const std::string& target, const CurvedMesh& mesh, MeshFormat format, const WriteOptions& options,
                     std::vector<std::string>& notes);

}  // namespace curvewright
