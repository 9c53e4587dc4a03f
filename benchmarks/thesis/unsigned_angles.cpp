#include "core/untangle/unsigned_angles.h"

#include <optional>
#include <variant>

#include "benchmarks/cases/sample_files.h"
#include "benchmarks/cases/timed.h"
#include "benchmarks/thesis/distortion.h"
#include "benchmarks/thesis/measurements.h"
#include "benchmarks/thesis/published.h"
#include "core/deform/deformation.h"
#include "core/io/deformation_file.h"

namespace curvewright::benchmarks {
namespace {

/// The mesh before it was tangled on purpose: what the deformation does up to its last projection onto a shape.
Coordinates before_tangling(const UntangleCase& problem, const Settings& settings) {
    const auto deformation = read_deformation(settings.samples / problem.name / "deformation.json");
    OperationList kept;
    std::size_t count = 0;
    const auto& all = std::get<OperationList>(deformation.content).operations;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (std::holds_alternative<SnapToCircle>(all[i].kind)) count = i + 1;
    kept.operations.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    return apply_deformation(problem.mesh.with_coordinates(problem.ideal), {kept, deformation.source});
}

struct Runs {
    Timed<UntangleResult> literal, several;
    Timed<GuaranteedResult> valid, guaranteed;
};

Runs run(const UntangleCase& problem, const Repeats& repeats) {
    const auto by_angles = [&](const UnsignedAngleOptions& options) {
        return best_of([&] { return timed([&] { return untangle_unsigned_angles(problem.mesh, options); }); }, repeats);
    };
    return {by_angles(UnsignedAngleOptions::literal()), by_angles({}),
            best_of([&] { return timed_guaranteed(problem, false); }, repeats),
            best_of([&] { return timed_guaranteed(problem, true); }, repeats)};
}

struct Tallies {
    Tally literal, several, guaranteed, valid, above_peer;
};

std::vector<Cell> with_time(std::vector<Cell> cells, double seconds) {
    cells.emplace_back(seconds);
    return cells;
}

/// One sample of an example in the table of its figure and in table 3.1.
void compare(const published::UnsignedExample& example, const std::string& sample, const Settings& settings,
             const Peers& peers, Comparison& figure, Comparison& times, Tallies& tallies) {
    const UntangleCase problem = load_untangle_case(settings.samples, sample);
    const MeshTopology& topology = problem.mesh.topology();
    const std::string order = fmt::format("P{}", topology.order());
    const MeshDistortion start = distortion_of(problem, problem.mesh.coordinates());
    for (const auto& mesh : example.meshes) {
        if (std::string(mesh.name) == "original mesh")
            figure.add(By::here, mesh.name, "remade, " + order,
                       cells(distortion_of(problem, before_tangling(problem, settings))));
        if (std::string(mesh.name) == "tangled mesh") figure.add(By::here, mesh.name, "remade, " + order, cells(start));
    }
    const Runs runs = run(problem, settings.repeats());
    const MeshDistortion literal = distortion_of(problem, runs.literal.result.coordinates);
    const MeshDistortion several = distortion_of(problem, runs.several.result.coordinates);
    const MeshDistortion guaranteed = distortion_of(problem, runs.guaranteed.result.coordinates);
    const char* const result = "resulting mesh";
    figure.add(By::literal, result, "Alg. 4 and 5, " + order, with_time(cells(literal), runs.literal.seconds),
               fmt::format("{} pass{}{}", runs.literal.result.passes, runs.literal.result.passes == 1 ? "" : "es",
                           literal.not_valid ? "; ends where the sum of the angles is flat, see METHODS.md" : ""));
    figure.add(By::best, result, "unsigned angles, several starts, " + order,
               with_time(cells(several), runs.several.seconds));
    figure.add(By::best, result, "guaranteed method, " + order, with_time(cells(guaranteed), runs.guaranteed.seconds),
               fmt::format("certified valid after {:.2g} s", runs.valid.seconds));
    const PeerResult* peer = peers.best(sample);
    if (peer)
        figure.add(By::peer, result, peer->name() + ", " + order,
                   {fixed(peer->least), Cell(), fixed(peer->mean), Cell(), peer->not_valid, peer->seconds});

    const std::string name = example.name;
    times.add(By::literal, name, "Alg. 4 and 5, " + order,
              {topology.element_count(), runs.literal.result.passes, runs.literal.seconds, fixed(literal.least),
               literal.not_valid});
    times.add(By::best, name, "unsigned angles, several starts, " + order,
              {topology.element_count(), runs.several.result.passes, runs.several.seconds, fixed(several.least),
               several.not_valid});
    times.add(By::best, name, "guaranteed method, until valid, " + order,
              {topology.element_count(), Cell(), runs.valid.seconds,
               fixed(distortion_of(problem, runs.valid.result.coordinates).least),
               static_cast<Index>(runs.valid.result.unmended.size())});
    times.add(
        By::best, name, "guaranteed method, to the end, " + order,
        {topology.element_count(), Cell(), runs.guaranteed.seconds, fixed(guaranteed.least), guaranteed.not_valid});
    if (const PeerResult* quick = peers.quickest(sample))
        times.add(By::peer, name, quick->name() + ", " + order,
                  {topology.element_count(), Cell(), quick->seconds, fixed(quick->least), quick->not_valid},
                  "the quickest that leaves nothing invalid");

    const double thesis = example.meshes.back().least;
    const auto label = example.samples.size() > 1 ? name + ", " + order : name;
    tallies.literal.add(literal.not_valid == 0 && literal.least >= thesis, label);
    tallies.several.add(several.not_valid == 0 && several.least >= thesis, label);
    tallies.guaranteed.add(guaranteed.least >= thesis, label);
    tallies.valid.add(guaranteed.not_valid == 0, label);
    if (peer) tallies.above_peer.add(guaranteed.least >= peer->least, label);
}

}  // namespace

void measure_unsigned_angles(const Settings& settings, const Peers& peers, ThesisReport& report) {
    Comparison times({"table", "3.1"}, "unsigned angles, times", "Wall clock. Thesis: Matlab R2017b on a Xeon W3520.",
                     "example", {"elements", "passes", "s", "least", "not valid"});
    std::vector<Comparison> figures;
    Tallies tallies;
    for (const auto& example : published::unsigned_examples()) {
        times.add(By::thesis, example.name, "",
                  {example.elements, 1, example.seconds, fixed(example.meshes.back().least)}, example.remark);
        if (!settings.wants("table", "3.1") && !settings.wants("figure", example.figure)) continue;
        tell(fmt::format("figure {}: {}", example.figure, example.name));
        Comparison figure({"figure", example.figure}, fmt::format("unsigned angles, {}", example.name),
                          fmt::format("Certified min J / max J: least, largest, mean over all elements (Avg1) and over "
                                      "the curved ones of the mesh in question (Avg2). {}",
                                      example.remark),
                          "mesh", {"least", "largest", "Avg1", "Avg2", "not valid", "s"});
        for (const auto& mesh : example.meshes) {
            std::vector<Cell> row{fixed(mesh.least), fixed(mesh.largest), fixed(mesh.avg1), fixed(mesh.avg2)};
            if (std::string(mesh.name) == "resulting mesh") {
                row.emplace_back();
                row.emplace_back(example.seconds);
            }
            figure.add(By::thesis, mesh.name, "", row);
        }
        for (const std::string& sample : example.samples)
            compare(example, sample, settings, peers, figure, times, tallies);
        figures.push_back(std::move(figure));
    }
    if (figures.empty()) return;
    report.add(times);
    for (const Comparison& figure : figures) report.add(figure);
    tallies.literal.tell_in(report, "unsigned angles, literal: valid, and the thesis's minimum reached",
                            "all examples");
    tallies.several.tell_in(report, "unsigned angles, several starts: valid, and above the thesis's minimum",
                            "all examples");
    tallies.guaranteed.tell_in(report, "chapter 3, guaranteed method: above the thesis's minimum", "all examples");
    tallies.valid.tell_in(report, "chapter 3, guaranteed method: every element certified valid", "all examples");
    tallies.above_peer.tell_in(report, "chapter 3, guaranteed method: above the best peer's minimum", "all examples");
}

}  // namespace curvewright::benchmarks
