#include "tests/regression/process.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace curvewright::testing {
namespace {

std::string read_all(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

void redirect(const std::string& file, int descriptor) {
    const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
    close(opened);
}

}  // namespace

namespace {

/// The program's process; what it writes goes to the two files.
pid_t start(const std::vector<std::string>& command, const std::string& output, const std::string& errors) {
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("fork failed");
    if (child == 0) {
        unsetenv("DISPLAY");
        unsetenv("WAYLAND_DISPLAY");
        redirect(output, STDOUT_FILENO);
        redirect(errors, STDERR_FILENO);
        execv(arguments[0], arguments.data());
        _exit(127);
    }
    return child;
}

int code_of(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ProcessResult run_program(const std::vector<std::string>& command) {
    const TemporaryFolder folder;
    const std::string output = folder / "output", errors = folder / "errors";
    const pid_t child = start(command, output, errors);
    int status = 0;
    waitpid(child, &status, 0);
    return {code_of(status), read_all(output), read_all(errors)};
}

ProcessResult interrupt_program(const std::vector<std::string>& command, const std::string& text) {
    using namespace std::chrono_literals;
    const TemporaryFolder folder;
    const std::string output = folder / "output", errors = folder / "errors";
    const pid_t child = start(command, output, errors);
    const auto limit = std::chrono::steady_clock::now() + 2min;
    bool is_interrupted = false;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (!is_interrupted && read_all(errors).find(text) != std::string::npos) {
            is_interrupted = true;
            kill(child, SIGINT);
        }
        if (std::chrono::steady_clock::now() > limit) kill(child, SIGKILL);
        std::this_thread::sleep_for(10ms);
    }
    return {code_of(status), read_all(output), read_all(errors)};
}

TemporaryFolder::TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "curvewright-test-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace curvewright::testing
