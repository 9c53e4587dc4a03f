#pragma once

#include <optional>

#include "core/base/task.h"
#include "ui/document/mesh_document.h"

namespace curvewright {

/// A document that is had again, with its history.
struct RestoredWork {
    OpenedMesh opened;
    KeptHistory history;
    std::optional<LoadedDeformation> deformation;
    QString remark;            ///< what is not as it was; "" = everything is
    quint64 intact_bytes = 0;  ///< of the journal that are in here
    quint32 records = 0;       ///< in them
};

/// What a journal has kept, bit for bit, with every state certified anew. Throws InvalidInput if the journal is damaged
/// at its beginning or the mesh file is gone or another one, and Cancelled.
RestoredWork read_lost_work(const QString& journal_path, const TaskContext& context);

/// Does a session again: the steps that are part of its history at the end (what was undone and done otherwise is left
/// out). Throws InvalidInput for what is no session or cannot be done, what the operations throw, and Cancelled.
RestoredWork redo_session(const QString& session_path, const TaskContext& context);

}  // namespace curvewright
