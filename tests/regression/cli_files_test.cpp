/// What files say about themselves, and what goes through `convert`.

#include <nlohmann/json.hpp>

#include "core/base/sha256.h"
#include "core/io/mesh_io.h"
#include "tests/regression/command_line.h"

namespace curvewright {
namespace {

using namespace testing;
using Json = nlohmann::json;

const std::string periodic = CURVEWRIGHT_TEST_DATA "/io/square_periodic_partitioned.msh";

class FilesOnTheCommandLine : public CommandLine {};

/// The line of a comment that begins with a key; "" if there is none.
std::string comment(const std::string& file, const std::string& key) {
    const std::string text = read(file);
    const std::string comments = text.substr(0, text.find("$EndComments"));
    const std::size_t begin = comments.find("\n" + key + ": ");
    if (begin == comments.npos) return {};
    const std::size_t from = begin + key.size() + 3;
    return comments.substr(from, comments.find('\n', from) - from);
}

TEST_F(FilesOnTheCommandLine, OutputsTellWhoMadeThem) {
    const std::string out = folder / "out.msh";
    ASSERT_EQ(cli({"warp", annulus, "--deformation", annulus_deformation, "--weights", "elastic", "--threads", "1",
                   "--json", "-o", out})
                  .status,
              0);
    EXPECT_EQ(comment(out, "Made by"), "Curvewright " + std::string(CURVEWRIGHT_VERSION));
    EXPECT_EQ(comment(out, "Command"),
              "curvewright-cli warp annulus.msh --deformation deformation.json --weights elastic");
    EXPECT_EQ(comment(out, "Input"), "annulus.msh");
    EXPECT_EQ(comment(out, "Input SHA-256"), sha256_of_file(annulus));
    EXPECT_TRUE(read_mesh(out).notes.empty());
}

TEST_F(FilesOnTheCommandLine, WhatHasNoEffectIsNotRecorded) {
    for (const std::string suffix : {".msh", ".vtu", ".vtk"}) {
        ASSERT_EQ(cli({"convert", annulus, folder / ("a" + suffix), "--threads", "1"}).status, 0);
        ASSERT_EQ(cli({"convert", "--quiet", annulus, folder / ("another" + suffix), "--json"}).status, 0);
        EXPECT_EQ(read(folder / ("a" + suffix)), read(folder / ("another" + suffix)));
    }
    ASSERT_EQ(cli({"convert", annulus, folder / "with space.msh", "--flip"}).status, 0);
    ASSERT_EQ(cli({"convert", folder / "with space.msh", folder / "out.msh", "--format", "msh2"}).status, 0);
    EXPECT_EQ(comment(folder / "out.msh", "Command"), "curvewright-cli convert 'with space.msh' --format msh2");
}

TEST_F(FilesOnTheCommandLine, ConvertKeepsPeriodicEntitiesAndPartitions) {
    const auto told = [](const std::string& file) { return Json::parse(cli({"info", file, "--json"}).output); };
    const Json before = told(periodic);
    EXPECT_EQ(before["periodic"], 3);
    EXPECT_EQ(before["partitions"], 2);
    std::string from = periodic;
    for (const auto& [name, format] : {std::pair{"a.msh", "msh4"}, std::pair{"b.vtu", "vtu"}, std::pair{"c.vtk", "vtk"},
                                       std::pair{"d.msh", "msh2"}}) {
        const std::string to = folder / name;
        const ProcessResult result = cli({"convert", from, to, "--format", format});
        ASSERT_EQ(result.status, 0) << result.errors;
        EXPECT_EQ(result.errors.find("skipped"), std::string::npos) << result.errors;
        EXPECT_EQ(told(to)["periodic"], 3) << name;
        EXPECT_EQ(told(to)["partitions"], 2) << name;
        from = to;
    }
}

TEST_F(FilesOnTheCommandLine, AFullDiskIsOneSentence) {
    if (!exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
    for (const char* format : {"msh2", "msh4", "vtu", "vtk"})
        expect_bad_input({"convert", annulus, "/dev/full", "--format", format, "--quiet"},
                         "/dev/full: the file cannot be written (No space left on device).");
}

}  // namespace
}  // namespace curvewright
