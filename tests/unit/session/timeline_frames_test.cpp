#include "core/session/timeline_frames.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/unit/timeline/runs.h"

namespace curvewright {
namespace {

TEST(TimelineFrames, AreTheStepsOfTheRecording) {
    const testing::Run run = testing::runs()[0];
    const auto recording = testing::record(run);
    const StepNumber last = recording->step_count() - 1;
    TimelineFrames passes(recording, StepLevel::pass, 0, 0, last);
    ASSERT_EQ(passes.count(), 1 + 3 + 1);
    EXPECT_EQ(passes.make(0, {}).mesh.coordinates(), run.mesh.coordinates());
    EXPECT_EQ(passes.make(4, {}).mesh.coordinates(), testing::untangle(run, nullptr));
    TimelineCursor cursor(recording);
    for (const int index : {3, 1, 2}) {  // in any order
        const Frame frame = passes.make(index, {});
        cursor.seek(passes.steps()[static_cast<std::size_t>(index)]);
        EXPECT_EQ(frame.mesh.coordinates(), cursor.coordinates());
        EXPECT_EQ(frame.quality->summary.min, cursor.quality().summary.min);
        EXPECT_TRUE(frame.highlighted.empty());
        EXPECT_NE(frame.caption.find("pass " + std::to_string(index)), std::string::npos) << frame.caption;
    }
    TimelineFrames some(recording, StepLevel::iteration, 25, 0, last);
    ASSERT_EQ(some.count(), 25);
    EXPECT_EQ(some.steps().front(), 0u);
    EXPECT_EQ(some.steps().back(), last);
    TimelineFrames part(recording, StepLevel::patch, 0, recording->passes()[1].first, recording->passes()[1].last);
    EXPECT_EQ(part.steps().front(), recording->passes()[1].first);
    EXPECT_EQ(part.steps().back(), recording->passes()[1].last);
    EXPECT_GT(part.count(), 10);
    EXPECT_EQ(part.make(1, {}).highlighted.size(), 2u);  // the triangles at an edge
    EXPECT_THROW(TimelineFrames(recording, StepLevel::pass, 0, 5, 4), InvalidInput);
    EXPECT_THROW(TimelineFrames(recording, StepLevel::pass, 0, 0, last + 1), InvalidInput);
}

}  // namespace
}  // namespace curvewright
