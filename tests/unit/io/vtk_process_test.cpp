#include "core/io/vtk_process.h"

#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

#include <sys/wait.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/io/vtk_answer.h"
#include "core/io/vtk_io.h"
#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Puts the program that stands in for the reader in its place, with something to do.
class BrokenReader {
  public:
    explicit BrokenReader(const char* mode) {
        ::setenv("CURVEWRIGHT_BROKEN", mode, 1);
        set_vtk_reader(CURVEWRIGHT_BROKEN_READER);
    }
    ~BrokenReader() {
        ::unsetenv("CURVEWRIGHT_BROKEN");
        set_vtk_reader({});
    }
    BrokenReader(const BrokenReader&) = delete;
    BrokenReader& operator=(const BrokenReader&) = delete;
};

/// Whatever a reading ends with, it leaves no descriptor and no child behind.
class LeavesNothing {
  public:
    ~LeavesNothing() {
        EXPECT_EQ(open_descriptors(), before_);
        EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
        EXPECT_EQ(errno, ECHILD);
    }

  private:
    static std::ptrdiff_t open_descriptors() {
        return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
    }
    std::ptrdiff_t before_ = open_descriptors();
};

std::string text_of(const CurvedMesh& mesh, const std::string& name, bool is_binary) {
    const TemporaryFolder folder;
    WriteOptions options;
    options.binary = is_binary;
    write_mesh(folder / name, mesh, options);
    return read_text_file(folder / name);
}

/// What a reading ends with when the program behaves like that.
std::string message_with(const char* mode, std::chrono::milliseconds deadline = 20s, const TaskContext& context = {}) {
    const LeavesNothing check;
    const BrokenReader broken(mode);
    VtkReaderLimits limits = vtk_reader_limits(1000);
    limits.deadline = deadline;
    return message_of<InvalidInput>([&] {
        const auto answer = read_in_vtk_process("text", true, "dir/a.vtu", "a grid", limits, context);
        mesh_of_vtk_answer(answer->bytes(), "dir/a.vtu", MeshFormat::vtu);
    });
}

TEST(VtkProcess, a_crash_is_one_sentence) {
    EXPECT_EQ(message_with("crash"),
              "dir/a.vtu: the file is damaged: VTK's reader crashed on it (signal 11: Segmentation fault); a grid was "
              "expected.");
    EXPECT_EQ(message_with("abort"),
              "dir/a.vtu: the file is damaged: VTK's reader crashed on it (signal 6: Aborted); a grid was expected.");
}

TEST(VtkProcess, a_hang_is_ended) {
    const std::string expected =
        "dir/a.vtu: the file is damaged: VTK's reader did not come to an end within 20 s; a grid was expected.";
    EXPECT_EQ(message_with("hang", 50ms), expected);
    EXPECT_EQ(message_with("sleep", 50ms), expected);
    EXPECT_EQ(message_with("processor"), expected);
}

TEST(VtkProcess, memory_has_a_bound) {
    EXPECT_EQ(message_with("memory"),
              "dir/a.vtu: the file is damaged: VTK's reader asks for more than 256 MB of memory; a grid was expected.");
}

TEST(VtkProcess, being_killed_is_not_the_fault_of_the_file) {
    EXPECT_EQ(message_with("killed"),
              "dir/a.vtu: VTK's reader was ended from outside (signal 9: Killed); a grid was expected.");
}

TEST(VtkProcess, rubbish_is_not_believed) {
    for (const char* mode : {"rubbish", "short", "nothing"}) {
        const std::string message = message_with(mode);
        EXPECT_TRUE(
            message.starts_with("dir/a.vtu: the answer of the program that reads VTK files cannot be understood ("))
            << mode << ": " << message;
    }
    EXPECT_EQ(message_with("status"),
              "dir/a.vtu: VTK's reader ended with status 42 and no answer; a grid was expected.");
}

TEST(VtkProcess, what_the_program_says_is_kept_from_the_terminal_and_short) {
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const std::string message = message_with("chatter");
    EXPECT_EQ(::testing::internal::GetCapturedStdout() + ::testing::internal::GetCapturedStderr(), "");
    EXPECT_TRUE(message.starts_with("dir/a.vtu: VTK's reader cannot read the file (aaa")) << message.substr(0, 100);
    EXPECT_LT(message.size(), 5000u);
}

TEST(VtkProcess, a_request_to_stop_ends_it) {
    const LeavesNothing check;
    const BrokenReader broken("hang");
    std::stop_source source;
    std::jthread later([&source] {
        std::this_thread::sleep_for(30ms);
        source.request_stop();
    });
    EXPECT_THROW(read_in_vtk_process("text", true, "a.vtu", "a grid", vtk_reader_limits(4), {source.get_token(), {}}),
                 Cancelled);
    EXPECT_THROW(read_in_vtk_process("text", true, "a.vtu", "a grid", vtk_reader_limits(4), {source.get_token(), {}}),
                 Cancelled);
}

TEST(VtkProcess, a_missing_program_is_told) {
    const TemporaryFolder folder;
    write_mesh(folder / "a.vtu", one_element_mesh({Shape::triangle, 2}));
    const LeavesNothing check;
    set_vtk_reader(folder / "nowhere");
    const std::string message = message_of<InvalidInput>([&] { read_mesh(folder / "a.vtu"); });
    set_vtk_reader({});
    EXPECT_NE(message.find("a.vtu: "), std::string::npos) << message;
    EXPECT_NE(message.find("nowhere cannot be started (No such file or directory)."), std::string::npos) << message;
    EXPECT_NO_THROW(read_mesh(folder / "a.vtu"));
    const auto places = vtk_reader_places();
    ASSERT_EQ(places.size(), 3u);
    EXPECT_EQ(places[0].filename(), vtk_reader_name);
    EXPECT_EQ(places[1], (fs::read_symlink("/proc/self/exe").parent_path() / "../libexec/curvewright" / vtk_reader_name)
                             .lexically_normal());
}

TEST(VtkProcess, works_where_the_end_of_children_is_ignored) {
    const TemporaryFolder folder;
    write_mesh(folder / "a.vtu", one_element_mesh({Shape::triangle, 2}));
    const auto before = std::signal(SIGCHLD, SIG_IGN);
    EXPECT_EQ(read_mesh(folder / "a.vtu").mesh.topology().element_count(), 1);
    const std::string message = message_of<InvalidInput>([&] {
        const BrokenReader broken("crash");
        read_mesh(folder / "a.vtu");
    });
    std::signal(SIGCHLD, before);
    EXPECT_NE(message.find("a.vtu: "), std::string::npos) << message;
    EXPECT_NE(message.find("cannot be understood"), std::string::npos) << message;
}

TEST(VtkProcess, needs_no_folder_for_temporary_files) {
    const TemporaryFolder folder;
    write_mesh(folder / "a.vtk", one_element_mesh({Shape::hexahedron, 2}));
    const char* before = std::getenv("TMPDIR");
    const std::string kept = before != nullptr ? before : "";
    ::setenv("TMPDIR", "/no such folder", 1);
    EXPECT_EQ(read_mesh(folder / "a.vtk").mesh.topology().element_count(), 1);
    if (before != nullptr)
        ::setenv("TMPDIR", kept.c_str(), 1);
    else
        ::unsetenv("TMPDIR");
}

TEST(VtkProcess, several_threads_read_at_once) {
    const TemporaryFolder folder;
    const CurvedMesh mesh = one_element_mesh({Shape::tetrahedron, 3});
    write_mesh(folder / "a.vtu", mesh);
    const LeavesNothing check;
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            for (int turn = 0; turn < 3; ++turn)
                EXPECT_TRUE(same_bits(read_mesh(folder / "a.vtu").mesh.coordinates(), mesh.coordinates()));
        });
}

TEST(VtkProcess, limits_grow_with_the_file) {
    EXPECT_EQ(vtk_reader_limits(0).memory_bytes, 256u << 20);
    EXPECT_EQ(vtk_reader_limits(1000).memory_bytes, (256u << 20) + 64000u);
    EXPECT_GT(vtk_reader_limits(100u << 20).processor_seconds, vtk_reader_limits(0).processor_seconds);
    EXPECT_GT(vtk_reader_limits(0).deadline, std::chrono::seconds(vtk_reader_limits(0).processor_seconds));
}

/// An array that is said to be larger than the bound is refused by the real program without the machine noticing.
TEST(VtkProcess, an_array_beyond_the_bound_is_refused) {
    std::string text = text_of(one_element_mesh({Shape::triangle, 1}), "a.vtu", false);
    const std::size_t points = text.find("NumberOfPoints=\"3\"");
    ASSERT_NE(points, text.npos);
    text.replace(points, 18, "NumberOfPoints=\"3000000000\"");
    const TemporaryFolder folder;
    const std::string message = message_of<InvalidInput>([&] { read_mesh(folder.write("b.vtu", text)); });
    EXPECT_NE(message.find("b.vtu: "), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

/// Grids come through the other process as they were, and an answer with a byte less or other bytes is refused or read,
/// but nothing else.
TEST(VtkAnswer, a_damaged_answer_is_refused) {
    const std::string text = text_of(one_element_mesh({Shape::prism, 2}), "a.vtu", true);
    const auto answer = read_in_vtk_process(text, true, "a.vtu", "a grid", vtk_reader_limits(text.size()), {});
    const std::span<std::byte> whole = answer->bytes();
    EXPECT_EQ(mesh_of_vtk_answer(whole, "a.vtu", MeshFormat::vtu).mesh.topology().element_count(), 1);
    std::vector<std::byte> copy(whole.begin(), whole.end());
    for (std::size_t size = 0; size < whole.size(); size += 8)
        EXPECT_THROW(mesh_of_vtk_answer(std::span(copy).first(size), "a.vtu", MeshFormat::vtu), InvalidInput) << size;
    std::mt19937 random(5);
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<std::byte> damaged = copy;
        damaged[random() % damaged.size()] = static_cast<std::byte>(random() % 256);
        refused += !message_of<Error>([&] { mesh_of_vtk_answer(damaged, "a.vtu", MeshFormat::vtu); }).empty();
    }
    EXPECT_GT(refused, 200);
}

}  // namespace
}  // namespace curvewright
