#include "ui/document/mesh_document.h"

#include <QFileInfo>
#include <QUndoCommand>

namespace curvewright {

/// One step of the history. Undoing and redoing change nothing themselves: the document reads the state off the step
/// that the history stands on, so that a jump over many steps shows one change.
class MeshDocument::StateCommand : public QUndoCommand {
  public:
    StateCommand(const QString& name, const QString& details, Action action, MeshState before, MeshState after)
        : QUndoCommand(name),
          details_(details),
          action_(std::move(action)),
          before_(std::move(before)),
          after_(std::move(after)) {}

    const QString& details() const { return details_; }
    const Action& action() const { return action_; }
    const MeshState& before() const { return before_; }
    const MeshState& after() const { return after_; }

  private:
    QString details_;
    Action action_;
    MeshState before_, after_;
};

MeshDocument::MeshDocument(QObject* parent) : QObject(parent) {
    connect(&history_, &QUndoStack::indexChanged, this, &MeshDocument::follow_history);
    connect(&history_, &QUndoStack::cleanChanged, this, [this] { emit dirty_changed(is_dirty()); });
}

MeshDocument::~MeshDocument() {
    history_.disconnect(this);
}

QString MeshDocument::file_name() const {
    return QFileInfo(file_path_).fileName();
}

bool MeshDocument::is_deformation_applied() const {
    return deformation_ && current_.applied_deformations.contains(deformation_->file_path);
}

void MeshDocument::replace(OpenedMesh opened_mesh) {
    {
        const QSignalBlocker blocker(history_);
        history_.clear();
        history_.setClean();
    }
    original_ = before_ = current_ = std::move(opened_mesh.state);
    file_path_ = std::move(opened_mesh.file_path);
    notes_ = std::move(opened_mesh.notes);
    fields_ = opened_mesh.fields ? std::move(opened_mesh.fields) : std::make_shared<const std::vector<FieldArray>>();
    if (opened_mesh.groups)
        groups_ = std::move(*opened_mesh.groups);
    else
        groups_ = has_mesh() ? list_groups(original_.mesh->topology()) : QVector<GroupLine>();
    deformation_.reset();
    session_.clear();
}

void MeshDocument::open(OpenedMesh opened_mesh) {
    const bool was_dirty = is_dirty();
    replace(std::move(opened_mesh));
    emit opened();
    emit deformation_changed();
    emit file_path_changed();
    emit history_.indexChanged(0);
    emit history_.canUndoChanged(false);
    emit history_.canRedoChanged(false);
    if (was_dirty) emit dirty_changed(false);
    if (has_mesh()) record(OpenAction{file_path_.toStdString()});
}

void MeshDocument::restore(OpenedMesh opened_mesh, KeptHistory history) {
    const bool was_dirty = is_dirty();
    replace(std::move(opened_mesh));
    if (!history.saved_path.isEmpty()) file_path_ = history.saved_path;
    {
        const QSignalBlocker blocker(history_);
        const MeshState* before = &original_;
        for (KeptHistory::Step& step : history.steps) {
            auto* command =
                new StateCommand(step.name, step.details, std::move(step.action), *before, std::move(step.state));
            history_.push(command);
            before = &command->after();
        }
        if (history.clean_index < 0) {
            history_.resetClean();
        } else {
            history_.setIndex(history.clean_index);
            history_.setClean();
        }
        history_.setIndex(history.index);
    }
    read_history();
    emit opened();
    emit deformation_changed();
    emit file_path_changed();
    // The session is still empty: what follows the history does not record this.
    emit history_.indexChanged(history_.index());
    emit history_.canUndoChanged(history_.canUndo());
    emit history_.canRedoChanged(history_.canRedo());
    session_ = std::move(history.session);
    if (was_dirty != is_dirty()) emit dirty_changed(is_dirty());
}

void MeshDocument::close() {
    open({});
}

void MeshDocument::apply(const QString& name, MeshState state, Action action, const QString& details) {
    Q_ASSERT(has_mesh() && state.mesh && state.mesh->topology().node_count() == current_.mesh->topology().node_count());
    is_applying_ = true;
    history_.push(new StateCommand(name, details, action, current_, std::move(state)));
    is_applying_ = false;
    record(std::move(action));
}

void MeshDocument::record(Action action) {
    session_.push_back(std::move(action));
    emit recorded(session_.back());
}

std::vector<Action> MeshDocument::way_here() const {
    if (session_.empty()) return {};
    std::vector<Action> way{session_.front()};
    for (int step = 0; step < history_.index(); ++step)
        way.push_back(static_cast<const StateCommand*>(history_.command(step))->action());
    return way;
}

const MeshState& MeshDocument::state_at(int steps) const {
    return steps == 0 ? original_ : static_cast<const StateCommand*>(history_.command(steps - 1))->after();
}

const Action& MeshDocument::step_action(int step) const {
    return static_cast<const StateCommand*>(history_.command(step))->action();
}

QString MeshDocument::step_details(int step) const {
    if (step < 0 || step >= history_.count()) return {};
    return static_cast<const StateCommand*>(history_.command(step))->details();
}

void MeshDocument::set_deformation(LoadedDeformation deformation) {
    deformation_ = std::move(deformation);
    emit deformation_changed();
}

void MeshDocument::mark_saved(const QString& file_path) {
    file_path_ = file_path;
    history_.setClean();
    emit file_path_changed();
}

void MeshDocument::read_history() {
    const int index = history_.index();
    if (index == 0) {
        current_ = before_ = original_;
    } else {
        const auto* step = static_cast<const StateCommand*>(history_.command(index - 1));
        current_ = step->after();
        before_ = step->before();
    }
}

void MeshDocument::follow_history() {
    read_history();
    if (!is_applying_ && !session_.empty()) record(HistoryAction{history_.index()});
    emit state_changed();
}

}  // namespace curvewright
