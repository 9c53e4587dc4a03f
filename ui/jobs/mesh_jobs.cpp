#include "ui/jobs/mesh_jobs.h"

#include <filesystem>

#include <QDir>
#include <QFileInfo>
#include <QRegularExpression>

#include "core/base/error.h"
#include "core/deform/deformation.h"
#include "core/io/deformation_file.h"
#include "ui/document/number_format.h"

namespace curvewright {
namespace {

std::filesystem::path to_path(const QString& path) {
    return {path.toStdU16String()};
}

/// Certifies a mesh; one whose elements cannot be assessed is shown without quality, with the reason. What became of
/// another state of the same mesh is judged with that state's orientation: turned inside out is not valid.
MeshState make_state(CurvedMesh mesh, const TaskContext& context, const MeshState* origin = nullptr) {
    MeshState state;
    state.mesh = std::make_shared<const CurvedMesh>(std::move(mesh));
    QualityOptions options;
    if (origin != nullptr && origin->quality) options.orientation_sign = origin->quality->orientation_sign;
    try {
        state.quality = std::make_shared<const QualityReport>(assess_quality(*state.mesh, options, context));
    } catch (const Unsupported& problem) {
        state.quality_note = QString::fromUtf8(problem.what());
    }
    return state;
}

QString by_file(const QString& deformation_path) {
    return MeshJobs::tr("By %1").arg(QDir::toNativeSeparators(deformation_path));
}

QString steps_text(const IncrementOptions& increments) {
    if (increments.steps == 0) return MeshJobs::tr("automatic steps");
    return increments.steps == 1 ? MeshJobs::tr("1 step")
                                 : MeshJobs::tr("%1 steps").arg(format_count(increments.steps));
}

/// fraction: of the motion that was reached.
QString warp_name(const WarpOptions& options, const std::optional<IncrementOptions>& increments, double fraction) {
    QString name = fraction < 1.0 ? MeshJobs::tr("Warp to %1 %").arg(QString::number(100.0 * fraction, 'g', 4))
                                  : MeshJobs::tr("Warp");
    name += options.weighting == Weighting::elastic  ? MeshJobs::tr(", elastic body")
            : options.weighting == Weighting::affine ? MeshJobs::tr(", affine weights")
                                                     : MeshJobs::tr(", convex weights");
    if (options.weighting != Weighting::elastic && options.distance_power != WarpOptions().distance_power)
        name += MeshJobs::tr(", power %1").arg(short_number(options.distance_power));
    if (increments) name += QStringLiteral(", ") + steps_text(*increments);
    return name;
}

/// The options that were used, a line each for the weights and the steps.
QString warp_details(const WarpOptions& options, const std::optional<IncrementOptions>& increments) {
    QString text;
    if (options.weighting == Weighting::elastic) {
        text = MeshJobs::tr("Poisson’s ratio %1, stiffening %2")
                   .arg(short_number(options.poisson_ratio), short_number(options.stiffening));
    } else {
        text = MeshJobs::tr("Distance power %1").arg(short_number(options.distance_power));
        if (options.neighbours == NeighbourKind::high_order) text += MeshJobs::tr(", high-order neighbours");
        if (options.neighbours == NeighbourKind::edge_connected) text += MeshJobs::tr(", neighbours one edge away");
    }
    if (increments)
        text += QLatin1Char('\n') + (increments->recomputes_weights
                                         ? MeshJobs::tr("In %1, with new weights at every step")
                                         : MeshJobs::tr("In %1, with the weights of the first mesh"))
                                        .arg(steps_text(*increments));
    return text;
}

QString describe_increments(const IncrementReport& report, const MeshTopology& topology) {
    static const QRegularExpression minus(QStringLiteral("-(?=\\d)"));
    return QString::fromStdString(describe(report, topology)).replace(minus, QString(QChar(0x2212)));
}

QString describe_warp(const WarpReport& report) {
    QString text = MeshJobs::tr("%1 interior nodes followed the boundary").arg(format_count(report.interior_nodes));
    text += report.solver == SolverChoice::direct
                ? MeshJobs::tr(" (direct solver).")
                : MeshJobs::tr(" (iterative solver, %1 iterations).").arg(format_count(report.iterations));
    if (!report.outside_hull.empty())
        text += MeshJobs::tr(" %1 nodes have no convex weights and took affine ones.")
                    .arg(format_count(static_cast<long long>(report.outside_hull.size())));
    if (!report.degenerate.empty())
        text += MeshJobs::tr(" %1 nodes have degenerate neighbours and took least-squares weights.")
                    .arg(format_count(static_cast<long long>(report.degenerate.size())));
    return text;
}

Index moved_nodes(const Coordinates& a, const Coordinates& b) {
    Index count = 0;
    for (Eigen::Index row = 0; row < a.rows(); ++row) count += (a.row(row) != b.row(row));
    return count;
}

}  // namespace

MeshJobs::MeshJobs(MeshDocument& document, QObject* parent) : QObject(parent), document_(document) {}

bool MeshJobs::open(OpenRequest request) {
    const QString name = QFileInfo(request.mesh_path).fileName();
    return runner_.start(tr("Opening %1").arg(name), [this, request = std::move(request)](const TaskContext& context) {
        ReadResult read = read_mesh(to_path(request.mesh_path), context);
        OpenedMesh opened;
        opened.file_path = QFileInfo(request.mesh_path).absoluteFilePath();
        for (const std::string& text : read.notes) opened.notes << QString::fromStdString(text);
        opened.fields = std::make_shared<const std::vector<FieldArray>>(std::move(read.fields));
        opened.state = make_state(std::move(read.mesh), context);

        std::optional<LoadedDeformation> loaded;
        std::optional<MeshState> deformed;
        if (!request.deformation_path.isEmpty()) {
            auto deformation =
                std::make_shared<const Deformation>(read_deformation(to_path(request.deformation_path), context));
            loaded = LoadedDeformation{deformation, QFileInfo(request.deformation_path).absoluteFilePath()};
            if (request.apply_deformation) {
                const CurvedMesh& mesh = *opened.state.mesh;
                deformed =
                    make_state(mesh.with_coordinates(apply_deformation(mesh, *deformation)), context, &opened.state);
                deformed->applied_deformations << loaded->file_path;
            }
        }
        std::optional<std::pair<MeshState, Step>> first;
        if (request.first_step) {
            Step step = request.first_step(*opened.state.mesh);
            MeshState state = make_state(opened.state.mesh->with_coordinates(step.coordinates), context, &opened.state);
            if (!step.action)
                step.action =
                    place_action(opened.state.mesh->topology(), opened.state.mesh->coordinates(), step.coordinates);
            first.emplace(std::move(state), std::move(step));
        }
        return [this, opened = std::move(opened), loaded, deformed, first, is_start = request.is_starting_point,
                then = request.then] {
            document_.open(opened);
            if (loaded) document_.set_deformation(*loaded);
            if (deformed)
                document_.apply(tr("Deform boundary"), *deformed, DeformAction{loaded->file_path.toStdString()},
                                by_file(loaded->file_path));
            if (first) document_.apply(first->second.name, first->first, *first->second.action, first->second.details);
            if (is_start) document_.mark_unchanged();
            if (then) then();
            if (!opened.notes.isEmpty()) emit note(opened.notes.join(QLatin1Char(' ')));
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
                        std::function<Step(const CurvedMesh&, const TaskContext&)> step, bool can_keep) {
    const MeshState start = document_.state();
    QStringList applied = start.applied_deformations;
    if (applies_deformation) applied << document_.deformation()->file_path;
    auto work = [this, start, applied, step = std::move(step)](const TaskContext& context,
                                                               const std::stop_token& keep) {
        // The step stops for either reason; what is done with its result is only stopped by cancelling.
        std::stop_source either;
        const auto stop = [&either] { either.request_stop(); };
        const std::stop_callback on_cancel(context.stop, stop), on_keep(keep, stop);
        Step result = step(*start.mesh, {either.get_token(), context.progress});
        context.check();
        MeshState state = make_state(start.mesh->with_coordinates(std::move(result.coordinates)), context, &start);
        state.applied_deformations = applied;
        QString text = result.note;
        if (state.quality && state.quality->summary.invalid > 0 && !result.advice.isEmpty())
            text += QLatin1Char(' ') + result.advice;
        const QString details =
            result.details.isEmpty() ? result.note : result.details + QLatin1Char('\n') + result.note;
        Action action =
            result.action
                ? std::move(*result.action)
                : Action(place_action(start.mesh->topology(), start.mesh->coordinates(), state.mesh->coordinates()));
        return [this, state = std::move(state), name = result.name, details, text, action = std::move(action)] {
            document_.apply(name, state, action, details);
            if (!text.isEmpty()) emit note(text);
        };
    };
    if (can_keep) return runner_.start_keepable(title, std::move(work));
    return runner_.start(title, [work = std::move(work)](const TaskContext& context) { return work(context, {}); });
}

bool MeshJobs::deform() {
    if (!why_not_deform().isEmpty()) return false;
    const LoadedDeformation loaded = *document_.deformation();
    return run_step(tr("Deforming the boundary"), true, [loaded](const CurvedMesh& mesh, const TaskContext&) {
        Step step;
        step.coordinates = apply_deformation(mesh, *loaded.deformation);
        step.action = DeformAction{loaded.file_path.toStdString()};
        step.name = tr("Deform boundary");
        step.details = by_file(loaded.file_path);
        step.note = tr("Moved %1 boundary nodes; the interior stayed where it was.")
                        .arg(format_count(moved_nodes(mesh.coordinates(), step.coordinates)));
        step.advice = tr("Untangle the elements that have tangled, or undo and warp instead.");
        return step;
    });
}

bool MeshJobs::warp(const WarpOptions& options, const std::optional<IncrementOptions>& increments) {
    if (!why_not_warp().isEmpty()) return false;
    const LoadedDeformation loaded = *document_.deformation();
    return run_step(
        tr("Warping"), true, [loaded, options, increments](const CurvedMesh& mesh, const TaskContext& context) {
            WarpOptions with_interfaces = options;
            with_interfaces.prescribed_nodes = prescribed_interior_nodes(mesh, *loaded.deformation);
            Step step;
            step.details = by_file(loaded.file_path) + QLatin1Char('\n') + warp_details(options, increments);
            double fraction = 1.0;
            if (increments) {
                const BoundaryPath path = [&](double part) {
                    return apply_deformation(mesh, *loaded.deformation, part);
                };
                IncrementalResult result = warp_in_increments(mesh, path, with_interfaces, *increments, context);
                fraction = result.increments.fraction;
                const QString way = describe_increments(result.increments, mesh.topology());
                if (fraction == 0.0)
                    throw SolverFailure(tr("%1 More steps or other weights may go further.").arg(way).toStdString());
                const QString followed = describe_warp(result.report);
                if (result.increments.is_complete()) {
                    step.note = followed + QLatin1Char(' ') + way;
                } else {
                    step.note = way;
                    step.details += QLatin1Char('\n') + followed;
                }
                step.coordinates = std::move(result.coordinates);
            } else {
                WarpResult result =
                    curvewright::warp(mesh, apply_deformation(mesh, *loaded.deformation), with_interfaces, context);
                step.note = describe_warp(result.report);
                step.coordinates = std::move(result.coordinates);
            }
            step.action = WarpAction{loaded.file_path.toStdString(), options, increments};
            step.name = warp_name(options, increments, fraction);
            step.advice =
                tr("Elements have tangled: undo and try automatic steps, other weights or another distance power, or "
                   "untangle.");
            return step;
        });
}

bool MeshJobs::untangle(const UntangleOptions& options) {
    if (!why_not_untangle(method_of(options)).isEmpty()) return false;
    const bool can_keep = method_of(options) == UntangleMethod::guaranteed;
    return run_step(
        tr("Untangling"), false,
        [options](const CurvedMesh& mesh, const TaskContext& context) {
            return curvewright::untangle(mesh, options, context);
        },
        can_keep);
}

bool MeshJobs::flip() {
    if (!document_.has_mesh()) return false;
    const MeshState start = document_.state();
    return runner_.start(tr("Renumbering"), [this, start](const TaskContext& context) {
        MeshState state = make_state(flip_orientation(*start.mesh), context);
        state.applied_deformations = start.applied_deformations;
        return [this, state] {
            document_.apply(tr("Flip numbering"), state, FlipAction{},
                            tr("All elements are numbered the other way round."));
        };
    });
}

bool MeshJobs::write(const QString& path, std::optional<MeshFormat> format, bool mark_saved) {
    if (!document_.has_mesh()) return false;
    const MeshState state = document_.state(), original = document_.original();
    const auto fields = document_.fields();
    const QString name = QFileInfo(path).fileName();
    return runner_.start(tr("Writing %1").arg(name), [=, this](const TaskContext& context) {
        context.report("writing", 0.0);
        WriteOptions options;
        options.format = format;
        options.quality = state.quality.get();
        options.reference = &original.mesh->coordinates();
        options.fields = fields.get();
        QString told = tr("Wrote %1.").arg(path);
        for (const std::string& text : write_mesh(to_path(path), *state.mesh, options))
            told += QLatin1Char(' ') + QString::fromStdString(text);
        return [=, this] {
            if (mark_saved) document_.mark_saved(QFileInfo(path).absoluteFilePath());
            emit note(told);
        };
    });
}

QString MeshJobs::why_not_deform() const {
    if (!document_.has_mesh()) return tr("Open a mesh first.");
    if (!document_.deformation()) return tr("Load a deformation first.");
    return {};
}

QString MeshJobs::why_not_warp() const {
    return why_not_deform();
}

QString MeshJobs::why_not_untangle(UntangleMethod method) const {
    if (!document_.has_mesh()) return tr("Open a mesh first.");
    const QString reason = curvewright::why_not_untangle(document_.state().mesh->topology(), method);
    if (!reason.isEmpty()) return reason;
    if (!document_.state().quality) return document_.state().quality_note;
    return {};
}

}  // namespace curvewright
