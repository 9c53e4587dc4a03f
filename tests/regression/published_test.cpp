// What benchmarks/thesis has taken over from the thesis and from other programs.

#include "benchmarks/thesis/published.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "benchmarks/thesis/peers.h"
#include "benchmarks/thesis/settings.h"
#include "core/base/error.h"

namespace curvewright::benchmarks {
namespace {

nlohmann::json manifest() {
    std::ifstream stream(std::filesystem::path(CURVEWRIGHT_SAMPLES) / "MANIFEST");
    return nlohmann::json::parse(stream)["samples"];
}

/// Samples per table or figure, as published.h has them.
std::map<std::string, std::set<std::string>> samples_of_tables() {
    std::map<std::string, std::set<std::string>> samples{{"table 2.1", {"circle_family"}},
                                                         {"table 2.2", {"sphere_family"}}};
    for (const auto& example : published::warp_examples())
        for (const std::string table : {"table 2.3", "table 2.4", "table 2.5", "figure "})
            samples[table == "figure " ? table + example.figure : table].insert(example.sample);
    for (const auto& example : published::unsigned_examples())
        for (const std::string& sample : example.samples) {
            // The annulus of chapter 4 is that of chapter 3; as a sample it has another name there.
            const std::string name = sample == "annulus" ? "annulus_ch3" : sample;
            samples["table 3.1"].insert(name);
            samples[std::string("figure ") + example.figure].insert(name);
        }
    for (const auto& example : published::signed_examples()) {
        samples["table 4.1"].insert(example.sample);
        samples[std::string("figure ") + example.figure].insert(example.sample);
    }
    for (const char* figure : {"figure 2.2", "figure 2.3"}) samples[figure] = {"circle_family", "sphere_family"};
    return samples;
}

TEST(Published, HasEverySampleOfEveryTable) {
    std::map<std::string, std::set<std::string>> wanted;
    for (const auto& card : manifest()) {
        if (!card.contains("chapter")) continue;
        for (const auto& table : card["tables"].get<std::vector<std::string>>())
            wanted["table " + table].insert(card["name"]);
        for (const auto& figure : card["figures"].get<std::vector<std::string>>())
            wanted["figure " + figure].insert(card["name"]);
    }
    EXPECT_EQ(samples_of_tables(), wanted);
}

TEST(Published, CountsOfTheDiscObeyEuler) {
    for (const auto& level : published::circle_levels()) {
        SCOPED_TRACE(level.level);
        const Index facets = (level.nodes_p3 - level.interior_p3) / 3;
        const auto agrees = [&](Index elements, Index nodes_p2) {
            const Index edges = (3 * elements + facets) / 2, vertices = 1 + edges - elements;
            return vertices + edges == nodes_p2 && vertices + 2 * edges + elements == level.nodes_p3 &&
                   nodes_p2 - facets * 2 == level.interior_p2;
        };
        EXPECT_EQ(agrees(level.elements, level.nodes_p2), level.level != 6);
        if (level.level != 6) continue;
        // What the remark on that level says.
        EXPECT_TRUE(agrees(28227, 56826));
        EXPECT_NE(std::string(level.remark).find("28,227"), std::string::npos);
    }
}

TEST(Published, CountsOfTheBallObeyEuler) {
    for (const auto& level : published::sphere_levels()) {
        SCOPED_TRACE(level.level);
        const Index facets = (level.nodes_p2 - level.interior_p2 - 2) / 2;
        EXPECT_EQ(2 * (level.nodes_p3 - level.interior_p3 - 2), 9 * facets);
        const Index faces = 2 * level.elements + facets / 2;
        // vertices - edges = 1 + elements - faces
        const Index edges = (level.nodes_p2 - (1 + level.elements - faces)) / 2;
        EXPECT_EQ(level.nodes_p3, level.nodes_p2 + edges + faces);
    }
}

TEST(Published, TablesAreChosenByNumber) {
    Settings settings;
    EXPECT_TRUE(settings.wants("figure", "2.1"));
    settings.only = {"2.1", "table 4.1", "f4.6"};
    EXPECT_NO_THROW(check_selection(settings));
    EXPECT_TRUE(settings.wants("table", "2.1"));
    EXPECT_TRUE(settings.wants("figure", "2.1"));
    EXPECT_TRUE(settings.wants("table", "4.1"));
    EXPECT_TRUE(settings.wants("figure", "4.6"));
    EXPECT_FALSE(settings.wants("figure", "4.10"));
    EXPECT_FALSE(settings.wants("table", "2.2"));
    settings.only = {"2.1", "5.1"};
    EXPECT_THROW(check_selection(settings), InvalidInput);
}

TEST(Published, PeersAreThoseOfTheFile) {
    const Peers peers(CURVEWRIGHT_THESIS_PEERS);
    const PeerResult* best = peers.best("annulus");
    ASSERT_TRUE(best);
    EXPECT_EQ(best->name(), "Gmsh 4.8.4, elastic");
    EXPECT_DOUBLE_EQ(best->least, 0.6789);
    EXPECT_EQ(best->elements, 30);
    // "opt" leaves its elements invalid.
    EXPECT_EQ(peers.find("brake_rotor", "opt")->not_valid, 34);
    EXPECT_EQ(peers.quickest("brake_rotor")->setting, "opt@10");
    EXPECT_FALSE(peers.best("no such sample"));
    for (const auto& example : published::warp_examples()) EXPECT_TRUE(peers.best(example.sample)) << example.sample;
    for (const auto& example : published::signed_examples()) EXPECT_TRUE(peers.best(example.sample)) << example.sample;
    for (const auto& example : published::unsigned_examples())
        for (const auto& sample : example.samples) EXPECT_TRUE(peers.best(sample)) << sample;
}

TEST(Published, FaultyPeersAreNamedByLine) {
    const std::string file = ::testing::TempDir() + "peers.csv";
    std::ofstream(file) << "# comment\ncase,elements,program,setting,least,mean,largest,not_valid,seconds\n"
                           "annulus,30,Gmsh,opt,0.1,0.5,,0,0.1\nannulus,30,Gmsh,opt,much,0.5,,0,0.1\n";
    try {
        const Peers peers(file);
        FAIL() << "\"much\" was read as a number";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("peers.csv:4"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace curvewright::benchmarks
