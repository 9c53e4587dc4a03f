/// Recordings told again, and all breakpoints at once.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sstream>

#include "core/base/error.h"
#include "core/timeline/replay.h"
#include "core/timeline/search.h"
#include "core/untangle/trace.h"
#include "core/untangle/trace_reader.h"
#include "tests/unit/timeline/runs.h"

namespace curvewright {
namespace {

/// Compares the coordinates of passes with those that another run told.
struct Passes : UntangleObserver {
    void on_event(const UntangleEvent& event) override {
        if (const auto* started = std::get_if<untangle_event::Started>(&event))
            coordinates.push_back(started->mesh->coordinates());
        if (const auto* ended = std::get_if<untangle_event::PassEnded>(&event))
            coordinates.push_back(*ended->coordinates);
    }
    std::vector<Coordinates> coordinates;
};

std::string trace_of(const testing::Run& run) {
    std::ostringstream stream;
    TraceWriter writer(stream);
    testing::untangle(run, &writer);
    return stream.str();
}

/// The names of the events, one per line: a recording has some of their numbers in single precision.
std::string events_of(const std::string& trace) {
    std::istringstream lines(trace);
    std::string line, names;
    while (std::getline(lines, line)) names += nlohmann::json::parse(line).at("event").get<std::string>() + '\n';
    return names;
}

TEST(Replay, TellsWhatTheMethodTold) {
    for (const testing::Run& run : testing::runs()) {
        SCOPED_TRACE(run.name);
        const auto recording = testing::record(run);
        std::ostringstream told;
        TraceWriter writer(told);
        replay(recording, writer);
        EXPECT_EQ(events_of(told.str()), events_of(trace_of(run)));
        std::istringstream again(told.str());
        Recorder recorder;
        read_trace(again, "again", run.mesh, recorder);
        const auto second = recorder.finish();
        ASSERT_EQ(second->step_count(), recording->step_count());
        EXPECT_EQ(second->patches().size(), recording->patches().size());

        Passes expected, passes;
        testing::untangle(run, &expected);
        replay(recording, passes);
        ASSERT_EQ(passes.coordinates.size(), expected.coordinates.size());
        for (std::size_t i = 0; i < passes.coordinates.size(); ++i)
            EXPECT_EQ(passes.coordinates[i], expected.coordinates[i]) << i;
    }
}

TEST(Replay, RefusesAWarp) {
    const CurvedMesh mesh = testing::square_mesh(2, 2);
    Recorder recorder;
    recorder.begin_warp(mesh);
    recorder.add_increment({1.0, true, 1.0, 0, 0}, mesh.coordinates());
    recorder.end_warp(mesh.coordinates(), StopReason::converged);
    Passes passes;
    EXPECT_THROW(replay(recorder.finish(), passes), Unsupported);
}

TEST(Replay, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    Passes passes;
    EXPECT_THROW(replay(testing::record(testing::runs().front()), passes, {stop.get_token(), {}}), Cancelled);
}

TEST(BreakSteps, AreThoseOfOneAfterTheOther) {
    for (const testing::Run& run : testing::runs()) {
        SCOPED_TRACE(run.name);
        const auto recording = testing::record(run);
        Breakpoints breakpoints;
        breakpoints.min_crosses_zero = true;
        const auto& first = recording->patches().front();
        const auto began = std::get<untangle_event::PatchBegan>(recording->read(first.first));
        breakpoints.nodes = {began.nodes.front()};
        breakpoints.elements = {began.elements.back(), 0};
        std::vector<StepNumber> expected;
        for (auto step = next_break(*recording, 0, breakpoints); step;
             step = next_break(*recording, *step, breakpoints))
            expected.push_back(*step);
        EXPECT_FALSE(expected.empty());
        EXPECT_EQ(break_steps(*recording, breakpoints), expected);
    }
    EXPECT_TRUE(break_steps(*testing::record(testing::runs().front()), {}).empty());
}

}  // namespace
}  // namespace curvewright
