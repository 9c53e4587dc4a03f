// The jobs of MeshJobs that record steps, and read and write them.

#include <fstream>

#include <QFileInfo>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/io/deformation_file.h"
#include "core/timeline/recorder.h"
#include "core/timeline/replay.h"
#include "core/untangle/trace.h"
#include "core/untangle/trace_reader.h"
#include "ui/jobs/mesh_jobs.h"
#include "ui/jobs/mesh_state.h"
#include "ui/jobs/operation_steps.h"

namespace curvewright {
namespace {

/// Passed from the thread that records to the window's.
struct Outlet {
    std::shared_ptr<const Recording> recording;
};

}  // namespace

bool MeshJobs::untangle_recorded(const UntangleOptions& options) {
    if (!why_not_untangle(method_of(options)).isEmpty()) return false;
    if (is_untangled(options)) return true;
    auto outlet = std::make_shared<Outlet>();
    return run_step(
        tr("Untangling step by step"), false,
        [options, outlet](const CurvedMesh& mesh, const TaskContext& context) {
            // The method alone is stopped: where it keeps the best it has, that is recorded too.
            Recorder recorder;
            Step step = curvewright::untangle(mesh, options, &recorder, context);
            outlet->recording = recorder.finish();
            return step;
        },
        method_of(options) == UntangleMethod::guaranteed,
        [this, options, outlet](bool is_step) {
            const int step = is_step ? document_.history()->index() - 1 : -1;
            const QString name = is_step ? document_.history()->text(step) : tr("An untangling that moved nothing");
            emit recorded({outlet->recording, name, options, step});
        });
}

bool MeshJobs::can_record(int step) const {
    if (step < 0 || step >= document_.history()->count()) return false;
    const Action& action = document_.step_action(step);
    if (const auto* warp = std::get_if<WarpAction>(&action)) return warp->increments.has_value();
    return std::holds_alternative<UntangleAction>(action);
}

bool MeshJobs::record_step(int step) {
    if (!can_record(step)) return false;
    const Action action = document_.step_action(step);
    const auto mesh = document_.state_at(step).mesh;
    const QString name = document_.history()->text(step);
    return runner_.start(tr("Doing “%1” again").arg(name), [=, this](const TaskContext& context) {
        Recorder recorder({}, context);
        std::optional<UntangleOptions> options;
        if (const auto* warp = std::get_if<WarpAction>(&action)) {
            const auto path = std::filesystem::path(warp->deformation);
            const LoadedDeformation loaded{std::make_shared<const Deformation>(read_deformation(path, context)),
                                           QString::fromStdString(warp->deformation)};
            warp_step(*mesh, loaded, warp->options, warp->increments, context, &recorder);
        } else {
            options = std::get<UntangleAction>(action).options;
            curvewright::untangle(*mesh, *options, &recorder, context);
        }
        context.check();
        const auto recording = recorder.finish();
        return [=, this] { emit recorded({recording, name, options, step}); };
    });
}

bool MeshJobs::open_trace(const QString& path) {
    if (!document_.has_mesh()) return false;
    const auto mesh = document_.state().mesh;
    const QString name = QFileInfo(path).fileName();
    return runner_.start(tr("Reading %1").arg(name), [=, this](const TaskContext& context) {
        std::ifstream stream(to_path(path));
        if (!stream) throw InvalidInput(tr("%1 cannot be read.").arg(path).toStdString());
        Recorder recorder({}, context);
        read_trace(stream, name.toStdString(), *mesh, recorder, context);
        const auto recording = recorder.finish();
        return [=, this] { emit recorded({recording, name, std::nullopt, -1}); };
    });
}

bool MeshJobs::save_trace(const std::shared_ptr<const Recording>& recording, const QString& path) {
    return runner_.start(tr("Writing %1").arg(QFileInfo(path).fileName()), [=, this](const TaskContext& context) {
        AtomicFile file(to_path(path));
        std::ofstream stream(file.path());
        TraceWriter writer(stream);
        replay(recording, writer, context);
        stream.close();
        if (!stream) throw InvalidInput(tr("%1 cannot be written.").arg(path).toStdString());
        file.commit();
        return [=, this] { emit note(tr("Wrote %1.").arg(path)); };
    });
}

}  // namespace curvewright
