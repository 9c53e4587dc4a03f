#include "core/io/deformation_file.h"

#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

std::vector<Operation> operations_of(const TemporaryFolder& folder, const std::string& text) {
    const auto file = folder.write("d.json", "{\"operations\": [" + text + "], \"note\": \"ignored\"}");
    return std::get<OperationList>(read_deformation(file).content).operations;
}

template <class Kind>
Kind only(const TemporaryFolder& folder, const std::string& text) {
    const auto operations = operations_of(folder, "{\"group\": \"wall\", " + text + "}");
    EXPECT_EQ(operations.size(), 1u);
    EXPECT_EQ(operations.front().group, "wall");
    return std::get<Kind>(operations.front().kind);
}

TEST(DeformationFile, reads_every_operation) {
    const TemporaryFolder folder;
    EXPECT_EQ(only<Translate>(folder, R"("type": "translate", "vector": [1, -2.5, 3e-1])").vector,
              (Vector3{1, -2.5, 0.3}));
    const auto rotate =
        only<Rotate>(folder, R"("type": "rotate", "center": [1, 2, 3], "angle_deg": 30, "axis": [0, 2, 0])");
    EXPECT_EQ(rotate.center, (Vector3{1, 2, 3}));
    EXPECT_EQ(rotate.angle_deg, 30.0);
    EXPECT_EQ(rotate.axis, (Vector3{0, 1, 0}));
    EXPECT_EQ(only<Rotate>(folder, R"("type": "rotate", "center": [1, 2, 3], "angle_deg": 30)").axis,
              (Vector3{0, 0, 1}));
    EXPECT_EQ(only<Scale>(folder, R"("type": "scale", "center": [0, 0, 0], "factors": [1, 2, 3])").factors,
              (Vector3{1, 2, 3}));
    const auto shear = only<Shear>(folder, R"("type": "shear", "axis": "z", "along": "y", "factor": 0.5, "origin": 7)");
    EXPECT_EQ(std::tuple(shear.axis, shear.along, shear.factor, shear.origin), std::tuple(2, 1, 0.5, 7.0));
    EXPECT_EQ(only<Shear>(folder, R"("type": "shear", "axis": "x", "along": "y", "factor": 0.5)").origin, 0.0);
    const auto expression = only<Expression>(folder, R"("type": "expression", "x": "x + 1", "z": "0")");
    EXPECT_EQ(expression.components[0], "x + 1");
    EXPECT_FALSE(expression.components[1].has_value());
    EXPECT_EQ(expression.components[2], "0");
}

TEST(DeformationFile, reads_every_shape_to_snap_to) {
    const TemporaryFolder folder;
    EXPECT_EQ(
        only<SnapToCircle>(folder, R"("type": "snap_to", "shape": "circle", "center": [1, 2, 0], "radius": 3)").radius,
        3.0);
    EXPECT_EQ(
        only<SnapToSphere>(folder, R"("type": "snap_to", "shape": "sphere", "center": [1, 2, 4], "radius": 3)").center,
        (Vector3{1, 2, 4}));
    EXPECT_EQ(only<SnapToCylinder>(
                  folder, R"("type": "snap_to", "shape": "cylinder", "center": [0, 0, 0], "axis": "x", "radius": 3)")
                  .axis,
              (Vector3{1, 0, 0}));
    EXPECT_EQ(
        only<SnapToCylinder>(
            folder, R"("type": "snap_to", "shape": "cylinder", "center": [0, 0, 0], "axis": [0, 3, 4], "radius": 3)")
            .axis,
        (Vector3{0, 0.6, 0.8}));
    const auto revolution = only<SnapToRevolution>(
        folder, R"("type": "snap_to", "shape": "revolution", "axis": "z", "profile": [[0, 1], [1, 0], [2.5, 2]])");
    EXPECT_EQ(revolution.axis, 2);
    EXPECT_EQ(revolution.profile, (std::vector<std::array<double, 2>>{{0, 1}, {1, 0}, {2.5, 2}}));
    const auto ellipse = only<SnapToEllipse>(
        folder, R"("type": "snap_to", "shape": "ellipse", "center": [0, 0, 0], "semi_axes": [2, 1])");
    EXPECT_EQ(std::pair(ellipse.semi_axis_x, ellipse.semi_axis_y), std::pair(2.0, 1.0));
    const std::string naca = R"("leading_edge": [0, 0, 0], "chord": 2)";
    EXPECT_EQ(only<SnapToNaca>(folder, R"("type": "snap_to", "shape": "naca0012", )" + naca).thickness, 0.12);
    EXPECT_EQ(only<SnapToNaca>(folder, R"("type": "snap_to", "shape": "naca", "digits": "0015", )" + naca).thickness,
              0.15);
    EXPECT_EQ(only<SnapToNaca>(folder, R"("type": "snap_to", "shape": "naca", "thickness": 0.21, )" + naca).thickness,
              0.21);
    EXPECT_EQ(only<SnapToNaca>(folder, R"("type": "snap_to", "shape": "naca0012", )" + naca).chord, 2.0);
}

TEST(DeformationFile, keeps_the_order_of_operations) {
    const TemporaryFolder folder;
    const auto operations = operations_of(folder, R"({"group": "b", "type": "translate", "vector": [0, 0, 0]},
                                                     {"group": "a", "type": "translate", "vector": [0, 0, 0]})");
    ASSERT_EQ(operations.size(), 2u);
    EXPECT_EQ(operations[0].group, "b");
    EXPECT_EQ(operations[1].group, "a");
    EXPECT_TRUE(operations_of(folder, "").empty());
}

TEST(DeformationFile, bad_operations_are_told_with_number_group_and_reason) {
    const std::string good = R"({"group": "g", "type": "translate", "vector": [0, 0, 0]}, )";
    const auto second = [&](const std::string& rest) { return good + R"({"group": "wall", "type": )" + rest + "}"; };
    const std::vector<std::pair<std::string, std::string>> table = {
        {second(R"("twist")"), "operation 2 (group \"wall\") twist: unknown type \"twist\"; one of translate, rotate"},
        {second(R"(3)"), "\"type\" must be a string, not 3"},
        {second(R"("translate")"), "operation 2 (group \"wall\") translate: \"vector\" is missing"},
        {second(R"("translate", "vector": [1, 2])"), "\"vector\" must be a list of 3 numbers, not [1,2]"},
        {second(R"("translate", "vector": [1, 2, "3"])"), "\"vector\" must be a list of 3 numbers"},
        {second(R"("translate", "vector": 5)"), "\"vector\" must be a list of 3 numbers, not 5"},
        {second(R"("rotate", "center": [0, 0, 0], "angle_deg": "30")"), "\"angle_deg\" must be a number, not \"30\""},
        {second(R"("rotate", "center": [0, 0, 0], "angle_deg": 30, "axis": [0, 0, 0])"),
         "\"axis\" must not be the zero"},
        {second(R"("scale", "center": [0, 0, 0])"), "\"factors\" is missing"},
        {second(R"("shear", "axis": "w", "along": "y", "factor": 1)"),
         "\"axis\" must be \"x\", \"y\" or \"z\", not \"w\""},
        {second(R"("shear", "axis": "x", "along": 1, "factor": 1)"), "\"along\" must be a string"},
        {second(R"("expression")"), "at least one of \"x\", \"y\", \"z\""},
        {second(R"("expression", "x": 0)"), "\"x\" must be a string, not 0"},
        {second(R"("snap_to")"), "\"shape\" is missing"},
        {second(R"("snap_to", "shape": "cube")"), "unknown shape \"cube\"; one of circle, sphere"},
        {second(R"("snap_to", "shape": "circle", "center": [0, 0, 0])"), "snap_to circle: \"radius\" is missing"},
        {second(R"("snap_to", "shape": "circle", "center": [0, 0, 0], "radius": 0)"),
         "\"radius\" must be positive, not 0"},
        {second(R"("snap_to", "shape": "sphere", "center": [0, 0, 0], "radius": -2)"),
         "\"radius\" must be positive, not -2"},
        {second(R"("snap_to", "shape": "cylinder", "center": [0, 0, 0], "axis": "q", "radius": 1)"), "not \"q\""},
        {second(R"("snap_to", "shape": "cylinder", "center": [0, 0, 0], "axis": [0, 0, 0], "radius": 1)"),
         "zero vector"},
        {second(R"("snap_to", "shape": "revolution", "axis": "z", "profile": [[0, 1]])"), "at least two pairs"},
        {second(R"("snap_to", "shape": "revolution", "axis": "z", "profile": [[0, 1], [0, 2]])"), "must ascend"},
        {second(R"("snap_to", "shape": "revolution", "axis": "z", "profile": [[0, 1], [1]])"),
         "point 2 of \"profile\""},
        {second(R"("snap_to", "shape": "revolution", "axis": "z", "profile": [[0, -1], [1, 1]])"),
         "negative radius -1"},
        {second(R"("snap_to", "shape": "ellipse", "center": [0, 0, 0], "semi_axes": [1, 0])"), "two positive numbers"},
        {second(R"("snap_to", "shape": "naca0012", "leading_edge": [0, 0, 0], "chord": 0)"),
         "\"chord\" must be positive"},
        {second(R"("snap_to", "shape": "naca2412", "leading_edge": [0, 0, 0], "chord": 1)"), "no symmetric four-digit"},
        {second(R"("snap_to", "shape": "naca", "thickness": 12, "leading_edge": [0, 0, 0], "chord": 1)"),
         "below 1, not 12"},
        {good + "7", "operation 2: an object"},
        {good + R"({"type": "translate", "vector": [0, 0, 0]})", "operation 2: \"group\" is missing"},
        {good + R"({"group": "", "type": "translate"})", "\"group\" must not be empty"},
    };
    const TemporaryFolder folder;
    for (const auto& [text, expected] : table) {
        const std::string message = message_of<InvalidInput>([&] { operations_of(folder, text); });
        EXPECT_NE(message.find(expected), std::string::npos) << "expected: " << expected << "\n message: " << message;
        EXPECT_NE(message.find("d.json: operation 2"), std::string::npos) << message;
    }
}

TEST(DeformationFile, bad_json_is_told_with_its_line) {
    const TemporaryFolder folder;
    const auto message = [&](const std::string& text) {
        return message_of<InvalidInput>([&] { read_deformation(folder.write("d.json", text)); });
    };
    EXPECT_NE(message("{\n\"operations\": [\n}\n").find("d.json:3: this is no valid JSON"), std::string::npos);
    EXPECT_NE(message("").find("no valid JSON"), std::string::npos);
    EXPECT_NE(message("{\"operations\": [{\"group\": \"a\", \"type\": \"translate\", \"vector\": [1e999, 0, 0]}]}")
                  .find("no valid JSON"),
              std::string::npos);
    EXPECT_NE(message("{}").find("a list \"operations\" was expected"), std::string::npos);
    EXPECT_NE(message("[]").find("a list \"operations\" was expected"), std::string::npos);
    EXPECT_NE(message("{\"operations\": 3}").find("must be a list, not 3"), std::string::npos);
}

TEST(DeformationFile, reads_node_tables) {
    const TemporaryFolder folder;
    for (const char* text : {"tag,x,y,z\n7,1,2.5,-3\n2,0.1,0,1e-3\n", "tag,x,y,z\r\n7,1,2.5,-3\r\n2,0.1,0,1e-3\r\n\r\n",
                             "\xEF\xBB\xBFtag, x, y, z\n 7 , 1 , 2.5 , -3\n2,+0.1,0,1e-3"}) {
        const auto table = std::get<NodeTable>(read_deformation(folder.write("t.csv", text)).content);
        EXPECT_FALSE(table.is_mesh);
        ASSERT_EQ(table.rows.size(), 2u);
        EXPECT_EQ(table.rows[0].tag.value, 7);
        EXPECT_EQ(table.rows[0].position, (Vector3{1, 2.5, -3}));
        EXPECT_EQ(table.rows[1].position, (Vector3{0.1, 0, 1e-3}));
    }
}

TEST(DeformationFile, bad_node_tables_are_told_with_their_line) {
    const TemporaryFolder folder;
    const std::vector<std::pair<std::string, std::string>> table = {
        {"", "t.csv: the file is empty"},
        {"tag,x,y,z\n", "t.csv: the table holds no nodes"},
        {"1,0,0,0\n", "t.csv:1: the header \"tag,x,y,z\" was expected"},
        {"x,y,z,tag\n", "t.csv:1: the header"},
        {"tag,x,y,z\n1,0,0\n", "t.csv:2: 4 columns (tag,x,y,z) were expected, not 3"},
        {"tag,x,y,z\n1,0,0,0,0\n", "not 5"},
        {"tag,x,y,z\n1,0,0,0\none,0,0,0\n", "t.csv:3: \"one\" stands where a node tag"},
        {"tag,x,y,z\n1.5,0,0,0\n", "\"1.5\" stands where a node tag"},
        {"tag,x,y,z\n1,0,,0\n", "t.csv:2: \"\" stands where a coordinate"},
        {"tag,x,y,z\n1,0,nan,0\n", "\"nan\" stands where a coordinate"},
        {"tag,x,y,z\n1,0,0,0\n\n1,0,0,0\n", "t.csv:4: node 1 occurs twice"},
    };
    for (const auto& [text, expected] : table) {
        const auto file = folder.write("t.csv", text);
        const std::string message = message_of<InvalidInput>([&] { read_deformation(file); });
        EXPECT_NE(message.find(expected), std::string::npos) << "expected: " << expected << "\n message: " << message;
    }
}

TEST(DeformationFile, a_mesh_serves_as_a_table) {
    const Deformation deformation = read_deformation(test_data("annulus.msh"));
    const auto& table = std::get<NodeTable>(deformation.content);
    EXPECT_TRUE(table.is_mesh);
    EXPECT_EQ(table.rows.size(), 159u);
    EXPECT_EQ(deformation.source, test_data("annulus.msh"));
}

TEST(DeformationFile, unusable_files_are_told_apart) {
    const TemporaryFolder folder;
    const auto message = [&](const std::filesystem::path& file) {
        return message_of<InvalidInput>([&] { read_deformation(file); });
    };
    EXPECT_NE(message(folder / "missing.json").find("no such file"), std::string::npos);
    EXPECT_NE(message(folder / "missing.csv").find("no such file"), std::string::npos);
    EXPECT_NE(message(folder / "missing.msh").find("no such file"), std::string::npos);
    EXPECT_NE(message(folder / "missing.txt").find("no such file"), std::string::npos);
    EXPECT_NE(message(folder.write("a.txt", "x")).find("\".txt\" is no suffix of a deformation"), std::string::npos);
}

}  // namespace
}  // namespace curvewright
