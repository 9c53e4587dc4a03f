#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <QImage>
#include <QObject>
#include <QString>
#include <QStringList>

#include "core/io/animation_file.h"
#include "core/session/frames.h"
#include "core/timeline/search.h"
#include "ui/document/mesh_document.h"
#include "ui/jobs/job_runner.h"

namespace curvewright {

/// What a finished film is.
struct FilmResult {
    int pictures = 0;
    quint64 bytes = 0;  ///< of an animation's file
    QString remark;     ///< "" or a sentence
};

/// A film as pictures, PREFIX-0001.png, PREFIX-0002.png, …, or as one animation, PREFIX.webp.
struct FilmRequest {
    /// Makes what is shown. Called on the worker's thread.
    std::function<std::unique_ptr<FrameSource>(const TaskContext&)> source;
    bool goes_back = false;  ///< there and back without a stop, so that it can be shown in a loop
    QString folder, prefix;
    /// An animation instead of pictures, of the size that is drawn.
    std::optional<AnimationOptions> animation;
    /// Draws a frame. Called on the window's thread, once per turn of its event loop. A null image: it cannot be drawn.
    std::function<QImage(const Frame&)> draw;
    /// All of it is there. Called on the window's thread.
    std::function<void(const FilmResult&)> then;
};

/// How many pictures a film of so many frames has.
int pictures_of(int frames, bool goes_back);
/// Path of a picture; number: from 1.
QString film_file(const QString& folder, const QString& prefix, int number);
/// Path of an animation.
QString animation_path(const QString& folder, const QString& prefix);
/// Paths of the pictures that a film of this name has left in a folder.
QStringList film_files(const QString& folder, const QString& prefix);

/// The work of a job: frames are made, certified and written on its thread, drawn on the window's. window: an object of
/// the window's thread. Every picture appears whole or not at all; when the film is complete, those of a longer one of
/// the same name are removed. An animation appears when it is complete; its way back is computed and drawn once more,
/// so that no more than a frame is kept.
JobRunner::Work film_work(QObject* window, FilmRequest request);

/// The way of the document from a state of its history (0 = as opened) to the present one. pre: has_mesh(), from <
/// history()->index(), count >= 2.
std::function<std::unique_ptr<FrameSource>(const TaskContext&)> film_of_history(const MeshDocument& document, int from,
                                                                                int count);

/// The steps of a timeline: all of a level or, if there are more, as many of them as `count` in even distances. pre:
/// count >= 2.
std::function<std::unique_ptr<FrameSource>(const TaskContext&)> film_of_timeline(
    std::shared_ptr<const Recording> recording, StepLevel level, int count);
/// How many steps of a level there are, the first one and the last one included.
int count_steps(const Recording& recording, StepLevel level);

}  // namespace curvewright
