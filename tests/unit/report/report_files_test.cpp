#include "core/report/report_files.h"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace curvewright {
namespace {

namespace fs = std::filesystem;

class ReportFilesTest : public ::testing::Test {
  protected:
    ReportFilesTest() {
        folder_ = fs::temp_directory_path() / ("curvewright_report_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directory(folder_);
    }
    ~ReportFilesTest() override { fs::remove_all(folder_); }
    void expect_refused(const fs::path& folder, const std::string& fragment, const std::vector<fs::path>& others = {}) {
        try {
            check_report_folder(folder, others);
            FAIL() << folder;
        } catch (const InvalidInput& problem) {
            EXPECT_NE(std::string(problem.what()).find(fragment), std::string::npos) << problem.what();
        }
    }
    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const auto& entry : fs::recursive_directory_iterator(folder_))
            result.push_back(fs::relative(entry.path(), folder_).string());
        std::sort(result.begin(), result.end());
        return result;
    }

    fs::path folder_;
    RunReport report_;
    ReportPictures pictures_;
    ReportColors colors_{[](double) { return std::string("#000000"); }, "#000000", "#000000"};
};

TEST_F(ReportFilesTest, AppearTogetherWithTheirFolder) {
    {
        ReportFiles files(folder_ / "new" / "", report_, pictures_, colors_);
        EXPECT_FALSE(fs::exists(folder_ / "new" / report_html_name));
        files.commit();
    }
    EXPECT_EQ(names(), (std::vector<std::string>{"new", "new/report.html", "new/report.json"}));
    std::ifstream stream(folder_ / "new" / report_json_name);
    EXPECT_EQ(nlohmann::json::parse(stream)["report"], "untangling");
}

TEST_F(ReportFilesTest, LeaveNothingIfTheyAreGivenUp) {
    { ReportFiles files(folder_ / "new", report_, pictures_, colors_); }
    EXPECT_TRUE(names().empty());
    // What was there before stays.
    fs::create_directory(folder_ / "old");
    std::ofstream(folder_ / "old" / report_html_name) << "mine";
    { ReportFiles files(folder_ / "old", report_, pictures_, colors_); }
    EXPECT_EQ(fs::file_size(folder_ / "old" / report_html_name), 4u);
    EXPECT_EQ(names().size(), 2u);
}

TEST_F(ReportFilesTest, AreRefusedWhereTheyCannotBe) {
    expect_refused("", "no name");
    expect_refused(folder_ / "a" / "b", "there is no folder");
    std::ofstream(folder_ / "file") << "x";
    expect_refused(folder_ / "file", "something else");
    expect_refused(folder_ / "file" / "report", "there is no folder");
    fs::create_symlink(folder_ / "nowhere", folder_ / "link");
    expect_refused(folder_ / "link", "something else");
    fs::create_directories(folder_ / "odd" / report_json_name);
    expect_refused(folder_ / "odd", "there is a folder of that name");
    expect_refused(folder_ / "out", "the report has a file of that name", {folder_ / "out" / report_html_name});
    expect_refused(folder_ / "out", "at the same time", {folder_ / "." / "out"});
    EXPECT_NO_THROW(check_report_folder(folder_, {folder_ / "mesh.msh"}));
    EXPECT_NO_THROW(check_report_folder(folder_ / "out" / "", {folder_ / "mesh.msh"}));
    EXPECT_FALSE(fs::exists(folder_ / "out"));
}

}  // namespace
}  // namespace curvewright
