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
        connect(&timer_, &QTimer::timeout, this, &Turns::call_first);
    }
    void add(QObject* receiver, std::function<void()> call) {
        waiting_.emplace_back(receiver, std::move(call));
        if (!timer_.isActive()) timer_.start(1);
    }

  private:
    void call_first() {
        while (!waiting_.empty()) {
            const auto [receiver, call] = std::move(waiting_.front());
            waiting_.pop_front();
            if (!receiver) continue;
            // Also if the call turns an event loop of its own.
            if (!waiting_.empty()) timer_.start(1);
            call();
            // Counted from now: not again in this turn.
            if (!waiting_.empty()) timer_.start(1);
            return;
        }
    }

    std::deque<std::pair<QPointer<QObject>, std::function<void()>>> waiting_;
    QTimer timer_;
};

}  // namespace

void call_in_own_turn(QObject* receiver, std::function<void()> call) {
    static QPointer<Turns> turns;
    if (!turns) turns = new Turns(QCoreApplication::instance());
    turns->add(receiver, std::move(call));
}

}  // namespace curvewright
