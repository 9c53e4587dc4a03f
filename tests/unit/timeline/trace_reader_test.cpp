#include "core/untangle/trace_reader.h"

#include <sstream>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/timeline/cursor.h"
#include "core/untangle/trace.h"
#include "tests/unit/timeline/runs.h"

namespace curvewright {
namespace {

std::string trace_of(const testing::Run& run) {
    std::ostringstream stream;
    TraceWriter writer(stream);
    testing::untangle(run, &writer);
    return stream.str();
}

TEST(TraceReader, ATraceWrittenAgainIsTheSame) {
    for (const testing::Run& run : testing::runs()) {
        SCOPED_TRACE(run.name);
        const std::string trace = trace_of(run);
        std::istringstream in(trace);
        std::ostringstream out;
        TraceWriter writer(out);
        // The mesh may be in any state; the trace knows where it began.
        const CurvedMesh elsewhere = run.mesh.with_coordinates(2.0 * run.mesh.coordinates());
        read_trace(in, "run.jsonl", elsewhere, writer);
        EXPECT_EQ(out.str(), trace);
    }
}

TEST(TraceReader, ATraceRecordedIsTheRunRecorded) {
    for (const testing::Run& run : testing::runs()) {
        SCOPED_TRACE(run.name);
        std::istringstream in(trace_of(run));
        Recorder recorder;
        read_trace(in, "run.jsonl", run.mesh, recorder);
        const auto from_trace = recorder.finish(), recorded = testing::record(run);
        ASSERT_EQ(from_trace->step_count(), recorded->step_count());
        EXPECT_EQ(from_trace->quality_points().size(), recorded->quality_points().size());
        TimelineCursor a(from_trace), b(recorded);
        for (StepNumber step = 0; step < recorded->step_count(); step += recorded->step_count() / 50 + 1) {
            a.seek(step);
            b.seek(step);
            ASSERT_EQ(a.coordinates(), b.coordinates()) << step;
        }
        a.seek(recorded->step_count() - 1);
        EXPECT_EQ(a.coordinates(), testing::untangle(run, nullptr));
    }
}

TEST(TraceReader, ReadsAsFarAsAWriterCame) {
    const testing::Run run = testing::runs()[0];
    const std::string trace = trace_of(run);
    const std::size_t somewhere = trace.find("simplex_step", trace.size() / 2);
    std::istringstream in(trace.substr(0, somewhere + 5));
    Recorder recorder;
    read_trace(in, "run.jsonl", run.mesh, recorder);
    const auto recording = recorder.finish();
    EXPECT_GT(recording->step_count(), 100u);
    TimelineCursor cursor(recording);
    cursor.seek(recording->step_count() - 1);
}

TEST(TraceReader, NamesTheLineOfWhatIsNoTraceOfTheMesh) {
    const testing::Run run = testing::runs()[0];
    const std::string trace = trace_of(run);
    const std::string start = trace.substr(0, trace.find('\n') + 1);
    const std::string tag = std::to_string(run.mesh.topology().element_tag(0).value);
    const std::string patch = R"({"event":"patch_began","nodes":[60],"elements":[)" + tag +
                              R"(],"positions":[[0,0,0]]})"
                              "\n";
    const struct {
        std::string text, expected;
    } cases[] = {
        {"", "trace.jsonl: the trace is empty"},
        {"nonsense\n", "trace.jsonl:1: this is no JSON object"},
        {"[1, 2]\n", "trace.jsonl:1: this is no JSON object"},
        {"{}\n", "trace.jsonl:1: \"event\" is missing"},
        {"{\"event\": 3}\n", "\"event\" must be a string"},
        {"{\"event\": \"finished\"}\n", "begins with the event \"started\""},
        {R"({"event":"started","elements":1,"nodes":3,"tags":[1,2,3],"positions":[]})"
         "\n",
         "of 1 elements and 3 nodes"},
        {start + start, "trace.jsonl:2: the trace starts a second time"},
        {start + "{\"event\":\"dance\"}\n", "\"dance\" is no event"},
        {start + "{\"event\":\"pass_began\",\"pass\":1e300}\n", "\"pass\" must hold whole numbers"},
        {start + R"({"event":"patch_began","nodes":[999999],"elements":[],"positions":[[0,0,0]]})"
                 "\n",
         "the mesh has no node 999999"},
        {start + R"({"event":"patch_began","nodes":["x"],"elements":[],"positions":[]})"
                 "\n",
         "must be whole numbers"},
        {start + R"({"event":"patch_began","nodes":[60],"elements":[],"positions":[[0,0]]})"
                 "\n",
         "three coordinates"},
        {start + R"({"event":"patch_began","nodes":[60],"elements":[],"positions":[[0,null,0]]})"
                 "\n",
         "not finite"},
        {start + R"({"event":"patch_began","nodes":[60],"elements":[],"positions":[]})"
                 "\n",
         "array of 1 values"},
        {start + R"({"event":"patch_began","nodes":[60],"elements":[77777],"positions":[[0,0,0]]})"
                 "\n",
         "no element 77777"},
        {start + patch + patch, "trace.jsonl:3: a patch begins before"},
        {start + R"({"event":"patch_ended","nodes":[60]})"
                 "\n",
         "none has begun"},
        {start + patch +
             R"({"event":"patch_ended","nodes":[61]})"
             "\n",
         "other nodes than it began with"},
        {start + patch +
             R"({"event":"face_nodes_moved","nodes":[61],"positions":[[0,0,0]]})"
             "\n",
         "before the patch has ended"},
        {start + patch +
             R"({"event":"bfgs_step","iteration":0,"positions":[[0,0,0],[1,1,1]]})"
             "\n",
         "more positions"},
        {start + R"({"event":"nodes_placed","placement":"straightened","nodes":[],"positions":[]})"
                 "\n",
         "outside a patch"},
        {start + R"({"event":"finished","reason":"bored","passes":1})"
                 "\n",
         "\"bored\" is no reason"},
    };
    for (const auto& [text, expected] : cases) {
        std::istringstream in(text);
        Recorder recorder;
        try {
            read_trace(in, "trace.jsonl", run.mesh, recorder);
            ADD_FAILURE() << "accepted: " << text.substr(start.size() < text.size() ? start.size() : 0);
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace curvewright
