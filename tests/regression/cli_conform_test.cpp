// Meshes that touch without being connected, hanging nodes, mixed orders, interfaces; raising the order; comparing.

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/io/mesh_io.h"
#include "core/quality/element_size.h"
#include "tests/regression/command_line.h"
#include "tests/support/mesh_factory.h"
#include "tests/support/region_meshes.h"
#include "tests/unit/mesh/torn_meshes.h"

namespace curvewright {
namespace {

using namespace testing;
using Json = nlohmann::json;

double size_of(const CurvedMesh& mesh) {
    double size = 0.0;
    for (const double one : element_sizes(mesh)) size += one;
    return size;
}

Json parse(const ProcessResult& result) {
    EXPECT_TRUE(Json::accept(result.output)) << result.output << result.errors;
    return Json::parse(result.output, nullptr, false);
}

bool has_note(const Json& json, const std::string& fragment) {
    for (const Json& note : json["notes"])
        if (note.get<std::string>().find(fragment) != std::string::npos) return true;
    return false;
}

TEST_F(CommandLine, CellsWithPointsOfTheirOwnAreConnectedAndMoveTogether) {
    for (const CurvedMesh& whole : {square_mesh(3, 2), cube_mesh(2, 2)}) {
        const std::string torn = folder / "torn.vtu", out = folder / "out.vtu", motion = folder / "motion.json";
        write_mesh(torn, with_own_points(whole));
        write(motion, R"({"operations": [{"group": "boundary", "type": "expression", "x": "x + 0.1*y*y"}]})");
        const Json json =
            parse(cli({"warp", torn, "--deformation", motion, "-o", out, "--json", "--quiet", "--weights", "affine"}));
        EXPECT_TRUE(has_note(json, "Every element has nodes of its own")) << json["notes"];
        EXPECT_EQ(json["mesh"]["nodes"], whole.topology().node_count());
        EXPECT_EQ(json["globally_valid"], "yes");
        EXPECT_EQ(parse(cli({"info", torn, "--json"}))["mesh"]["nodes"], whole.topology().node_count());
    }
}

TEST_F(CommandLine, ASlitStaysOpenUnlessItsNodesAreToBeMerged) {
    const CurvedMesh whole = square_mesh(4, 2);
    const auto is_on_slit = [](const Eigen::RowVector3d& x) { return x[1] == 0.5 && x[0] > 0.25 && x[0] < 0.75; };
    const CurvedMesh slit =
        with_slit(whole, is_on_slit, [](const Eigen::RowVector3d& center) { return center[1] > 0.5; });
    ASSERT_GT(slit.topology().node_count(), whole.topology().node_count());
    const std::string file = folder / "slit.msh", out = folder / "out.msh";
    write_mesh(file, slit);
    Json json = parse(cli({"quality", file, "--json"}));
    EXPECT_EQ(json["mesh"]["nodes"], slit.topology().node_count());
    EXPECT_TRUE(has_note(json, "--merge-nodes")) << json["notes"];
    EXPECT_EQ(cli({"untangle", file, "-o", out}).status, 0);
    json = parse(cli({"quality", file, "--json", "--merge-nodes", "1e-9"}));
    EXPECT_EQ(json["mesh"]["nodes"], whole.topology().node_count());
    EXPECT_EQ(json["globally_valid"], "yes");
    expect_bad_input({"quality", file, "--merge-nodes", "0.4"}, "would become one");
}

TEST_F(CommandLine, HangingNodesAreToldAndNotMoved) {
    const std::string motion = folder / "motion.json", out = folder / "out.msh";
    write(motion, R"({"operations": [{"group": "all", "type": "translate", "vector": [0.1, 0, 0]}]})");
    for (const CurvedMesh& mesh : {hanging_square(), hanging_cubes()}) {
        const std::string file = folder / "hanging.msh";
        write_mesh(file, mesh);
        const ProcessResult looked_at = cli({"quality", file, "--json"});
        EXPECT_EQ(looked_at.status, 0) << looked_at.errors;
        EXPECT_TRUE(has_note(parse(looked_at), "hangs")) << looked_at.output;
        EXPECT_EQ(cli({"convert", file, folder / "copy.vtu"}).status, 0);
        for (const std::vector<std::string>& command :
             {std::vector<std::string>{"warp", file, "--deformation", motion, "-o", out},
              {"deform", file, "--deformation", motion, "-o", out},
              {"untangle", file, "-o", out},
              {"improve", file, "-o", out}}) {
            const ProcessResult result = cli(command);
            EXPECT_EQ(result.status, 1) << command[0];
            EXPECT_NE(result.errors.find("hangs on"), std::string::npos) << result.errors;
            EXPECT_FALSE(exists(out)) << command[0];
        }
    }
}

TEST_F(CommandLine, RaisingTheOrderKeepsTheGeometryUnlessItIsToBeStraight) {
    const CurvedMesh bent = with_bent_middle(square_mesh(4, 2), 0.1);
    CurvedMesh curved = bent.with_coordinates([&] {
        Coordinates x = bent.coordinates();
        for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 1) += 0.2 * x(i, 0) * x(i, 0);
        return x;
    }());
    const std::string file = folder / "p2.msh", out = folder / "out.msh";
    write_mesh(file, curved);
    const double area = size_of(curved);
    ASSERT_EQ(cli({"elevate", file, "--order", "4", "-o", out}).status, 0);
    EXPECT_EQ(read_mesh(out).mesh.topology().order(), 4);
    EXPECT_NEAR(size_of(read_mesh(out).mesh), area, 1e-13);
    Json json = parse(cli({"elevate", file, "--order", "1", "-o", out, "--json"}));
    EXPECT_GT(json["distance"]["absolute"].get<double>(), 1e-3) << json;
    EXPECT_TRUE(has_note(json, "from where they were"));
    ASSERT_EQ(cli({"elevate", file, "--order", "3", "--straight", "-o", out}).status, 0);
    // Sides of a straight-sided mesh are chords of y = 0.2 x²: 8 of length 1/4 below and above cancel.
    const CurvedMesh straight = read_mesh(out).mesh;
    for (Index element = 0; element < straight.topology().element_count(); ++element) {
        const auto nodes = straight.topology().element_nodes(element);
        const Eigen::RowVector3d third =
            (2.0 * straight.coordinates().row(nodes[0]) + straight.coordinates().row(nodes[1])) / 3.0;
        EXPECT_NEAR((straight.coordinates().row(nodes[3]) - third).norm(), 0.0, 1e-14);
    }
}

TEST_F(CommandLine, CompareTellsHowFarNodesWent) {
    const CurvedMesh mesh = square_mesh(3, 2);
    Coordinates x = mesh.coordinates();
    const Index node = mesh.topology().interior_nodes().front();
    x(node, 0) += 0.03;
    x(node, 1) += 0.04;
    const std::string a = folder / "a.msh", b = folder / "b.msh";
    write_mesh(a, mesh);
    write_mesh(b, mesh.with_coordinates(x));
    const Json json = parse(cli({"compare", a, b, "--json"}));
    EXPECT_EQ(json["motion"]["moved"], 1);
    EXPECT_NEAR(json["motion"]["max"].get<double>(), 0.05, 1e-15);
    EXPECT_NEAR(json["motion"]["relative"]["max"].get<double>(), 0.05 / std::sqrt(2.0), 1e-14);
    EXPECT_EQ(json["motion"]["farthest"], mesh.topology().node_tag(node).value);
    EXPECT_EQ(json["boundary"]["moved"], 0);
    EXPECT_FALSE(json["elements"]["moved"].empty());
    EXPECT_EQ(cli({"compare", a, b}).status, 0);
    EXPECT_EQ(cli({"compare", a, b, "--tolerance", "0.1"}).status, 0);
    EXPECT_EQ(cli({"compare", a, b, "--tolerance", "0.01"}).status, 4);
    EXPECT_EQ(cli({"compare", a, a, "--tolerance", "0"}).status, 0);
    expect_bad_input({"compare", a, folder / "none.msh"}, "none.msh");
}

TEST_F(CommandLine, InterfacesStayOrSlideAsToldByGroup) {
    const CurvedMesh plain = with_regions(square_mesh(4, 2), InterfaceCells::named);
    Coordinates x = plain.coordinates();
    x(node_at(plain, 0.5, 0.375), 1) = 0.27;  // folds an edge of the interface
    const std::string file = folder / "regions.msh", out = folder / "out.msh";
    write_mesh(file, plain.with_coordinates(x));
    ProcessResult result = cli({"untangle", file, "-o", out, "--json", "--quiet"});
    EXPECT_EQ(result.status, 3);
    EXPECT_TRUE(has_note(parse(result), "--boundary \"interface=slide\"")) << result.output;
    const CurvedMesh stayed = read_mesh(out).mesh;
    for (const Index node : plain.topology().interface_nodes()) EXPECT_EQ(stayed.coordinates().row(node), x.row(node));
    result = cli({"untangle", file, "-o", out, "--json", "--boundary", "interface=slide"});
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_NEAR(size_of_group(read_mesh(out).mesh, "near"), 0.5, 1e-12);
    expect_bad_input({"untangle", file, "-o", folder / "none.msh", "--boundary", "inner=slide"}, "inner");
}

}  // namespace
}  // namespace curvewright
