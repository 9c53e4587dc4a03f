// Stands in for curvewright-vtk-reader and does what no test could make VTK do on every machine. What, the environment
// says: CURVEWRIGHT_BROKEN=crash, abort, hang, sleep, memory, rubbish, short, nothing, status, chatter, processor,
// killed.

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

namespace {

void answer(const std::string& text) {
    if (::write(3, text.data(), text.size()) < 0) std::exit(1);
}

/// Takes memory until there is no more, up to what no test machine has.
int take_memory() {
    const rlimit most{std::stoull("1073741824"), std::stoull("1073741824")};
    ::setrlimit(RLIMIT_AS, &most);
    std::vector<std::vector<char>> all;
    try {
        for (int i = 0; i < 100000; ++i) all.emplace_back(1u << 20, 'x');
    } catch (const std::bad_alloc&) {
        return 11;
    }
    return 0;
}

}  // namespace

int main() {
    const char* wish = std::getenv("CURVEWRIGHT_BROKEN");
    const std::string mode = wish != nullptr ? wish : "";
    if (mode == "crash") std::raise(SIGSEGV);
    if (mode == "abort") std::abort();
    if (mode == "hang") {
        for (volatile unsigned turns = 0;; turns = turns + 1) {
        }
    }
    if (mode == "sleep") {
        ::close(4);  // even when nothing can come any more
        for (;;) ::pause();
    }
    if (mode == "processor") std::raise(SIGXCPU);
    if (mode == "killed") std::raise(SIGKILL);
    if (mode == "memory") return take_memory();
    if (mode == "rubbish") answer("This is no grid, but it is long enough to be taken for one at first sight.");
    if (mode == "short") answer(std::string("CWGRID1\n") + std::string(60, '\0'));
    if (mode == "status") return 42;
    if (mode == "chatter") {
        std::cout << "to the terminal" << std::endl;
        std::cerr << "to the terminal" << std::endl;
        const std::string much(1u << 16, 'a');
        for (int i = 0; i < 64; ++i)
            if (::write(4, much.data(), much.size()) < 0) return 1;
        return 10;
    }
    return 0;  // with an empty answer
}
