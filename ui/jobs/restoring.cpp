#include "ui/jobs/restoring.h"

#include <QCoreApplication>
#include <QDir>
#include <QFileInfo>

#include "core/base/error.h"
#include "core/io/deformation_file.h"
#include "core/io/matched_mesh.h"
#include "core/session/journal_file.h"
#include "core/session/session_file.h"
#include "ui/document/number_format.h"
#include "ui/jobs/mesh_state.h"
#include "ui/jobs/operation_steps.h"

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("curvewright::MeshJobs", text);
}

QString step_title(std::size_t step, std::size_t count) {
    return tr("step %1 of %2")
        .arg(format_count(static_cast<long long>(step)), format_count(static_cast<long long>(count)));
}

QStringList to_list(const std::vector<std::string>& texts) {
    QStringList list;
    for (const std::string& text : texts) list << QString::fromStdString(text);
    return list;
}

LoadedDeformation load(const QString& path, const TaskContext& context) {
    return {std::make_shared<const Deformation>(read_deformation(to_path(path), context)), path};
}

/// The mesh of a journal with its nodes where they were when it was opened. The file may have been saved since, or
/// turned round, but not be another mesh.
/// opened: gets what else the file has: notes and arrays.
CurvedMesh read_kept_mesh(const JournalContent& content, OpenedMesh& opened, const TaskContext& context) {
    std::optional<InvalidInput> problem;
    std::vector<std::string> files{content.head.mesh};
    if (content.head.saved != content.head.mesh && !content.head.saved.empty()) files.push_back(content.head.saved);
    for (const std::string& file : files) {
        try {
            ReadResult read = read_matched_mesh(to_path(QString::fromStdString(file)), {}, context);
            const auto is_it = [&](const CurvedMesh& mesh) {
                return mesh.topology().node_count() == content.opened.rows() &&
                       fingerprint(mesh.topology()) == content.head.topology;
            };
            std::optional<CurvedMesh> mesh;
            if (is_it(read.mesh)) {
                mesh = std::move(read.mesh);
            } else {
                try {
                    mesh = flip_orientation(read.mesh);
                } catch (const Unsupported&) {
                    // Not of elements that could have been turned round.
                }
                if (mesh && !is_it(*mesh)) mesh.reset();
            }
            if (!mesh)
                throw InvalidInput(file, 0,
                                   "it has changed since: its nodes or elements are not those of the kept work. The "
                                   "work stays kept; put the file back that it belongs to.");
            for (const std::string& note : read.notes) opened.notes << QString::fromStdString(note);
            opened.fields = std::make_shared<const std::vector<FieldArray>>(std::move(read.fields));
            return mesh->with_coordinates(content.opened);
        } catch (const InvalidInput& error) {
            if (!problem) problem = error;
        }
    }
    throw *problem;
}

}  // namespace

RestoredWork read_lost_work(const QString& journal_path, const TaskContext& context) {
    JournalContent content = read_journal(to_path(journal_path), part_of(context, tr("reading"), 0.0, 0.1));
    if (content.steps.empty() && !content.damage.empty())
        throw InvalidInput(journal_path.toStdString(), 0,
                           "the kept work is damaged before its first step; nothing of it can be recovered.");
    RestoredWork work;
    const std::size_t count = content.steps.size();
    const auto part = [&](std::size_t state) {
        const double begin = 0.1 + 0.9 * static_cast<double>(state) / static_cast<double>(count + 1);
        return part_of(context, state == 0 ? tr("the mesh") : step_title(state, count), begin,
                       begin + 0.9 / static_cast<double>(count + 1));
    };
    CurvedMesh mesh = read_kept_mesh(content, work.opened, part(0));
    work.opened.file_path = QString::fromStdString(content.head.mesh);
    work.opened.state = make_state(std::move(mesh), part(0));
    work.opened.groups = list_groups(work.opened.state.mesh->topology());

    const MeshState* before = &work.opened.state;
    work.history.steps.reserve(count);
    for (JournalContent::Step& step : content.steps) {
        const TaskContext its = part(work.history.steps.size() + 1);
        KeptHistory::Step kept{
            QString::fromStdString(step.name), QString::fromStdString(step.details), std::move(step.action), {}};
        // As when the step was done: what was renumbered is judged by itself.
        const CurvedMesh base = numbered_by(kept.action, *before->mesh);
        kept.state = make_state(base.with_coordinates(std::move(step.positions)), its,
                                is_renumbering(kept.action) ? nullptr : before);
        kept.state.applied_deformations = to_list(step.applied_deformations);
        work.history.steps.push_back(std::move(kept));
        before = &work.history.steps.back().state;
    }
    work.history.index = content.index;
    work.history.clean_index = content.head.clean;
    work.history.session = std::move(content.session);
    if (content.head.saved != content.head.mesh) work.history.saved_path = QString::fromStdString(content.head.saved);
    work.intact_bytes = content.intact_bytes;
    work.records = content.records;
    if (!content.damage.empty())
        work.remark = tr("The kept work is damaged; it could be recovered up to step %1.")
                          .arg(format_count(static_cast<long long>(content.index)));
    if (!content.deformation.empty()) {
        try {
            work.deformation = load(QString::fromStdString(content.deformation), {context.stop, {}});
        } catch (const InvalidInput&) {
            // It has done what it did; who wants more of it will load it again.
        }
    }
    return work;
}

RestoredWork redo_session(const QString& session_path, const TaskContext& context) {
    const std::string name = session_path.toStdString();
    std::vector<Action> actions = read_session(to_path(session_path));
    if (!std::holds_alternative<OpenAction>(actions.front()))
        throw InvalidInput(name, 0, "the session does something before it opens a mesh; \"open\" was expected first.");
    // Another mesh begins another history.
    std::size_t first = 0;
    for (std::size_t i = 0; i < actions.size(); ++i)
        if (std::holds_alternative<OpenAction>(actions[i])) first = i;
    const QDir folder = QFileInfo(session_path).absoluteDir();
    const auto resolve = [&folder](std::string& file) {
        file = QDir::cleanPath(folder.absoluteFilePath(QString::fromStdString(file))).toStdString();
    };
    RestoredWork work;
    auto open = std::get<OpenAction>(actions[first]);
    resolve(open.mesh);

    // Which of them count: those that were undone and replaced do not.
    std::vector<Action> way;
    std::size_t index = 0;
    for (std::size_t i = first + 1; i < actions.size(); ++i) {
        if (const auto* jump = std::get_if<HistoryAction>(&actions[i])) {
            if (static_cast<std::size_t>(jump->step) > way.size())
                throw InvalidInput(name, 0,
                                   "the session goes to step " + std::to_string(jump->step) + " of a history of " +
                                       std::to_string(way.size()) + " steps.");
            index = static_cast<std::size_t>(jump->step);
            continue;
        }
        if (auto* deform = std::get_if<DeformAction>(&actions[i])) resolve(deform->deformation);
        if (auto* warp = std::get_if<WarpAction>(&actions[i])) resolve(warp->deformation);
        way.resize(index, OpenAction{});
        way.push_back(std::move(actions[i]));
        ++index;
    }

    const std::size_t count = way.size();
    const auto part = [&](std::size_t state) {
        const double share = 1.0 / static_cast<double>(count + 1), begin = static_cast<double>(state) * share;
        return part_of(context, state == 0 ? tr("opening") : step_title(state, count), begin, begin + share);
    };
    ReadResult read = read_matched_mesh(to_path(QString::fromStdString(open.mesh)), {}, part(0));
    for (const std::string& note : read.notes) work.opened.notes << QString::fromStdString(note);
    work.opened.fields = std::make_shared<const std::vector<FieldArray>>(std::move(read.fields));
    work.opened.file_path = QString::fromStdString(open.mesh);
    work.opened.state = make_state(std::move(read.mesh), part(0));
    work.opened.groups = list_groups(work.opened.state.mesh->topology());
    work.history.session.emplace_back(open);

    const MeshState* before = &work.opened.state;
    work.history.steps.reserve(count);
    for (const Action& action : way) {
        const TaskContext its = part(work.history.steps.size() + 1);
        its.report("", 0.0);
        QStringList applied = before->applied_deformations;
        const auto load_file = [&](const std::string& file) {
            const QString path = QString::fromStdString(file);
            if (!work.deformation || work.deformation->file_path != path) work.deformation = load(path, its);
            applied << path;
            return *work.deformation;
        };
        Step step = again(action, *before->mesh, *work.opened.state.mesh, load_file, its);
        const CurvedMesh base = numbered_by(action, *before->mesh);
        KeptHistory::Step kept{step.name, full_details(step), action, {}};
        kept.state = make_state(base.with_coordinates(std::move(step.coordinates)), its,
                                is_renumbering(action) ? nullptr : before);
        kept.state.applied_deformations = applied;
        work.history.steps.push_back(std::move(kept));
        work.history.session.push_back(action);
        before = &work.history.steps.back().state;
    }
    work.history.index = static_cast<int>(index);
    if (index != count) work.history.session.emplace_back(HistoryAction{work.history.index});
    return work;
}

}  // namespace curvewright
