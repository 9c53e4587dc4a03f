#include "core/io/vtk_process.h"

#include <csignal>
#include <cstring>
#include <mutex>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/io/mesh_io.h"

namespace curvewright {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t megabyte = 1u << 20;

/// What set_vtk_reader() was told.
struct Named {
    std::mutex mutex;
    fs::path program;
};

Named& named() {
    static Named instance;
    return instance;
}

/// Why a reading gave no grid, without the file's name and what was expected.
std::string failure_of(const ChildResult& result, const VtkReaderLimits& limits) {
    const std::string memory = fmt::format("the file is damaged: VTK's reader asks for more than {} MB of memory",
                                           limits.memory_bytes / megabyte);
    const std::string time =
        fmt::format("the file is damaged: VTK's reader did not come to an end within {} s", limits.processor_seconds);
    if (result.end == ChildResult::End::too_late) return time;
    if (result.end == ChildResult::End::signalled) {
        if (result.code == SIGXCPU) return time;
        if (result.code == SIGXFSZ) return memory;
        if (result.code == SIGKILL || result.code == SIGTERM)
            return fmt::format("VTK's reader was ended from outside (signal {}: {})", result.code,
                               strsignal(result.code));
        return fmt::format("the file is damaged: VTK's reader crashed on it (signal {}: {})", result.code,
                           strsignal(result.code));
    }
    switch (static_cast<VtkReaderStatus>(result.code)) {
        case VtkReaderStatus::out_of_memory:
            return memory;
        case VtkReaderStatus::refused:
            return fmt::format("VTK's reader cannot read the file ({})", result.message);
        case VtkReaderStatus::no_room:
            return fmt::format("there is no room for what VTK's reader made of the file ({})", result.message);
        default:
            return fmt::format("VTK's reader ended with status {} and no answer", result.code);
    }
}

}  // namespace

void set_vtk_reader(const fs::path& program) {
    const std::lock_guard lock(named().mutex);
    named().program = program;
}

VtkReaderLimits vtk_reader_limits(std::uint64_t file_bytes) {
    VtkReaderLimits limits;
    limits.memory_bytes = 256 * megabyte + 64 * file_bytes;
    limits.processor_seconds = 20 + static_cast<int>(file_bytes / megabyte);
    limits.deadline = std::chrono::seconds(6 * limits.processor_seconds);
    return limits;
}

std::vector<fs::path> vtk_reader_places() {
    std::vector<fs::path> folders;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (!error) folders = {program.parent_path(), program.parent_path() / CURVEWRIGHT_LIBEXEC_FROM_BIN};
    folders.emplace_back(CURVEWRIGHT_LIBEXEC);
    for (fs::path& folder : folders) folder = (folder / vtk_reader_name).lexically_normal();
    return folders;
}

fs::path find_vtk_reader(const std::string& file) {
    {
        const std::lock_guard lock(named().mutex);
        if (!named().program.empty()) return named().program;
    }
    std::string places;
    for (const fs::path& place : vtk_reader_places()) {
        std::error_code ignored;
        if (fs::is_regular_file(place, ignored)) return place;
        places += (places.empty() ? "" : ", ") + place.string();
    }
    throw InvalidInput(file, 0,
                       fmt::format("the program that reads VTK files was not found ({}); install it there, or name it "
                                   "with set_vtk_reader().",
                                   places));
}

std::unique_ptr<MappedFile> read_in_vtk_process(std::string text, bool is_xml, const std::string& file,
                                                std::string_view expected, const VtkReaderLimits& limits,
                                                const TaskContext& context) {
    const fs::path program = find_vtk_reader(file);
    std::string failure;
    try {
        const Descriptor input = memory_file("curvewright-vtk-file"), output = memory_file("curvewright-vtk-answer");
        write_all(input, text);
        text = {};
        ChildTask task;
        task.program = program;
        task.arguments = {vtk_reader_protocol, is_xml ? "xml" : "legacy", std::to_string(limits.memory_bytes),
                          std::to_string(limits.processor_seconds)};
        task.input = &input;
        task.output = &output;
        task.deadline = limits.deadline;
        const ChildResult result = run_child(task, context);
        // Who waits for all children, or ignores their end, may have taken the status: then the answer speaks for
        // itself.
        const bool is_done = (result.end == ChildResult::End::exited && result.code == 0) ||
                             (result.end == ChildResult::End::unknown && result.message.empty());
        if (is_done) return std::make_unique<MappedFile>(output);
        failure = failure_of(result, limits);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        throw InvalidInput(file, 0, fmt::format("the file cannot be handed to VTK's reader: {}", error.what()));
    }
    throw InvalidInput(file, 0, fmt::format("{}; {} was expected.", failure, expected));
}

}  // namespace curvewright
