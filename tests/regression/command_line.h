#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/regression/process.h"

namespace curvewright::testing {

inline const std::string samples = CURVEWRIGHT_SAMPLES "/";
inline const std::string annulus = samples + "annulus/annulus.msh",
                         annulus_deformation = samples + "annulus/deformation.json";
inline const std::string circle = samples + "moving_circle/moving_circle.msh",
                         circle_deformation = samples + "moving_circle/deformation.json";

inline ProcessResult cli(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), CURVEWRIGHT_CLI);
    return run_program(arguments);
}

inline void write(const std::string& file, const std::string& text) {
    std::ofstream(file) << text;
}

inline std::string read(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

inline bool exists(const std::string& file) {
    return std::filesystem::exists(file);
}

class CommandLine : public ::testing::Test {
  protected:
    TemporaryFolder folder;
    std::string tangled = folder / "tangled.msh";

    void make_tangled() {
        ASSERT_EQ(cli({"deform", annulus, "--deformation", annulus_deformation, "-o", tangled}).status, 0);
    }
    /// The command fails with status 1, one line on standard error that holds `fragment`, nothing on standard output.
    static void expect_bad_input(const std::vector<std::string>& arguments, const std::string& fragment) {
        const ProcessResult result = cli(arguments);
        EXPECT_EQ(result.status, 1) << result.errors;
        EXPECT_NE(result.errors.find(fragment), std::string::npos) << result.errors;
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_TRUE(result.output.empty()) << result.output;
    }
};

}  // namespace curvewright::testing
