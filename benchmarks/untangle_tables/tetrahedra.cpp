#include <algorithm>
#include <limits>

#include "benchmarks/cases/timed.h"
#include "benchmarks/untangle_tables/measurements.h"
#include "core/io/mesh_io.h"
#include "core/warp/warp.h"

namespace curvewright::benchmarks {
namespace {

/// The time of a peer that was stopped before it ended, s.
constexpr double endless = std::numeric_limits<double>::infinity();

/// The bent shell after a warp by affine weights that count all neighbours alike, as the thesis has it.
UntangleCase warped_shell(const Settings& settings) {
    UntangleCase problem = load_case(settings, "shell2");
    WarpOptions options;
    options.weighting = Weighting::affine;
    options.distance_power = options.sharing_power = 0.0;
    const CurvedMesh straight = problem.mesh.with_coordinates(problem.ideal);
    problem.name = "shell2, warped";
    problem.mesh = problem.mesh.with_coordinates(warp(straight, problem.mesh.coordinates(), options).coordinates);
    return problem;
}

std::vector<UntangleCase> cases(const Settings& settings) {
    std::vector<UntangleCase> cases;
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

/// How often our time until the mesh is valid, or given up, was below the peer's.
class Race {
  public:
    void add(const std::string& name, double ours, double theirs) {
        ++count_;
        if (ours < theirs)
            ++won_;
        else
            lost_ += (lost_.empty() ? "; not " : ", ") + name;
    }

    void tell_in(Report& report, const std::string& what) const {
        if (count_)
            report.add({what, "below Gmsh's \"HighOrder\" on the same file",
                        fmt::format("{} of {}{}", won_, count_, lost_), won_ == count_});
    }

  private:
    int count_ = 0, won_ = 0;
    std::string lost_;
};

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
        "as it is; where it leaves elements invalid, its time is that until it gave up.",
        {"case", "P", "invalid", "least", "distance", "valid, s", "end, s", "Gmsh, invalid", "Gmsh, least", "Gmsh, s"},
        {}};
    int count = 0, explained = 0, slid = 0;
    std::string left;
    Race pinned, sliding, given_up;
    for (const UntangleCase& problem : cases(settings)) {
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
            if (peer.is_available()) pinned.add(problem.name, first.seconds, theirs ? theirs->seconds : endless);
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
            if (peer.is_available()) {
                Race& race = !theirs || theirs->judgement.invalid != 0 ? given_up : sliding;
                race.add(problem.name, first.seconds, theirs ? theirs->seconds : endless);
            }
        }
    }
    report.add(fixed);
    report.add(slide);
    report.add({"tetrahedra, boundary fixed: certified valid, or a list with reasons", "all",
                fmt::format("{} of {}", explained, count), explained == count});
    report.add({"tetrahedra, boundary slides: certified valid", "all", fmt::format("{} of {}{}", slid, count, left),
                slid == count});
    pinned.tell_in(report, "tetrahedra, boundary fixed: time until valid or given up");
    sliding.tell_in(report, "tetrahedra, boundary slides: time until valid, where Gmsh ends valid too");
    given_up.tell_in(report, "tetrahedra, boundary slides: time until valid, where Gmsh gives up");
}

}  // namespace curvewright::benchmarks
