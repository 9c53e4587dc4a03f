#include "core/session/replay.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/edit/drag.h"
#include "core/io/deformation_file.h"
#include "core/io/mesh_io.h"
#include "core/mesh/renumbering.h"
#include "core/session/session_file.h"
#include "tests/support/mesh_factory.h"
#include "tests/unit/mesh/torn_meshes.h"

namespace curvewright {
namespace {

namespace fs = std::filesystem;
using namespace curvewright::testing;

class ReplayTest : public ::testing::Test {
  protected:
    fs::path folder = fs::temp_directory_path() / ("curvewright_replay_" + std::to_string(::getpid()));

    void SetUp() override {
        fs::create_directories(folder);
        write_mesh(folder / "square.msh", square_mesh(4, 3));
        std::ofstream(folder / "bump.json") << R"json({"operations": [
            {"group": "bottom", "type": "expression", "y": "y + 0.2 * sin(pi * x)"}]})json";
    }
    void TearDown() override {
        set_thread_count(0);
        fs::remove_all(folder);
    }
    DragAction drag_of(const MeshTopology& topology, const char* group) {
        DragAction drag;
        const std::vector<Index> nodes = topology.find_group_nodes(group).value();
        for (const Index node : nodes) drag.nodes.push_back(topology.node_tag(node));
        drag.motion.shift = {0.05, 0.02, 0.0};
        return drag;
    }
};

TEST_F(ReplayTest, DoesWhatWasDone) {
    Replay replay(folder);
    EXPECT_FALSE(replay.has_mesh());
    replay.perform(OpenAction{"square.msh"});
    const CurvedMesh opened = replay.mesh();
    const MeshTopology& topology = opened.topology();

    replay.perform(DeformAction{"bump.json"});
    const Deformation bump = read_deformation(folder / "bump.json");
    EXPECT_EQ(replay.mesh().coordinates(), apply_deformation(opened, bump));
    const CurvedMesh deformed = replay.mesh();
    replay.perform(UntangleAction{GuaranteedOptions{}});
    EXPECT_EQ(replay.mesh().coordinates(), untangle_guaranteed(deformed).coordinates);

    // Back to the beginning, and another way from there: what was ahead is gone.
    replay.perform(HistoryAction{0});
    EXPECT_EQ(replay.mesh().coordinates(), opened.coordinates());
    replay.perform(HistoryAction{2});
    replay.perform(HistoryAction{0});
    replay.perform(WarpAction{"bump.json", {}, IncrementOptions{}});
    EXPECT_THROW(replay.perform(HistoryAction{2}), InvalidInput);
    const CurvedMesh warped = replay.mesh();

    const DragAction drag = drag_of(topology, "right");
    replay.perform(drag);
    Drag by_hand(std::make_shared<const Warper>(opened), {topology.find_group_nodes("right").value(), {}},
                 ResponseKind::translation, Eigen::Vector3d::Zero(), warped, nullptr);
    EXPECT_EQ(replay.mesh().coordinates(), by_hand.move(drag.motion));

    replay.perform(place_action(topology, replay.mesh().coordinates(), opened.coordinates()));
    EXPECT_EQ(replay.mesh().coordinates(), opened.coordinates());
    replay.perform(FlipAction{});
    EXPECT_NE(replay.mesh().shared_topology(), opened.shared_topology());
    // After renumbering the weights are those of the mesh as it is; the same here, as nothing has moved.
    replay.perform(drag);
    EXPECT_EQ(replay.opened().coordinates(), opened.coordinates());
}

TEST_F(ReplayTest, ImprovesAndTellsWhatItNotes) {
    Replay replay(folder);
    replay.perform(OpenAction{"square.msh"});
    replay.perform(DeformAction{"bump.json"});
    replay.perform(UntangleAction{GuaranteedOptions{}});
    const CurvedMesh valid = replay.mesh();
    EXPECT_TRUE(replay.notes().empty());
    ImproveOptions options;
    options.target = 1.0;
    options.max_move = 0.01;
    options.nodes.fixed_groups = {"left"};
    replay.perform(ImproveAction{options});
    EXPECT_EQ(replay.mesh().coordinates(), improve(valid, options).coordinates);

    // A corner of the square pulled over the middle: its triangle cannot be mended, and the replay says so.
    PlaceAction place;
    const Index corner = valid.topology().element_nodes(0)[0];
    place.rows.push_back({valid.topology().node_tag(corner), {0.9, 0.9, 0.0}});
    replay.perform(place);
    replay.perform(UntangleAction{GuaranteedOptions{}});
    ASSERT_FALSE(replay.notes().empty());
    EXPECT_TRUE(replay.notes()[0].starts_with("Element "));
    replay.perform(OpenAction{"square.msh"});
    EXPECT_TRUE(replay.notes().empty());
}

TEST_F(ReplayTest, RenumbersReversedElementsAndGoesBack) {
    const CurvedMesh plain = square_mesh(3, 2);
    write_mesh(folder / "reversed.msh", renumbered(plain, [](Index element) { return element % 3 == 1; }));
    Replay replay(folder);
    replay.perform(OpenAction{"reversed.msh"});
    ASSERT_EQ(replay.mesh().topology().reversed_count(), 6);
    replay.perform(parse_action(to_json_line(ReorientAction{})));
    EXPECT_EQ(replay.mesh().topology().reversed_count(), 0);
    EXPECT_EQ(replay.mesh().coordinates(), plain.coordinates());
    for (Index element = 0; element < plain.topology().element_count(); ++element)
        EXPECT_TRUE(std::ranges::equal(replay.mesh().topology().element_nodes(element),
                                       plain.topology().element_nodes(element)));
    replay.perform(HistoryAction{0});
    EXPECT_EQ(replay.mesh().topology().reversed_count(), 6);
    replay.perform(HistoryAction{1});
    EXPECT_EQ(replay.mesh().topology().reversed_count(), 0);
}

TEST_F(ReplayTest, TheSameForEveryNumberOfThreads) {
    const MeshTopology topology = square_mesh(4, 3).topology();
    DragAction drag = drag_of(topology, "top");
    drag.kind = ResponseKind::affine;
    drag.origin = {0.5, 1.0, 0.0};
    drag.motion.linear = AffineMotion::rotation(Eigen::Vector3d::UnitZ(), 0.2).linear;
    const std::vector<Action> actions{OpenAction{"square.msh"}, WarpAction{"bump.json", {}, {}}, drag,
                                      UntangleAction{GuaranteedOptions{}}};
    std::vector<Coordinates> results;
    for (const int threads : {1, 2, 3}) {
        set_thread_count(threads);
        Replay replay(folder);
        // Through the text, as from a file.
        for (const Action& action : actions) replay.perform(parse_action(to_json_line(action)));
        results.push_back(replay.mesh().coordinates());
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

TEST_F(ReplayTest, MeshesAreConnectedOrRefusedAsInTheWindow) {
    write_mesh(folder / "torn.msh", with_own_points(square_mesh(2, 2)));
    Replay replay(folder);
    replay.perform(OpenAction{"torn.msh"});
    EXPECT_EQ(replay.mesh().topology().node_count(), square_mesh(2, 2).topology().node_count());

    write_mesh(folder / "hanging.msh", hanging_square());
    std::ofstream(folder / "shift.json") << R"json({"operations": [
        {"group": "all", "type": "translate", "vector": [0.1, 0, 0]}]})json";
    replay.perform(OpenAction{"hanging.msh"});
    DragAction drag;
    drag.nodes = {{1}};
    drag.motion.shift = {0.05, 0.0, 0.0};
    for (const Action& action : {Action(DeformAction{"shift.json"}), Action(WarpAction{"shift.json", {}, {}}),
                                 Action(UntangleAction{GuaranteedOptions{}}), Action(drag)})
        EXPECT_THROW(replay.perform(action), Unsupported);
    EXPECT_EQ(replay.mesh().coordinates(), hanging_square().coordinates());
}

TEST_F(ReplayTest, WhatCannotBeDoneLeavesTheMesh) {
    Replay replay(folder);
    EXPECT_THROW(replay.perform(FlipAction{}), InvalidInput);
    EXPECT_THROW(replay.perform(OpenAction{"nothing.msh"}), InvalidInput);
    EXPECT_FALSE(replay.has_mesh());
    replay.perform(OpenAction{(folder / "square.msh").string()});
    const Coordinates opened = replay.mesh().coordinates();
    DragAction drag;
    drag.nodes = {{999999}};
    EXPECT_THROW(replay.perform(drag), InvalidInput);
    EXPECT_THROW(replay.perform(DeformAction{"nothing.json"}), InvalidInput);
    EXPECT_THROW(replay.perform(PlaceAction{{{{999999}, {}}}}), InvalidInput);
    EXPECT_THROW(replay.perform(HistoryAction{1}), InvalidInput);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(replay.perform(WarpAction{"bump.json", {}, {}}, {stop.get_token(), {}}), Cancelled);
    EXPECT_EQ(replay.mesh().coordinates(), opened);
}

}  // namespace
}  // namespace curvewright
