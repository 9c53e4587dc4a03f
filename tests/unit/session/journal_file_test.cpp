#include "core/session/journal_file.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/session/session_file.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::square_mesh;

/// A file of its own, gone at the end.
struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("curvewright_journal_" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
    std::filesystem::path file(const std::string& name = "kept.journal") const { return path / name; }
};

bool is_same(const Coordinates& a, const Coordinates& b) {
    return a.rows() == b.rows() &&
           std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

void write(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

JournalStep step_of(const std::string& name, Action action) {
    return {name, "how \"" + name + "\" went,\nline 2", std::move(action), {"/meshes/a.json", "ünï.json"}};
}

/// A history in which everything occurs: open, two steps, back by one, another step, saved, back to the start, redo.
struct Work {
    CurvedMesh mesh = square_mesh(2, 2);
    std::vector<Coordinates> x;
    std::vector<std::string> records;

    Work() {
        x.assign(4, mesh.coordinates());
        x[1].row(3) << 0.1, -0.0, 1e-300;
        x[2] = x[1];
        x[2].row(0) << 1.0 / 3.0, 2.0, std::nextafter(1.0, 2.0);
        x[3] = x[1];
        x[3].row(5) << -0.0, 0.0, 0.0;
        JournalHead head{"/meshes/square.msh", "/meshes/square.msh", 0, fingerprint(mesh.topology())};
        records.push_back(journal_head(head, x[0]));
        records.push_back(journal_step(1, 0, step_of("one", FlipAction{}), x[0], x[1]));
        records.push_back(journal_deformation(2, "/meshes/a.json"));
        records.push_back(journal_step(3, 1, step_of("two", DeformAction{"/meshes/a.json"}), x[1], x[2]));
        records.push_back(journal_jump(4, 1));
        PlaceAction place;
        place.rows.push_back({{6}, {-0.0, 0.0, 0.0}});
        records.push_back(journal_step(5, 1, step_of("three", place), x[1], x[3]));
        records.push_back(journal_clean(6, 2, "/meshes/saved.msh"));
        records.push_back(journal_jump(7, 0));
        records.push_back(journal_jump(8, 1));
    }
    void save(const std::filesystem::path& file) const {
        JournalFile journal(file);
        for (const std::string& record : records) ASSERT_TRUE(journal.append(record));
    }
};

std::string session_text(const std::vector<Action>& session) {
    std::string text;
    for (const Action& action : session) text += to_json_line(action) + '\n';
    return text;
}

TEST(JournalFile, AllOfTheHistoryComesBackBitForBit) {
    const Folder folder;
    const Work work;
    work.save(folder.file());
    const JournalContent content = read_journal(folder.file());
    EXPECT_EQ(content.damage, "");
    EXPECT_EQ(content.records, work.records.size());
    EXPECT_EQ(content.intact_bytes, std::filesystem::file_size(folder.file()));
    EXPECT_EQ(content.head.mesh, "/meshes/square.msh");
    EXPECT_EQ(content.head.saved, "/meshes/saved.msh");
    EXPECT_EQ(content.head.clean, 2);
    EXPECT_EQ(content.head.topology, fingerprint(work.mesh.topology()));
    EXPECT_TRUE(is_same(content.opened, work.x[0]));
    ASSERT_EQ(content.steps.size(), 2u);
    EXPECT_EQ(content.index, 1);
    EXPECT_EQ(content.deformation, "/meshes/a.json");
    EXPECT_EQ(content.steps[0].name, "one");
    EXPECT_EQ(content.steps[1].name, "three");
    EXPECT_EQ(content.steps[1].details, "how \"three\" went,\nline 2");
    EXPECT_EQ(content.steps[1].applied_deformations, (std::vector<std::string>{"/meshes/a.json", "ünï.json"}));
    EXPECT_TRUE(std::holds_alternative<FlipAction>(content.steps[0].action));
    EXPECT_TRUE(std::holds_alternative<PlaceAction>(content.steps[1].action));
    EXPECT_TRUE(is_same(content.steps[0].positions, work.x[1]));
    EXPECT_TRUE(is_same(content.steps[1].positions, work.x[3]));
    EXPECT_EQ(session_text(content.session),
              "{\"action\":\"open\",\"mesh\":\"/meshes/square.msh\"}\n"
              "{\"action\":\"flip\"}\n"
              "{\"action\":\"deform\",\"deformation\":\"/meshes/a.json\"}\n"
              "{\"action\":\"history\",\"step\":1}\n"
              "{\"action\":\"place\",\"nodes\":[[6,-0.0,0.0,0.0]]}\n"
              "{\"action\":\"history\",\"step\":0}\n"
              "{\"action\":\"history\",\"step\":1}\n");

    const JournalSummary summary = summarize_journal(folder.file());
    EXPECT_EQ(summary.mesh, "/meshes/square.msh");
    EXPECT_EQ(summary.saved, "/meshes/saved.msh");
    EXPECT_EQ(summary.steps, std::vector<std::string>{"one"});
    EXPECT_TRUE(summary.is_dirty());
    EXPECT_GT(summary.time, 1577836800000);  // 2020
}

TEST(JournalFile, AStepCostsOnlyWhatItMoves) {
    const CurvedMesh mesh = square_mesh(8, 3);
    Coordinates after = mesh.coordinates();
    after.row(7) << 5.0, 6.0, 0.0;
    const JournalStep step = step_of("small", FlipAction{});
    EXPECT_LT(journal_step(1, 0, step, mesh.coordinates(), after).size(), 400u);
    // A zero that changes its sign has moved.
    Coordinates signs = mesh.coordinates();
    signs(0, 2) = -signs(0, 2);
    EXPECT_EQ(journal_step(1, 0, step, mesh.coordinates(), signs).size(),
              journal_step(1, 0, step, mesh.coordinates(), after).size());
}

TEST(JournalFile, WhatReplacesTheSavedStateIsNotSaved) {
    const Folder folder;
    const Work work;
    JournalFile journal(folder.file());
    for (std::size_t i = 0; i < 2; ++i) journal.append(work.records[i]);
    journal.append(journal_clean(2, 1, "/meshes/square.msh"));
    EXPECT_FALSE(summarize_journal(folder.file()).is_dirty());
    journal.append(journal_jump(3, 0));
    EXPECT_TRUE(summarize_journal(folder.file()).is_dirty());
    journal.append(journal_step(4, 0, step_of("other", FlipAction{}), work.x[0], work.x[2]));
    EXPECT_TRUE(summarize_journal(folder.file()).is_dirty());
    EXPECT_EQ(summarize_journal(folder.file()).clean, -1);
    EXPECT_EQ(read_journal(folder.file()).head.clean, -1);
}

TEST(JournalFile, BrokenOffAnywhereItIsGoodUpToTheLastWholeRecord) {
    const Folder folder;
    const Work work;
    work.save(folder.file());
    const std::string bytes = read_text_file(folder.file());
    std::vector<std::size_t> ends{16};
    for (const std::string& record : work.records) ends.push_back(ends.back() + record.size());
    ASSERT_EQ(ends.back(), bytes.size());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        write(folder.file("cut"), bytes.substr(0, size));
        if (size < ends[1]) {
            EXPECT_THROW(read_journal(folder.file("cut")), InvalidInput) << size;
            // The list does not read the positions, but it sees that they are not all there.
            EXPECT_THROW(summarize_journal(folder.file("cut")), InvalidInput) << size;
            continue;
        }
        const auto whole =
            static_cast<std::uint32_t>(std::upper_bound(ends.begin(), ends.end(), size) - ends.begin() - 1);
        const JournalContent content = read_journal(folder.file("cut"));
        EXPECT_EQ(content.records, whole) << size;
        EXPECT_EQ(content.intact_bytes, ends[whole]) << size;
        EXPECT_EQ(content.damage.empty(), size == ends[whole]) << size;
        EXPECT_EQ(static_cast<std::size_t>(content.index), summarize_journal(folder.file("cut")).steps.size()) << size;

        // The writer goes on behind what is whole.
        if (size % 37 != 0) continue;
        {
            JournalFile journal(folder.file("cut"), content.intact_bytes);
            for (std::size_t i = whole; i < work.records.size(); ++i) ASSERT_TRUE(journal.append(work.records[i]));
        }
        EXPECT_EQ(read_text_file(folder.file("cut")), bytes) << size;
    }
}

TEST(JournalFile, NoFlippedByteGoesUnnoticed) {
    const Folder folder;
    const Work work;
    work.save(folder.file());
    const std::string bytes = read_text_file(folder.file());
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x41);
        write(folder.file("bad"), damaged);
        try {
            const JournalContent content = read_journal(folder.file("bad"));
            EXPECT_FALSE(content.damage.empty()) << at;
            EXPECT_LE(content.intact_bytes, at) << at;
            for (const auto& step : content.steps) EXPECT_TRUE(step.positions.allFinite());
        } catch (const InvalidInput& problem) {
            EXPECT_NE(std::string(problem.what()).find("bad"), std::string::npos) << at;  // names the file
        }
        try {
            summarize_journal(folder.file("bad"));
        } catch (const InvalidInput&) {
        }
    }
}

TEST(JournalFile, RecordsThatContradictThemselvesAreRefused) {
    const Folder folder;
    const Work work;
    Coordinates wrong = work.x[1];
    wrong(2, 1) = std::numeric_limits<double>::quiet_NaN();
    Coordinates more(work.x[0].rows() + 3, 3);
    more.setOnes();
    const auto step = [](const char* name) { return step_of(name, FlipAction{}); };
    const std::string bad[] = {
        journal_step(1, 0, step("not finite"), work.x[0], wrong),
        journal_step(1, 1, step("too late"), work.x[0], work.x[1]),
        journal_step(1, -1, step("too early"), work.x[0], work.x[1]),
        journal_step(1, 0, step("nodes beyond"), Coordinates::Zero(more.rows(), 3), more),
        journal_step(1, 0, step_of("no step", HistoryAction{0}), work.x[0], work.x[1]),
        journal_step(1, 0, step_of("no step", OpenAction{"a"}), work.x[0], work.x[1]),
        journal_step(2, 0, step("a record before is missing"), work.x[0], work.x[1]),
        journal_jump(1, 1),
        journal_jump(1, -1),
        journal_clean(1, 1, "a"),
        journal_clean(1, -2, "a"),
        journal_head({"again", "again", 0, 1}, work.x[0]),
    };
    for (const std::string& record : bad) {
        std::filesystem::remove(folder.file());
        JournalFile journal(folder.file());
        journal.append(work.records[0]);
        journal.append(record);
        const JournalContent content = read_journal(folder.file());
        EXPECT_FALSE(content.damage.empty());
        EXPECT_EQ(content.steps.size(), 0u);
        EXPECT_EQ(content.index, 0);
        EXPECT_EQ(content.records, 1u);
    }
    // Heads that no step can follow.
    wrong = work.x[0];
    wrong(0, 0) = std::numeric_limits<double>::infinity();
    for (const std::string& head : {journal_head({"a", "a", 0, 1}, wrong), journal_head({"", "", 0, 1}, work.x[0]),
                                    journal_head({"a", "a", 3, 1}, work.x[0]), work.records[1]}) {
        std::filesystem::remove(folder.file());
        JournalFile(folder.file()).append(head);
        EXPECT_THROW(read_journal(folder.file()), InvalidInput);
    }
    EXPECT_THROW(read_journal(folder.file("missing")), InvalidInput);
    EXPECT_THROW(summarize_journal(folder.file("missing")), InvalidInput);
    write(folder.file(), "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    EXPECT_THROW(read_journal(folder.file()), InvalidInput);
}

TEST(JournalFile, WhatCannotBeWrittenIsWrittenLater) {
    const Folder folder;
    const Work work;
    const auto late = folder.path / "not yet";
    JournalFile journal(late / "kept.journal");
    EXPECT_FALSE(journal.append(work.records[0]));
    EXPECT_FALSE(journal.append(work.records[1]));
    std::filesystem::create_directories(late);
    EXPECT_TRUE(journal.append(work.records[2]));
    EXPECT_EQ(read_journal(late / "kept.journal").records, 3u);
    EXPECT_EQ(read_journal(late / "kept.journal").damage, "");
}

TEST(JournalFile, ReadingCanBeStopped) {
    const Folder folder;
    const Work work;
    work.save(folder.file());
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(read_journal(folder.file(), {stop.get_token(), {}}), Cancelled);
}

TEST(JournalFile, TheFingerprintTellsMeshesApart) {
    const CurvedMesh mesh = square_mesh(2, 2);
    EXPECT_EQ(fingerprint(mesh.topology()), fingerprint(square_mesh(2, 2).topology()));
    EXPECT_NE(fingerprint(mesh.topology()), fingerprint(square_mesh(2, 3).topology()));
    EXPECT_NE(fingerprint(mesh.topology()), fingerprint(flip_orientation(mesh).topology()));
    EXPECT_EQ(fingerprint(mesh.topology()), fingerprint(flip_orientation(flip_orientation(mesh)).topology()));
    MeshData data = mesh.topology().data();
    data.node_tags.back().value += 1;
    EXPECT_NE(fingerprint(mesh.topology()), fingerprint(MeshTopology(data)));
}

TEST(SessionFile, IsToldFromADeformationByItsContent) {
    const Folder folder;
    const std::pair<const char*, bool> cases[] = {
        {"{\"action\":\"open\",\"mesh\":\"a.msh\"}\n{\"action\":\"flip\"}\n", true},
        {"\n\n  {\"action\":\"open\",\"mesh\":\"a.msh\"}", true},
        {"{\"action\":\"opne\"\n", true},  // damaged: the session's reader says where
        {"{\"operations\": [{\"group\": \"action\", \"type\": \"translate\"}]}", false},
        {"{\n  \"operations\": []\n}\n", false},
        {"{\"action\": \"x\", \"operations\": []}", false},
        {"tag,x,y,z\n1,0,0,0\n", false},
        {"$MeshFormat\n4.1 0 8\n", false},
        {"", false},
        {"   \n", false}};
    for (const auto& [text, is_session] : cases) {
        write(folder.file("some.json"), text);
        EXPECT_EQ(is_session_file(folder.file("some.json")), is_session) << text;
    }
    EXPECT_FALSE(is_session_file(folder.file("missing.json")));
    EXPECT_FALSE(is_session_file(folder.path));
}

}  // namespace
}  // namespace curvewright
