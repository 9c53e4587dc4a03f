#include "ui/jobs/step_player.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/timeline/cursor.h"

namespace curvewright {

/// One thread with the cursor. Of seeks and searches that wait only the latest of each kind is done.
class StepPlayer::Worker {
  public:
    Worker(StepPlayer& player, std::shared_ptr<const Recording> recording, int generation)
        : player_(player),
          recording_(std::move(recording)),
          generation_(generation),
          thread_([this](const std::stop_token& stop) { run(stop); }) {}
    ~Worker() {
        {
            const std::lock_guard lock(mutex_);
            thread_.request_stop();
            seek_stop_.request_stop();
            search_stop_.request_stop();
        }
        wake_.notify_all();
    }

    void seek(StepNumber step) {
        const std::lock_guard lock(mutex_);
        step_ = step;
        // What runs is left where it is: its positions without their proof.
        seek_stop_.request_stop();
        seek_stop_ = {};
        wake_.notify_all();
    }
    void search(const Breakpoints& breakpoints, int number) {
        const std::lock_guard lock(mutex_);
        breakpoints_ = breakpoints;
        search_ = number;
        search_stop_.request_stop();
        search_stop_ = {};
        wake_.notify_all();
    }

  private:
    void run(const std::stop_token& stop) {
        TimelineCursor cursor(recording_);
        StepExplainer explainer;
        std::unique_lock lock(mutex_);
        while (true) {
            wake_.wait(lock, stop, [this] { return step_ || breakpoints_; });
            if (stop.stop_requested()) return;
            if (step_) {
                const StepNumber step = *std::exchange(step_, std::nullopt);
                const TaskContext context{seek_stop_.get_token(), {}};
                lock.unlock();
                go_to(cursor, explainer, step, context);
            } else {
                const Breakpoints breakpoints = *std::exchange(breakpoints_, std::nullopt);
                const int number = search_;
                const TaskContext context{search_stop_.get_token(), {}};
                lock.unlock();
                find(breakpoints, number, context);
            }
            lock.lock();
        }
    }

    void go_to(TimelineCursor& cursor, StepExplainer& explainer, StepNumber step, const TaskContext& context) {
        auto shown = std::make_shared<Shown>();
        shown->step = step;
        QString problem;
        try {
            cursor.seek(step, context);
            shown->has_quality = true;
            shown->explanation = std::make_shared<const StepExplanation>(explainer.explain(cursor, context));
        } catch (const Cancelled&) {
        } catch (const Error& error) {
            problem = QString::fromUtf8(error.what());
        }
        shown->coordinates = cursor.coordinates();
        shown->quality = cursor.quality();
        shown->patch = cursor.patch();
        QMetaObject::invokeMethod(
            &player_,
            [player = &player_, generation = generation_, shown, problem] {
                player->receive(generation, shown, problem);
            },
            Qt::QueuedConnection);
    }

    void find(const Breakpoints& breakpoints, int number, const TaskContext& context) {
        std::vector<StepNumber> steps;
        try {
            steps = curvewright::break_steps(*recording_, breakpoints, context);
        } catch (const Cancelled&) {
            return;
        } catch (const Error&) {
            // Going to a step will tell.
        }
        QMetaObject::invokeMethod(
            &player_, [player = &player_, number, steps] { player->receive_breaks(number, steps); },
            Qt::QueuedConnection);
    }

    StepPlayer& player_;
    const std::shared_ptr<const Recording> recording_;
    const int generation_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::optional<StepNumber> step_;
    std::optional<Breakpoints> breakpoints_;
    int search_ = 0;
    std::stop_source seek_stop_, search_stop_;
    std::jthread thread_;
};

StepPlayer::StepPlayer(QObject* parent) : QObject(parent) {
    timer_.setTimerType(Qt::PreciseTimer);
    timer_.setInterval(5);
    connect(&timer_, &QTimer::timeout, this, &StepPlayer::tick);
}

StepPlayer::~StepPlayer() = default;

void StepPlayer::open(std::shared_ptr<const Recording> recording) {
    close();
    recording_ = std::move(recording);
    target_ = 0;
    auto start = std::make_shared<Shown>();
    start->coordinates = recording_->mesh().coordinates();
    start->quality = recording_->start_quality();
    start->has_quality = true;
    start->explanation = std::make_shared<const StepExplanation>();  // there is nothing yet
    shown_ = std::move(start);
    worker_ = std::make_unique<Worker>(*this, recording_, ++generation_);
    emit opened_changed(true);
    emit frame(shown_->coordinates, &shown_->quality);
    emit step_changed(0);
}

void StepPlayer::close() {
    if (!recording_) return;
    pause();
    worker_.reset();
    ++generation_;
    ++search_;
    recording_.reset();
    waiting_.reset();
    is_seeking_ = is_searching_ = false;
    breakpoints_ = {};
    break_steps_.clear();
    emit opened_changed(false);
    shown_.reset();
}

void StepPlayer::seek(StepNumber step) {
    target_ = std::min(step, recording_->step_count() - 1);
    is_seeking_ = true;
    worker_->seek(target_);
}

void StepPlayer::receive(int generation, std::shared_ptr<const Shown> shown, const QString& problem) {
    if (generation != generation_) return;
    if (shown->step == target_) is_seeking_ = false;
    if (!problem.isEmpty()) {
        pause();
        emit failed(problem);
        return;
    }
    waiting_ = std::move(shown);
    if (!is_held_) show_waiting();
}

void StepPlayer::show_waiting() {
    if (!waiting_) return;
    const auto shown = shown_ = std::exchange(waiting_, nullptr);
    emit frame(shown->coordinates, shown->has_quality ? &shown->quality : nullptr);
    if (shown == shown_) emit step_changed(shown->step);
}

void StepPlayer::hold_frames(bool is_held) {
    if (is_held_ == is_held) return;
    is_held_ = is_held;
    if (is_held || !waiting_) return;
    // Not in the turn of the event loop that shows the last frame, but in the next: what the user does comes first.
    QTimer::singleShot(0, this, [this] {
        if (!is_held_) show_waiting();
    });
}

void StepPlayer::go_to(StepNumber step) {
    if (!is_open()) return;
    pause();
    seek(step);
}

void StepPlayer::step_by(int direction) {
    if (!is_open()) return;
    go_to(direction > 0 ? step_after(*recording_, target_, level_) : step_before(*recording_, target_, level_));
}

void StepPlayer::step_into() {
    if (!is_open()) return;
    if (level_ != StepLevel::iteration) set_level(static_cast<StepLevel>(static_cast<int>(level_) + 1));
    step_by(1);
}

void StepPlayer::step_out() {
    if (!is_open()) return;
    if (level_ != StepLevel::pass) set_level(static_cast<StepLevel>(static_cast<int>(level_) - 1));
    step_by(1);
}

void StepPlayer::set_level(StepLevel level) {
    if (level == level_) return;
    level_ = level;
    emit level_changed(level);
}

void StepPlayer::set_speed(double speed) {
    speed = std::clamp(speed, min_speed, max_speed);
    if (speed == speed_) return;
    speed_ = speed;
    emit speed_changed(speed);
}

void StepPlayer::set_breakpoints(const Breakpoints& breakpoints) {
    if (!is_open()) return;
    breakpoints_ = breakpoints;
    break_steps_.clear();
    is_searching_ = !breakpoints.is_empty();
    ++search_;
    if (is_searching_) worker_->search(breakpoints, search_);
    emit breakpoints_changed();
}

void StepPlayer::receive_breaks(int search, std::vector<StepNumber> steps) {
    if (search != search_) return;
    is_searching_ = false;
    break_steps_ = std::move(steps);
    emit breakpoints_changed();
}

void StepPlayer::play() {
    if (!is_open() || is_playing()) return;
    if (target_ + 1 >= recording_->step_count()) seek(0);
    owed_ = 0.0;
    clock_.start();
    timer_.start();
    emit playing_changed(true);
}

void StepPlayer::pause() {
    if (!is_playing()) return;
    timer_.stop();
    emit playing_changed(false);
}

void StepPlayer::tick() {
    // Who shows the frames sets the pace where the speed is beyond it: steps are then passed over, not put off.
    constexpr double longest_pause = 0.5;  // seconds; a longer one is not made up for
    owed_ += speed_ * std::min(longest_pause, static_cast<double>(clock_.nsecsElapsed()) * 1e-9);
    clock_.start();
    if (is_searching_) owed_ = 0.0;
    if (owed_ < 1.0) return;
    if (is_seeking() || is_held_) {
        owed_ = std::min(owed_, std::max(1.0, longest_pause * speed_));
        return;
    }
    const StepNumber last = recording_->step_count() - 1;
    StepNumber step = target_;
    for (; owed_ >= 1.0 && step < last; owed_ -= 1.0) step = step_after(*recording_, step, level_);
    const auto next = std::upper_bound(break_steps_.begin(), break_steps_.end(), target_);
    const bool breaks = next != break_steps_.end() && *next <= step;
    if (breaks) step = *next;
    seek(step);
    if (!breaks && step < last) return;
    pause();
    if (breaks)
        emit at_break(step);
    else
        emit at_end();
}

}  // namespace curvewright
