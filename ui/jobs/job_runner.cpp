#include "ui/jobs/job_runner.h"

#include <chrono>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <utility>

#include <QMetaObject>

#include "ui/jobs/own_turn.h"

namespace curvewright {

struct JobRunner::Outcome {
    Finish finish;
    QString error;
    bool was_cancelled = false;
};

/// What a thread has said last, and whether the window has yet to hear of it.
struct JobRunner::Said {
    std::mutex mutex;
    QString phase;
    double fraction = 0.0;
    bool is_waiting = false;
};

JobRunner::JobRunner(QObject* parent) : QObject(parent) {}

JobRunner::~JobRunner() {
    stop_.request_stop();
    if (thread_.joinable()) thread_.join();
}

bool JobRunner::start(const QString& title, Work work) {
    return launch(
        title, [work = std::move(work)](const TaskContext& context, const std::stop_token&) { return work(context); },
        false);
}

bool JobRunner::start_keepable(const QString& title, KeepableWork work) {
    return launch(title, std::move(work), true);
}

void JobRunner::stop_and_keep() {
    keep_.request_stop();
}

bool JobRunner::launch(const QString& title, KeepableWork work, bool can_keep) {
    if (is_running_) return false;
    if (thread_.joinable()) thread_.join();
    stop_ = std::stop_source();
    keep_ = std::stop_source();
    can_keep_ = can_keep;
    title_ = title;
    is_running_ = true;
    const int job = ++job_;
    emit running_changed(true);
    emit started(title);
    thread_ = std::jthread([this, job, stop = stop_.get_token(), keep = keep_.get_token(), work = std::move(work)] {
        TaskContext context;
        context.stop = stop;
        // Called on this thread only (parallel loops report from one thread at a time).
        context.progress = [this, job, said = std::make_shared<Said>(), last = std::chrono::steady_clock::time_point(),
                            last_phase = std::string()](std::string_view phase, double fraction) mutable {
            const auto now = std::chrono::steady_clock::now();
            if (phase == last_phase && now - last < std::chrono::milliseconds(50)) return;
            last = now;
            last_phase = phase;
            {
                const std::lock_guard lock(said->mutex);
                said->phase = QString::fromUtf8(phase.data(), static_cast<qsizetype>(phase.size()));
                said->fraction = fraction;
                if (std::exchange(said->is_waiting, true)) return;
            }
            QMetaObject::invokeMethod(this, [this, job, said] { tell(job, *said); });
        };
        auto outcome = std::make_shared<Outcome>();
        try {
            outcome->finish = work(context, keep);
            outcome->was_cancelled = stop.stop_requested();
        } catch (const Cancelled&) {
            outcome->was_cancelled = true;
        } catch (const std::bad_alloc&) {
            outcome->error = tr("There is not enough memory for this.");
        } catch (const std::exception& problem) {
            outcome->error = QString::fromUtf8(problem.what());
        }
        QMetaObject::invokeMethod(
            this, [this, job, outcome] { call_in_own_turn(this, [this, job, outcome] { deliver(job, outcome); }); });
    });
    return true;
}

void JobRunner::cancel() {
    stop_.request_stop();
}

void JobRunner::cancel_and_wait() {
    if (!is_running_) return;
    stop_.request_stop();
    thread_.join();
    ++job_;  // what the thread has posted is late from here on
    is_running_ = false;
    emit running_changed(false);
    emit cancelled(title_);
}

void JobRunner::tell(int job, Said& said) {
    QString phase;
    double fraction = 0.0;
    {
        const std::lock_guard lock(said.mutex);
        phase = said.phase;
        fraction = said.fraction;
        said.is_waiting = false;
    }
    if (is_running_ && job == job_) emit progress(phase, fraction);
}

void JobRunner::deliver(int job, const std::shared_ptr<Outcome>& outcome) {
    if (!is_running_ || job != job_) return;
    thread_.join();
    is_running_ = false;
    const QString title = title_;
    if (outcome->was_cancelled || stop_.stop_requested()) {
        emit running_changed(false);
        emit cancelled(title);
    } else if (!outcome->finish) {
        emit running_changed(false);
        emit failed(title, outcome->error);
    } else {
        outcome->finish();
        emit running_changed(false);
        emit finished(title);
    }
}

}  // namespace curvewright
