#include "core/untangle/signed_angles.h"

#include <optional>
#include <utility>
#include <variant>

#include "benchmarks/cases/timed.h"
#include "benchmarks/thesis/distortion.h"
#include "benchmarks/thesis/manifest.h"
#include "benchmarks/thesis/measurements.h"
#include "benchmarks/thesis/published.h"

namespace curvewright::benchmarks {
namespace {

/// Seconds of the second passes of a run: from the last patch of a first pass until the face nodes have moved.
class SecondPassWatch : public UntangleObserver {
  public:
    void on_event(const UntangleEvent& event) override {
        if (std::holds_alternative<untangle_event::PatchEnded>(event)) since_ = watch_.seconds();
        if (std::holds_alternative<untangle_event::FaceNodesMoved>(event)) seconds_ += watch_.seconds() - since_;
    }
    double seconds() const { return seconds_; }

  private:
    Stopwatch watch_;
    double since_ = 0.0, seconds_ = 0.0;
};

struct AngleRun {
    std::string method;
    Timed<UntangleResult> timed;
    MeshDistortion distortion;
    Cell beta;
    std::optional<double> second_pass;
};

SignedAngleOptions with_beta(double beta) {
    SignedAngleOptions options;
    options.beta = beta;
    return options;
}

AngleRun run_angles(const UntangleCase& problem, const std::string& method, const SignedAngleOptions& options,
                    const Repeats& repeats) {
    AngleRun run;
    run.method = method;
    run.timed = best_of([&] { return timed([&] { return untangle_signed_angles(problem.mesh, options); }); }, repeats);
    run.distortion = distortion_of(problem, run.timed.result.coordinates);
    if (options.beta_choice == BetaChoice::automatic) {
        run.beta = "auto";
        return run;
    }
    run.beta = formatted(options.beta, "{:g}");
    if (problem.mesh.topology().order() > 2) {
        SecondPassWatch watch;
        untangle_signed_angles(problem.mesh, options, &watch);
        run.second_pass = watch.seconds();
    }
    return run;
}

/// The literal method with that of some values of beta, the same for all edges, which leaves the fewest invalid
/// elements and then the highest minimum.
AngleRun run_best_beta(const UntangleCase& problem, const Repeats& repeats) {
    double best_beta = 0.0;
    MeshDistortion best;
    for (const double beta : {0.9, 0.7, 0.5, 0.3, 0.1, 0.06, 0.03, 0.01, 0.003, 0.001, 1e-4, 1e-5}) {
        const auto result = untangle_signed_angles(problem.mesh, with_beta(beta));
        const MeshDistortion distortion = distortion_of(problem, result.coordinates);
        if (best_beta != 0.0 &&
            std::pair(-distortion.not_valid, distortion.least) <= std::pair(-best.not_valid, best.least))
            continue;
        best_beta = beta;
        best = distortion;
    }
    return run_angles(problem, "Alg. 6, best of twelve beta", with_beta(best_beta), repeats);
}

/// All that is run on an example.
struct Runs {
    AngleRun published, fitted, tried, automatic;
    Timed<GuaranteedResult> valid, guaranteed;
    MeshDistortion after_guaranteed;
};

Runs run(const published::SignedExample& example, const UntangleCase& problem, const Settings& settings) {
    const Repeats repeats = settings.repeats();
    SignedAngleOptions automatic;
    automatic.beta_choice = BetaChoice::automatic;
    Runs runs{run_angles(problem, "Alg. 6, thesis's beta", with_beta(example.beta), repeats),
              run_angles(problem, "Alg. 6, the sample's beta",
                         with_beta(manifest_beta(settings.samples, example.sample)), repeats),
              run_best_beta(problem, repeats),
              run_angles(problem, "signed angles, beta auto", automatic, repeats),
              best_of([&] { return timed_guaranteed(problem, false); }, repeats),
              best_of([&] { return timed_guaranteed(problem, true); }, repeats),
              {}};
    runs.after_guaranteed = distortion_of(problem, runs.guaranteed.result.coordinates);
    return runs;
}

/// least, largest, not valid, s
std::vector<Cell> figure_cells(const MeshDistortion& distortion, double seconds) {
    return {fixed(distortion.least), fixed(distortion.largest), distortion.not_valid, seconds};
}

void add_to_figure(const Runs& runs, const PeerResult* peer, const std::string& what, Comparison& figure) {
    figure.add(By::best, what, runs.automatic.method,
               figure_cells(runs.automatic.distortion, runs.automatic.timed.seconds));
    figure.add(By::best, what, "guaranteed method", figure_cells(runs.after_guaranteed, runs.guaranteed.seconds),
               fmt::format("certified valid after {:.2g} s", runs.valid.seconds));
    if (peer) figure.add(By::peer, what, peer->name(), {fixed(peer->least), Cell(), peer->not_valid, peer->seconds});
}

Comparison figure_of(const published::SignedExample& example, const UntangleCase& problem, const Runs& runs,
                     const PeerResult* peer) {
    Comparison figure(
        {"figure", example.figure}, fmt::format("signed angles, {}", example.name),
        fmt::format("Certified min J / max J. Tangled elements at the start: {} in the thesis, {} here. The "
                    "literal objective depends on the unit of length, so a beta belongs to a mesh.",
                    example.tangled, distortion_of(problem, problem.mesh.coordinates()).not_valid),
        "mesh", {"least", "largest", "not valid", "s"});
    const MeshDistortion start = distortion_of(problem, problem.mesh.coordinates());
    figure.add(By::thesis, "original mesh", "", {fixed(example.start), fixed(1.0), example.tangled});
    figure.add(By::here, "original mesh", "remade", {fixed(start.least), fixed(start.largest), start.not_valid});
    figure.add(By::thesis, "resulting mesh", fmt::format("beta = {:g}", example.beta),
               {fixed(example.least), fixed(1.0), Cell(), example.first_pass + example.second_pass.value_or(0.0)});
    for (const AngleRun* run : {&runs.published, &runs.fitted, &runs.tried})
        figure.add(By::literal, "resulting mesh", fmt::format("{}: {}", run->method, run->beta.shown),
                   figure_cells(run->distortion, run->timed.seconds));
    add_to_figure(runs, peer, "resulting mesh", figure);
    return figure;
}

/// Figure 4.6: three beta on one mesh.
Comparison annulus_figure(const published::SignedExample& example, const UntangleCase& problem, const Runs& runs,
                          const PeerResult* peer, const Settings& settings, ThesisReport& report) {
    Comparison figure({"figure", example.figure}, "signed angles, annulus with three values of beta",
                      "Certified min J / max J. The last rows are the same mesh by methods that need no beta.", "beta",
                      {"least", "largest", "not valid", "s"});
    Tally near;
    for (const auto& row : published::annulus_betas()) {
        const std::string what = fmt::format("{:g}", row.beta);
        const AngleRun run = run_angles(problem, "Alg. 6", with_beta(row.beta), settings.repeats());
        figure.add(By::thesis, what, "", {fixed(row.least), fixed(row.largest), Cell(), row.seconds});
        figure.add(By::literal, what, run.method, figure_cells(run.distortion, run.timed.seconds),
                   fmt::format("{} iterations", run.timed.result.passes));
        near.add(run.distortion.not_valid == 0 && run.distortion.least >= row.least - 0.05, "beta = " + what);
    }
    add_to_figure(runs, peer, "none", figure);
    if (settings.wants("figure", example.figure))
        near.tell_in(report, "figure 4.6: literal minimum at least the thesis's less .05", "all three beta");
    return figure;
}

void add_to_table(const published::SignedExample& example, const UntangleCase& problem, const Runs& runs,
                  const Peers& peers, Comparison& table) {
    const Index elements = problem.mesh.topology().element_count();
    const int order = problem.mesh.topology().order();
    const std::string name = example.name;
    for (const AngleRun* run : {&runs.published, &runs.fitted, &runs.tried, &runs.automatic})
        table.add(
            run == &runs.automatic ? By::best : By::literal, name, run->method,
            {elements, order, run->beta, run->timed.result.passes, run->timed.seconds - run->second_pass.value_or(0.0),
             run->second_pass ? Cell(*run->second_pass) : Cell(), fixed(run->distortion.least),
             run->distortion.not_valid});
    table.add(By::best, name, "guaranteed method, until valid",
              {elements, order, Cell(), Cell(), runs.valid.seconds, Cell(),
               fixed(distortion_of(problem, runs.valid.result.coordinates).least),
               static_cast<Index>(runs.valid.result.unmended.size())});
    table.add(By::best, name, "guaranteed method, to the end",
              {elements, order, Cell(), Cell(), runs.guaranteed.seconds, Cell(), fixed(runs.after_guaranteed.least),
               runs.after_guaranteed.not_valid});
    if (const PeerResult* quick = peers.quickest(example.sample))
        table.add(By::peer, name, quick->name(),
                  {elements, order, Cell(), Cell(), quick->seconds, Cell(), fixed(quick->least), quick->not_valid},
                  "the quickest that leaves nothing invalid");
}

}  // namespace

void measure_signed_angles(const Settings& settings, const Peers& peers, ThesisReport& report) {
    Comparison table(
        {"table", "4.1"}, "signed angles",
        fmt::format(
            "Wall clock on {} threads; thesis: a Ryzen 7 1700. Literal, Algorithm 6: with the thesis's beta, with the "
            "one that the sample is set up with, and with the best of twelve between 0.9 and 1e-5, since a beta "
            "belongs "
            "to a mesh and its unit of length. The second pass was timed in a run of its own, step by step on one "
            "thread. Best: beta chosen edge by edge, and the guaranteed method.",
            settings.threads),
        "example",
        {"elements", "order", "beta", "iterations", "s, but for the second pass", "second pass, s", "least",
         "not valid"});
    std::vector<Comparison> figures;
    Tally published_valid, fitted_valid, fitted_near, automatic_above, guaranteed_above, guaranteed_valid, above_peer;
    for (const auto& example : published::signed_examples()) {
        table.add(
            By::thesis, example.name, "",
            {example.elements, example.order, formatted(example.beta, "{:g}"), example.iterations, example.first_pass,
             example.second_pass ? Cell(*example.second_pass) : Cell(), fixed(example.least)});
        if (!settings.wants("table", "4.1") && !settings.wants("figure", example.figure)) continue;
        tell(fmt::format("figure {}: {}", example.figure, example.name));
        const UntangleCase problem = load_untangle_case(settings.samples, example.sample);
        const Runs runs = run(example, problem, settings);
        const PeerResult* peer = peers.best(example.sample);
        add_to_table(example, problem, runs, peers, table);
        figures.push_back(std::string(example.figure) == "4.6"
                              ? annulus_figure(example, problem, runs, peer, settings, report)
                              : figure_of(example, problem, runs, peer));
        published_valid.add(runs.published.distortion.not_valid == 0, example.name);
        fitted_valid.add(runs.fitted.distortion.not_valid == 0, example.name);
        fitted_near.add(runs.tried.distortion.least >= example.least - 0.05, example.name);
        automatic_above.add(
            runs.automatic.distortion.not_valid == 0 && runs.automatic.distortion.least >= example.least, example.name);
        guaranteed_above.add(runs.after_guaranteed.least >= example.least, example.name);
        guaranteed_valid.add(runs.after_guaranteed.not_valid == 0, example.name);
        if (peer) above_peer.add(runs.after_guaranteed.least >= peer->least, example.name);
    }
    if (figures.empty()) return;
    report.add(table);
    for (const Comparison& figure : figures) report.add(figure);
    published_valid.tell_in(report, "signed angles, literal, thesis's beta: every element valid", "all examples");
    fitted_valid.tell_in(report, "signed angles, literal, the sample's beta: every element valid", "all examples");
    fitted_near.tell_in(report, "signed angles, literal, best of twelve beta: at least the thesis's minimum less .05",
                        "all examples");
    automatic_above.tell_in(report, "signed angles, beta auto: valid, and above the thesis's minimum", "all examples");
    guaranteed_above.tell_in(report, "chapter 4, guaranteed method: above the thesis's minimum", "all examples");
    guaranteed_valid.tell_in(report, "chapter 4, guaranteed method: every element certified valid", "all examples");
    above_peer.tell_in(report, "chapter 4, guaranteed method: above the best peer's minimum", "all examples");
}

}  // namespace curvewright::benchmarks
