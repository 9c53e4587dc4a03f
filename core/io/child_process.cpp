#include "core/io/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

using Clock = std::chrono::steady_clock;

// How soon a request to stop is heeded while a child works.
constexpr int poll_milliseconds = 20;
constexpr std::size_t longest_message = 4096;

/// The child's descriptors are put in place one after the other: none of ours may stand where one of them goes.
Descriptor moved_up(int number) {
    Descriptor result(::fcntl(number, F_DUPFD_CLOEXEC, 10));
    if (!result.is_open()) throw Error(fmt::format("no file can be opened ({}).", std::strerror(errno)));
    return result;
}

class SpawnSettings {
  public:
    SpawnSettings() {
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawnattr_init(&attributes);
        // Whatever the caller ignores or blocks, a child that crashes or outlives its input ends.
        sigset_t signals;
        sigemptyset(&signals);
        ::posix_spawnattr_setsigmask(&attributes, &signals);
        sigfillset(&signals);
        ::posix_spawnattr_setsigdefault(&attributes, &signals);
        ::posix_spawnattr_setpgroup(&attributes, 0);
        ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
    ~SpawnSettings() {
        ::posix_spawn_file_actions_destroy(&actions);
        ::posix_spawnattr_destroy(&attributes);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;

    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
};

/// A child that is running; killed and waited for if nobody has waited for it.
class Child {
  public:
    Child(const ChildTask& task, int status) {
        SpawnSettings settings;
        const Descriptor input = moved_up(task.input->get()), output = moved_up(task.output->get());
        const Descriptor message = moved_up(status);
        ::posix_spawn_file_actions_adddup2(&settings.actions, input.get(), 0);
        ::posix_spawn_file_actions_addopen(&settings.actions, 1, "/dev/null", O_WRONLY, 0);
        ::posix_spawn_file_actions_addopen(&settings.actions, 2, "/dev/null", O_WRONLY, 0);
        ::posix_spawn_file_actions_adddup2(&settings.actions, output.get(), 3);
        ::posix_spawn_file_actions_adddup2(&settings.actions, message.get(), 4);
        ::posix_spawn_file_actions_addclosefrom_np(&settings.actions, 5);
        std::string name = task.program.string();
        std::vector<std::string> arguments = task.arguments;
        std::vector<char*> words = {name.data()};
        for (std::string& argument : arguments) words.push_back(argument.data());
        words.push_back(nullptr);
        const int error =
            ::posix_spawn(&id_, name.c_str(), &settings.actions, &settings.attributes, words.data(), environ);
        if (error != 0) throw Error(fmt::format("the program {} cannot be started ({}).", name, std::strerror(error)));
    }
    ~Child() {
        if (id_ <= 0) return;
        kill();
        result(true);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    void kill() { ::kill(id_, SIGKILL); }
    /// How it ended; nothing while it runs, if not told to wait for that.
    std::optional<ChildResult> result(bool is_waiting = false) {
        ChildResult result;
        int status = 0;
        pid_t found = -1;
        do found = ::waitpid(id_, &status, is_waiting ? 0 : WNOHANG);
        while (found < 0 && errno == EINTR);
        if (found == 0) return std::nullopt;
        if (found == id_) {
            const bool is_signal = WIFSIGNALED(status);
            result.end = is_signal ? ChildResult::End::signalled : ChildResult::End::exited;
            result.code = is_signal ? WTERMSIG(status) : WEXITSTATUS(status);
        }
        id_ = -1;
        return result;
    }

  private:
    pid_t id_ = -1;
};

}  // namespace

Descriptor::~Descriptor() {
    if (number_ >= 0) ::close(number_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
}

int Descriptor::release() {
    return std::exchange(number_, -1);
}

Descriptor memory_file(const char* name) {
    Descriptor file(::memfd_create(name, MFD_CLOEXEC));
    if (!file.is_open()) throw Error(fmt::format("no file in memory can be made ({}).", std::strerror(errno)));
    return file;
}

void write_all(const Descriptor& file, std::string_view text) {
    while (!text.empty()) {
        const ssize_t sent = ::write(file.get(), text.data(), text.size());
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) throw Error(fmt::format("a file in memory cannot be written ({}).", std::strerror(errno)));
        text.remove_prefix(static_cast<std::size_t>(sent));
    }
}

MappedFile::MappedFile(const Descriptor& file) {
    struct stat about {};
    if (::fstat(file.get(), &about) != 0 || about.st_size <= 0) return;
    void* data = ::mmap(nullptr, static_cast<std::size_t>(about.st_size), PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_NORESERVE, file.get(), 0);
    if (data == MAP_FAILED) throw Error(fmt::format("a file in memory cannot be seen ({}).", std::strerror(errno)));
    data_ = static_cast<std::byte*>(data);
    size_ = static_cast<std::size_t>(about.st_size);
}

MappedFile::~MappedFile() {
    if (data_ != nullptr) ::munmap(data_, size_);
}

ChildResult run_child(const ChildTask& task, const TaskContext& context) {
    context.check();
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw Error(fmt::format("no pipe can be made ({}).", std::strerror(errno)));
    const Descriptor reading(ends[0]);
    Descriptor writing(ends[1]);
    Child child(task, writing.get());
    writing = Descriptor();

    const auto begin = Clock::now();
    bool is_too_late = false, is_open = true;
    std::string message;
    std::array<char, 1024> buffer{};
    for (;;) {
        context.check();  // the destructor kills the child
        if (!is_too_late && Clock::now() - begin > task.deadline) {
            is_too_late = true;
            child.kill();
        }
        // The child holds the only other end, so that the pipe ends with it, or shortly before.
        pollfd wanted{is_open ? reading.get() : -1, POLLIN, 0};
        const bool has_news = ::poll(&wanted, 1, is_open ? poll_milliseconds : 1) > 0;
        if (has_news) {
            const ssize_t got = ::read(reading.get(), buffer.data(), buffer.size());
            if (got > 0 && message.size() < longest_message)
                message.append(buffer.data(),
                               std::min(static_cast<std::size_t>(got), longest_message - message.size()));
            is_open = got > 0 || (got < 0 && errno == EINTR);
        }
        if (is_open) continue;
        if (auto result = child.result()) {
            result->message = std::move(message);
            if (is_too_late) result->end = ChildResult::End::too_late;
            return *result;
        }
    }
}

}  // namespace curvewright
