#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#if !defined(__SANITIZE_THREAD__)
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#endif

namespace curvewright {
namespace {

std::size_t thread_count(int threads) {
    return threads > 0 ? static_cast<std::size_t>(threads)
                       : std::size_t{std::max(1u, std::thread::hardware_concurrency())};
}

#if defined(__SANITIZE_THREAD__)

// Debian's oneTBB is not built for the thread sanitizer, which reports what it does inside as races. Suppressing these
// would hide our own: plain threads instead.
std::atomic<std::size_t> most_threads = thread_count(0);

void run_pieces(std::size_t pieces, const std::function<void(std::size_t)>& run) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr error;
    const auto work = [&] {
        for (std::size_t piece = next++; piece < pieces; piece = next++) {
            try {
                run(piece);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!error) error = std::current_exception();
                next = pieces;
            }
        }
    };
    {
        std::vector<std::jthread> threads;
        for (std::size_t i = 1; i < std::min(pieces, most_threads.load()); ++i) threads.emplace_back(work);
        work();
    }
    if (error) std::rethrow_exception(error);
}

#else

void run_pieces(std::size_t pieces, const std::function<void(std::size_t)>& run) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pieces, 1), [&](const auto& range) {
        for (std::size_t piece = range.begin(); piece != range.end(); ++piece) run(piece);
    });
}

#endif

}  // namespace

void set_thread_count(int threads) {
#if defined(__SANITIZE_THREAD__)
    most_threads = thread_count(threads);
#else
    static std::unique_ptr<tbb::global_control> control;
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    control.reset();
    control =
        std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, thread_count(threads));
#endif
}

void parallel_for(std::size_t count, std::size_t grain, const TaskContext& context, std::string_view phase,
                  const std::function<void(std::size_t, std::size_t)>& body) {
    if (count == 0) return;
    const std::size_t step = std::max<std::size_t>(1, grain);
    const std::size_t pieces = (count + step - 1) / step;
    const auto caller = std::this_thread::get_id();
    std::atomic<std::size_t> done = 0;
    run_pieces(pieces, [&](std::size_t piece) {
        context.check();
        body(piece * step, std::min(count, (piece + 1) * step));
        const std::size_t finished = ++done;
        // Only the calling thread reports, so that callbacks need no lock and stay on the thread they expect.
        if (!phase.empty() && std::this_thread::get_id() == caller)
            context.report(phase, static_cast<double>(finished) / static_cast<double>(pieces));
    });
    context.check();
}

}  // namespace curvewright
