#include <algorithm>

#include "benchmarks/untangle_tables/measurements.h"
#include "benchmarks/untangle_tables/timed.h"
#include "core/io/mesh_io.h"
#include "core/warp/warp.h"

namespace curvewright::benchmarks {
namespace {

/// The bent shell after a warp by affine weights that count all neighbours alike, as the thesis has it.
Case warped_shell(const Settings& settings) {
    Case problem = load_case(settings, "shell2");
    WarpOptions options;
    options.weighting = Weighting::affine;
    options.distance_power = options.sharing_power = 0.0;
    const CurvedMesh straight = problem.mesh.with_coordinates(problem.ideal);
    problem.name = "shell2, warped";
    problem.mesh = problem.mesh.with_coordinates(warp(straight, problem.mesh.coordinates(), options).coordinates);
    return problem;
}

std::vector<Case> cases(const Settings& settings) {
    std::vector<Case> cases;
    if (!settings.is_quick) {
        cases.push_back(warped_shell(settings));
        cases.push_back(load_case(settings, "screw"));
    }
    std::vector<std::filesystem::path> files;
    if (std::filesystem::is_directory(settings.cad))
        for (const auto& entry : std::filesystem::directory_iterator(settings.cad))
            if (entry.path().extension() == ".msh") files.push_back(entry.path());
    if (files.empty())
        tell(fmt::format("No CAD shapes in {}: make them with sample_meshes/cad/generate.py.", settings.cad.string()));
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        const CurvedMesh mesh = read_mesh(file).mesh;
        if (settings.is_quick && mesh.topology().order() > 2) continue;
        cases.push_back({file.stem().string(), mesh, mesh.coordinates()});
    }
    return cases;
}

std::vector<Cell> cells(const std::optional<PeerRun>& run) {
    if (!run) return {Cell(), Cell(), Cell()};
    return {run->judgement.invalid, run->judgement.min, run->seconds};
}

}  // namespace

void measure_tetrahedra(const Settings& settings, const GmshPeer& peer, Report& report) {
    Table fixed{
        "untangle_tetrahedra_fixed",
        "Tetrahedra, boundary fixed",
        "shell2 after a warp by affine weights, the screw, and CAD shapes meshed coarsely by Gmsh with nothing "
        "optimised. \"proved\": of the invalid elements, those for which there is a proof that no position of the "
        "interior nodes mends them. Gmsh: optimize(\"HighOrder\"), boundary pinned.",
        {"case", "P", "elements", "invalid at the start", "least at the start", "invalid", "proved", "least",
         "valid, s", "end, s", "Gmsh, invalid", "Gmsh, least", "Gmsh, s"},
        {}};
    Table slide{
        "untangle_tetrahedra_slide",
        "Tetrahedra, boundary slides",
        "The same with `--boundary slide`: boundary nodes move on the boundary as it was read. Distance: the "
        "largest of the new boundary from it, over the size of the mesh. Gmsh: optimize(\"HighOrder\") on the file "
        "as it is.",
        {"case", "P", "invalid", "least", "distance", "valid, s", "end, s", "Gmsh, invalid", "Gmsh, least", "Gmsh, s"},
        {}};
    int count = 0, explained = 0, slid = 0, compared = 0, quicker = 0;
    std::string left, slower;
    for (const Case& problem : cases(settings)) {
        tell("tetrahedra: " + problem.name);
        const MeshTopology& topology = problem.mesh.topology();
        const Judgement start = judge(problem, problem.mesh.coordinates());
        const double size =
            (problem.ideal.colwise().maxCoeff() - problem.ideal.colwise().minCoeff()).cwiseAbs().maxCoeff();
        ++count;
        const auto run = [&](BoundaryMode mode) {
            const auto first = timed_guaranteed(problem, false, mode);
            const auto end = timed_guaranteed(problem, true, mode);
            return std::tuple(first, end, judge(problem, end.result.coordinates));
        };
        const auto compare = [&](const Timed<GuaranteedResult>& ours, const std::optional<PeerRun>& theirs,
                                 const char* mode) {
            if (!peer.is_available()) return;
            ++compared;
            const bool is_quicker = !theirs || ours.seconds < theirs->seconds;
            quicker += is_quicker;
            if (!is_quicker) slower += fmt::format("{}{} ({})", slower.empty() ? "; not " : ", ", problem.name, mode);
        };
        {
            const auto [first, end, result] = run(BoundaryMode::fixed);
            const auto& unmended = end.result.unmended;
            const auto proved =
                std::count_if(unmended.begin(), unmended.end(), [](const auto& element) { return element.is_proved; });
            const auto theirs = peer.run(problem, "opt");
            std::vector<Cell> row{problem.name,  topology.order(), topology.element_count(),
                                  start.invalid, start.min,        result.invalid,
                                  proved,        result.min,       first.seconds,
                                  end.seconds};
            for (const Cell& cell : cells(theirs)) row.push_back(cell);
            fixed.add(row);
            explained += static_cast<Index>(unmended.size()) == result.invalid;
            compare(first, theirs, "fixed");
        }
        {
            const auto [first, end, result] = run(BoundaryMode::slide);
            const auto theirs = peer.run(problem, "opt*");
            std::vector<Cell> row{problem.name,
                                  topology.order(),
                                  result.invalid,
                                  result.min,
                                  formatted(end.result.largest_boundary_distance / size, "{:.1e}"),
                                  first.seconds,
                                  end.seconds};
            for (const Cell& cell : cells(theirs)) row.push_back(cell);
            slide.add(row);
            slid += result.invalid == 0;
            if (result.invalid != 0)
                left += fmt::format("{}{} ({})", left.empty() ? "; not " : ", ", problem.name, result.invalid);
            compare(first, theirs, "slide");
        }
    }
    report.add(fixed);
    report.add(slide);
    report.add({"tetrahedra, boundary fixed: certified valid, or a list with reasons", "all",
                fmt::format("{} of {}", explained, count), explained == count});
    report.add({"tetrahedra, boundary slides: certified valid", "all", fmt::format("{} of {}{}", slid, count, left),
                slid == count});
    if (compared)
        report.add({"tetrahedra: time until valid", "below Gmsh's \"HighOrder\" on the same file",
                    fmt::format("{} of {}{}", quicker, compared, slower), quicker == compared});
}

}  // namespace curvewright::benchmarks
