#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <vector>

#include "core/base/error.h"
#include "core/deform/expression.h"
#include "core/io/child_process.h"
#include "core/io/deformation_file.h"
#include "core/io/msh_io.h"
#include "core/io/vtk_io.h"
#include "core/session/journal_file.h"
#include "core/session/session_file.h"
#include "core/untangle/trace_reader.h"

namespace curvewright::fuzz {
namespace {

/// The mesh of the traces: a square of two curved triangles.
constexpr const char* trace_mesh = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
9
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 .5 .4 0
6 1 .5 0
7 .9 .2 0
8 .5 1 0
9 0 .5 0
$EndNodes
$Elements
2
1 9 2 1 1 1 2 3 5 6 7
2 9 2 1 1 1 3 4 7 8 9
$EndElements
)";

/// Whether the reading is done without an Error of ours.
template <class Function>
bool is_taken(Function&& function) {
    try {
        function();
        return true;
    } catch (const Error&) {
        return false;
    }
}

bool run_msh(std::string_view bytes) {
    return is_taken([&] { read_msh(bytes, "fuzz.msh", {}); });
}

bool run_deformation(std::string_view bytes, bool is_table) {
    return is_taken([&] {
        const Deformation deformation = parse_deformation(std::string(bytes), "fuzz", is_table);
        const auto* list = std::get_if<OperationList>(&deformation.content);
        for (std::size_t i = 0; list != nullptr && i < list->operations.size(); ++i)
            if (const auto* its = std::get_if<Expression>(&list->operations[i].kind))
                for (const auto& component : its->components)
                    if (component) CompiledExpression(*component).evaluate(0.5, -1.0, 2.0);
    });
}

bool run_json(std::string_view bytes) {
    return run_deformation(bytes, false);
}
bool run_table(std::string_view bytes) {
    return run_deformation(bytes, true);
}

bool run_expression(std::string_view bytes) {
    return is_taken([&] { CompiledExpression(std::string(bytes)).evaluate(0.5, -1.0, 2.0); });
}

bool run_session(std::string_view bytes) {
    return is_taken([&] {
        const std::vector<Action> actions = parse_session(bytes, "fuzz.json");
        for (const Action& action : actions) parse_action(to_json_line(action));
        command_line(actions, "out.msh");
    });
}

bool run_trace(std::string_view bytes) {
    struct Silent : UntangleObserver {
        void on_event(const UntangleEvent&) override {}
    };
    static const CurvedMesh mesh = read_msh(trace_mesh, "trace.msh", {}).mesh;
    return is_taken([&] {
        std::istringstream stream{std::string(bytes)};
        Silent observer;
        read_trace(stream, "fuzz.jsonl", mesh, observer);
    });
}

bool run_journal(std::string_view bytes) {
    const Descriptor file = memory_file("journal");
    write_all(file, bytes);
    const std::string path = "/proc/self/fd/" + std::to_string(file.get());
    const bool has_summary = is_taken([&] { summarize_journal(path); });
    bool is_whole = false;
    is_taken([&] { is_whole = read_journal(path).damage.empty(); });
    return has_summary && is_whole;
}

/// What stands before VTK's readers.
bool run_vtk_check(std::string_view bytes) {
    const bool is_xml = bytes.substr(0, 1) == "<";
    return is_taken([&] { check_vtk_text(bytes, "fuzz", is_xml ? MeshFormat::vtu : MeshFormat::vtk); });
}

/// What stands behind them.
bool run_vtk_answer(std::string_view bytes) {
    std::vector<std::uint64_t> aligned(bytes.size() / 8 + 1);
    if (!bytes.empty()) std::memcpy(aligned.data(), bytes.data(), bytes.size());
    const std::span<std::byte> answer(reinterpret_cast<std::byte*>(aligned.data()), bytes.size());
    return is_taken([&] { mesh_of_vtk_answer(answer, "fuzz.vtu", MeshFormat::vtu); });
}

constexpr std::array<Target, 9> all = {{{"msh", "msh", &run_msh},
                                        {"deformation_json", "deformation_json", &run_json},
                                        {"deformation_csv", "deformation_csv", &run_table},
                                        {"expression", "expression", &run_expression},
                                        {"session", "session", &run_session},
                                        {"trace", "trace", &run_trace},
                                        {"journal", "journal", &run_journal},
                                        {"vtk_check", "vtk", &run_vtk_check},
                                        {"vtk_answer", "vtk_answer", &run_vtk_answer}}};

}  // namespace

std::span<const Target> targets() {
    return all;
}

const Target* find_target(std::string_view name) {
    const auto* found = std::find_if(all.begin(), all.end(), [&](const Target& target) { return target.name == name; });
    return found == all.end() ? nullptr : found;
}

}  // namespace curvewright::fuzz
