#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>

#include <QMetaObject>
#include <QObject>

#include "core/base/error.h"

namespace curvewright {

/// Calls a function on the window's thread, in a turn of its event loop of its own, from a worker that waits for it.
/// What the function throws is thrown here; Cancelled if stop is asked for first. window: an object of that thread.
template <class Result>
Result call_in_window(QObject* window, std::function<Result()> function, const std::stop_token& stop) {
    // Shared by both threads; whoever gives up first leaves it to the other.
    struct Call {
        std::mutex mutex;
        std::condition_variable_any is_over;
        bool is_done = false, is_given_up = false;
        std::optional<Result> result;
        std::exception_ptr problem;
    };
    auto call = std::make_shared<Call>();
    QMetaObject::invokeMethod(
        window,
        [call, function = std::move(function)] {
            {
                const std::lock_guard lock(call->mutex);
                if (call->is_given_up) return;
            }
            std::optional<Result> result;
            std::exception_ptr problem;
            try {
                result = function();
            } catch (...) {
                problem = std::current_exception();
            }
            const std::lock_guard lock(call->mutex);
            call->result = std::move(result);
            call->problem = problem;
            call->is_done = true;
            call->is_over.notify_all();
        },
        Qt::QueuedConnection);
    std::unique_lock lock(call->mutex);
    if (!call->is_over.wait(lock, stop, [&] { return call->is_done; })) {
        call->is_given_up = true;
        throw Cancelled();
    }
    if (call->problem) std::rethrow_exception(call->problem);
    return std::move(*call->result);
}

}  // namespace curvewright
