#include "core/untangle/trace.h"

#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/untangle/signed_angles.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

TEST(TraceWriter, EveryLineIsAnEventWithTagsOfTheFile) {
    const CurvedMesh mesh = testing::bulged_square_mesh(2, 3, 0.3);
    std::ostringstream stream;
    TraceWriter writer(stream);
    SignedAngleOptions options;
    options.max_passes = 2;
    const UntangleResult result = untangle_signed_angles(mesh, options, &writer);
    std::istringstream lines(stream.str());
    std::vector<nlohmann::json> events;
    for (std::string line; std::getline(lines, line);) events.push_back(nlohmann::json::parse(line));
    ASSERT_GT(events.size(), 10u);
    EXPECT_EQ(events.front()["event"], "started");
    EXPECT_EQ(events.back(),
              (nlohmann::json{{"event", "finished"}, {"passes", result.passes}, {"reason", to_string(result.reason)}}));
    int patches = 0;
    for (const auto& event : events) {
        if (event["event"] != "patch_ended") continue;
        ++patches;
        const auto node = mesh.topology().find_node({event["nodes"].at(0).get<std::int64_t>()});
        ASSERT_TRUE(node);
        EXPECT_TRUE(mesh.topology().is_interior_node(*node));
        EXPECT_EQ(event["positions"].at(0).size(), 3u);
    }
    EXPECT_EQ(patches, result.passes * (16 - 8) * 2);
}

}  // namespace
}  // namespace curvewright
