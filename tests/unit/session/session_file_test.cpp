#include "core/session/session_file.h"

#include <gtest/gtest.h>
#include <algorithm>

#include "core/base/error.h"

namespace curvewright {
namespace {

/// Every action with every option away from its default.
std::vector<Action> all_actions() {
    WarpOptions weights;
    weights.weighting = Weighting::elastic;
    weights.distance_power = 1.0 / 3.0;
    weights.sharing_power = 2.5;
    weights.neighbours = NeighbourKind::edge_connected;
    weights.outside_hull = OutsideHull::refuse;
    weights.poisson_ratio = 0.41;
    weights.stiffening = 0.7;
    weights.solver = SolverChoice::direct;
    GuaranteedOptions guaranteed;
    guaranteed.improves = false;
    guaranteed.target = 0.55;
    guaranteed.shape_floor = 0.1;
    guaranteed.boundary.add("slide");
    guaranteed.boundary.add("outer rim=fixed");
    SignedAngleOptions given;
    given.beta = 0.07;
    given.displacement = DisplacementUnit::edge_length;
    given.max_passes = 7;
    given.reject_worse_pass = true;
    SignedAngleOptions automatic;
    automatic.beta_choice = BetaChoice::automatic;
    UnsignedAngleOptions literal = UnsignedAngleOptions::literal();
    literal.max_passes = 3;
    DragAction drag;
    drag.nodes = {{7}, {123456789012}};
    drag.weights = {1.0, 0.1};
    drag.pinned = {{9}};
    drag.kind = ResponseKind::affine;
    drag.origin = {0.1, 1e-300, -7.0 / 3.0};
    drag.motion = AffineMotion::rotation({1.0, 2.0, 3.0}, 0.7);
    drag.motion.shift = {1e17 + 2, 0.1 + 0.2, -0.0};
    drag.options = weights;
    drag.rules.boundary.add("slide");
    drag.rules.boundary.add("outer wall=free");
    drag.rules.solves_anew = true;
    DragAction plain;
    plain.nodes = {{1}};
    plain.motion.shift = {1.0, 2.0, 3.0};
    ImproveOptions shape;
    shape.goal = ImproveGoal::shape;
    shape.target = 0.1 + 0.2;
    shape.max_move = 1.0 / 3.0;
    shape.shape_floor = 0.25;
    shape.boundary.add("outer rim=slide");
    shape.nodes = {true, {{7}, {123456789012}}, {"a group"}};
    SignedAngleOptions keeping;
    keeping.nodes = {false, {{5}}, {}};
    return {OpenAction{"a mesh \"with\" quotes.msh"},
            DeformAction{"/d/ü.json"},
            WarpAction{"d.json", weights, IncrementOptions{4, false, 0.01}},
            WarpAction{"d.csv", {}, {}},
            UntangleAction{guaranteed},
            UntangleAction{given},
            UntangleAction{automatic},
            UntangleAction{literal},
            FlipAction{},
            ReorientAction{},
            drag,
            plain,
            PlaceAction{{{{3}, {0.1, 0.2, 0.3}}}},
            HistoryAction{4},
            ImproveAction{shape},
            ImproveAction{},
            UntangleAction{keeping}};
}

TEST(SessionFile, EveryActionComesBackAsItWas) {
    for (const Action& action : all_actions()) {
        const std::string line = to_json_line(action);
        EXPECT_EQ(line.find('\n'), std::string::npos);
        const Action back = parse_action(line);
        EXPECT_EQ(back.index(), action.index()) << line;
        EXPECT_EQ(to_json_line(back), line);
    }
    const Action back = parse_action(to_json_line(all_actions()[10]));
    const auto& drag = std::get<DragAction>(back);
    const Action first = all_actions()[10];
    const auto& its = std::get<DragAction>(first);
    EXPECT_EQ(drag.nodes, its.nodes);
    EXPECT_EQ(drag.weights, its.weights);
    EXPECT_EQ(drag.pinned, its.pinned);
    EXPECT_EQ(drag.motion.linear, its.motion.linear);  // bit for bit
    EXPECT_EQ(drag.motion.shift, its.motion.shift);
    EXPECT_EQ(drag.origin, its.origin);
    EXPECT_EQ(drag.rules.boundary.otherwise, BoundaryMode::slide);
    ASSERT_EQ(drag.rules.boundary.groups.size(), 1u);
    EXPECT_EQ(drag.rules.boundary.groups[0].group, "outer wall");
    EXPECT_EQ(drag.rules.boundary.groups[0].mode, BoundaryMode::free);
    EXPECT_TRUE(drag.rules.solves_anew);
    EXPECT_EQ(drag.options.distance_power, 1.0 / 3.0);
    EXPECT_EQ(drag.options.neighbours, NeighbourKind::edge_connected);
    EXPECT_EQ(drag.options.solver, SolverChoice::direct);
    const std::vector<Action> actions = all_actions();
    const Action untangle =
        parse_action(to_json_line(*std::find_if(actions.begin(), actions.end(), [](const Action& action) {
            return std::holds_alternative<UntangleAction>(action);
        })));
    const auto& guaranteed = std::get<GuaranteedOptions>(std::get<UntangleAction>(untangle).options);
    EXPECT_FALSE(guaranteed.improves);
    EXPECT_EQ(guaranteed.boundary.otherwise, BoundaryMode::slide);
    ASSERT_EQ(guaranteed.boundary.groups.size(), 1u);
    EXPECT_EQ(guaranteed.boundary.groups[0].group, "outer rim");
}

TEST(SessionFile, ImprovingComesBackWithAllItsOptions) {
    const std::vector<Action> actions = all_actions();
    const Action back = parse_action(to_json_line(actions[actions.size() - 3]));
    const ImproveOptions& options = std::get<ImproveAction>(back).options;
    EXPECT_EQ(options.goal, ImproveGoal::shape);
    EXPECT_EQ(options.target, 0.1 + 0.2);
    EXPECT_EQ(options.max_move, 1.0 / 3.0);
    EXPECT_EQ(options.shape_floor, 0.25);
    EXPECT_EQ(options.boundary.groups.at(0).group, "outer rim");
    EXPECT_TRUE(options.nodes.keeps_vertices);
    EXPECT_EQ(options.nodes.fixed_nodes, (std::vector<NodeTag>{{7}, {123456789012}}));
    EXPECT_EQ(options.nodes.fixed_groups, std::vector<std::string>{"a group"});
    const Action plain = parse_action(to_json_line(actions[actions.size() - 2]));
    EXPECT_FALSE(std::get<ImproveAction>(plain).options.max_move);
    EXPECT_TRUE(std::get<ImproveAction>(plain).options.nodes.is_empty());

    // Nodes by tag have no words on a command line.
    EXPECT_NE(command_line(actions[actions.size() - 3], "in.msh", "out.msh").find("replay"), std::string::npos);
    ImproveOptions words = options;
    words.nodes.fixed_nodes.clear();
    words.target = 0.75;
    EXPECT_EQ(command_line(ImproveAction{words}, "in.msh", "out.msh"),
              "curvewright-cli improve in.msh -o out.msh --goal shape --target 0.75 --max-move 0.3333333333333333 "
              "--shape-floor 0.25 --boundary fixed --boundary 'outer rim=slide' --keep-vertices --fix-nodes 'a group'");
}

TEST(SessionFile, WholeSessions) {
    std::string text;
    for (const Action& action : all_actions()) text += to_json_line(action) + "\r\n\n";
    EXPECT_EQ(parse_session(text, "s").size(), all_actions().size());
    EXPECT_THROW(parse_session("", "s"), InvalidInput);
    EXPECT_THROW(parse_session("\n \n", "s"), InvalidInput);
}

TEST(SessionFile, BadLinesAreNamed) {
    const struct {
        const char *line, *expected;
    } cases[] = {
        {"nonsense", "not one whole JSON object"},
        {"{\"action\": \"open\"", "not one whole JSON object"},
        {"[1, 2]", "object"},
        {"{}", "\"action\" is missing"},
        {"{\"action\": 3}", "must be a text"},
        {"{\"action\": \"explode\"}", "unknown action \"explode\""},
        {"{\"action\": \"open\"}", "\"mesh\" is missing"},
        {"{\"action\": \"open\", \"mesh\": 3}", "\"mesh\" must be a text"},
        {"{\"action\": \"warp\", \"deformation\": \"d\", \"weights\": \"magic\"}", "one of convex, affine, elastic"},
        {"{\"action\": \"warp\", \"deformation\": \"d\", \"increments\": 3}", "\"increments\" must be an object"},
        {"{\"action\": \"warp\", \"deformation\": \"d\", \"increments\": {\"steps\": -1}}", "whole number"},
        {"{\"action\": \"warp\", \"deformation\": \"d\", \"stiffening\": \"a lot\"}", "must be of numbers"},
        {"{\"action\": \"untangle\", \"method\": \"prayer\"}", "unknown method"},
        {"{\"action\": \"untangle\", \"method\": \"guaranteed\", \"boundary\": [\"fly\"]}", "fly"},
        {"{\"action\": \"untangle\", \"method\": \"guaranteed\", \"boundary\": \"slide\"}", "must be a list"},
        {"{\"action\": \"untangle\", \"method\": \"signed-angle\", \"beta\": \"big\"}", "\"auto\""},
        {"{\"action\": \"untangle\", \"method\": \"signed-angle\", \"beta\": 0.5, \"max_passes\": 0}", "whole number"},
        {"{\"action\": \"drag\", \"shift\": [0, 0, 0]}", "\"nodes\" is missing"},
        {"{\"action\": \"drag\", \"nodes\": [1.5], \"shift\": [0, 0, 0]}", "node tags"},
        {"{\"action\": \"drag\", \"nodes\": [1], \"shift\": [0, 0, 0], \"boundary\": [\"glide\"]}", "not understood"},
        {"{\"action\": \"drag\", \"nodes\": [1], \"shift\": [0, 0, 0], \"solves_anew\": 1}", "true or false"},
        {"{\"action\": \"drag\", \"nodes\": [1], \"shares\": [1, 2], \"shift\": [0, 0, 0]}", "1 nodes and 2 shares"},
        {"{\"action\": \"drag\", \"nodes\": [1], \"shift\": [0, 0]}", "three numbers"},
        {"{\"action\": \"drag\", \"nodes\": [1], \"shift\": [0, 0, 1e999]}", "not"},
        {"{\"action\": \"drag\", \"nodes\": [1], \"shift\": [0, 0, 0], \"linear\": [[1, 0, 0]]}", "three rows"},
        {"{\"action\": \"drag\", \"nodes\": [1], \"shift\": [0, 0, 0], \"linear\": [[1,0,0],[0,1,0],[0,0,1]]}",
         "\"origin\" is missing"},
        {"{\"action\": \"place\", \"nodes\": [[1, 2, 3]]}", "[tag, x, y, z]"},
        {"{\"action\": \"place\", \"nodes\": [[1, 2, 3, null]]}", "numbers"},
        {"{\"action\": \"history\", \"step\": -2}", "whole number"},
        {"{\"action\": \"history\", \"step\": 1e3}", "whole number"},
    };
    for (const auto& [line, expected] : cases) {
        try {
            parse_session(std::string("{\"action\": \"flip\"}\n") + line, "work.json");
            ADD_FAILURE() << line << " was read";
        } catch (const InvalidInput& problem) {
            const std::string what = problem.what();
            EXPECT_NE(what.find("work.json:2: "), std::string::npos) << what;
            EXPECT_NE(what.find(expected), std::string::npos) << what;
        }
    }
}

TEST(SessionFile, EveryCutOfALineIsRefused) {
    for (const Action& action : all_actions()) {
        const std::string line = to_json_line(action);
        for (std::size_t length = 0; length < line.size(); ++length)
            EXPECT_THROW(parse_action(line.substr(0, length)), InvalidInput) << line.substr(0, length);
    }
}

TEST(SessionFile, CommandLines) {
    const auto actions = all_actions();
    EXPECT_EQ(command_line(actions[1], "in.msh", "out.vtu"),
              "curvewright-cli deform in.msh -o out.vtu --deformation '/d/ü.json'");
    const std::string warp = command_line(actions[2], "in put.msh", "out.msh");
    EXPECT_NE(warp.find("'in put.msh'"), std::string::npos);
    EXPECT_NE(warp.find("--weights elastic --poisson-ratio 0.41 --stiffening 0.7"), std::string::npos);
    EXPECT_NE(warp.find("--increments 4 --keep-weights"), std::string::npos);
    const std::string untangle = command_line(actions[4], "a", "b");
    EXPECT_NE(untangle.find("--method guaranteed --valid-only --shape-floor 0.1 --boundary slide --boundary 'outer "
                            "rim=fixed'"),
              std::string::npos)
        << untangle;
    EXPECT_NE(command_line(actions[6], "a", "b").find("--beta auto"), std::string::npos);
    const std::string drag = command_line(actions[9], "it's.msh", "b.msh");
    EXPECT_TRUE(
        drag.starts_with("curvewright-cli replay - -o b.msh <<'END'\n{\"action\":\"open\",\"mesh\":\"it's.msh\"}"))
        << drag;
}

}  // namespace
}  // namespace curvewright
