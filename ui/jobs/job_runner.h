#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <thread>

#include <QObject>
#include <QString>

#include "core/base/task.h"

namespace curvewright {

/// Runs one job at a time on a thread of its own. A job is a function that must not touch anything of the window; it
/// returns what is to be done with its result on the window's thread. All members are for the window's thread.
class JobRunner : public QObject {
    Q_OBJECT

  public:
    using Finish = std::function<void()>;
    using Work = std::function<Finish(const TaskContext&)>;
    /// Work that can be asked to stop early and return the best it has so far: `keep` is asked for that.
    using KeepableWork = std::function<Finish(const TaskContext&, std::stop_token keep)>;

    explicit JobRunner(QObject* parent = nullptr);
    /// Asks a running job to stop and waits for its thread.
    ~JobRunner() override;

    bool is_running() const { return is_running_; }
    const QString& title() const { return title_; }

    /// Starts a job. Returns false, and does nothing, if one is running.
    bool start(const QString& title, Work work);
    bool start_keepable(const QString& title, KeepableWork work);
    /// Whether the running job can stop_and_keep().
    bool can_keep() const { return is_running_ && can_keep_; }
    /// Asks the running job to end with what it has; finished() follows.
    void stop_and_keep();
    /// Asks the running job to stop; cancelled() follows when it has. Its result is dropped even if it was complete.
    void cancel();
    /// cancel(), and returns only when the thread has ended; cancelled() is emitted before the return.
    void cancel_and_wait();

  signals:
    void started(const QString& title);
    /// At most 20 times per second, and at every new phase, unless there is more to tell before the event loop comes to
    /// it. fraction in [0, 1].
    void progress(const QString& phase, double fraction);
    /// The end of a job: exactly one of these three, after its Finish has run (finished) or without it.
    void finished(const QString& title);
    void failed(const QString& title, const QString& message);
    void cancelled(const QString& title);
    /// is_running() has changed.
    void running_changed(bool is_running);

  private:
    struct Outcome;
    struct Said;

    bool launch(const QString& title, KeepableWork work, bool can_keep);
    void tell(int job, Said& said);
    void deliver(int job, const std::shared_ptr<Outcome>& outcome);

    std::jthread thread_;
    std::stop_source stop_, keep_;
    bool can_keep_ = false;
    QString title_;
    int job_ = 0;  ///< number of the last job; an outcome of an older one is late and dropped
    bool is_running_ = false;
};

}  // namespace curvewright
