#include "ui/jobs/own_turn.h"

#include <deque>
#include <utility>

#include <QCoreApplication>
#include <QPointer>
#include <QTimer>

namespace curvewright {
namespace {

class Turns : public QObject {
  public:
    explicit Turns(QObject* parent) : QObject(parent) {
        timer_.setSingleShot(true);
        timer_.setTimerType(Qt::PreciseTimer);
        connect(&timer_, &QTimer::timeout, this, &Turns::wait_for_turn);
        next_turn_.setSingleShot(true);
        next_turn_.setTimerType(Qt::PreciseTimer);
        connect(&next_turn_, &QTimer::timeout, this, &Turns::call_first);
    }
    void add(QObject* receiver, std::function<void()> call) {
        waiting_.emplace_back(receiver, std::move(call));
        begin();
    }

  private:
    void begin() {
        if (!timer_.isActive() && !next_turn_.isActive()) timer_.start(1);
    }
    /// This turn may have a repaint of the window in it, the next one is our own.
    void wait_for_turn() { next_turn_.start(0); }
    void call_first() {
        while (!waiting_.empty()) {
            const auto [receiver, call] = std::move(waiting_.front());
            waiting_.pop_front();
            if (!receiver) continue;
            // Also if the call turns an event loop of its own.
            if (!waiting_.empty()) begin();
            call();
            // Counted from now: not again in this turn.
            if (!waiting_.empty()) {
                next_turn_.stop();
                timer_.start(1);
            }
            return;
        }
    }

    std::deque<std::pair<QPointer<QObject>, std::function<void()>>> waiting_;
    QTimer timer_, next_turn_;
};

}  // namespace

void call_in_own_turn(QObject* receiver, std::function<void()> call) {
    static QPointer<Turns> turns;
    if (!turns) turns = new Turns(QCoreApplication::instance());
    turns->add(receiver, std::move(call));
}

}  // namespace curvewright
