// Holds the walls: reads the includes of every source file and compares them with the arrows of docs/ARCHITECTURE.md.

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;
const fs::path source = CURVEWRIGHT_SOURCE;

/// What each folder may include, besides itself. "core" stands for every folder of core.
const std::map<std::string, std::set<std::string>> allowed = {
    {"core/base", {}},
    {"core/basis", {"core/base"}},
    {"core/mesh", {"core/base", "core/basis"}},
    {"core/quality", {"core/base", "core/basis", "core/mesh"}},
    {"core/deform", {"core/base", "core/basis", "core/mesh"}},
    {"core/tessellate", {"core/base", "core/basis", "core/mesh"}},
    {"core/boundary", {"core/base", "core/basis", "core/mesh"}},
    {"core/linear", {"core/base"}},
    {"core/warp", {"core/base", "core/basis", "core/mesh", "core/boundary", "core/quality", "core/linear"}},
    {"core/edit",
     {"core/base", "core/basis", "core/mesh", "core/boundary", "core/quality", "core/deform", "core/warp"}},
    {"core/optimize", {"core/base"}},
    {"core/untangle", {"core/base", "core/basis", "core/mesh", "core/boundary", "core/quality", "core/optimize"}},
    {"core/io", {"core/base", "core/basis", "core/mesh", "core/quality", "core/deform"}},
    {"core/timeline", {"core/base", "core/basis", "core/mesh", "core/quality", "core/optimize", "core/untangle"}},
    {"core/session",
     {"core/base", "core/mesh", "core/boundary", "core/quality", "core/deform", "core/warp", "core/edit",
      "core/untangle", "core/timeline", "core/io"}},
    {"core/report",
     {"core/base", "core/basis", "core/mesh", "core/boundary", "core/quality", "core/untangle", "core/io",
      "core/session"}},
    // The one header of the library's users, above all of core; nothing of ours includes it.
    {"core/curvewright.h",
     {"core/base", "core/basis", "core/mesh", "core/quality", "core/deform", "core/warp", "core/untangle", "core/io",
      "core/session"}},
    {"ui/palette", {"core"}},
    {"ui/scene", {"core", "ui/palette"}},
    {"ui/document", {"core"}},
    {"ui/jobs", {"core", "ui/document"}},
    {"ui/tools", {"core", "ui/document", "ui/jobs", "ui/palette"}},
    {"ui/panels", {"core", "ui/document", "ui/jobs", "ui/palette"}},
    {"ui/main_window", {"core", "ui/document", "ui/jobs", "ui/tools", "ui/panels", "ui/palette", "ui/scene"}},
    {"app/cli", {"core", "ui/scene", "ui/palette", "app/cli"}},
    {"app/vtk_reader", {"core/io"}},
    {"app/desktop", {"core", "ui/main_window", "ui/document", "ui/panels", "ui/scene"}},
};

/// "core/mesh" of "core/mesh/elevate.h"; a file directly in core, ui or app stands for itself; empty for others.
std::string folder_of(const std::string& path) {
    const auto first = path.find('/');
    if (first == std::string::npos) return {};
    const auto second = path.find('/', first + 1);
    const std::string top = path.substr(0, first);
    return top == "core" || top == "ui" || top == "app" ? path.substr(0, second) : std::string();
}

std::vector<std::pair<std::string, std::string>> includes_of_tree() {
    std::vector<std::pair<std::string, std::string>> result;  // file, included
    const std::regex include("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
    for (const char* top : {"core", "ui", "app"})
        for (const auto& entry : fs::recursive_directory_iterator(source / top)) {
            const auto extension = entry.path().extension();
            if (extension != ".h" && extension != ".cpp") continue;
            std::ifstream stream(entry.path());
            std::smatch match;
            for (std::string line; std::getline(stream, line);)
                if (std::regex_search(line, match, include))
                    result.emplace_back(fs::relative(entry.path(), source).generic_string(), match[1]);
        }
    return result;
}

TEST(Architecture, IncludesFollowTheArrows) {
    int checked = 0;
    for (const auto& [file, included] : includes_of_tree()) {
        const std::string from = folder_of(file), to = folder_of(included);
        if (to.empty() || from == to) continue;
        ++checked;
        const auto rule = allowed.find(from);
        ASSERT_NE(rule, allowed.end()) << file << " is in a folder that the architecture does not know";
        const bool is_core = to.starts_with("core/") && to != "core/curvewright.h";
        const bool is_allowed = rule->second.contains(to) || (is_core && rule->second.contains("core"));
        EXPECT_TRUE(is_allowed) << file << " includes " << included << ", but " << from << " may not see " << to;
    }
    EXPECT_GT(checked, 100);
}

TEST(Architecture, CoreKnowsNeitherQtNorVtk) {
    const std::regex qt("^Q[A-Z].*"), vtk("^vtk.*");
    for (const auto& [file, included] : includes_of_tree()) {
        const bool is_qt = std::regex_match(included, qt), is_vtk = std::regex_match(included, vtk);
        if (file.starts_with("core/")) {
            EXPECT_FALSE(is_qt) << file << " includes " << included;
            // The files of core/io that speak VTK; the public headers of core/io are not among them.
            const bool is_vtk_part = file.starts_with("core/io/vtk_");
            EXPECT_FALSE(is_vtk && !is_vtk_part) << file << " includes " << included;
        }
        if (file.starts_with("ui/scene/") || file.starts_with("ui/palette/") || file.starts_with("app/cli/")) {
            EXPECT_FALSE(is_qt) << file << " includes " << included;
        }
        if (file.starts_with("ui/document/") || file.starts_with("ui/jobs/") || file.starts_with("ui/tools/") ||
            file.starts_with("ui/panels/")) {
            EXPECT_FALSE(is_vtk) << file << " includes " << included;
        }
        if (file.starts_with("ui/document/")) {
            EXPECT_FALSE(included == "QWidget" || included.starts_with("QtWidgets")) << file;
        }
    }
}

}  // namespace
