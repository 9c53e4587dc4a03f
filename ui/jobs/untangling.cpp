#include "ui/jobs/untangling.h"

#include <set>
#include <string>

#include <QCoreApplication>
#include <QStringList>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("curvewright::MeshJobs", text);
}

QString seconds_text(double seconds) {
    if (seconds < 0.001) return tr("less than 0.001 s");
    return tr("%1 s").arg(QString::number(seconds, 'f', seconds < 0.1 ? 3 : seconds < 10.0 ? 2 : 1));
}

/// Elements for which the same is known: how many, the first and what is wrong with it. That they cannot be mended is
/// said only where it is proved.
QString describe_alike(const std::vector<const UnmendedElement*>& unmended, const MeshTopology& topology) {
    const UnmendedElement& first = *unmended.front();
    const QString tag = QString::number(topology.element_tag(first.element).value);
    const QString reason = QString::fromStdString(first.reason);
    if (unmended.size() == 1)
        return (first.is_proved ? tr("Element %1 cannot be mended with the boundary as it is: %2.")
                                : tr("No way was found to mend element %1 with the boundary as it is: %2."))
            .arg(tag, reason);
    return (first.is_proved
                ? tr("%1 elements cannot be mended with the boundary as it is; the first is element %2: %3.")
                : tr("No way was found to mend %1 elements with the boundary as it is; the first is element %2: %3."))
        .arg(format_count(static_cast<long long>(unmended.size())), tag, reason);
}

/// The elements that are still not valid.
QString describe_unmended(const std::vector<UnmendedElement>& unmended, const MeshTopology& topology) {
    std::vector<const UnmendedElement*> proved, others;
    for (const UnmendedElement& element : unmended) (element.is_proved ? proved : others).push_back(&element);
    QStringList text;
    for (const auto& alike : {proved, others})
        if (!alike.empty()) text << describe_alike(alike, topology);
    return text.join(QLatin1Char(' '));
}

/// What stays told of them, with the way on if there is one.
Notice unmended_notice(const GuaranteedResult& result, const GuaranteedOptions& options, const QString& advice,
                       const MeshTopology& topology) {
    std::vector<Index> elements;
    for (const UnmendedElement& its : result.unmended) elements.push_back(its.element);
    const QString text = result.reason == StopReason::cancelled
                             ? tr("Stopped on request; %1 elements are not mended yet.")
                                   .arg(format_count(static_cast<long long>(elements.size())))
                             : describe_unmended(result.unmended, topology) + QLatin1Char(' ') + advice;
    Notice notice{NoticeSeverity::warning, text, {selecting_elements(std::move(elements))}};
    if (result.reason == StopReason::cancelled) return notice;
    std::set<std::string> interfaces;
    for (const UnmendedElement& its : result.unmended)
        interfaces.insert(its.fixed_interfaces.begin(), its.fixed_interfaces.end());
    if (!interfaces.empty()) {
        QStringList names;
        for (const std::string& name : interfaces) names << QStringLiteral("“%1”").arg(QString::fromStdString(name));
        notice.text += QLatin1Char(' ') +
                       tr("What stays inside the domain may be in the way: %1.").arg(names.join(QStringLiteral(", ")));
    }
    for (auto& slide : {sliding_interfaces(options, interfaces, true), sliding_boundary(options, true)})
        if (slide) notice.actions.push_back(*slide);
    return notice;
}

QString describe_untangling(const GuaranteedResult& result, const GuaranteedOptions& options,
                            const MeshTopology& topology) {
    QStringList text;
    const QString valid = seconds_text(result.valid_seconds), improved = seconds_text(result.improve_seconds);
    if (result.reason == StopReason::cancelled)
        text << tr("Stopped on request; the best mesh so far is kept.");
    else if (!result.unmended.empty())
        text << tr("Stopped after %1.").arg(valid) << describe_unmended(result.unmended, topology);
    else if (options.improves)
        text << tr("Valid after %1; improved in %2.").arg(valid, improved);
    else
        text << tr("Valid after %1.").arg(valid);
    return text.join(QLatin1Char(' '));
}

QString describe_passes(const UntangleResult& result) {
    const QString passes = result.passes == 1 ? tr("1 pass") : tr("%1 passes").arg(format_count(result.passes));
    switch (result.reason) {
        case StopReason::converged:
            return tr("Converged after %1.").arg(passes);
        case StopReason::untangled:
            return tr("All elements are valid after %1.").arg(passes);
        case StopReason::pass_limit:
            return tr("Stopped at the limit of %1.").arg(passes);
        case StopReason::no_progress:
            return tr("Stopped after %1: a further one would not make things better.").arg(passes);
        case StopReason::cancelled:
            return tr("Cancelled after %1.").arg(passes);
    }
    return {};
}

Step run(const CurvedMesh& mesh, GuaranteedOptions options, UntangleObserver* observer, const TaskContext& context) {
    options.keeps_best_on_cancel = true;
    GuaranteedResult result = untangle_guaranteed(mesh, options, observer, context);
    Step step;
    step.name = tr("Untangle, guaranteed");
    step.details = options.improves ? tr("Elements below %1 improved afterwards").arg(short_number(options.target))
                                    : tr("Valid only, nothing improved afterwards");
    step.note = describe_untangling(result, options, mesh.topology());
    if (!options.boundary.is_all_fixed()) {
        step.name = tr("Untangle, guaranteed, boundary moves");
        step.note +=
            QLatin1Char(' ') +
            tr("The boundary is at most %1 from where it was.").arg(short_number(result.largest_boundary_distance));
    }
    step.advice = options.boundary.is_all_fixed()
                      ? tr("Let the boundary slide, move it less, or refine the mesh there.")
                      : tr("Move the boundary less, or refine the mesh there.");
    if (options.improves && options.target != GuaranteedOptions().target) step.target = options.target;
    if (!result.unmended.empty()) {
        step.notices.push_back(unmended_notice(result, options, step.advice, mesh.topology()));
        step.warns_of_tangled = false;
    }
    step.coordinates = std::move(result.coordinates);
    // One that was stopped does not come out the same again.
    if (result.reason != StopReason::cancelled) step.action = UntangleAction{options};
    return step;
}

Step run(const CurvedMesh& mesh, const SignedAngleOptions& options, UntangleObserver* observer,
         const TaskContext& context) {
    UntangleResult result = untangle_signed_angles(mesh, options, observer, context);
    Step step;
    const bool is_automatic = options.beta_choice == BetaChoice::automatic;
    step.name = is_automatic ? tr("Untangle, signed angles, β chosen")
                             : tr("Untangle, signed angles, β %1").arg(QString::number(options.beta, 'g', 4));
    step.note = describe_passes(result);
    step.advice = is_automatic
                      ? tr("Elements are still tangled: corners and boundary may be in the way. Undo, and try the "
                           "guaranteed method.")
                      : tr("Elements are still tangled: undo, and try a smaller or larger weight β.");
    step.coordinates = std::move(result.coordinates);
    step.action = UntangleAction{options};
    return step;
}

Step run(const CurvedMesh& mesh, const UnsignedAngleOptions& options, UntangleObserver* observer,
         const TaskContext& context) {
    UntangleResult result = untangle_unsigned_angles(mesh, options, observer, context);
    Step step;
    step.name = tr("Untangle, unsigned angles");
    step.details = options.is_guarded ? tr("Several starts and steps per edge, the best by its certificate")
                                      : tr("As published: one start and one first step per edge");
    step.note = describe_passes(result);
    step.advice =
        tr("Elements are still tangled: where tangling is deep, the sum of the angles is flat. Undo, and try "
           "the guaranteed method.");
    step.coordinates = std::move(result.coordinates);
    step.action = UntangleAction{options};
    return step;
}

}  // namespace

QString why_not_untangle(const MeshTopology& topology, UntangleMethod method) {
    if (method == UntangleMethod::guaranteed) return {};
    for (const ElementBlock& block : topology.blocks()) {
        if (dimension(block.type.shape) != topology.dimension()) continue;
        if (block.type.shape != Shape::triangle || block.type.order < 2)
            return tr("Angles untangle curved triangles of order 2 and up; this mesh has %1 elements.")
                .arg(QString::fromStdString(name(block.type)));
    }
    return {};
}

Step untangle(const CurvedMesh& mesh, const UntangleOptions& options, UntangleObserver* observer,
              const TaskContext& context) {
    return std::visit([&](const auto& of_method) { return run(mesh, of_method, observer, context); }, options);
}

}  // namespace curvewright
