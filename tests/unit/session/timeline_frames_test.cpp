#include "core/session/timeline_frames.h"

#include <cmath>

#include <fmt/format.h>
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

TEST(TimelineFrames, CaptionsTellOfTheMeshShown) {
    // Within a patch of the guaranteed method the mesh is that of the iteration, not that before the patch.
    const auto recording = testing::record(testing::runs()[5]);
    TimelineFrames frames(recording, StepLevel::iteration, 0, 0, recording->step_count() - 1);
    int others = 0;
    for (int i = 0; i < frames.count(); ++i) {
        const Frame frame = frames.make(i, {});
        const double least = frame.quality->summary.min;
        const std::string said = fmt::format("min {}{:.3g}", least < 0 ? "\u2212" : "", std::abs(least));
        EXPECT_TRUE(frame.caption.ends_with(said)) << frame.caption << " but " << least;
        const Index not_valid = frame.quality->summary.invalid + frame.quality->summary.undecided;
        EXPECT_EQ(frame.caption.find("all valid") != std::string::npos, not_valid == 0) << frame.caption;
        if (std::abs(least - recording->quality_at(static_cast<StepNumber>(i)).min_scaled_jacobian) > 0.01) ++others;
    }
    EXPECT_GT(others, 0);
}

}  // namespace
}  // namespace curvewright
