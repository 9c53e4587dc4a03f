#include "ui/jobs/improving.h"

#include <QCoreApplication>
#include <QStringList>

#include "core/quality/shape_quality.h"
#include "ui/document/number_format.h"

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("curvewright::MeshJobs", text);
}

}  // namespace

Step improve_step(const CurvedMesh& mesh, const ImproveOptions& options, UntangleObserver* observer,
                  const TaskContext& context) {
    ImproveOptions its = options;
    its.keeps_best_on_cancel = true;
    ImproveResult result = improve(mesh, its, observer, context);
    const bool is_stopped = result.reason == StopReason::cancelled;
    Step step;
    step.name = options.goal == ImproveGoal::shape ? tr("Improve the shape") : tr("Improve");
    QStringList details{
        options.goal == ImproveGoal::shape
            ? tr("Elements with a mean ratio below %1 improved").arg(short_number(options.target))
            : tr("Elements with a scaled Jacobian below %1 improved").arg(short_number(options.target))};
    if (options.max_move)
        details << tr("No node farther than %1 of the mesh’s size").arg(short_number(*options.max_move));
    step.details = details.join(QLatin1Char('\n'));
    QStringList text;
    if (is_stopped) text << tr("Stopped on request; the best mesh so far is kept.");
    if (result.largest_move > 0.0)
        text << tr("The farthest node has moved by %1.").arg(short_number(result.largest_move));
    else
        text << tr("Nothing better was found, or no element is below the target of %1.")
                    .arg(short_number(options.target));
    if (!options.boundary.is_all_fixed())
        text << tr("The boundary is at most %1 from where it was.").arg(short_number(result.largest_boundary_distance));
    step.note = text.join(QLatin1Char(' '));
    // What was asked for is the target.
    if (options.goal == ImproveGoal::jacobian && result.largest_move > 0.0) step.target = options.target;
    if (options.goal == ImproveGoal::shape && result.largest_move > 0.0 && !is_stopped) {
        const ShapeSummary shape = assess_shape(mesh.with_coordinates(result.coordinates), mesh.coordinates(), context);
        if (shape.min < options.target)
            step.notices.push_back(
                {NoticeSeverity::information, tr("The worst mean ratio is %1: the target of %2 is not reached.")
                                                  .arg(format_number(shape.min), short_number(options.target))});
    }
    step.coordinates = std::move(result.coordinates);
    // One that was stopped does not come out the same again.
    if (!is_stopped) step.action = ImproveAction{options};
    return step;
}

}  // namespace curvewright
