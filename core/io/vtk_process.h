#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/task.h"
#include "core/io/child_process.h"

namespace curvewright {

// VTK's readers run in a process of their own, the program curvewright-vtk-reader (app/vtk_reader): a crash, a hang or
// an appetite for memory ends that process, and here becomes one sentence. That keeps the program alive; it is no
// sandbox against files made to break in.

/// What the reading of a file may take.
struct VtkReaderLimits {
    std::uint64_t memory_bytes = 0;         ///< address space, and the size of the answer
    int processor_seconds = 0;              ///< of all threads together: a busy machine is no reason to give up
    std::chrono::milliseconds deadline{0};  ///< by the clock, for a reader that sleeps for ever
};

/// For a file of that size: 256 MB and 64 times the size; 20 s and 1 s per MB of processor time, six times that by the
/// clock.
VtkReaderLimits vtk_reader_limits(std::uint64_t file_bytes);

/// The version of the arguments and of the answer; the program refuses any other.
constexpr const char* vtk_reader_protocol = "1";
constexpr const char* vtk_reader_name = "curvewright-vtk-reader";

/// The exit statuses of the program: with the first its answer is in descriptor 3, with the others a reason, or none,
/// in descriptor 4.
enum class VtkReaderStatus { done = 0, refused = 10, out_of_memory = 11, no_room = 12, wrong_use = 13 };

/// Where the program is: what set_vtk_reader() named, else the first of vtk_reader_places() that exists. Throws
/// InvalidInput that names the file and all places if there is none.
std::filesystem::path find_vtk_reader(const std::string& file);
/// Where it is looked for: beside the running program, in ../libexec/curvewright from there, where it was installed.
std::vector<std::filesystem::path> vtk_reader_places();

/// The answer of the program (vtk_answer.h) for the text of a VTU (is_xml) or legacy VTK file. file: for messages;
/// expected: what should have been in it ("a VTK XML unstructured grid"). The text is freed when it has been handed
/// over. Throws InvalidInput that names the file, and Cancelled.
std::unique_ptr<MappedFile> read_in_vtk_process(std::string text, bool is_xml, const std::string& file,
                                                std::string_view expected, const VtkReaderLimits& limits,
                                                const TaskContext& context);

}  // namespace curvewright
