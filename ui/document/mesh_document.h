#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QObject>
#include <QString>
#include <QStringList>
#include <QUndoStack>

#include "core/deform/deformation.h"
#include "core/mesh/curved_mesh.h"
#include "core/mesh/field_array.h"
#include "core/quality/quality.h"
#include "core/session/action.h"
#include "ui/document/mesh_text.h"

namespace curvewright {

/// A mesh with its certified quality at one point of the history. Immutable; states share their topology, so a state
/// costs one coordinate array and one report.
struct MeshState {
    std::shared_ptr<const CurvedMesh> mesh;
    /// Report of this very mesh; null if its elements cannot be assessed (see quality_note).
    std::shared_ptr<const QualityReport> quality;
    /// Why there is no report; empty if there is one.
    QString quality_note;
    /// The deformations that were applied on the way from the opened mesh to this state.
    QStringList applied_deformations;
};

/// A mesh as a reader and the quality assessment leave it: what MeshDocument::open takes.
struct OpenedMesh {
    MeshState state;
    QString file_path;
    QStringList notes;  ///< what the reader passed over or repaired
    /// The file's arrays of numbers on nodes and elements; null = none. They go with the mesh through all of its
    /// states.
    std::shared_ptr<const std::vector<FieldArray>> fields;
    /// Of the mesh, where they have been listed before it is opened.
    std::optional<QVector<GroupLine>> groups = {};
};

/// A deformation and the file that it came from.
struct LoadedDeformation {
    std::shared_ptr<const Deformation> deformation;
    QString file_path;
};

/// A history that was had elsewhere: before a crash, or in a session.
struct KeptHistory {
    struct Step {
        QString name, details;
        Action action;
        MeshState state;  ///< after it; what the state before is follows from the order
    };
    std::vector<Step> steps;      ///< those done, and those that can be redone
    int index = 0;                ///< steps done
    int clean_index = 0;          ///< steps done in the state that is saved; -1 = none is
    std::vector<Action> session;  ///< everything that was done, from opening on
    QString saved_path;           ///< file that the document stands for if not the one opened; "" = that one
};

/// The open mesh, its history and the loaded deformation. Qt core (and QtGui's undo stack) only: no widgets, no VTK.
/// All members belong to the window's thread; jobs work on copies of state(), which are immutable.
class MeshDocument : public QObject {
    Q_OBJECT

  public:
    explicit MeshDocument(QObject* parent = nullptr);
    ~MeshDocument() override;

    bool has_mesh() const { return current_.mesh != nullptr; }
    /// The present state; its mesh is null if no mesh is open.
    const MeshState& state() const { return current_; }
    /// The state as the file had it.
    const MeshState& original() const { return original_; }
    /// The state that the last operation started from; the opened one if there is no operation.
    const MeshState& before() const { return before_; }

    /// Full path of the mesh file ("" = none) and its last component.
    const QString& file_path() const { return file_path_; }
    QString file_name() const;
    const QStringList& notes() const { return notes_; }
    /// The arrays of the file; never null.
    const std::shared_ptr<const std::vector<FieldArray>>& fields() const { return fields_; }

    /// The physical groups of the mesh as opened.
    const QVector<GroupLine>& groups() const { return groups_; }

    const std::optional<LoadedDeformation>& deformation() const { return deformation_; }
    /// True if the loaded deformation was already applied on the way to the present state.
    bool is_deformation_applied() const;

    QUndoStack* history() { return &history_; }
    const QUndoStack* history() const { return &history_; }
    bool is_dirty() const { return has_mesh() && !history_.isClean(); }

    /// Replaces everything by a newly read mesh; the history and the deformation start anew.
    void open(OpenedMesh opened);
    /// open(), with a history. pre: the states have as many nodes as the mesh, 0 <= index <= steps,
    /// clean_index <= steps, session begins with the opening.
    void restore(OpenedMesh opened, KeptHistory history);
    /// Back to no mesh.
    void close();
    /// Adds one step to the history: its name, as short as a list needs it, and what else there is to know about it.
    /// pre: has_mesh(), as many nodes as the present mesh.
    /// action: what was done, for the session.
    void apply(const QString& name, MeshState state, Action action, const QString& details = {});
    /// Everything that was done since the mesh was opened, undo and redo included; empty without a mesh.
    const std::vector<Action>& session() const { return session_; }
    /// What leads from the file to the present state, without the ways that were undone; empty without a mesh.
    std::vector<Action> way_here() const;
    /// The state in which so many steps of the history are done; 0 = as opened. pre: 0 <= steps <= history()->count()
    const MeshState& state_at(int steps) const;
    /// What a step of the history (0 = the first after opening) did. pre: there is such a step.
    const Action& step_action(int step) const;
    /// What is to be known about a step of the history (0 = the first after opening); "" = nothing.
    QString step_details(int step) const;
    void set_deformation(LoadedDeformation deformation);
    /// Nothing would be lost with the present state: it is no longer counted as changed.
    void mark_unchanged() { history_.setClean(); }
    /// The present state has been written to file_path.
    void mark_saved(const QString& file_path);

  signals:
    /// Another mesh was opened, or the mesh was closed.
    void opened();
    /// state() or before() is another one than before (also emitted after opened()).
    void state_changed();
    void deformation_changed();
    void dirty_changed(bool is_dirty);
    void file_path_changed();
    /// session() has one action more.
    void recorded(const Action& action);

  private:
    class StateCommand;

    void replace(OpenedMesh opened);
    void read_history();
    void follow_history();
    void record(Action action);

    MeshState current_, original_, before_;
    QString file_path_;
    QStringList notes_;
    std::shared_ptr<const std::vector<FieldArray>> fields_ = std::make_shared<const std::vector<FieldArray>>();
    QVector<GroupLine> groups_;
    std::optional<LoadedDeformation> deformation_;
    std::vector<Action> session_;
    bool is_applying_ = false;
    QUndoStack history_;
};

}  // namespace curvewright
