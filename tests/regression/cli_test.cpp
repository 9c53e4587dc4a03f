#include <algorithm>
#include <fstream>
#include <sstream>
#include <thread>

#include <sys/stat.h>

#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <nlohmann/json.hpp>

#include "core/io/mesh_io.h"
#include "core/quality/quality.h"
#include "tests/regression/command_line.h"
#include "tests/support/decoded_animation.h"

namespace curvewright {
namespace {

using namespace testing;
using Json = nlohmann::json;

TEST_F(CommandLine, InfoTellsTypeOrderCountsGroupsOrientationBox) {
    const ProcessResult result = cli({"info", annulus, "--json"});
    ASSERT_EQ(result.status, 0) << result.errors;
    const Json json = Json::parse(result.output);
    EXPECT_EQ(json["mesh"]["dimension"], 2);
    EXPECT_EQ(json["mesh"]["order"], 3);
    EXPECT_EQ(json["mesh"]["elements"], 30);
    EXPECT_EQ(json["mesh"]["nodes"], 159);
    EXPECT_EQ(json["mesh"]["interior_nodes"], 111);
    EXPECT_EQ(json["format"], "msh4");
    EXPECT_EQ(json["orientation"], "positive");
    EXPECT_EQ(json["cells"]["P3 triangle"], 30);
    EXPECT_EQ(json["groups"].size(), 3u);
    EXPECT_EQ(json["groups"][0]["name"], "outer");
    EXPECT_EQ(json["groups"][0]["nodes"], 30);
    EXPECT_DOUBLE_EQ(json["bounding_box"][0][0], -1.0);
    const ProcessResult text = cli({"info", annulus});
    EXPECT_NE(text.output.find("P3 30 triangles; 159 nodes (111 interior, 48 on the boundary)"), std::string::npos);
}

TEST_F(CommandLine, QualityCountsTangledElementsAndWritesCsv) {
    make_tangled();
    const std::string csv = folder / "q.csv";
    const ProcessResult result = cli({"quality", tangled, "--json", "--csv", csv});
    EXPECT_EQ(result.status, 3);
    EXPECT_TRUE(result.errors.empty()) << result.errors;
    const Json json = Json::parse(result.output);
    EXPECT_NEAR(json["scaled_jacobian"]["min"].get<double>(), -0.2223, 1e-3);
    EXPECT_EQ(json["scaled_jacobian"]["invalid"], 2);
    EXPECT_EQ(json["scaled_jacobian"]["valid"], 28);
    EXPECT_EQ(json["scaled_jacobian"]["undecided"], 0);
    ASSERT_EQ(json["worst"].size(), 10u);
    EXPECT_EQ(json["worst"][0]["scaled_jacobian"], json["scaled_jacobian"]["min"]);
    EXPECT_EQ(json["worst"][0]["center"].size(), 3u);
    EXPECT_TRUE(json["timings"].contains("certify"));
    const std::string lines = read(csv);
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 31);
    EXPECT_EQ(cli({"quality", annulus}).status, 0);
}

TEST_F(CommandLine, DeformMovesTheBoundaryOnly) {
    make_tangled();
    const CurvedMesh before = read_mesh(annulus).mesh, after = read_mesh(tangled).mesh;
    for (Index node : before.topology().interior_nodes())
        EXPECT_EQ(before.coordinates().row(node), after.coordinates().row(node));
    const auto inner = before.topology().find_group_nodes("inner").value();
    for (Index node : inner) EXPECT_NEAR(after.coordinates().row(node).norm(), 0.4, 1e-14);
    // The deformed mesh serves as a deformation itself, and so does a table of its boundary nodes.
    const std::string again = folder / "again.msh", table = folder / "table.csv", by_table = folder / "by_table.msh";
    EXPECT_EQ(cli({"deform", annulus, "--deformation", tangled, "-o", again}).status, 0);
    EXPECT_EQ(read_mesh(again).mesh.coordinates(), after.coordinates());
    std::ostringstream rows;
    rows.precision(17);
    rows << "tag,x,y,z\n";
    for (Index node : after.topology().boundary_nodes())
        rows << after.topology().node_tag(node).value << ',' << after.coordinates()(node, 0) << ','
             << after.coordinates()(node, 1) << ',' << after.coordinates()(node, 2) << '\n';
    write(table, rows.str());
    EXPECT_EQ(cli({"deform", annulus, "--deformation", table, "-o", by_table}).status, 0);
    EXPECT_EQ(read_mesh(by_table).mesh.coordinates(), after.coordinates());
}

TEST_F(CommandLine, ElevateKeepsCornersAndGroups) {
    const std::string out = folder / "p5.msh";
    ASSERT_EQ(cli({"elevate", annulus, "--order", "5", "-o", out}).status, 0);
    const CurvedMesh mesh = read_mesh(out).mesh;
    EXPECT_EQ(mesh.topology().order(), 5);
    EXPECT_EQ(mesh.topology().element_count(), 30);
    EXPECT_EQ(mesh.topology().groups().size(), 3u);
    EXPECT_NEAR(assess_quality(mesh).summary.min, 1.0, 1e-6);
}

TEST_F(CommandLine, ConvertChangesNothingButTheFormat) {
    make_tangled();
    const CurvedMesh original = read_mesh(tangled).mesh;
    for (const auto& [name, format] : std::vector<std::pair<std::string, std::string>>{
             {"a.vtu", ""}, {"b.vtk", ""}, {"c.msh", "msh2"}, {"d.msh", "msh4"}, {"e.dat", "vtu"}}) {
        const std::string out = folder / name;
        std::vector<std::string> arguments{"convert", tangled, out};
        if (!format.empty()) arguments.insert(arguments.end(), {"--format", format});
        ASSERT_EQ(cli(arguments).status, 0) << name;
        if (name == "e.dat") continue;  // the reader goes by the suffix
        const CurvedMesh copy = read_mesh(out).mesh;
        EXPECT_EQ(copy.coordinates(), original.coordinates()) << name;
        EXPECT_EQ(copy.topology().groups().size(), 3u) << name;
    }
    const std::string binary = folder / "binary.vtu";
    ASSERT_EQ(cli({"convert", tangled, binary, "--binary"}).status, 0);
    EXPECT_NE(read(binary).find("ScaledJacobian"), std::string::npos);
    EXPECT_NE(read(binary).find("Validity"), std::string::npos);
    const std::string flipped = folder / "flipped.msh";
    ASSERT_EQ(cli({"convert", tangled, flipped, "--flip"}).status, 0);
    const ProcessResult quality = cli({"quality", flipped, "--json"});
    EXPECT_EQ(Json::parse(quality.output)["orientation"], "negative");
    EXPECT_EQ(Json::parse(quality.output)["scaled_jacobian"]["invalid"], 2);
    EXPECT_NE(quality.errors.find("clockwise"), std::string::npos);
}

TEST_F(CommandLine, RenderNeedsNoDisplay) {
    make_tangled();
    const std::string picture = folder / "picture.png";
    const ProcessResult result = cli({"render", tangled, "-o", picture, "--size", "320x240"});
    ASSERT_EQ(result.status, 0) << result.errors;
    const std::string bytes = read(picture);
    ASSERT_GT(bytes.size(), 2000u);
    EXPECT_EQ(bytes.substr(1, 3), "PNG");
    const auto big_endian = [&](int at) {
        return (static_cast<unsigned char>(bytes[at + 2]) << 8) + static_cast<unsigned char>(bytes[at + 3]);
    };
    EXPECT_EQ(big_endian(16), 320);
    EXPECT_EQ(big_endian(20), 240);
    expect_bad_input({"render", tangled, "-o", folder / "picture.jpg"}, "pictures are written as .png");
}

TEST_F(CommandLine, RenderLooksInside) {
    const std::string screw = samples + "screw/screw.msh.gz";
    std::vector<std::string> pictures;
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{},
                                               {"--clip", "z"},
                                               {"--cut", "z"},
                                               {"--cut", "z", "--clip-at", "0.3"},
                                               {"--cut", "y", "--clip-at", "0.3"},
                                               {"--orthographic"},
                                               {"--node-numbers"},
                                               {"--element-numbers"}}) {
        const std::string picture = folder / "inside.png";
        std::vector<std::string> arguments{"render", screw, "-o", picture, "--size", "320x240"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = cli(arguments);
        ASSERT_EQ(result.status, 0) << result.errors;
        pictures.push_back(read(picture));
        for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
            EXPECT_NE(pictures.back(), pictures[i]) << options.front() << " shows what number " << i << " does";
    }
}

TEST_F(CommandLine, RenderLeavesTheGroundOut) {
    const std::string picture = folder / "clear.png";
    ASSERT_EQ(cli({"render", annulus, "-o", picture, "--size", "320x240", "--transparent"}).status, 0);
    EXPECT_EQ(read(picture)[25], 6);  // colour type: with alpha
    ASSERT_EQ(cli({"render", annulus, "-o", picture, "--size", "320x240"}).status, 0);
    EXPECT_EQ(read(picture)[25], 2);
}

/// Pixels of a picture that `are` so: red, green and blue; top and left first.
template <class Are>
double share_of_pixels(const std::string& file, Are are) {
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    const int* size = reader->GetOutput()->GetDimensions();
    const auto* rgb = static_cast<const unsigned char*>(reader->GetOutput()->GetScalarPointer());
    int count = 0;
    for (int i = 0; i < size[0] * size[1]; ++i) count += are(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]) ? 1 : 0;
    return static_cast<double>(count) / (size[0] * size[1]);
}

TEST_F(CommandLine, RenderComesNear) {
    make_tangled();
    const std::string picture = folder / "near.png", again = folder / "again.png";
    const auto draw = [&](const std::string& file, std::vector<std::string> options) {
        std::vector<std::string> arguments = {"render", tangled,   "-o",          file,
                                              "--size", "320x240", "--no-legend", "--json"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, 0) << result.errors;
        return Json::parse(result.output);
    };
    const auto is_alarm = [](int red, int green, int blue) { return red > 180 && green < 60 && blue > 60; };
    EXPECT_FALSE(draw(picture, {}).contains("view"));
    const double far = share_of_pixels(picture, is_alarm);
    const Json worst = draw(picture, {"--focus", "worst", "--margin", "0.1"})["view"];
    EXPECT_GT(share_of_pixels(picture, is_alarm), 4.0 * far);
    ASSERT_EQ(worst["elements"].size(), 1u);

    // The same place in numbers, the same element by its tag.
    const std::string place =
        worst["center"][0].dump() + "," + worst["center"][1].dump() + "," + worst["radius"].dump();
    draw(again, {"--zoom=" + place});
    EXPECT_EQ(read(again), read(picture));
    const std::string element = "element:" + worst["elements"][0].dump();
    draw(again, {"--focus", element, "--margin", "0.1"});
    EXPECT_EQ(read(again), read(picture));
    draw(again, {"--focus", element, "--margin", "0.1", "--outline", element});
    EXPECT_NE(read(again), read(picture));

    const Json both = draw(picture, {"--focus", "tangled", "--margin", "0"})["view"];
    EXPECT_EQ(both["elements"].size(), 2u);
    EXPECT_NEAR(both["center"][1].get<double>(), 0.0, 0.05);  // one above the hole, one below it
    EXPECT_EQ(draw(picture, {"--focus", "worst:3"})["view"]["elements"].size(), 3u);

    expect_bad_input({"render", tangled, "-o", picture, "--focus", "element:12345"}, "no element 12345");
    expect_bad_input({"render", annulus, "-o", picture, "--focus", "tangled"}, "No element is tangled");
}

TEST_F(CommandLine, RenderLooksFromWhereItIsTold) {
    const std::string screw = samples + "screw/screw.msh.gz";
    std::vector<std::string> pictures;
    const auto draw = [&](std::vector<std::string> options) {
        const std::string picture = folder / "side.png";
        std::vector<std::string> arguments{"render", screw, "-o", picture, "--size", "160x120", "--no-legend"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        EXPECT_EQ(cli(arguments).status, 0);
        return read(picture);
    };
    EXPECT_EQ(draw({"--view", "iso"}), draw({}));
    EXPECT_EQ(draw({"--view", "front"}), draw({"--view", "-90,0"}));
    EXPECT_NE(draw({"--view", "front"}), draw({"--view", "back"}));
    // The section is on the side of the eye, and goes through what is looked at.
    EXPECT_EQ(draw({"--view", "top", "--cut", "z", "--zoom", "0,0,1.935,1"}),
              draw({"--view", "top", "--cut", "z", "--zoom", "0,0,1.935,1", "--clip-at", "0.5"}));
    EXPECT_NE(draw({"--view", "back", "--cut", "y"}), draw({"--view", "back"}));
    expect_bad_input({"render", screw, "-o", folder / "side.png", "--zoom", "0,0,1", "--quiet"}, "four numbers");
}

TEST_F(CommandLine, RenderWithAPalette) {
    make_tangled();
    const std::string full = folder / "full.png", small = folder / "small.png";
    ASSERT_EQ(cli({"render", tangled, "-o", full, "--size", "320x240"}).status, 0);
    ASSERT_EQ(cli({"render", tangled, "-o", small, "--size", "320x240", "--palette", "32"}).status, 0);
    EXPECT_EQ(read(small)[25], 3);  // colour type: palette
    EXPECT_LT(2 * read(small).size(), read(full).size());
    const auto is_white = [](int red, int green, int blue) { return red == 255 && green == 255 && blue == 255; };
    EXPECT_NEAR(share_of_pixels(small, is_white), share_of_pixels(full, is_white), 0.02);
}

TEST_F(CommandLine, HistogramsOnOneScale) {
    make_tangled();
    const std::string picture = folder / "histograms.svg";
    const ProcessResult result =
        cli({"histogram", annulus, tangled, "-o", picture, "--title", "a < b", "--title", "Tangled", "--json"});
    ASSERT_EQ(result.status, 0) << result.errors;
    const Json states = Json::parse(result.output)["states"];
    ASSERT_EQ(states.size(), 2u);
    EXPECT_EQ(states[0]["histogram"]["tangled"], 0);
    EXPECT_EQ(states[1]["histogram"]["tangled"], 2);
    EXPECT_EQ(states[1]["scaled_jacobian"]["invalid"], 2);
    const std::string svg = read(picture);
    EXPECT_EQ(svg.substr(0, 4), "<svg");
    for (const char* text : {"a &lt; b", ">Tangled<", "all 30 valid", "2 of 30 tangled", "min −0.22"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    expect_bad_input({"histogram", annulus, "-o", folder / "histograms.png"}, "histograms are written as .svg");
    EXPECT_EQ(cli({"histogram", annulus, tangled, "-o", picture, "--title", "one"}).status, 2);
}

TEST_F(CommandLine, AnimateWritesPicturesOfAWarp) {
    const std::string deformation = folder / "shift.json", film = folder / "film";
    write(deformation, R"({"operations": [{"group": "inner", "type": "translate", "vector": [0.05, 0, 0]}]})");
    const ProcessResult result = cli({"animate", annulus, "--deformation", deformation, "-o", film, "--frames", "4",
                                      "--size", "160x120", "--there-and-back", "--weights", "affine", "--json"});
    ASSERT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(Json::parse(result.output)["pictures"]["count"], 6);
    const auto picture = [&](int number) { return read(film + "/annulus-000" + std::to_string(number) + ".png"); };
    for (int number = 1; number <= 6; ++number) EXPECT_EQ(picture(number).substr(1, 3), "PNG") << number;
    EXPECT_NE(picture(1), picture(2));
    EXPECT_NE(picture(3), picture(4));
    EXPECT_EQ(picture(5), picture(3));
    EXPECT_EQ(picture(6), picture(2));
    EXPECT_FALSE(std::filesystem::exists(film + "/annulus-0007.png"));
    expect_bad_input({"animate", annulus, "--deformation", deformation, "-o", "/proc/film"}, "/proc/film");
    EXPECT_EQ(cli({"animate", annulus, "--deformation", deformation, "-o", film, "--size", "161x120"}).status, 2);
    EXPECT_EQ(cli({"animate", annulus, "--deformation", deformation, "-o", film, "--frames", "1"}).status, 2);
}

TEST_F(CommandLine, AnimateWritesAnAnimation) {
    const std::string deformation = folder / "shift.json", film = folder / "film.webp", pictures = folder / "pictures";
    write(deformation, R"({"operations": [{"group": "inner", "type": "translate", "vector": [0.05, 0, 0]}]})");
    const std::vector<std::string> common = {"animate",  annulus, "--deformation",   deformation, "--size", "160x120",
                                             "--frames", "4",     "--there-and-back"};
    const auto animate = [&](std::vector<std::string> more) {
        more.insert(more.begin(), common.begin(), common.end());
        return cli(more);
    };
    const ProcessResult result = animate({"-o", film, "--fps", "8", "--lossless", "--json"});
    ASSERT_EQ(result.status, 0) << result.errors;
    const Json told = Json::parse(result.output)["animation"];
    EXPECT_EQ(told["count"], 6);
    EXPECT_EQ(told["seconds"], 0.75);
    EXPECT_EQ(told["bytes"], std::filesystem::file_size(film));
    const testing::DecodedAnimation decoded(read(film));
    EXPECT_EQ(decoded.width, 160);
    EXPECT_EQ(decoded.height, 120);
    ASSERT_EQ(decoded.frames.size(), 6u);
    EXPECT_EQ(decoded.ends, (std::vector<int>{125, 250, 375, 500, 625, 750}));
    // Back the same way, to rounding: it is drawn once more.
    const auto difference = [&](std::size_t a, std::size_t b) {
        return testing::DecodedAnimation::difference(decoded.frames[a], decoded.frames[b]);
    };
    EXPECT_GT(difference(0, 1), 0.02);
    EXPECT_LT(difference(4, 2), 0.001);
    EXPECT_LT(difference(5, 1), 0.001);
    // The same as the pictures, rows the same way up.
    ASSERT_EQ(animate({"-o", pictures}).status, 0);
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName((pictures + "/annulus-0003.png").c_str());
    reader->Update();
    vtkImageData* image = reader->GetOutput();
    for (const auto& [x, y] : {std::pair{80, 60}, {40, 30}, {100, 50}, {155, 10}})
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(decoded.pixel(2, x, y)[static_cast<std::size_t>(k)],
                      image->GetScalarComponentAsDouble(x, 119 - y, 0, k))
                << x << " " << y;
    EXPECT_EQ(decoded.pixel(2, 2, 2)[3], 255);
    EXPECT_EQ(animate({"-o", pictures, "--fps", "8"}).status, 2);
    EXPECT_EQ(animate({"-o", film, "--fps", "100"}).status, 2);
    EXPECT_EQ(animate({"-o", film, "--lossless", "--quality", "10"}).status, 2);
    expect_bad_input({"animate", annulus, "--deformation", deformation, "-o", folder / "none/film.webp"}, "film.webp");
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

TEST_F(CommandLine, AnimateWritesTheStepsOfATrace) {
    const std::string deformation = folder / "shift.json", start = folder / "start.msh", trace = folder / "steps.jsonl",
                      film = folder / "steps.webp";
    write(deformation,
          R"({"operations": [{"group": "inner", "type": "rotate", "center": [0, 0, 0], "angle_deg": 30}]})");
    ASSERT_EQ(cli({"deform", annulus, "--deformation", deformation, "-o", start}).status, 0);
    ASSERT_LE(cli({"untangle", start, "-o", folder / "out.msh", "--beta", "0.5", "--max-passes", "3", "--trace", trace})
                  .status,
              3);
    const auto animate = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"animate", annulus, "--trace", trace, "--size", "160x120"});
        return cli(more);
    };
    // The mesh may be in another state: the trace knows where it began.
    const ProcessResult passes = animate({"-o", film, "--level", "pass", "--lossless", "--json"});
    ASSERT_EQ(passes.status, 0) << passes.errors;
    // Start, passes, end; two pictures that are the same are one that is longer.
    EXPECT_GE(Json::parse(passes.output)["animation"]["count"], 4);
    const testing::DecodedAnimation decoded(read(film));
    ASSERT_GE(decoded.frames.size(), 3u);
    EXPECT_GT(testing::DecodedAnimation::difference(decoded.frames[0], decoded.frames[1]), 0.02);
    const ProcessResult some = animate({"-o", folder / "pictures", "--frames", "7", "--json"});
    ASSERT_EQ(some.status, 0) << some.errors;
    EXPECT_EQ(Json::parse(some.output)["pictures"]["count"], 7);

    EXPECT_EQ(animate({"-o", film, "--deformation", deformation}).status, 2);
    EXPECT_EQ(animate({"-o", film, "--level", "round"}).status, 2);
    EXPECT_EQ(cli({"animate", annulus, "-o", film}).status, 2);
    EXPECT_EQ(cli({"animate", annulus, "--deformation", deformation, "--level", "pass", "-o", film}).status, 2);
    expect_bad_input({"animate", annulus, "--trace", folder / "none.jsonl", "-o", film}, "none.jsonl");
    write(trace, "{\"event\": \"dance\"}\n");
    expect_bad_input({"animate", annulus, "--trace", trace, "-o", film}, "steps.jsonl:1");
}

TEST_F(CommandLine, BadInputGetsOneSentenceAndNoOutput) {
    const std::string out = folder / "out.msh", bad = folder / "bad.msh", deformation = folder / "d.json";
    expect_bad_input({"quality", folder / "missing.msh"}, "missing.msh");
    write(bad, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 1 2\n2 1 0 2\n1\n2\n0 0 0\n1 zero 0\n$EndNodes\n");
    expect_bad_input({"quality", bad}, "bad.msh:10: ");
    write(deformation, R"({"operations": [{"group": "wing", "type": "translate", "vector": [1, 0, 0]}]})");
    expect_bad_input({"deform", annulus, "--deformation", deformation, "-o", out}, "there is no group 'wing'");
    write(deformation, R"({"operations": [{"group": "inner", "type": "twist"}]})");
    expect_bad_input({"warp", annulus, "--deformation", deformation, "-o", out, "--quiet"}, "twist");
    expect_bad_input({"elevate", annulus, "--order", "11", "-o", out}, "orders 1 to 10");
    const std::string p1 = folder / "p1.msh";
    ASSERT_EQ(cli({"elevate", annulus, "--order", "1", "-o", p1}).status, 0);
    expect_bad_input({"untangle", p1, "-o", out, "--method", "signed-angle"}, "this mesh has P1 triangle elements");
    expect_bad_input({"convert", annulus, folder / "out.stl"}, "out.stl");
    expect_bad_input({"convert", annulus, folder / "no/such/folder/out.msh"}, "no/such/folder/out.msh");
    EXPECT_FALSE(exists(out));
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        EXPECT_TRUE(entry.path() == bad || entry.path() == deformation || entry.path() == p1)
            << "left behind: " << entry.path();
}

TEST_F(CommandLine, ReplayDoesWhatTheCommandsDo) {
    make_tangled();
    const std::string session = folder / "work.json", out = folder / "out.msh", again = folder / "again.msh";
    ASSERT_EQ(cli({"untangle", tangled, "-o", out, "--method", "guaranteed", "--target", "0.5"}).status, 0);
    write(session, "{\"action\": \"open\", \"mesh\": \"" + annulus + "\"}\n\n" +
                       "{\"action\": \"deform\", \"deformation\": \"" + annulus_deformation + "\"}\n" +
                       "{\"action\": \"untangle\", \"method\": \"unsigned-angle\"}\n" +
                       "{\"action\": \"history\", \"step\": 1}\n" +
                       "{\"action\": \"untangle\", \"method\": \"guaranteed\", \"target\": 0.5}\n");
    const ProcessResult result = cli({"replay", session, "-o", again, "--json"});
    ASSERT_EQ(result.status, 0) << result.errors;
    const Json json = Json::parse(result.output);
    EXPECT_EQ(json["actions"], 5);
    EXPECT_EQ(json["scaled_jacobian"]["valid"], 30);
    EXPECT_EQ(json["before"]["scaled_jacobian"]["invalid"], 0);
    // The tangled state went through a file in between; its 17 digits lose nothing.
    EXPECT_EQ(read_mesh(again).mesh.coordinates(), read_mesh(out).mesh.coordinates());
    // Without an output it tells what came out.
    EXPECT_NE(cli({"replay", session}).output.find("5 actions replayed"), std::string::npos);
    // A file beside the session is found from anywhere.
    write(session, "{\"action\": \"open\", \"mesh\": \"tangled.msh\"}\n");
    EXPECT_EQ(cli({"replay", session}).status, 3);
}

TEST_F(CommandLine, BadSessionsGetOneSentenceAndNoOutput) {
    const std::string session = folder / "work.json", out = folder / "out.msh";
    expect_bad_input({"replay", folder / "nothing.json", "-o", out}, "nothing.json");
    const struct {
        const char *text, *expected;
    } cases[] = {
        {"", "the session is empty"},
        {"{\"action\": \"flip\"}\n", "before it opens a mesh"},
        {"{\"action\": \"open\", \"mesh\": \"gone.msh\"}\n", "gone.msh"},
        {"\n{\"action\": \"dance\"}\n", "work.json:2: unknown action"},
        {"{\"action\": \"open\", \"mesh\"", "work.json:1: this is not one whole JSON object"},
    };
    for (const auto& [text, expected] : cases) {
        write(session, text);
        expect_bad_input({"replay", session, "-o", out}, expected);
        EXPECT_FALSE(exists(out));
    }
    write(session, "{\"action\": \"open\", \"mesh\": \"" + annulus +
                       "\"}\n{\"action\": \"drag\", \"nodes\": [424242], \"shift\": [1, 0, 0]}\n");
    expect_bad_input({"replay", session, "-o", out}, "no node 424242");
    EXPECT_FALSE(exists(out));
}

TEST_F(CommandLine, FailedCommandLeavesAnExistingOutputAlone) {
    const std::string out = folder / "out.msh", deformation = folder / "d.json";
    write(out, "precious");
    write(deformation, R"({"operations": [{"group": "inner", "type": "scale"}]})");
    EXPECT_EQ(cli({"deform", annulus, "--deformation", deformation, "-o", out}).status, 1);
    EXPECT_EQ(read(out), "precious");
}

TEST_F(CommandLine, AMeshTurnedInsideOutIsNotValid) {
    const std::string deformation = folder / "mirror.json", out = folder / "mirrored.msh";
    write(deformation,
          R"({"operations": [{"group": "boundary", "type": "scale", "center": [0, 0, 0], "factors": [-1, 1, 1]}]})");
    const ProcessResult result = cli({"warp", circle, "--deformation", deformation, "-o", out, "--json"});
    EXPECT_EQ(result.status, 3);
    EXPECT_EQ(Json::parse(result.output)["scaled_jacobian"]["invalid"], 1660);
}

TEST_F(CommandLine, DeformationOutOfThePlaneIsNamed) {
    const std::string deformation = folder / "lift.json", out = folder / "lifted.msh";
    write(deformation, R"({"operations": [{"group": "circle", "type": "translate", "vector": [0, 0, 0.1]}]})");
    expect_bad_input({"warp", circle, "--deformation", deformation, "-o", out}, "must keep z");
}

TEST_F(CommandLine, NamesThatAreNoUtf8DoNotBreakJson) {
    const std::string out = folder / "caf\xe9.msh";
    const ProcessResult result = cli({"deform", annulus, "--deformation", annulus_deformation, "-o", out, "--json"});
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_TRUE(Json::accept(result.output));
    EXPECT_TRUE(exists(out));
}

TEST_F(CommandLine, LinksAreFollowedAndPipesAreFed) {
    const std::string real = folder / "real.csv", link = folder / "link.csv", pipe = folder / "pipe.csv";
    write(real, "old");
    std::filesystem::create_symlink(real, link);
    ASSERT_EQ(cli({"quality", annulus, "--csv", link, "--quiet"}).status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_NE(read(real).find("element,scaled_jacobian"), std::string::npos);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] { received = read(pipe); });
    ASSERT_EQ(cli({"quality", annulus, "--csv", pipe, "--quiet"}).status, 0);
    reader.join();
    EXPECT_EQ(received, read(real));
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST_F(CommandLine, DemonstrationReportsTheResults) {
    const std::string out = folder / "out";
    const ProcessResult result = run_program({"/bin/bash", CURVEWRIGHT_DEMO, out, CURVEWRIGHT_CLI});
    ASSERT_EQ(result.status, 0) << result.errors;
    const std::string report = read(out + "/report.md");
    EXPECT_NE(report.find("| annulus | boundary moved | -0.222 | 0.634 | 28 | 2 |"), std::string::npos) << report;
    EXPECT_NE(report.find("| annulus | untangled, signed angles, beta 0.7 | 0.456 | 0.656 | 30 | 0 |"),
              std::string::npos)
        << report;
    EXPECT_NE(report.find("| moving_circle | warped, convex weights | 0.735 | 0.99"), std::string::npos) << report;
    EXPECT_TRUE(exists(out + "/annulus_untangled.png"));
    EXPECT_TRUE(exists(out + "/moving_sphere_small_warped.vtu"));
}

TEST_F(CommandLine, WrongUsageEndsWithTwo) {
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {},
             {"frobnicate"},
             {"quality"},
             {"quality", annulus, "--nonsense"},
             {"quality", annulus, "--tolerance", "-1"},
             {"warp", annulus, "-o", "x.msh"},
             {"warp", annulus, "--deformation", annulus_deformation, "-o", "x.msh", "--weights", "heavy"},
             {"untangle", annulus, "-o", "x.msh", "--method", "magic"},
             {"untangle", annulus, "-o", "x.msh", "--beta", "7"},
             {"untangle", annulus, "-o", "x.msh", "--max-passes", "0"},
             {"warp", annulus, "--deformation", annulus_deformation, "-o", "x.msh", "--distance-power", "9"},
             {"render", annulus, "-o", "x.png", "--size", "big"},
             {"render", annulus, "-o", "x.png", "--cut", "x", "--clip", "y"},
             {"render", annulus, "-o", "x.png", "--clip-at", "0.5"},
             {"render", annulus, "-o", "x.png", "--cut", "x", "--clip-at", "2"},
             {"render", annulus, "-o", "x.png", "--focus", "best"},
             {"render", annulus, "-o", "x.png", "--focus", "worst", "--zoom", "0,0,1"},
             {"render", annulus, "-o", "x.png", "--margin", "1"},
             {"render", annulus, "-o", "x.png", "--zoom", "0,0"},
             {"render", annulus, "-o", "x.png", "--view", "above"},
             {"render", annulus, "-o", "x.png", "--palette", "1"},
             {"render", annulus, "-o", "x.png", "--palette", "64", "--transparent"},
             {"elevate", annulus, "-o", "x.msh"}}) {
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, 2) << (arguments.empty() ? "" : arguments.back());
        EXPECT_FALSE(result.errors.empty() && result.output.empty());
    }
    EXPECT_EQ(cli({"--help"}).status, 0);
    EXPECT_EQ(cli({"warp", "--help"}).status, 0);
    EXPECT_EQ(cli({"--version"}).status, 0);
}

TEST_F(CommandLine, ThreadCountDoesNotChangeTheResult) {
    const std::string one = folder / "one.msh", two = folder / "two.msh";
    ASSERT_EQ(cli({"warp", circle, "--deformation", circle_deformation, "-o", one, "--threads", "1"}).status, 0);
    ASSERT_EQ(cli({"warp", circle, "--deformation", circle_deformation, "-o", two, "--threads", "2"}).status, 0);
    EXPECT_EQ(read(one), read(two));
}

}  // namespace
}  // namespace curvewright
