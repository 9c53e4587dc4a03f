#include "core/io/atomic_file.h"

#include "tests/unit/io/io_helpers.h"

namespace curvewright {
namespace {

std::size_t files_in(const TemporaryFolder& folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++count;
    return count;
}

TEST(AtomicFile, appears_with_commit_only) {
    const TemporaryFolder folder;
    {
        AtomicFile file(folder / "a.msh");
        EXPECT_EQ(file.path().parent_path(), folder.path());
        EXPECT_EQ(file.path().extension(), ".msh");
        std::ofstream(file.path()) << "new";
        EXPECT_FALSE(std::filesystem::exists(folder / "a.msh"));
        file.commit();
    }
    EXPECT_EQ(read_text_file(folder / "a.msh"), "new");
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(AtomicFile, without_commit_the_target_stays_as_it_was) {
    const TemporaryFolder folder;
    folder.write("a.msh", "old");
    {
        AtomicFile file(folder / "a.msh");
        std::ofstream(file.path()) << "half of the n";
    }
    EXPECT_EQ(read_text_file(folder / "a.msh"), "old");
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(AtomicFile, failed_writes_leave_nothing_and_name_the_target) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "taken");
    for (const char* target : {"taken", "missing/a.txt"}) {
        const std::string message = message_of<InvalidInput>([&] { write_text_file(folder / target, "text"); });
        EXPECT_NE(message.find(target), std::string::npos) << message;
    }
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(AtomicFile, a_mesh_that_cannot_be_written_leaves_the_old_file) {
    const TemporaryFolder folder;
    for (const char* name : {"a.vtu", "a.vtk", "a.msh"}) {
        folder.write(name, "old");
        const ElementType unwritable =
            std::string(name) == "a.msh" ? ElementType{Shape::prism, 10} : ElementType{Shape::pyramid, 3};
        EXPECT_THROW(write_mesh(folder / name, one_element_mesh(unwritable)), Unsupported);
        EXPECT_EQ(read_text_file(folder / name), "old");
    }
    EXPECT_EQ(files_in(folder), 3u);
}

TEST(TextFile, keeps_bytes_as_they_are) {
    const TemporaryFolder folder;
    const std::string text("line\r\n\0zero\nno end", 18);
    write_text_file(folder / "a.txt", text);
    EXPECT_EQ(read_text_file(folder / "a.txt"), text);
    write_text_file(folder / "a.txt", "");
    EXPECT_EQ(read_text_file(folder / "a.txt"), "");
    EXPECT_THROW(read_text_file(folder / "missing"), InvalidInput);
    EXPECT_THROW(read_text_file(folder.path()), InvalidInput);
}

}  // namespace
}  // namespace curvewright
