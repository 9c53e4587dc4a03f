#pragma once

#include <functional>
#include <optional>

#include <QObject>
#include <QString>

#include "core/io/mesh_io.h"
#include "core/timeline/recording.h"
#include "core/warp/incremental.h"
#include "ui/document/mesh_document.h"
#include "ui/document/notice.h"
#include "ui/jobs/film.h"
#include "ui/jobs/job_runner.h"
#include "ui/jobs/reporting.h"
#include "ui/jobs/restoring.h"
#include "ui/jobs/untangling.h"

namespace curvewright {

/// What to open.
struct OpenRequest {
    QString mesh_path;
    QString deformation_path;  ///< "" = none
    /// Apply the deformation to the boundary at once, as the first step of the history.
    bool apply_deformation = false;
    /// The mesh with the deformation applied is where the user starts, and not yet a change to be saved.
    bool is_starting_point = false;
    /// Called on the window's thread when the mesh is there, before finished().
    std::function<void()> then;
};

/// A recording and where it comes from.
struct RecordedRun {
    std::shared_ptr<const Recording> recording;
    QString name;
    std::optional<UntangleOptions> options;  ///< none: not an untangling done here
    /// The step of the document's history (0 = the first after opening) that it shows; -1 = none.
    int history_step = -1;
};

/// The operations of the window on its document: each takes a snapshot of the present state, calls the core on a worker
/// thread, certifies the result there, and becomes one step of the history. A failed or cancelled job changes nothing,
/// and one that moves nothing leaves no step. Each returns false, and does nothing, while another job is running.
class MeshJobs : public QObject {
    Q_OBJECT

  public:
    explicit MeshJobs(MeshDocument& document, QObject* parent = nullptr);

    MeshDocument& document() { return document_; }
    JobRunner& runner() { return runner_; }
    const JobRunner& runner() const { return runner_; }

    bool open(OpenRequest request);
    /// Opens what a journal has kept: the mesh with its whole history, every state certified anew. then: called on the
    /// window's thread when the document has it, with how much of the journal it is.
    bool recover(const QString& journal_path, std::function<void(const RestoredWork&)> then);
    /// Opens the mesh of a session and does again what led to its end, in the history. then: like OpenRequest::then.
    bool open_session(const QString& path, std::function<void()> then);
    bool load_deformation(const QString& path);
    /// Moves the boundary as the loaded deformation says; the interior stays.
    bool deform();
    /// Moves the boundary as the loaded deformation says, relative to the mesh as it is; the interior follows: at once,
    /// or in increments, up to the last state without tangled elements. Fails if no increment goes without them.
    bool warp(const WarpOptions& options, const std::optional<IncrementOptions>& increments = {});
    /// Moves interior nodes until no element is tangled, by the method that the options belong to.
    bool untangle(const UntangleOptions& options);
    /// The same, and recorded() follows.
    bool untangle_recorded(const UntangleOptions& options);
    /// Does a step of the history again, for its recording; the document stays. recorded() follows.
    bool record_step(int step);
    /// Reads what a TraceWriter wrote of an untangling of the open mesh. recorded() follows.
    bool open_trace(const QString& path);
    bool save_trace(const std::shared_ptr<const Recording>& recording, const QString& path);
    /// Raises the quality of a valid mesh.
    bool improve(const ImproveOptions& options);
    /// Numbers every element the other way round.
    bool flip();
    /// Renumbers the elements that run against their neighbours, see reorient().
    bool renumber();
    /// Writes the present state; VTU and VTK with quality and the displacement from the mesh as opened. mark_saved: the
    /// file becomes the document's own.
    bool write(const QString& path, std::optional<MeshFormat> format, bool mark_saved);

    /// Writes the pictures of a film; the document stays.
    bool write_film(FilmRequest request);
    /// Writes the report of the last untangling in the history, which is made again for that; the document stays.
    /// Does nothing if there is none.
    bool write_report(ReportRequest request);

    /// Why the operation cannot run on the present state, as a sentence; empty if it can.
    QString why_not_deform() const;
    QString why_not_warp() const;
    QString why_not_untangle(UntangleMethod method) const;
    QString why_not_improve() const;
    /// Whether a step of the history goes through steps of its own: an untangling, or a warp in increments.
    bool can_record(int step) const;

  signals:
    void recorded(const RecordedRun& run);
    /// What a finished operation has to say, one line: "Moved 3,232 interior nodes, iterative solver, 41 iterations."
    void note(const QString& text);
    /// What is to stay told until somebody has read it, about the present state.
    void noticed(const Notice& notice);

  private:
    void restore(const RestoredWork& work);
    /// A step that leaves every coordinate as it was, bit for bit, is none: that is noticed, and nothing else happens.
    /// then: called on the window's thread after the document has the step; is_step: whether there is one.
    /// can_keep: where the context says stop, the step returns the best it has instead of throwing.
    bool run_step(const QString& title, bool applies_deformation,
                  std::function<Step(const CurvedMesh&, const TaskContext&)> step, bool can_keep = false,
                  std::function<void(bool is_step)> then = {});

    /// What is told instead of a step from a state. Of a worker thread; what it returns is of the window's.
    JobRunner::Finish nothing_moved(Step result, const MeshState& state, std::function<void(bool is_step)> then);
    /// Whether there is nothing to be untangled in the present state; says so if there is not.
    bool is_untangled(const UntangleOptions& options);

    MeshDocument& document_;
    JobRunner runner_;
    /// The file that was opened last, and the hash of its bytes then.
    QString hashed_path_;
    std::string hash_;
};

}  // namespace curvewright
