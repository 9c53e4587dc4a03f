#pragma once

#include <string>
#include <string_view>

#include "core/io/mesh_io.h"

namespace curvewright {

/// Reads an ASCII MSH text (4.1, 4.0, 2.x). `file` is for messages only. Throws like read_mesh.
ReadResult read_msh(std::string_view text, const std::string& file, const TaskContext& context);

/// The mesh as MSH 4.1 ASCII: runs of nodes of one entity and runs of elements keep their order. Elements and nodes
/// without entity are put on one that is made for them. Throws Unsupported for types that Gmsh does not have and for
/// group names that MSH cannot hold. provenance becomes a section $Comments; null = none.
std::string msh4_text(const CurvedMesh& mesh, const Provenance* provenance = nullptr);

/// The mesh as MSH 2.2 ASCII. An element in several physical groups stands once per group, with the same tag each time.
/// The classification of nodes and entities without elements have no place in the format. Throws like msh4_text.
std::string msh2_text(const CurvedMesh& mesh, const Provenance* provenance = nullptr);

/// The sections $NodeData and $ElementData of arrays, for both versions. Values that are missing are left out. MSH
/// knows rows of 1, 3 and 9 numbers: two become three, others arrays of their components, of which notes tell.
std::string msh_data_text(const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                          std::vector<std::string>& notes);

}  // namespace curvewright
