// curvewright-vtk-reader: reads one VTK file with VTK's own reader, for a Curvewright that shall outlive a crash of it.
//
//   curvewright-vtk-reader PROTOCOL xml|legacy MEMORY_BYTES PROCESSOR_SECONDS
//
// Descriptor 0 is the file, 3 takes the answer (core/io/vtk_answer.h), 4 the reason if there is none.

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <string_view>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>
#include <vtkUnstructuredGrid.h>

#include "core/io/vtk_answer.h"
#include "core/io/vtk_parse.h"
#include "core/io/vtk_process.h"

namespace {

using namespace curvewright;

int end_with(VtkReaderStatus status, std::string_view reason = {}) {
    if (!reason.empty() && ::write(4, reason.data(), reason.size()) < 0) return static_cast<int>(status);
    return static_cast<int>(status);
}

bool read_number(const char* text, rlim_t& value) {
    const char* end = text + std::strlen(text);
    const auto [stopped, error] = std::from_chars(text, end, value);
    return error == std::errc() && stopped == end && value > 0;
}

void limit(int what, rlim_t value) {
    rlimit present{};
    if (::getrlimit(what, &present) != 0) return;
    const rlimit wanted{std::min(value, present.rlim_max), std::min(value, present.rlim_max)};
    ::setrlimit(what, &wanted);
}

void set_limits(rlim_t memory, rlim_t seconds) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they reserve terabytes of addresses
    limit(RLIMIT_AS, memory);
#endif
    limit(RLIMIT_FSIZE, memory);
    limit(RLIMIT_CPU, seconds);
    limit(RLIMIT_CORE, 1);  // 1, not 0: a core dump that goes to a program is left out only for 1
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
}

}  // namespace

int main(int argc, char** argv) {
    rlim_t memory = 0, seconds = 0;
    if (argc != 5 || std::string_view(argv[1]) != vtk_reader_protocol || !read_number(argv[3], memory) ||
        !read_number(argv[4], seconds)) {
        std::fputs("curvewright-vtk-reader is started by Curvewright to read VTK files; it is of no use by itself.\n",
                   stderr);
        return static_cast<int>(VtkReaderStatus::wrong_use);
    }
    set_limits(memory, seconds);
    try {
        const VtkParse parse = parse_vtk("/proc/self/fd/0", std::string_view(argv[2]) == "xml");
        if (parse.is_out_of_memory) return end_with(VtkReaderStatus::out_of_memory);
        if (parse.grid == nullptr) return end_with(VtkReaderStatus::refused, parse.failure);
        if (!write_vtk_answer(*parse.grid, 3)) return end_with(VtkReaderStatus::no_room, std::strerror(errno));
        ::_exit(0);  // there is nothing left to be tidied up
    } catch (const std::bad_alloc&) {
        return end_with(VtkReaderStatus::out_of_memory);
    }
}
