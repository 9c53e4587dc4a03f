#pragma once

#include <filesystem>
#include <string>

#include "core/base/task.h"
#include "core/deform/deformation.h"

namespace curvewright {

/// Reads a deformation: .json (operations), .csv (node table with header tag,x,y,z), or a mesh (its nodes' positions).
/// Throws InvalidInput that names the file, the line or the operation, what is wrong and what was expected.
Deformation read_deformation(const std::filesystem::path& file, const TaskContext& context = {});

/// The same of a text: operations, or a node table (is_table). file: its name, for messages.
Deformation parse_deformation(const std::string& text, const std::string& file, bool is_table);

}  // namespace curvewright
