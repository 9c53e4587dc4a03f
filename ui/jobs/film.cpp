#include "ui/jobs/film.h"

#include <algorithm>
#include <utility>

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QRegularExpression>

#include "core/base/error.h"
#include "core/io/deformation_file.h"
#include "core/session/timeline_frames.h"
#include "ui/document/number_format.h"
#include "ui/jobs/in_window.h"
#include "ui/jobs/mesh_state.h"
#include "ui/jobs/picture_file.h"

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("curvewright::MeshJobs", text);
}

QImage draw_in_window(QObject* window, const std::function<QImage(const Frame&)>& draw,
                      std::shared_ptr<const Frame> frame, const std::stop_token& stop) {
    const auto image = call_in_window<QImage>(
        window, [draw, frame = std::move(frame)] { return draw(*frame); }, stop);
    if (image.isNull())
        throw Unsupported(tr("The picture could not be drawn: there is not enough graphics memory.").toStdString());
    return image;
}

/// What a leg of a film is made of.
struct LegPlan {
    QString name;
    std::shared_ptr<const CurvedMesh> start, end;
    QString deformation_path;                        ///< "" = straight
    std::shared_ptr<const Deformation> deformation;  ///< if it is still loaded
    std::optional<WarpOptions> warp;
};

MotionLeg leg_of(const LegPlan& plan, bool& is_lost, const TaskContext& context) {
    MotionLeg leg{plan.name.toStdString(), plan.start->coordinates(), plan.end->coordinates(), plan.deformation,
                  plan.warp};
    if (leg.deformation || plan.deformation_path.isEmpty()) return leg;
    try {
        leg.deformation =
            std::make_shared<const Deformation>(read_deformation(to_path(plan.deformation_path), context));
    } catch (const InvalidInput&) {
        is_lost = true;
    }
    return leg;
}

/// What the window draws of a frame.
QImage frame_image(QObject* window, const FilmRequest& request, FrameSource& source, int index, int number, int count,
                   const TaskContext& context) {
    const QString phase = tr("frame %1 of %2").arg(format_count(number + 1), format_count(count));
    context.report(phase.toStdString(), static_cast<double>(number) / count);
    auto frame = std::make_shared<const Frame>(source.make(index, {context.stop, {}}));
    return draw_in_window(window, request.draw, std::move(frame), context.stop);
}

void write_pictures(QObject* window, const FilmRequest& request, FrameSource& source, int pictures,
                    const TaskContext& context) {
    const int there = source.count();
    const QStringList older = film_files(request.folder, request.prefix);
    QStringList written;
    for (int index = 0; index < there; ++index) {
        const QByteArray bytes = encode_png(frame_image(window, request, source, index, index, there, context));
        // The way back shows the same.
        std::vector<int> places{index};
        if (request.goes_back && index > 0 && index < there - 1) places.push_back(pictures - index);
        for (const int place : places) {
            written << film_file(request.folder, request.prefix, place + 1);
            write_bytes(written.back(), bytes, {context.stop, {}});
        }
    }
    // A video of the pictures must not end with those of an older film.
    for (const QString& file : older)
        if (!written.contains(file)) QFile::remove(file);
}

/// Returns the size of the file.
quint64 write_animation(QObject* window, const FilmRequest& request, FrameSource& source, int pictures,
                        const TaskContext& context) {
    const TaskContext silent{context.stop, {}};
    AnimationFile file(to_path(animation_path(request.folder, request.prefix)), *request.animation);
    for (int number = 0; number < pictures; ++number) {
        const int index = there_and_back(number, source.count());
        const QImage image = frame_image(window, request, source, index, number, pictures, context)
                                 .convertToFormat(QImage::Format_RGBA8888);
        file.add({image.constBits(), static_cast<std::size_t>(image.sizeInBytes())}, silent);
    }
    context.report(tr("the file").toStdString(), 1.0);
    return file.finish(silent);
}

}  // namespace

QString film_file(const QString& folder, const QString& prefix, int number) {
    return QDir(folder).filePath(QStringLiteral("%1-%2.png").arg(prefix).arg(number, 4, 10, QLatin1Char('0')));
}

QStringList film_files(const QString& folder, const QString& prefix) {
    const QRegularExpression pattern(QStringLiteral("^%1-\\d{4,}\\.png$").arg(QRegularExpression::escape(prefix)));
    QStringList files;
    const QDir dir(folder);
    for (const QString& name : dir.entryList(QDir::Files))
        if (pattern.match(name).hasMatch()) files << dir.filePath(name);
    return files;
}

QString animation_path(const QString& folder, const QString& prefix) {
    return QDir(folder).filePath(prefix + QStringLiteral(".webp"));
}

int pictures_of(int frames, bool goes_back) {
    return goes_back ? std::max(1, 2 * (frames - 1)) : frames;
}

JobRunner::Work film_work(QObject* window, FilmRequest request) {
    return [window, request = std::move(request)](const TaskContext& context) -> JobRunner::Finish {
        const std::unique_ptr<FrameSource> source = request.source({context.stop, {}});
        if (!QDir().mkpath(request.folder))
            throw InvalidInput(request.folder.toStdString(), 0,
                               tr("this folder cannot be made; choose another one.").toStdString());
        FilmResult result;
        result.pictures = pictures_of(source->count(), request.goes_back);
        if (request.animation)
            result.bytes = write_animation(window, request, *source, result.pictures, context);
        else
            write_pictures(window, request, *source, result.pictures, context);
        result.remark = QString::fromStdString(source->remark());
        return [then = request.then, result] {
            if (then) then(result);
        };
    };
}

std::function<std::unique_ptr<FrameSource>(const TaskContext&)> film_of_history(const MeshDocument& document, int from,
                                                                                int count) {
    std::vector<LegPlan> plans;
    for (int step = from; step < document.history()->index(); ++step) {
        LegPlan plan;
        plan.name = document.history()->text(step);
        plan.start = document.state_at(step).mesh;
        plan.end = document.state_at(step + 1).mesh;
        const Action& action = document.step_action(step);
        if (const auto* deform = std::get_if<DeformAction>(&action))
            plan.deformation_path = QString::fromStdString(deform->deformation);
        // One in increments with weights of its own at every step is more than one warp.
        if (const auto* warp = std::get_if<WarpAction>(&action); warp && !warp->increments) {
            plan.deformation_path = QString::fromStdString(warp->deformation);
            plan.warp = warp->options;
        }
        const auto& loaded = document.deformation();
        if (!plan.deformation_path.isEmpty() && loaded && loaded->file_path == plan.deformation_path)
            plan.deformation = loaded->deformation;
        plans.push_back(std::move(plan));
    }
    const MeshState& present = document.state();
    const std::optional<OrientationSigns> sign =
        present.quality ? std::optional(present.quality->orientation_sign) : std::nullopt;
    return [plans, mesh = present.mesh, sign, count](const TaskContext& context) -> std::unique_ptr<FrameSource> {
        std::vector<MotionLeg> legs;
        std::vector<std::string> lost;
        for (const LegPlan& plan : plans) {
            bool is_lost = false;
            legs.push_back(leg_of(plan, is_lost, context));
            if (is_lost) lost.push_back(legs.back().caption);
        }
        auto frames = std::make_unique<MotionFrames>(*mesh, sign, std::move(legs), count);
        for (const std::string& caption : lost) frames->add_straightened(caption);
        return frames;
    };
}

std::function<std::unique_ptr<FrameSource>(const TaskContext&)> film_of_timeline(
    std::shared_ptr<const Recording> recording, StepLevel level, int count) {
    return [recording = std::move(recording), level, count](const TaskContext&) -> std::unique_ptr<FrameSource> {
        return std::make_unique<TimelineFrames>(recording, level, count, 0, recording->step_count() - 1);
    };
}

int count_steps(const Recording& recording, StepLevel level) {
    int count = 1;
    for (StepNumber step = 0; step + 1 < recording.step_count(); step = step_after(recording, step, level)) ++count;
    return count;
}

}  // namespace curvewright
