#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace curvewright {
namespace {

// Debian's oneTBB is not built for the thread sanitizer, which therefore does not see that a task starts after its loop
// and ends before the loop returns. These two tell it; elsewhere they are nothing.
void happens_before([[maybe_unused]] void* point) {
#if defined(__SANITIZE_THREAD__)
    __tsan_release(point);
#endif
}
void happens_after([[maybe_unused]] void* point) {
#if defined(__SANITIZE_THREAD__)
    __tsan_acquire(point);
#endif
}

}  // namespace

void set_thread_count(int threads) {
    static std::unique_ptr<tbb::global_control> control;
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    const auto count = threads > 0 ? static_cast<std::size_t>(threads)
                                   : std::size_t{std::max(1u, std::thread::hardware_concurrency())};
    control.reset();
    control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
}

void parallel_for(std::size_t count, std::size_t grain, const TaskContext& context, std::string_view phase,
                  const std::function<void(std::size_t, std::size_t)>& body) {
    if (count == 0) return;
    const std::size_t step = std::max<std::size_t>(1, grain);
    const std::size_t pieces = (count + step - 1) / step;
    const auto caller = std::this_thread::get_id();
    std::atomic<std::size_t> done = 0;
    char start = 0, end = 0;
    happens_before(&start);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pieces, 1), [&](const auto& range) {
        for (std::size_t piece = range.begin(); piece != range.end(); ++piece) {
            happens_after(&start);
            context.check();
            body(piece * step, std::min(count, (piece + 1) * step));
            happens_before(&end);
            const std::size_t finished = ++done;
            // Only the calling thread reports, so that callbacks need no lock and stay on the thread they expect.
            if (!phase.empty() && std::this_thread::get_id() == caller)
                context.report(phase, static_cast<double>(finished) / static_cast<double>(pieces));
        }
    });
    happens_after(&end);
    context.check();
}

}  // namespace curvewright
