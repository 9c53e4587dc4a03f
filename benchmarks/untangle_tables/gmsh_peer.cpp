#include "benchmarks/untangle_tables/gmsh_peer.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <unistd.h>

#include "benchmarks/tables/measure.h"
#include "core/io/mesh_io.h"

namespace curvewright::benchmarks {
namespace {

/// Standard output of a command; none if it fails.
std::optional<std::string> output_of(const std::string& command) {
    const auto close = [](FILE* pipe) { pclose(pipe); };
    const std::unique_ptr<FILE, decltype(close)> pipe(popen(command.c_str(), "r"), close);
    if (!pipe) return {};
    std::string text;
    for (char buffer[256]; std::fgets(buffer, sizeof buffer, pipe.get());) text += buffer;
    return text;
}

/// A folder for the files of one run; removed with all that is in it.
class ScratchFolder {
  public:
    ScratchFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("curvewright-peer-{}", getpid())) {
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    std::filesystem::path operator/(const char* name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

}  // namespace

GmshPeer::GmshPeer(const Settings& settings)
    : python_(settings.python), script_(CURVEWRIGHT_GMSH_PEER), limit_(settings.peer_limit) {
    if (python_.empty()) return;
    const auto version = output_of(fmt::format("'{}' -c 'import gmsh; print(gmsh.__version__)' 2>/dev/null", python_));
    is_available_ = version && !version->empty();
    if (!is_available_) tell(fmt::format("{} has no module gmsh: the peer's columns stay empty.", python_));
}

const std::vector<std::string>& GmshPeer::methods() {
    static const std::vector<std::string> names{"opt",     "opt0.5",      "opt@10",     "opt0.5@10",
                                                "elastic", "elastic+opt", "fastcurving"};
    return names;
}

std::optional<PeerRun> GmshPeer::run(const UntangleCase& problem, const std::string& method) const {
    if (!is_available_) return {};
    const ScratchFolder folder;
    write_mesh(folder / "in.msh", problem.mesh);
    const auto seconds =
        output_of(fmt::format("timeout {} '{}' '{}' '{}' '{}' '{}' 2>/dev/null", limit_, python_, script_,
                              (folder / "in.msh").string(), method, (folder / "out.txt").string()));
    std::ifstream stream(folder / "out.txt");
    if (!seconds || seconds->empty() || !stream) return {};
    PeerRun run{method, std::stod(*seconds), {}};
    Coordinates coordinates = problem.mesh.coordinates();
    Index count = 0;
    for (long long tag = 0; stream >> tag; ++count) {
        const auto node = problem.mesh.topology().find_node(NodeTag(tag));
        if (!node) return {};
        for (int axis = 0; axis < 3; ++axis) stream >> coordinates(*node, axis);
    }
    if (count != problem.mesh.topology().node_count()) return {};
    run.judgement = judge(problem, coordinates);
    return run;
}

}  // namespace curvewright::benchmarks
