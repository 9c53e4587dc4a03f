#include "ui/jobs/mesh_jobs.h"

#include <QFileInfo>

#include "core/base/sha256.h"
#include "core/deform/deformation.h"
#include "core/io/deformation_file.h"
#include "core/io/matched_mesh.h"
#include "core/mesh/conformity.h"
#include "ui/document/number_format.h"
#include "ui/jobs/improving.h"
#include "ui/jobs/mesh_state.h"
#include "ui/jobs/operation_steps.h"
#include "ui/jobs/window_provenance.h"

namespace curvewright {

namespace {

/// None if no element is tangled.
std::optional<Notice> warning_of_tangled(const QualityReport& quality, const QString& advice) {
    std::vector<Index> tangled;
    for (std::size_t i = 0; i < quality.elements.size(); ++i)
        if (quality.elements[i].validity == Validity::invalid) tangled.push_back(static_cast<Index>(i));
    if (tangled.empty()) return std::nullopt;
    QString text =
        tangled.size() == 1
            ? MeshJobs::tr("1 element is tangled.")
            : MeshJobs::tr("%1 elements are tangled.").arg(format_count(static_cast<long long>(tangled.size())));
    if (!advice.isEmpty()) text += QLatin1Char(' ') + advice;
    return Notice{NoticeSeverity::warning, text, {selecting_elements(std::move(tangled))}};
}

QString why_nothing_is_assessed() {
    return MeshJobs::tr("All elements are pyramids, whose quality is not assessed.");
}

/// None if it was reached, or if elements are not valid, which is told then.
std::optional<Notice> note_of_missed_target(const QualityReport& quality, double target) {
    const QualitySummary& summary = quality.summary;
    if (summary.invalid + summary.undecided > 0 || summary.min >= target) return std::nullopt;
    std::vector<Index> below;
    for (std::size_t i = 0; i < quality.elements.size(); ++i)
        if (quality.elements[i].scaled_jacobian < target) below.push_back(static_cast<Index>(i));
    const QString text =
        MeshJobs::tr("The least scaled Jacobian is %1: the target of %2 is not reached; %3 below it.")
            .arg(format_number(summary.min), short_number(target),
                 below.size() == 1
                     ? MeshJobs::tr("1 element is")
                     : MeshJobs::tr("%1 elements are").arg(format_count(static_cast<long long>(below.size()))));
    return Notice{NoticeSeverity::information, text, {selecting_elements(std::move(below))}};
}

}  // namespace

MeshJobs::MeshJobs(MeshDocument& document, QObject* parent) : QObject(parent), document_(document) {}

bool MeshJobs::open(OpenRequest request) {
    const QString name = QFileInfo(request.mesh_path).fileName();
    return runner_.start(tr("Opening %1").arg(name), [this, request = std::move(request)](const TaskContext& context) {
        ReadResult read = read_matched_mesh(to_path(request.mesh_path), {}, context);
        OpenedMesh opened;
        opened.file_path = QFileInfo(request.mesh_path).absoluteFilePath();
        for (const std::string& text : read.notes) opened.notes << QString::fromStdString(text);
        opened.fields = std::make_shared<const std::vector<FieldArray>>(std::move(read.fields));
        const std::string hash = sha256_of_file(to_path(request.mesh_path));
        opened.state = make_state(std::move(read.mesh), context);
        opened.groups = list_groups(opened.state.mesh->topology());

        std::optional<LoadedDeformation> loaded;
        std::optional<MeshState> deformed;
        if (!request.deformation_path.isEmpty()) {
            auto deformation =
                std::make_shared<const Deformation>(read_deformation(to_path(request.deformation_path), context));
            loaded = LoadedDeformation{deformation, QFileInfo(request.deformation_path).absoluteFilePath()};
            if (request.apply_deformation) {
                const CurvedMesh& mesh = *opened.state.mesh;
                require_conforming(mesh, context);
                deformed =
                    make_state(mesh.with_coordinates(apply_deformation(mesh, *deformation)), context, &opened.state);
                deformed->applied_deformations << loaded->file_path;
            }
        }
        return [this, opened = std::move(opened), loaded, deformed, hash, is_start = request.is_starting_point,
                then = request.then] {
            document_.open(opened);
            hashed_path_ = opened.file_path;
            hash_ = hash;
            if (loaded) document_.set_deformation(*loaded);
            if (deformed)
                document_.apply(tr("Deform boundary"), *deformed, DeformAction{loaded->file_path.toStdString()},
                                by_file(loaded->file_path));
            if (is_start) document_.mark_unchanged();
            if (then) then();
        };
    });
}

void MeshJobs::restore(const RestoredWork& work) {
    document_.restore(work.opened, work.history);
    hashed_path_.clear();
    if (work.deformation) document_.set_deformation(*work.deformation);
}

bool MeshJobs::recover(const QString& journal_path, std::function<void(const RestoredWork&)> then) {
    return runner_.start(tr("Recovering"), [this, journal_path, then = std::move(then)](const TaskContext& context) {
        auto work = std::make_shared<const RestoredWork>(read_lost_work(journal_path, context));
        return [this, work, then] {
            restore(*work);
            then(*work);
        };
    });
}

bool MeshJobs::open_session(const QString& path, std::function<void()> then) {
    const QString title = tr("Doing %1 again").arg(QFileInfo(path).fileName());
    return runner_.start(title, [this, path, then = std::move(then)](const TaskContext& context) {
        auto work = std::make_shared<const RestoredWork>(redo_session(path, context));
        return [this, work, then] {
            restore(*work);
            then();
            const int steps = static_cast<int>(work->history.steps.size());
            emit note(steps == 1 ? tr("1 step was done again.") : tr("%1 steps were done again.").arg(steps));
        };
    });
}

bool MeshJobs::load_deformation(const QString& path) {
    return runner_.start(tr("Reading %1").arg(QFileInfo(path).fileName()), [this, path](const TaskContext& context) {
        auto deformation = std::make_shared<const Deformation>(read_deformation(to_path(path), context));
        LoadedDeformation loaded{deformation, QFileInfo(path).absoluteFilePath()};
        return [this, loaded] { document_.set_deformation(loaded); };
    });
}

bool MeshJobs::run_step(const QString& title, bool applies_deformation,
                        std::function<Step(const CurvedMesh&, const TaskContext&)> step, bool can_keep,
                        std::function<void(bool)> then) {
    const MeshState start = document_.state();
    QStringList applied = start.applied_deformations;
    if (applies_deformation) applied << document_.deformation()->file_path;
    auto work = [this, start, applied, step = std::move(step), then = std::move(then)](const TaskContext& context,
                                                                                       const std::stop_token& keep) {
        // The step stops for either reason; what is done with its result is only stopped by cancelling.
        std::stop_source either;
        const auto stop = [&either] { either.request_stop(); };
        const std::stop_callback on_cancel(context.stop, stop), on_keep(keep, stop);
        Step result = step(*start.mesh, {either.get_token(), context.progress});
        context.check();
        if (result.coordinates == start.mesh->coordinates()) return nothing_moved(std::move(result), start, then);
        MeshState state = make_state(start.mesh->with_coordinates(std::move(result.coordinates)), context, &start);
        state.applied_deformations = applied;
        QString text = result.note;
        if (state.quality && state.quality->summary.invalid > 0 && !result.advice.isEmpty())
            text += QLatin1Char(' ') + result.advice;
        if (state.quality && state.quality->summary.not_assessed > 0)
            text += QLatin1Char(' ') +
                    tr("%1 pyramids are not assessed.").arg(format_count(state.quality->summary.not_assessed));
        if (result.target && state.quality)
            if (auto missed = note_of_missed_target(*state.quality, *result.target)) result.notices.push_back(*missed);
        if (result.warns_of_tangled && state.quality)
            if (auto warning = warning_of_tangled(*state.quality, result.advice)) result.notices.push_back(*warning);
        const QString details = full_details(result);
        Action action =
            result.action
                ? std::move(*result.action)
                : Action(place_action(start.mesh->topology(), start.mesh->coordinates(), state.mesh->coordinates()));
        return JobRunner::Finish([this, state = std::move(state), name = result.name, details, text,
                                  action = std::move(action), notices = std::move(result.notices), then] {
            document_.apply(name, state, action, details);
            if (then) then(true);
            if (!text.isEmpty()) emit note(text);
            for (const Notice& notice : notices) emit noticed(notice);
        });
    };
    if (can_keep) return runner_.start_keepable(title, std::move(work));
    return runner_.start(title, [work = std::move(work)](const TaskContext& context) { return work(context, {}); });
}

JobRunner::Finish MeshJobs::nothing_moved(Step result, const MeshState& state, std::function<void(bool)> then) {
    std::vector<Notice> notices = std::move(result.notices);
    if (notices.empty()) {
        notices.push_back({NoticeSeverity::information, result.note});
        if (result.warns_of_tangled && state.quality)
            if (auto warning = warning_of_tangled(*state.quality, result.advice)) {
                if (!result.note.isEmpty()) warning->text = result.note + QLatin1Char(' ') + warning->text;
                notices.front() = *warning;
            }
    }
    // There is no step to be undone.
    for (Notice& notice : notices)
        for (NoticeAction& action : notice.actions) action.undoes = false;
    Notice& first = notices.front();
    first.topic = QStringLiteral("nothing_moved");
    const QString why = first.text;
    first.text = tr("Nothing moved, so there is no new step.");
    if (!why.isEmpty()) first.text += QLatin1Char(' ') + why;
    return [this, notices, then = std::move(then)] {
        if (then) then(false);
        for (const Notice& notice : notices) emit noticed(notice);
    };
}

bool MeshJobs::deform() {
    if (!why_not_deform().isEmpty()) return false;
    const LoadedDeformation loaded = *document_.deformation();
    return run_step(tr("Deforming the boundary"), true,
                    [loaded](const CurvedMesh& mesh, const TaskContext&) { return deform_step(mesh, loaded); });
}

bool MeshJobs::warp(const WarpOptions& options, const std::optional<IncrementOptions>& increments) {
    if (!why_not_warp().isEmpty()) return false;
    const LoadedDeformation loaded = *document_.deformation();
    return run_step(tr("Warping"), true,
                    [loaded, options, increments](const CurvedMesh& mesh, const TaskContext& context) {
                        return warp_step(mesh, loaded, options, increments, context);
                    });
}

bool MeshJobs::is_untangled(const UntangleOptions& options) {
    const auto& quality = document_.state().quality;
    if (runner_.is_running() || !quality || quality->summary.invalid + quality->summary.undecided > 0) return false;
    const QualitySummary& summary = quality->summary;
    Notice notice{NoticeSeverity::information, {}, {}, NoticeLife::state, QStringLiteral("nothing_moved")};
    notice.text = summary.assessed() == 0 ? why_nothing_is_assessed()
                  : summary.not_assessed == 0
                      ? tr("All elements are valid already, and untangling leaves such a mesh as it is.")
                      : tr("All elements that are assessed are valid already, and untangling leaves such a mesh as it "
                           "is; %1 are pyramids, which are not assessed.")
                            .arg(format_count(summary.not_assessed));
    if (summary.assessed() > 0) {
        NoticeAction improve{NoticeCommand::improve};
        improve.improve.emplace();
        if (const auto* guaranteed = std::get_if<GuaranteedOptions>(&options)) {
            improve.improve->target = guaranteed->target;
            improve.improve->boundary = guaranteed->boundary;
        }
        notice.actions.push_back(std::move(improve));
    }
    emit noticed(notice);
    return true;
}

bool MeshJobs::untangle(const UntangleOptions& options) {
    if (!why_not_untangle(method_of(options)).isEmpty()) return false;
    if (is_untangled(options)) return true;
    const bool can_keep = method_of(options) == UntangleMethod::guaranteed;
    return run_step(
        tr("Untangling"), false,
        [options](const CurvedMesh& mesh, const TaskContext& context) {
            return curvewright::untangle(mesh, options, nullptr, context);
        },
        can_keep);
}

bool MeshJobs::improve(const ImproveOptions& options) {
    if (!why_not_improve().isEmpty()) return false;
    return run_step(
        tr("Improving"), false,
        [options](const CurvedMesh& mesh, const TaskContext& context) {
            return improve_step(mesh, options, nullptr, context);
        },
        true);
}

bool MeshJobs::renumber() {
    if (!document_.has_mesh()) return false;
    const MeshState start = document_.state();
    return runner_.start(tr("Renumbering"), [this, start](const TaskContext& context) {
        const Reorientation reorientation = reorient(*start.mesh);
        if (reorientation.renumbered == 0) {
            Step step;
            step.note = tr("All elements are numbered alike.");
            return nothing_moved(std::move(step), start, {});
        }
        const Step step = reorient_step(reorientation);
        MeshState state = make_state(reorientation.mesh, context);
        state.applied_deformations = start.applied_deformations;
        return JobRunner::Finish([this, state, step] {
            document_.apply(step.name, state, *step.action, step.details);
            emit note(step.details);
        });
    });
}

bool MeshJobs::flip() {
    if (!document_.has_mesh()) return false;
    const MeshState start = document_.state();
    return runner_.start(tr("Renumbering"), [this, start](const TaskContext& context) {
        MeshState state = make_state(flip_orientation(*start.mesh), context);
        state.applied_deformations = start.applied_deformations;
        return [this, state] {
            const Step step = flip_step(*state.mesh);
            document_.apply(step.name, state, *step.action, step.details);
        };
    });
}

bool MeshJobs::write(const QString& path, std::optional<MeshFormat> format, bool mark_saved) {
    if (!document_.has_mesh()) return false;
    const MeshState state = document_.state(), original = document_.original();
    const auto fields = document_.fields();
    const std::vector<Action> way = document_.way_here();
    const auto* open = way.empty() ? nullptr : std::get_if<OpenAction>(&way.front());
    const bool is_hashed = open != nullptr && open->mesh == hashed_path_.toStdString();
    const Provenance provenance = window_provenance(way, is_hashed ? hash_ : std::string());
    const QString name = QFileInfo(path).fileName();
    return runner_.start(tr("Writing %1").arg(name), [=, this](const TaskContext& context) {
        context.report("writing", 0.0);
        WriteOptions options;
        options.format = format;
        options.quality = state.quality.get();
        options.reference = &original.mesh->coordinates();
        options.fields = fields.get();
        options.provenance = &provenance;
        QString told = tr("Wrote %1.").arg(path);
        QStringList lost;
        for (const std::string& text : write_mesh(to_path(path), *state.mesh, options))
            lost << QString::fromStdString(text);
        if (!lost.isEmpty()) told += QLatin1Char(' ') + lost.join(QLatin1Char(' '));
        return [=, this] {
            if (mark_saved) document_.mark_saved(QFileInfo(path).absoluteFilePath());
            emit note(told);
            // What the file does not hold is still there in the window, and gone when the file is opened again.
            if (!lost.isEmpty())
                emit noticed({NoticeSeverity::warning, told, {}, NoticeLife::document, QStringLiteral("written")});
        };
    });
}

bool MeshJobs::write_film(FilmRequest request) {
    return runner_.start(tr("Writing the animation"), film_work(this, std::move(request)));
}

bool MeshJobs::write_report(ReportRequest request) {
    const std::optional<int> step = last_untangling(document_);
    if (!step) return false;
    return runner_.start(tr("Writing the report"), report_work(this, document_, *step, std::move(request)));
}

QString MeshJobs::why_not_deform() const {
    if (!document_.has_mesh()) return tr("Open a mesh first.");
    if (!document_.deformation()) return tr("Load a deformation first.");
    return {};
}

QString MeshJobs::why_not_warp() const {
    return why_not_deform();
}

QString MeshJobs::why_not_improve() const {
    if (!document_.has_mesh()) return tr("Open a mesh first.");
    const MeshState& state = document_.state();
    if (!state.quality) return state.quality_note;
    if (state.quality->summary.invalid + state.quality->summary.undecided > 0)
        return tr("Only a mesh of valid elements can be improved: untangle it first.");
    if (state.quality->summary.assessed() == 0) return why_nothing_is_assessed();
    return {};
}

QString MeshJobs::why_not_untangle(UntangleMethod method) const {
    if (!document_.has_mesh()) return tr("Open a mesh first.");
    const QString reason = curvewright::why_not_untangle(document_.state().mesh->topology(), method);
    if (!reason.isEmpty()) return reason;
    if (!document_.state().quality) return document_.state().quality_note;
    return {};
}

}  // namespace curvewright
