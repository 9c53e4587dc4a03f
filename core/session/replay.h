#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh/curved_mesh.h"
#include "core/mesh/field_array.h"
#include "core/session/action.h"

namespace curvewright {

/// Does again what a session says. The same coordinates come out as they did at first, for any number of threads.
class Replay {
  public:
    /// folder: where relative file names begin.
    explicit Replay(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

    /// Throws InvalidInput when there is nothing to act on (no mesh opened yet, a history that is not that long), for
    /// files and nodes that do not exist, and whatever the operation throws. The mesh is then as it was before.
    void perform(const Action& action, const TaskContext& context = {});

    bool has_mesh() const { return !history_.empty(); }
    /// pre: has_mesh().
    const CurvedMesh& mesh() const { return history_[position_]; }
    /// As it was opened.
    const CurvedMesh& opened() const { return history_.front(); }
    /// The arrays of the file.
    const std::vector<FieldArray>& fields() const { return fields_; }
    /// What the reader, and the actions since the mesh was opened, had to say: one sentence each.
    const std::vector<std::string>& notes() const { return notes_; }
    /// As it was named.
    const std::string& mesh_file() const { return mesh_file_; }

  private:
    std::filesystem::path resolve(const std::string& file) const;

    std::filesystem::path folder_;
    std::string mesh_file_;
    std::vector<FieldArray> fields_;
    std::vector<std::string> notes_;
    std::vector<CurvedMesh> history_;  ///< states, the opened one first
    std::size_t position_ = 0;
};

/// What an action makes of a mesh; not for OpenAction and HistoryAction. opened: the first mesh of the session.
/// deformation_of: the content of a deformation file. notes: what the action has to say besides is added there, unless
/// null. Throws like Replay::perform.
CurvedMesh perform(const Action& action, const CurvedMesh& mesh, const CurvedMesh& opened,
                   const std::function<Deformation(const std::string& file)>& deformation_of,
                   const TaskContext& context = {}, std::vector<std::string>* notes = nullptr);

}  // namespace curvewright
