#include "ui/jobs/live_drag.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <limits>
#include <mutex>
#include <thread>

#include <QTimer>

#include "core/base/error.h"
#include "core/base/stopwatch.h"

namespace curvewright {
namespace {

/// A frame whose quality takes less is made in one go; otherwise the quality follows from the other thread.
constexpr double longest_wait = 0.02;  ///< seconds

bool is_same(const WarpOptions& a, const WarpOptions& b) {
    return a.weighting == b.weighting && a.distance_power == b.distance_power && a.sharing_power == b.sharing_power &&
           a.neighbours == b.neighbours && a.outside_hull == b.outside_hull && a.poisson_ratio == b.poisson_ratio &&
           a.stiffening == b.stiffening && a.prescribed_nodes == b.prescribed_nodes &&
           a.following_nodes == b.following_nodes && a.solver == b.solver;
}

bool is_rest(const AffineMotion& motion) {
    return motion.shift.isZero(0.0) && motion.linear.isIdentity(0.0);
}

/// Whether two states of a mesh differ by no more than rounding: a few units in the last place of its coordinates.
bool is_same_place(const Coordinates& a, const Coordinates& b) {
    constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
    if (a.rows() == 0) return true;
    return (a - b).cwiseAbs().maxCoeff() <= rounding * a.cwiseAbs().maxCoeff();
}

}  // namespace

/// One thread, one task after another, and the weights that were computed last.
class LiveDrag::Worker {
  public:
    using Task = std::function<void(const TaskContext&)>;

    Worker() : thread_([this](const std::stop_token& stop) { run(stop); }) {}
    ~Worker() {
        cancel();
        thread_.request_stop();
        wake_.notify_all();
    }

    void start(Task task) {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
        wake_.notify_all();
    }
    /// Drops what waits and stops what runs.
    void cancel() {
        const std::lock_guard lock(mutex_);
        tasks_.clear();
        stop_.request_stop();
        stop_ = {};
    }
    /// Tasks only: the weights of a mesh.
    std::shared_ptr<const Warper> weights(const CurvedMesh& mesh, const WarpOptions& options,
                                          const TaskContext& context) {
        // A few: with pinned or dragged interior nodes and without, with a boundary that follows, of the present mesh.
        const auto known = std::find_if(warpers_.begin(), warpers_.end(), [&](const auto& warper) {
            return warper->mesh().shared_topology() == mesh.shared_topology() && is_same(warper->options(), options) &&
                   warper->mesh().coordinates() == mesh.coordinates();
        });
        if (known != warpers_.end()) {
            std::rotate(warpers_.begin(), known, known + 1);
            return warpers_.front();
        }
        std::erase_if(warpers_,
                      [&](const auto& warper) { return warper->mesh().shared_topology() != mesh.shared_topology(); });
        constexpr std::size_t most_kept = 3;
        if (warpers_.size() >= most_kept) warpers_.pop_back();
        warpers_.insert(warpers_.begin(), std::make_shared<const Warper>(mesh, options, context));
        return warpers_.front();
    }

    WarperSource source(const TaskContext& context) {
        return [this, context](const CurvedMesh& mesh, const WarpOptions& options) {
            return weights(mesh, options, context);
        };
    }

  private:
    void run(const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        while (true) {
            wake_.wait(lock, stop, [this] { return !tasks_.empty(); });
            if (stop.stop_requested()) return;
            const Task task = std::move(tasks_.front());
            tasks_.pop_front();
            const TaskContext context{stop_.get_token(), {}};
            lock.unlock();
            task(context);
            lock.lock();
        }
    }

    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::deque<Task> tasks_;
    std::stop_source stop_;
    std::vector<std::shared_ptr<const Warper>> warpers_;  ///< used last first
    std::jthread thread_;
};

LiveDrag::LiveDrag(MeshDocument& document, QObject* parent)
    : QObject(parent), document_(document), worker_(std::make_unique<Worker>()) {
    connect(&document, &MeshDocument::opened, this, [this] {
        if (is_active()) close(false);
        worker_->cancel();
    });
}

LiveDrag::~LiveDrag() = default;

void LiveDrag::set_weights(const WarpOptions& options) {
    options_ = options;
    options_.prescribed_nodes.clear();
}

void LiveDrag::set_pinned(const std::vector<Index>& pinned) {
    pinned_ = pinned;
}

void LiveDrag::set_rules(const DragRules& rules) {
    rules_ = rules;
}

namespace {

/// The mesh whose weights a drag takes: the one that was opened, so that the way back leads back. After renumbering the
/// present one.
std::shared_ptr<const CurvedMesh> base_of(const MeshDocument& document) {
    const auto &opened = document.original().mesh, &present = document.state().mesh;
    return opened->shared_topology() == present->shared_topology() ? opened : present;
}

}  // namespace

void LiveDrag::prepare() {
    if (is_active() || !document_.has_mesh() || document_.state().mesh->topology().dimension() < 2) return;
    worker_->start([worker = worker_.get(), mesh = base_of(document_), options = options_](const TaskContext& context) {
        try {
            worker->weights(*mesh, options, context);
        } catch (const Error&) {
            // Whoever drags will be told.
        }
    });
}

void LiveDrag::set_phase(Phase phase) {
    const bool was_active = is_active();
    phase_ = phase;
    if (is_active() != was_active) emit active_changed(is_active());
}

void LiveDrag::set_allowed(bool is_allowed) {
    if (is_allowed == is_allowed_) return;
    is_allowed_ = is_allowed;
    emit allowed_changed();
}

void LiveDrag::begin(const DragRequest& request) {
    if (!can_begin()) return;
    start_ = document_.state();
    used_rules_ = rules_;
    used_pins_ = pinned_;
    motion_ = {};
    has_moved_ = false;
    report_ = start_.quality ? std::make_shared<QualityReport>(*start_.quality) : nullptr;
    finishes_ = false;
    set_up(request);
}

void LiveDrag::change(const DragRequest& request) {
    if (!is_active() || finishes_) return;
    report_ = start_.quality ? std::make_shared<QualityReport>(*start_.quality) : nullptr;
    set_up(request);
}

void LiveDrag::set_up(const DragRequest& request) {
    worker_->cancel();
    request_ = request;
    drag_.reset();
    is_certifying_ = is_newer_ = false;
    const int generation = ++generation_;
    set_phase(Phase::preparing);
    const DragSetup setup{request.set, request.kind, request.origin, used_pins_, options_, used_rules_};
    worker_->start([this, generation, setup, worker = worker_.get(), base = base_of(document_),
                    start = start_](const TaskContext& context) {
        std::shared_ptr<Drag> drag;
        QString problem;
        try {
            const TaskContext telling = reporting(context, generation);
            drag = std::make_shared<Drag>(setup, *base, *start.mesh, start.quality, worker->source(telling), telling);
        } catch (const Cancelled&) {
            return;
        } catch (const Error& error) {
            problem = QString::fromUtf8(error.what());
        }
        QMetaObject::invokeMethod(
            this,
            [this, generation, drag, problem] {
                if (generation != generation_) return;
                if (drag) {
                    receive(drag);
                } else {
                    cancel();
                    emit failed(problem);
                }
            },
            Qt::QueuedConnection);
    });
}

TaskContext LiveDrag::reporting(const TaskContext& context, int generation) {
    // A few times a second is enough for people.
    auto last = std::make_shared<Stopwatch>();
    return {context.stop, [this, generation, last](std::string_view phase, double fraction) {
                constexpr double pause = 0.1;
                if (last->seconds() < pause) return;
                *last = {};
                QMetaObject::invokeMethod(
                    this,
                    [this, generation, text = QString::fromUtf8(phase.data(), static_cast<qsizetype>(phase.size())),
                     fraction] {
                        if (generation == generation_) emit working(text, fraction);
                    },
                    Qt::QueuedConnection);
            }};
}

void LiveDrag::receive(std::shared_ptr<Drag> drag) {
    emit working({}, 1.0);
    drag_ = std::move(drag);
    set_phase(Phase::live);
    if (finishes_) {
        finish();
    } else if (!is_rest(motion_)) {
        step();
    }
}

void LiveDrag::move(const AffineMotion& motion) {
    if (!is_active() || finishes_) return;
    motion_ = motion;
    if (!is_rest(motion)) has_moved_ = true;
    if (phase_ != Phase::live || is_step_due_) return;
    // Moves that come faster than frames can be made are skipped.
    is_step_due_ = true;
    if (!is_held_) QTimer::singleShot(0, this, &LiveDrag::step);
}

void LiveDrag::hold_frames(bool is_held) {
    if (is_held_ == is_held) return;
    is_held_ = is_held;
    if (is_held || !is_step_due_) return;
    // Not in the turn of the event loop that shows the last frame, but in the next: what the user does comes first.
    QTimer::singleShot(0, this, [this] { QTimer::singleShot(0, this, &LiveDrag::step); });
}

void LiveDrag::step() {
    if (is_held_) return;  // hold_frames() comes back here
    is_step_due_ = false;
    if (phase_ != Phase::live || finishes_) return;
    const Coordinates& positions = drag_->move(motion_);
    if (!report_) {
        emit frame(positions, nullptr);
    } else if (certify_seconds_ < longest_wait && !is_certifying_) {
        const Stopwatch watch;
        drag_->certify(positions, *report_);
        certify_seconds_ = watch.seconds();
        emit frame(positions, report_.get());
    } else {
        emit frame(positions, nullptr);
        is_newer_ = true;
        if (!is_certifying_) certify_behind(positions);
    }
}

void LiveDrag::certify_behind(const Coordinates& at) {
    is_certifying_ = true;
    is_newer_ = false;
    worker_->start(
        [this, generation = generation_, drag = drag_, report = report_, positions = at](const TaskContext& context) {
            const Stopwatch watch;
            try {
                drag->certify(positions, *report, context);
            } catch (const Cancelled&) {
                return;
            }
            const auto take = [this, generation, report, seconds = watch.seconds()] {
                if (generation != generation_) return;
                is_certifying_ = false;
                certify_seconds_ = seconds;
                if (finishes_) return keep(report);
                emit frame(drag_->positions(), report.get());
                if (is_newer_) certify_behind(drag_->positions());
            };
            // Of a large mesh every frame takes long to take over: not two of them at once.
            QMetaObject::invokeMethod(
                this, [this, take] { QTimer::singleShot(0, this, take); }, Qt::QueuedConnection);
        });
}

void LiveDrag::finish() {
    if (!is_active()) return;
    if (is_rest(motion_)) return leave();
    finishes_ = true;
    if (phase_ != Phase::live) return;  // receive() comes back here
    set_phase(Phase::finishing);
    const Coordinates& positions = drag_->move(motion_);
    // Whatever runs is of older positions.
    const int generation = ++generation_;
    worker_->cancel();
    // A report whose certification was stopped is not to be used again.
    if (is_certifying_) report_ = std::make_shared<QualityReport>(*start_.quality);
    if (!drag_->needs_settling()) return finish_at(positions);
    emit frame(positions, nullptr);
    worker_->start([this, generation, drag = drag_, positions, worker = worker_.get()](const TaskContext& context) {
        auto end = std::make_shared<Coordinates>();
        QString problem;
        try {
            const TaskContext telling = reporting(context, generation);
            *end = drag->settled(positions, worker->source(telling), telling);
        } catch (const Cancelled&) {
            return;
        } catch (const Error& error) {
            problem = QString::fromUtf8(error.what());
        }
        QMetaObject::invokeMethod(
            this,
            [this, generation, end, problem] {
                if (generation != generation_) return;
                emit working({}, 1.0);
                if (problem.isEmpty()) return finish_at(*end);
                cancel();
                emit failed(problem);
            },
            Qt::QueuedConnection);
    });
}

void LiveDrag::finish_at(const Coordinates& positions) {
    if (is_same_place(start_.mesh->coordinates(), positions)) return leave();
    end_ = positions;
    emit frame(end_, nullptr);
    if (!report_) return keep(nullptr);
    certify_behind(end_);
}

void LiveDrag::keep(std::shared_ptr<QualityReport> report) {
    MeshState state;
    state.mesh = std::make_shared<const CurvedMesh>(start_.mesh->with_coordinates(end_));
    state.quality = std::move(report);
    state.quality_note = start_.quality_note;
    state.applied_deformations = start_.applied_deformations;
    const MeshTopology& topology = start_.mesh->topology();
    DragAction action;
    for (const Index node : request_.set.nodes) action.nodes.push_back(topology.node_tag(node));
    action.weights = request_.set.weights;
    for (const Index node : used_pins_) action.pinned.push_back(topology.node_tag(node));
    action.rules = used_rules_;
    action.kind = request_.kind;
    action.origin = {request_.origin[0], request_.origin[1], request_.origin[2]};
    action.motion = motion_;
    action.options = options_;
    const QString name = request_.name;
    close(true);
    document_.apply(name, state, std::move(action));
}

void LiveDrag::leave() {
    close(false);
    if (has_moved_) emit nothing_moved();
}

void LiveDrag::cancel() {
    if (is_active()) close(false);
}

void LiveDrag::close(bool is_kept) {
    ++generation_;
    worker_->cancel();
    drag_.reset();
    report_.reset();
    start_ = {};
    end_.resize(0, 3);
    finishes_ = is_certifying_ = is_newer_ = false;
    set_phase(Phase::idle);
    emit ended(is_kept);
}

}  // namespace curvewright
