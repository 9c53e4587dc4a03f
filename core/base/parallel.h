#pragma once

#include <cstddef>
#include <functional>

#include "core/base/task.h"

namespace curvewright {

/// Number of threads that parallel loops use from now on; 0 = one per processor. To be called before the work starts.
void set_thread_count(int threads);

/// Calls body(begin, end) for consecutive pieces of [0, count) on several threads. The pieces depend on count and grain
/// only, never on the number of threads, so a body that writes to its own indices gives the same result for every
/// thread count. Polls context.stop before each piece and throws Cancelled; an exception of a body is rethrown.
/// If phase is not empty, progress is reported (from one thread at a time).
void parallel_for(std::size_t count, std::size_t grain, const TaskContext& context, std::string_view phase,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace curvewright
