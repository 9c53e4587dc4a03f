#include "ui/jobs/operation_steps.h"

#include <QCoreApplication>
#include <QDir>
#include <QRegularExpression>

#include "core/base/error.h"
#include "core/base/overloaded.h"
#include "core/deform/deformation.h"
#include "core/mesh/conformity.h"
#include "core/session/replay.h"
#include "core/timeline/recorder.h"
#include "ui/document/number_format.h"
#include "ui/jobs/improving.h"
#include "ui/jobs/untangling.h"

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("curvewright::MeshJobs", text);
}

QString steps_text(const IncrementOptions& increments) {
    if (increments.steps == 0) return tr("automatic steps");
    return increments.steps == 1 ? tr("1 step") : tr("%1 steps").arg(format_count(increments.steps));
}

/// fraction: of the motion that was reached.
QString warp_name(const WarpOptions& options, const std::optional<IncrementOptions>& increments, double fraction) {
    QString name = fraction < 1.0 ? tr("Warp to %1 %").arg(QString::number(100.0 * fraction, 'g', 4)) : tr("Warp");
    name += options.weighting == Weighting::elastic  ? tr(", elastic body")
            : options.weighting == Weighting::affine ? tr(", affine weights")
                                                     : tr(", convex weights");
    if (options.weighting != Weighting::elastic && options.distance_power != WarpOptions().distance_power)
        name += options.distance_power == 0.0 && options.sharing_power == 0.0
                    ? tr(", as published")
                    : tr(", power %1").arg(short_number(options.distance_power));
    if (increments) name += QStringLiteral(", ") + steps_text(*increments);
    return name;
}

/// The options that were used, a line each for the weights and the steps.
QString warp_details(const WarpOptions& options, const std::optional<IncrementOptions>& increments) {
    QString text;
    if (options.weighting == Weighting::elastic) {
        text = tr("Poisson’s ratio %1, stiffening %2")
                   .arg(short_number(options.poisson_ratio), short_number(options.stiffening));
    } else {
        text = tr("Distance power %1").arg(short_number(options.distance_power));
        if (options.neighbours == NeighbourKind::high_order) text += tr(", high-order neighbours");
        if (options.neighbours == NeighbourKind::edge_connected) text += tr(", neighbours one edge away");
    }
    if (increments)
        text += QLatin1Char('\n') + (increments->recomputes_weights ? tr("In %1, with new weights at every step")
                                                                    : tr("In %1, with the weights of the first mesh"))
                                        .arg(steps_text(*increments));
    return text;
}

QString describe_increments(const IncrementReport& report, const MeshTopology& topology) {
    static const QRegularExpression minus(QStringLiteral("-(?=\\d)"));
    return QString::fromStdString(describe(report, topology)).replace(minus, QString(QChar(0x2212)));
}

QString nodes_text(std::size_t count) {
    return count == 1 ? tr("1 node") : tr("%1 nodes").arg(format_count(static_cast<long long>(count)));
}

/// "" if all nodes got the weights that were asked for.
QString outside_hull_text(const WarpReport& report) {
    const std::size_t count = report.outside_hull.size();
    if (count == 0) return {};
    return count == 1 ? tr("1 node has no convex weights and took affine ones.")
                      : tr("%1 have no convex weights and took affine ones.").arg(nodes_text(count));
}

QString degenerate_text(const WarpReport& report) {
    const std::size_t count = report.degenerate.size();
    if (count == 0) return {};
    return count == 1 ? tr("1 node has degenerate neighbours and took least-squares weights.")
                      : tr("%1 have degenerate neighbours and took least-squares weights.").arg(nodes_text(count));
}

QString describe_warp(const WarpReport& report) {
    QString text = tr("%1 interior nodes followed the boundary").arg(format_count(report.interior_nodes));
    text += report.solver == SolverChoice::direct
                ? tr(" (direct solver).")
                : tr(" (iterative solver, %1 iterations).").arg(format_count(report.iterations));
    for (const QString& special : {outside_hull_text(report), degenerate_text(report)})
        if (!special.isEmpty()) text += QLatin1Char(' ') + special;
    return text;
}

/// way: how far it went, in words.
Notice incomplete_notice(const IncrementReport& report, const QString& way) {
    Notice notice{NoticeSeverity::warning, way, {}, NoticeLife::step};
    if (report.failed_element) notice.actions.push_back(selecting_elements({*report.failed_element}));
    return notice;
}

/// Nodes that did not get the weights that were asked for.
void add_weight_notices(const WarpReport& report, std::vector<Notice>& notices) {
    const auto add = [&notices](NoticeSeverity severity, const std::vector<Index>& nodes, const QString& text) {
        if (!nodes.empty()) notices.push_back({severity, text, {selecting_nodes(nodes)}, NoticeLife::step});
    };
    add(NoticeSeverity::information, report.outside_hull, outside_hull_text(report));
    add(NoticeSeverity::warning, report.degenerate, degenerate_text(report));
}

Index moved_nodes(const Coordinates& a, const Coordinates& b) {
    Index count = 0;
    for (Eigen::Index row = 0; row < a.rows(); ++row) count += (a.row(row) != b.row(row));
    return count;
}

QString drag_name(const DragAction& action) {
    if (action.kind == ResponseKind::translation && action.nodes.size() == 1)
        return tr("Drag node %1").arg(action.nodes.front().value);
    return action.kind == ResponseKind::translation ? tr("Move %1").arg(nodes_text(action.nodes.size()))
                                                    : tr("Transform %1").arg(nodes_text(action.nodes.size()));
}

}  // namespace

QString by_file(const QString& deformation_path) {
    return tr("By %1").arg(QDir::toNativeSeparators(deformation_path));
}

Step deform_step(const CurvedMesh& mesh, const LoadedDeformation& loaded) {
    require_conforming(mesh);
    Step step;
    step.coordinates = apply_deformation(mesh, *loaded.deformation);
    step.action = DeformAction{loaded.file_path.toStdString()};
    step.name = tr("Deform boundary");
    step.details = by_file(loaded.file_path);
    const Index moved = moved_nodes(mesh.coordinates(), step.coordinates);
    step.note = moved == 0 ? tr("The deformation leaves the boundary where it is.")
                           : tr("Moved %1 boundary nodes; the interior stayed where it was.").arg(format_count(moved));
    step.advice = tr("Untangle the elements that have tangled, or undo and warp instead.");
    // That is what one expects of it, and the view and the verdict show it.
    step.warns_of_tangled = false;
    return step;
}

Step warp_step(const CurvedMesh& mesh, const LoadedDeformation& loaded, const WarpOptions& options,
               const std::optional<IncrementOptions>& increments, const TaskContext& context, Recorder* recorder) {
    WarpOptions with_interfaces = options;
    with_interfaces.prescribed_nodes = prescribed_interior_nodes(mesh, *loaded.deformation);
    Step step;
    step.details = by_file(loaded.file_path) + QLatin1Char('\n') + warp_details(options, increments);
    double fraction = 1.0;
    WarpReport report;
    if (apply_deformation(mesh, *loaded.deformation) == mesh.coordinates()) {
        // Weights would only add rounding.
        step.coordinates = mesh.coordinates();
        step.note = tr("The deformation leaves the boundary where it is.");
    } else if (increments) {
        const BoundaryPath path = [&](double part) { return apply_deformation(mesh, *loaded.deformation, part); };
        IncrementObserver observer;
        if (recorder) {
            recorder->begin_warp(mesh);
            observer = [recorder](const IncrementStep& tried, const Coordinates& coordinates) {
                recorder->add_increment({tried.fraction, tried.is_accepted, tried.summary.min, tried.summary.invalid,
                                         tried.summary.undecided},
                                        coordinates);
            };
        }
        IncrementalResult result = warp_in_increments(mesh, path, with_interfaces, *increments, context, observer);
        if (recorder)
            recorder->end_warp(result.coordinates,
                               result.increments.is_complete() ? StopReason::converged : StopReason::no_progress);
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
            step.notices.push_back(incomplete_notice(result.increments, way));
        }
        report = std::move(result.report);
        step.coordinates = std::move(result.coordinates);
    } else {
        WarpResult result = warp(mesh, apply_deformation(mesh, *loaded.deformation), with_interfaces, context);
        step.note = describe_warp(result.report);
        report = std::move(result.report);
        step.coordinates = std::move(result.coordinates);
    }
    add_weight_notices(report, step.notices);
    step.action = WarpAction{loaded.file_path.toStdString(), options, increments};
    step.name = warp_name(options, increments, fraction);
    step.advice =
        tr("Elements have tangled: undo and try automatic steps, other weights or another distance power, or "
           "untangle.");
    return step;
}

Step flip_step(const CurvedMesh& mesh) {
    Step step;
    step.coordinates = mesh.coordinates();
    step.name = tr("Flip numbering");
    step.details = tr("All elements are numbered the other way round.");
    step.action = FlipAction{};
    return step;
}

Step reorient_step(const Reorientation& reorientation) {
    Step step;
    step.coordinates = reorientation.mesh.coordinates();
    step.name = tr("Renumber elements");
    step.details =
        reorientation.reversed > 0
            ? tr("%1 elements ran against their neighbours; %2 are numbered the other way round now.")
                  .arg(format_count(reorientation.reversed), format_count(reorientation.renumbered))
            : tr("%1 elements are numbered the other way round now.").arg(format_count(reorientation.renumbered));
    step.action = ReorientAction{};
    return step;
}

CurvedMesh numbered_by(const Action& action, const CurvedMesh& mesh) {
    if (std::holds_alternative<FlipAction>(action)) return flip_orientation(mesh);
    if (std::holds_alternative<ReorientAction>(action)) return reorient(mesh).mesh;
    return mesh;
}

bool is_renumbering(const Action& action) {
    return std::holds_alternative<FlipAction>(action) || std::holds_alternative<ReorientAction>(action);
}

Step again(const Action& action, const CurvedMesh& mesh, const CurvedMesh& opened,
           const std::function<LoadedDeformation(const std::string&)>& load, const TaskContext& context) {
    const auto computed = [&](QString name) {
        Step step;
        step.name = std::move(name);
        step.coordinates = perform(action, mesh, opened, {}, context).coordinates();
        step.action = action;
        return step;
    };
    return std::visit(
        Overloaded{[&](const DeformAction& its) { return deform_step(mesh, load(its.deformation)); },
                   [&](const WarpAction& its) {
                       return warp_step(mesh, load(its.deformation), its.options, its.increments, context);
                   },
                   [&](const UntangleAction& its) {
                       Step step = untangle(mesh, its.options, nullptr, context);
                       context.check();
                       return step;
                   },
                   [&](const ImproveAction& its) {
                       Step step = improve_step(mesh, its.options, nullptr, context);
                       context.check();
                       return step;
                   },
                   [&](const FlipAction&) { return flip_step(mesh); },
                   [&](const ReorientAction&) { return reorient_step(reorient(mesh)); },
                   [&](const DragAction& its) { return computed(drag_name(its)); },
                   [&](const PlaceAction& its) { return computed(tr("Place %1").arg(nodes_text(its.rows.size()))); },
                   [&](const auto&) -> Step {
                       throw InvalidInput(
                           "Opening a mesh and walking through the history are nothing that a mesh can do.");
                   }},
        action);
}

QString full_details(const Step& step) {
    if (step.details.isEmpty()) return step.note;
    return step.note.isEmpty() ? step.details : step.details + QLatin1Char('\n') + step.note;
}

}  // namespace curvewright
