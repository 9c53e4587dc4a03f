/// Arrays of a file on their way through the commands, and in pictures.

#include <nlohmann/json.hpp>

#include "core/io/mesh_io.h"
#include "tests/regression/command_line.h"

namespace curvewright {
namespace {

using namespace testing;
using Json = nlohmann::json;
using Place = FieldArray::Place;

class FieldsOnTheCommandLine : public CommandLine {
  protected:
    void SetUp() override {
        const CurvedMesh mesh = read_mesh(annulus).mesh;
        fields.resize(3);
        fields[0].name = "pressure";
        fields[1].name = "velocity";
        fields[1].components = 3;
        for (Eigen::Index i = 0; i < mesh.coordinates().rows(); ++i) {
            const double x = mesh.coordinates()(i, 0), y = mesh.coordinates()(i, 1);
            fields[0].values.push_back(100.0 + x / 3.0);
            fields[1].values.insert(fields[1].values.end(), {-y, x, 0.0});
        }
        fields[2].name = "partition";
        fields[2].place = Place::elements;
        for (Index element = 0; element < mesh.topology().element_count(); ++element)
            fields[2].values.push_back(static_cast<double>(element % 4));
        WriteOptions options;
        options.fields = &fields;
        write_mesh(in, mesh, options);
    }
    void expect_kept(const std::string& file, bool on_nodes = true) const {
        const std::vector<FieldArray> back = read_mesh(file).fields;
        for (const FieldArray& field : fields) {
            const auto found = std::find_if(back.begin(), back.end(), [&](const FieldArray& other) {
                return other.name == field.name && other.place == field.place && other.values == field.values;
            });
            EXPECT_EQ(found != back.end(), on_nodes || field.place == Place::elements) << file << " " << field.name;
        }
    }

    std::string in = folder / "in.vtu";
    std::vector<FieldArray> fields;
};

TEST_F(FieldsOnTheCommandLine, EveryCommandKeepsThem) {
    const auto run = [&](std::vector<std::string> arguments, const std::string& out) {
        arguments.push_back("--quiet");
        const ProcessResult result = cli(arguments);
        EXPECT_TRUE(result.status == 0 || result.status == 3) << out << ": " << result.errors;
        return folder / out;
    };
    for (const std::string suffix : {"msh", "vtu", "vtk"}) {
        const std::string out = "converted." + suffix;
        expect_kept(run({"convert", in, folder / out}, out));
    }
    expect_kept(run({"convert", in, folder / "old.msh", "--format", "msh2"}, "old.msh"));
    expect_kept(run({"convert", in, folder / "flipped.vtu", "--flip"}, "flipped.vtu"));
    expect_kept(
        run({"deform", in, "--deformation", annulus_deformation, "-o", folder / "deformed.vtu"}, "deformed.vtu"));
    expect_kept(run({"warp", in, "--deformation", annulus_deformation, "-o", folder / "warped.msh"}, "warped.msh"));
    expect_kept(run({"untangle", folder / "deformed.vtu", "-o", folder / "mended.msh"}, "mended.msh"));
    // The way that the nodes of deformed.vtu had gone is not that of mended.msh.
    for (const FieldArray& field : read_mesh(folder / "mended.msh").fields) EXPECT_NE(field.name, "Displacement");
    write(folder / "session.json", "{\"action\":\"open\",\"mesh\":\"in.vtu\"}\n{\"action\":\"flip\"}\n");
    expect_kept(run({"replay", folder / "session.json", "-o", folder / "replayed.msh"}, "replayed.msh"));
    // Other nodes: arrays on nodes are interpolated.
    const ProcessResult elevated = cli({"elevate", in, "--order", "4", "-o", folder / "p4.vtu"});
    EXPECT_EQ(elevated.status, 0) << elevated.errors;
    expect_kept(folder / "p4.vtu", false);
    const ReadResult p4 = read_mesh(folder / "p4.vtu");
    const auto pressure = std::find_if(p4.fields.begin(), p4.fields.end(),
                                       [](const FieldArray& field) { return field.name == "pressure"; });
    ASSERT_NE(pressure, p4.fields.end());
    EXPECT_EQ(pressure->size(), static_cast<std::size_t>(p4.mesh.topology().node_count()));
}

TEST_F(FieldsOnTheCommandLine, InfoListsThem) {
    const Json arrays = Json::parse(cli({"info", in, "--json"}).output)["arrays"];
    ASSERT_EQ(arrays.size(), 3u);
    EXPECT_EQ(arrays[1]["name"], "velocity");
    EXPECT_EQ(arrays[1]["on"], "nodes");
    EXPECT_EQ(arrays[1]["components"], 3);
    EXPECT_NEAR(arrays[1]["range"][1].get<double>(), 1.0, 1e-12);
    EXPECT_NE(cli({"info", in}).output.find("array        partition on elements: numbers, from 0 to 3"),
              std::string::npos);
}

TEST_F(FieldsOnTheCommandLine, PicturesShowThem) {
    const std::string picture = folder / "picture.png";
    std::vector<std::string> seen;
    const auto colors = [&](std::vector<std::string> options) {
        std::vector<std::string> arguments = {"render", in, "-o", picture, "--size", "200x150", "--json", "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, 0) << result.errors;
        seen.push_back(read(picture));
        return Json::parse(result.output)["colors"];
    };
    Json json = colors({});
    EXPECT_EQ(json["by"], "scaled-jacobian");
    EXPECT_EQ(json["map"], "warm");
    EXPECT_EQ(json["range"], Json({0.0, 1.0}));
    json = colors({"--color-by", "pressure"});
    EXPECT_EQ(json["map"], "deep");
    EXPECT_NEAR(json["range"][1].get<double>(), 100.0 + 1.0 / 3.0, 1e-12);
    json = colors({"--color-by", "velocity:x", "--map", "balance"});
    EXPECT_EQ(json["range"][0].get<double>(), -json["range"][1].get<double>());
    json = colors({"--color-by", "velocity:2", "--reverse-map", "--range", "-0.5", "0.25"});
    EXPECT_EQ(json["reversed"], true);
    EXPECT_EQ(json["range"], Json({-0.5, 0.25}));
    colors({"--color-by", "partition"});
    colors({"--color-by", "size"});
    colors({"--color-by", "plain"});
    for (std::size_t i = 0; i < seen.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(seen[i], seen[j]) << i << " " << j;

    expect_bad_input({"render", in, "-o", folder / "no.png", "--quiet", "--color-by", "temperature"},
                     "there are scaled-jacobian, plain, shape, size, pressure, velocity, partition.");
    expect_bad_input({"render", in, "-o", folder / "no.png", "--quiet", "--color-by", "velocity:w"},
                     "velocity has no component \"w\"");
    expect_bad_input({"render", in, "-o", folder / "no.png", "--quiet", "--range", "2", "1"},
                     "--range goes from 2 to 1");
    EXPECT_FALSE(exists(folder / "no.png"));
    EXPECT_EQ(cli({"render", in, "-o", picture, "--map", "rainbow"}).status, 2);
}

}  // namespace
}  // namespace curvewright
