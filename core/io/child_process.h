#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/task.h"

namespace curvewright {

/// A descriptor that is closed with its owner; -1 = none.
class Descriptor {
  public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor();
    Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
    Descriptor& operator=(Descriptor&& other) noexcept;

    int get() const { return number_; }
    bool is_open() const { return number_ >= 0; }
    int release();

  private:
    int number_;
};

/// A file in memory, without a name in any folder. Throws Error if the system has none to give.
Descriptor memory_file(const char* name);
/// Writes all of the text. Throws Error if there is no room for it.
void write_all(const Descriptor& file, std::string_view text);

/// The content of an open file, in memory for as long as this lives. Writing into it does not change the file.
class MappedFile {
  public:
    explicit MappedFile(const Descriptor& file);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::span<std::byte> bytes() const { return {data_, size_}; }

  private:
    std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

/// A program to run, what it gets and how long it may take.
struct ChildTask {
    std::filesystem::path program;
    std::vector<std::string> arguments;  ///< without the program's name
    const Descriptor* input = nullptr;   ///< its standard input
    const Descriptor* output = nullptr;  ///< its descriptor 3, to write to
    std::chrono::milliseconds deadline{60000};
};

/// How a child ended.
struct ChildResult {
    enum class End { exited, signalled, too_late, unknown };
    End end = End::unknown;  ///< unknown: the system does not tell, because somebody else has waited for it
    int code = 0;            ///< exit status or signal
    std::string message;     ///< what it wrote to its descriptor 4, at most 4096 bytes
};

/// Runs a program and waits for it. It is in a process group of its own (a Ctrl+C at the terminal is for its parent),
/// its terminal is /dev/null, and it inherits no descriptor but 0 to 4. When the time is over or the caller asks to
/// stop, it is killed. Leaves neither a process nor a descriptor behind. May be called on any thread. Throws Cancelled,
/// and Error if the program cannot be started.
ChildResult run_child(const ChildTask& task, const TaskContext& context);

}  // namespace curvewright
