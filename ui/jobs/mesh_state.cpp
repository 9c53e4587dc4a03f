#include "ui/jobs/mesh_state.h"

namespace curvewright {

MeshState make_state(CurvedMesh mesh, const TaskContext& context, const MeshState* origin) {
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

TaskContext part_of(const TaskContext& context, const QString& title, double begin, double end) {
    TaskContext part{context.stop, {}};
    if (context.progress)
        part.progress = [progress = context.progress, title = title.toStdString(), begin, end](std::string_view phase,
                                                                                               double fraction) {
            const std::string text = phase.empty() ? title : title + ", " + std::string(phase);
            progress(text, begin + fraction * (end - begin));
        };
    return part;
}

}  // namespace curvewright
