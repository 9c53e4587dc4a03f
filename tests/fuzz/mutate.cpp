// Reads damaged files, each in a process of its own, and tells what they do to the parsers:
//
//   curvewright-mutate FORMAT COUNT [FIRST [KEEP]]     mutations FIRST to FIRST + COUNT - 1 of the seeds of a format
//   curvewright-mutate --list
//   curvewright-mutate --write-seeds FOLDER            the seeds that no other program writes
//
// A fault is a crash, ten seconds of processor time, more than 256 MB + 64 times the file's size of memory, or an
// exception that is no Error. A crash of VTK's readers is none if read_mesh makes a sentence of it. Inputs with faults
// are kept in the folder KEEP. The status is 1 if there is a fault.

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkUnstructuredGrid.h>
#include <zlib.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/io/child_process.h"
#include "core/io/vtk_answer.h"
#include "core/io/vtk_io.h"
#include "core/io/vtk_parse.h"
#include "core/session/journal_file.h"
#include "tests/fuzz/mutations.h"
#include "tests/fuzz/targets.h"

namespace {

using namespace curvewright;
namespace fs = std::filesystem;

constexpr std::uint64_t megabyte = 1u << 20;
constexpr rlim_t longest_seconds = 10;

/// What a process that reads tells, where its parent sees it although it crashes.
struct Shared {
    int is_in_vtk = 0;
    int is_taken = 0;
    int is_vtk_out_of_memory = 0;
};

struct Format {
    const char* name;
    const char* folder;  ///< below the corpus
    const char* part;    ///< of the names of its seeds
    const char* target;  ///< that reads it, or "gz", "vtu", "vtk"
};

constexpr std::array<Format, 15> formats = {{{"msh-2.2", "msh", "_2.2.msh", "msh"},
                                             {"msh-4.0", "msh", "_4.0.msh", "msh"},
                                             {"msh-4.1", "msh", "_4.1.msh", "msh"},
                                             {"msh.gz", "msh", ".msh", "gz"},
                                             {"vtu-ascii", "vtk", "ascii.vtu", "vtu"},
                                             {"vtu-appended", "vtk", "appended", "vtu"},
                                             {"vtu-inline", "vtk", "inline", "vtu"},
                                             {"vtk-ascii", "vtk", "ascii.vtk", "vtk"},
                                             {"vtk-binary", "vtk", "binary.vtk", "vtk"},
                                             {"vtk-answer", "vtk_answer", "", "vtk_answer"},
                                             {"deformation-json", "deformation_json", "", "deformation_json"},
                                             {"deformation-csv", "deformation_csv", "", "deformation_csv"},
                                             {"session", "session", "", "session"},
                                             {"trace", "trace", "", "trace"},
                                             {"journal", "journal", "", "journal"}}};

std::string compressed(const std::string& text) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    std::string result(deflateBound(&stream, text.size()) + 64, '\0');
    std::string in = text;
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    deflate(&stream, Z_FINISH);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    return result;
}

std::vector<std::string> seeds_of(const Format& format) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(fs::path(CURVEWRIGHT_CORPUS) / format.folder))
        if (entry.path().filename().string().find(format.part) != std::string::npos) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<std::string> seeds;
    for (const fs::path& file : files) {
        seeds.push_back(read_text_file(file));
        if (format.target == std::string_view("gz")) seeds.back() = compressed(seeds.back());
    }
    if (seeds.empty()) throw InvalidInput(fmt::format("There are no seeds of {}.", format.name));
    return seeds;
}

/// Reads a file of that name with those bytes through read_mesh. True if it is taken.
bool read_as_file(const std::string& bytes, const char* suffix) {
    const fs::path file = fs::temp_directory_path() / fmt::format("curvewright-mutate-{}{}", ::getpid(), suffix);
    write_text_file(file, bytes);
    bool is_taken = true;
    try {
        read_mesh(file);
    } catch (const Error&) {
        is_taken = false;
    }
    fs::remove(file);
    return is_taken;
}

/// The way of read_vtk with VTK's reader in this process.
bool read_vtk_here(const std::string& bytes, bool is_xml, Shared& shared) {
    const MeshFormat format = is_xml ? MeshFormat::vtu : MeshFormat::vtk;
    try {
        check_vtk_text(bytes, "mutated", format);
        const Descriptor input = memory_file("file"), output = memory_file("answer");
        write_all(input, bytes);
        shared.is_in_vtk = 1;
        const VtkParse parse = parse_vtk("/proc/self/fd/" + std::to_string(input.get()), is_xml);
        shared.is_vtk_out_of_memory = parse.is_out_of_memory ? 1 : 0;
        if (parse.grid == nullptr || !write_vtk_answer(*parse.grid, output.get())) return false;
        shared.is_in_vtk = 0;
        const MappedFile answer(output);
        mesh_of_vtk_answer(answer.bytes(), "mutated", format);
        return true;
    } catch (const Error&) {
        return false;
    }
}

struct Outcome {
    std::string fault;  ///< "" = none
    bool is_taken = false, is_contained = false;
    long memory_kb = 0;
};

/// Does something in a process of its own, with so much address space more than this one has (0 = any).
Outcome apart(Shared& shared, std::uint64_t memory, const std::function<bool()>& read) {
    shared = {};
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("no process can be started");
    if (child == 0) {
        const rlimit none{0, 0}, seconds{longest_seconds, longest_seconds + 1};
        ::setrlimit(RLIMIT_CORE, &none);
        ::setrlimit(RLIMIT_CPU, &seconds);
#if !defined(__SANITIZE_ADDRESS__)
        if (memory > 0) {
            long pages = 0;
            std::ifstream("/proc/self/statm") >> pages;
            const rlim_t all = static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + memory;
            const rlimit most{all, all};
            ::setrlimit(RLIMIT_AS, &most);
        }
#endif
        try {
            shared.is_taken = read() ? 1 : 0;
            ::_exit(0);
        } catch (const std::exception& error) {
            std::fprintf(stderr, "exception: %s\n", error.what());
            ::_exit(2);
        }
    }
    int status = 0;
    rusage usage{};
    while (::wait4(child, &status, 0, &usage) < 0) {
    }
    Outcome outcome;
    outcome.is_taken = shared.is_taken != 0;
    outcome.memory_kb = usage.ru_maxrss;
    if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        outcome.fault = signal == SIGXCPU || signal == SIGKILL ? "hang" : fmt::format("crash ({})", strsignal(signal));
    } else if (WEXITSTATUS(status) != 0) {
        outcome.fault = WEXITSTATUS(status) == 2 ? "an exception that is no Error" : "crash (sanitizer)";
    }
    outcome.is_contained = (!outcome.fault.empty() && shared.is_in_vtk != 0) || shared.is_vtk_out_of_memory != 0;
    return outcome;
}

Outcome read_apart(const Format& format, const std::string& bytes, Shared& shared, long idle_kb) {
    const std::string_view target = format.target;
    const std::uint64_t memory = 256 * megabyte + 64 * bytes.size();
    const bool is_xml = target == "vtu", is_vtk = is_xml || target == "vtk";
    Outcome outcome = apart(shared, is_vtk ? memory : 0, [&]() -> bool {
        if (is_vtk) return read_vtk_here(bytes, is_xml, shared);
        if (target == "gz") return read_as_file(bytes, ".msh.gz");
        return fuzz::find_target(target)->run(bytes);
    });
    const long most_kb = static_cast<long>(memory / 1024) + idle_kb;
    if (outcome.is_contained || (is_vtk && outcome.memory_kb > most_kb)) {
        // What it is with VTK's reader in a process of its own, which has no more than this one's limit.
        const Outcome real = apart(shared, 0, [&] { return read_as_file(bytes, is_xml ? ".vtu" : ".vtk"); });
        outcome.fault = outcome.is_contained && real.fault.empty() && real.is_taken
                            ? "taken, although VTK crashes on it"
                            : real.fault;
        outcome.memory_kb = real.memory_kb;
    }
    if (outcome.fault.empty() && outcome.memory_kb > most_kb) outcome.fault = fmt::format("{} kB", outcome.memory_kb);
    return outcome;
}

/// In order: those that are only read, so that nothing stands on a broken seed.
int mutate(const Format& format, std::uint64_t count, std::uint64_t first, const fs::path& keep) {
    auto* place = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) throw std::runtime_error("no memory can be shared");
    Shared& shared = *static_cast<Shared*>(place);
    const std::vector<std::string> seeds = seeds_of(format);
    const long idle_kb = apart(shared, 0, [] { return true; }).memory_kb;
    std::uint64_t taken = 0, contained = 0, faults = 0;
    long most_kb = 0;
    for (const std::string& seed : seeds)
        if (const Outcome outcome = read_apart(format, seed, shared, idle_kb); !outcome.is_taken) {
            fmt::print("{}: a seed is refused {}\n", format.name, outcome.fault);
            ++faults;
        }
    for (std::uint64_t number = first; number < first + count; ++number) {
        const std::string bytes = fuzz::mutated(seeds[number % seeds.size()], number);
        const Outcome outcome = read_apart(format, bytes, shared, idle_kb);
        taken += outcome.is_taken ? 1 : 0;
        contained += outcome.is_contained ? 1 : 0;
        most_kb = std::max(most_kb, outcome.memory_kb - idle_kb);
        if (outcome.fault.empty()) continue;
        ++faults;
        fmt::print("{}: mutation {}: {}\n", format.name, number, outcome.fault);
        if (!keep.empty()) write_text_file(keep / fmt::format("{}-{}", format.name, number), bytes);
    }
    fmt::print(
        "{}: {} mutations, {} taken, {} refused, of these {} after VTK's reader came to grief, at most {} MB; {} "
        "faults\n",
        format.name, count, taken, count - taken, contained, most_kb / 1024, faults);
    return faults == 0 ? 0 : 1;
}

void write_seeds(const fs::path& folder) {
    const Coordinates x{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    Coordinates y = x, z = x;
    y.row(1) << 1.5, 0.25, -0.0;
    z.row(2) << 0.5, 1.0, 1e-300;
    const auto step = [](const char* name, Action action) {
        return JournalStep{name, "how it went", std::move(action), {"a.json"}};
    };
    std::string journal("CWJRNL1\n");
    const std::uint64_t byte_order = 0x0102030405060708;
    journal.append(reinterpret_cast<const char*>(&byte_order), sizeof byte_order);
    journal += journal_head({"a.msh", "a.msh", 0, 0x1234}, x);
    journal += journal_step(1, 0, step("one", FlipAction{}), x, y);
    journal += journal_deformation(2, "a.json");
    journal += journal_step(3, 1, step("two", DeformAction{"a.json"}), y, z);
    journal += journal_jump(4, 1);
    journal += journal_clean(5, 1, "b.msh");
    fs::create_directories(folder / "journal");
    write_text_file(folder / "journal/steps.journal", journal);
    fs::create_directories(folder / "vtk_answer");
    for (const char* name : {"disc_appended.vtu", "mixed_51_binary.vtk"}) {
        const std::string file = std::string(CURVEWRIGHT_CORPUS "/vtk/") + name;
        const VtkParse parse = parse_vtk(file, fs::path(name).extension() == ".vtu");
        const Descriptor output = memory_file("answer");
        if (parse.grid == nullptr || !write_vtk_answer(*parse.grid, output.get()))
            throw InvalidInput(file, 0, "the file cannot be read.");
        const MappedFile answer(output);
        write_text_file(folder / "vtk_answer" / fs::path(name).replace_extension(".answer"),
                        {reinterpret_cast<const char*>(answer.bytes().data()), answer.bytes().size()});
    }
}

std::uint64_t number_of(const char* text) {
    std::uint64_t value = 0;
    const char* end = text + std::strlen(text);
    if (const auto [stopped, error] = std::from_chars(text, end, value); error != std::errc() || stopped != end)
        throw InvalidInput(fmt::format("\"{}\" is no number.", text));
    return value;
}

int run(int argc, char** argv) {
    const std::string_view first = argc > 1 ? argv[1] : "";
    if (first == "--list") {
        for (const Format& format : formats) fmt::print("{}\n", format.name);
        return 0;
    }
    if (first == "--write-seeds" && argc == 3) return write_seeds(argv[2]), 0;
    const auto* format = std::find_if(formats.begin(), formats.end(), [&](const Format& f) { return f.name == first; });
    if (argc < 3 || argc > 5 || format == formats.end()) {
        fmt::print(stderr, "curvewright-mutate FORMAT COUNT [FIRST [KEEP]] | --list | --write-seeds FOLDER\n");
        return 2;
    }
    return mutate(*format, number_of(argv[2]), argc > 3 ? number_of(argv[3]) : 1, argc > 4 ? argv[4] : "");
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    }
}
