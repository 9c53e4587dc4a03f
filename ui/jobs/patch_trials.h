#pragma once

#include <memory>
#include <optional>

#include <QObject>
#include <QThreadPool>

#include "core/quality/quality.h"
#include "core/timeline/explanation.h"
#include "core/timeline/landscape.h"

namespace curvewright {

/// What is to be found out about the patch in focus.
struct TrialRequest {
    std::shared_ptr<const CurvedMesh> mesh;   ///< positions in the step
    std::shared_ptr<const CurvedMesh> start;  ///< of the untangling
    OrientationSigns orientation_sign;
    std::shared_ptr<const StepExplanation> step;
    UntangleOptions options;
    TrialParameters parameters;
    /// Directions of the landscape, unit length.
    Eigen::RowVector3d across{1, 0, 0}, up{0, 1, 0};
};

/// The answer.
struct TrialResult {
    TrialParameters parameters;
    Landscape landscape;
    std::vector<double> levels;
    /// Per level, lines of equal height, (row, column) of the landscape.
    std::vector<std::vector<std::vector<Eigen::Vector2d>>> contours;
    PatchTrial::Outcome outcome;
    Index focus = 0;
    StepNumber step = 0;
};

/// Tries patches with other parameters on a thread of its own; the last request is what counts. All members are for the
/// window's thread.
class PatchTrials : public QObject {
    Q_OBJECT

  public:
    explicit PatchTrials(QObject* parent = nullptr);
    ~PatchTrials() override;

    void ask(TrialRequest request);
    /// Nothing is wanted any more.
    void cancel();
    bool is_busy() const { return is_running_; }

    static constexpr int resolution = 61, level_count = 11;
    /// The work itself. Throws what PatchTrial throws, Cancelled.
    static TrialResult answer(const TrialRequest& request, const TaskContext& context);

  signals:
    /// null: the patch cannot be tried.
    void answered(std::shared_ptr<const TrialResult> result);

  private:
    void start();

    QThreadPool pool_;
    std::stop_source stop_;
    std::optional<TrialRequest> next_;
    bool is_running_ = false;
};

}  // namespace curvewright
