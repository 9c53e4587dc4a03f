#pragma once

#include <filesystem>

#include <QString>

#include "core/base/task.h"
#include "ui/document/mesh_document.h"

namespace curvewright {

/// Certifies a mesh; one whose elements cannot be assessed is shown without quality, with the reason. What became of
/// another state of the same mesh is judged with that state's orientation: turned inside out is not valid. Throws
/// Cancelled.
MeshState make_state(CurvedMesh mesh, const TaskContext& context, const MeshState* origin = nullptr);

inline std::filesystem::path to_path(const QString& path) {
    return {path.toStdU16String()};
}

/// A part of a longer task: from `begin` to `end` of it, told as "title: phase".
TaskContext part_of(const TaskContext& context, const QString& title, double begin, double end);

}  // namespace curvewright
