#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace curvewright {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceInTheSamePieces) {
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        std::vector<int> visits(1000, 0), piece_begin(1000, -1);
        parallel_for(visits.size(), 7, {}, {}, [&](std::size_t begin, std::size_t end) {
            EXPECT_EQ(begin % 7, 0u);
            for (std::size_t i = begin; i < end; ++i) {
                ++visits[i];
                piece_begin[i] = static_cast<int>(begin);
            }
        });
        for (std::size_t i = 0; i < visits.size(); ++i) {
            EXPECT_EQ(visits[i], 1);
            EXPECT_EQ(piece_begin[i], static_cast<int>(i / 7 * 7));
        }
    }
    set_thread_count(0);
}

TEST(ParallelFor, RethrowsAndCancels) {
    EXPECT_THROW(parallel_for(100, 1, {}, {}, [](std::size_t, std::size_t) { throw InvalidInput("bad"); }),
                 InvalidInput);
    std::stop_source source;
    std::atomic<int> calls = 0;
    EXPECT_THROW(parallel_for(10000, 1, {source.get_token(), {}}, {},
                              [&](std::size_t, std::size_t) {
                                  if (++calls == 5) source.request_stop();
                              }),
                 Cancelled);
    EXPECT_LT(calls, 10000);
    EXPECT_NO_THROW(parallel_for(0, 1, {}, {}, [](std::size_t, std::size_t) { FAIL(); }));
}

TEST(ParallelFor, ReportsProgressOnTheCallersThread) {
    const auto caller = std::this_thread::get_id();
    double last = 0.0;
    const ProgressCallback progress = [&](std::string_view phase, double fraction) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_EQ(phase, "Counting");
        last = std::max(last, fraction);
    };
    set_thread_count(1);
    parallel_for(50, 1, {{}, progress}, "Counting", [](std::size_t, std::size_t) {});
    set_thread_count(0);
    EXPECT_DOUBLE_EQ(last, 1.0);
}

}  // namespace
}  // namespace curvewright
