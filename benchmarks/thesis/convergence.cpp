#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include "benchmarks/cases/timed.h"
#include "benchmarks/thesis/distortion.h"
#include "benchmarks/thesis/measurements.h"
#include "benchmarks/thesis/published.h"
#include "core/untangle/signed_angles.h"

namespace curvewright::benchmarks {
namespace {

/// Two quadratic triangles over and under an edge of this length from the origin along x, whose middle node is the
/// free one.
constexpr double edge_length = 2.984155;
/// At the origin the lower triangle's other edge rises above the edge by this angle, the negative one of the start:
/// beta e^(10 angle) is the thesis's f at iteration 0; between the two triangles' other edges there is an angle of fan.
constexpr double tangling = 0.442374, fan = 0.259849;

UntangleCase motivating_example() {
    const double l = edge_length;
    const Eigen::Vector2d a(0.0, 0.0), b(l, 0.0), lower(0.6 * l, -0.5 * l);
    const Eigen::Vector2d upper = 0.8 * l * Eigen::Vector2d(std::cos(tangling + fan), std::sin(tangling + fan));
    const Eigen::Vector2d tangent = l * Eigen::Vector2d(std::cos(tangling), std::sin(tangling));
    const std::vector<Eigen::Vector2d> points{
        a, b, upper, lower, (a + b) / 2, (b + upper) / 2, (upper + a) / 2, (lower + tangent) / 4, (lower + b) / 2};
    MeshData data;
    Coordinates x(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        data.node_tags.push_back(NodeTag(static_cast<std::int64_t>(i) + 1));
        x.row(static_cast<Eigen::Index>(i)) << points[i].transpose(), 0.0;
    }
    ElementBlock block;
    block.type = {Shape::triangle, 2};
    block.nodes = {0, 1, 2, 4, 5, 6, 0, 3, 1, 7, 8, 4};
    block.tags = {ElementTag(1), ElementTag(2)};
    data.blocks.push_back(block);
    const CurvedMesh mesh(std::make_shared<const MeshTopology>(std::move(data)), x);
    return {"motivating example", mesh, x};
}

class SimplexCourse : public UntangleObserver {
  public:
    void on_event(const UntangleEvent& event) override {
        if (const auto* step = std::get_if<untangle_event::SimplexStep>(&event)) steps.push_back(*step);
        if (const auto* end = std::get_if<untangle_event::PatchEnded>(&event)) start = end->objective_before;
    }
    std::vector<untangle_event::SimplexStep> steps;
    double start = 0.0;
};

}  // namespace

void measure_convergence(const Settings& settings, ThesisReport& report) {
    if (!settings.wants("figure", "4.2")) return;
    tell("figure 4.2");
    const UntangleCase problem = motivating_example();
    SignedAngleOptions options;
    options.beta = 0.35;
    options.max_passes = 1;
    options.simplex_tolerance = 0.01;
    SimplexCourse course;
    const auto literal = timed([&] { return untangle_signed_angles(problem.mesh, options, &course); });
    SignedAngleOptions automatic;
    automatic.beta_choice = BetaChoice::automatic;
    automatic.target = 1.0;
    const auto chosen = timed([&] { return untangle_signed_angles(problem.mesh, automatic); });

    Comparison table(
        {"figure", "4.2"}, "course of the simplex method on the example of figure 4.1",
        fmt::format(
            "beta = 0.35, tolerance 0.01. Term 1 is the displacement's, term 2 the angles'. The patch is remade: two "
            "quadratic triangles whose edge length and angles were chosen such that f at the start and both terms "
            "at the minimum are the thesis's; the steps between depend on the first simplex, of which the thesis "
            "says nothing. Ours, best vertex after each iteration, ends after {} iterations with a least scaled "
            "Jacobian of {:.3f} (at the start {:.3f}); with beta chosen automatically, which measures the "
            "displacement in edge lengths, it is {:.3f}.",
            course.steps.empty() ? 0 : course.steps.back().iteration,
            distortion_of(problem, literal.result.coordinates).least,
            distortion_of(problem, problem.mesh.coordinates()).least,
            distortion_of(problem, chosen.result.coordinates).least),
        "iteration", {"term 1", "term 2", "f"});
    const auto row = [](double displacement, double angle) {
        return std::vector<Cell>{formatted(displacement, "{:.4f}"), formatted(angle, "{:.4f}"),
                                 formatted(displacement + angle, "{:.4f}")};
    };
    Series theirs{"thesis", 1, true, {}}, ours{"this program", 0, false, {}};
    const auto add_published = [&](int iteration) {
        for (const auto& step : published::convergence_steps()) {
            if (step.iteration != iteration) continue;
            table.add(By::thesis, fmt::format("{}", iteration), "",
                      {formatted(step.displacement_term, "{:.4f}"), formatted(step.angle_term, "{:.4f}"),
                       formatted(step.objective, "{:.4f}")});
            theirs.points.emplace_back(iteration, step.objective);
        }
    };
    add_published(0);
    table.add(By::literal, "0", "Nelder-Mead", row(0.0, course.start), "the node where it was");
    ours.points.emplace_back(0.0, course.start);
    for (const auto& step : course.steps) {
        if (step.iteration == 0) continue;
        add_published(step.iteration);
        table.add(By::literal, fmt::format("{}", step.iteration), "Nelder-Mead",
                  row(step.displacement_term, step.angle_term));
        ours.points.emplace_back(step.iteration, step.objective.front());
    }
    Plot plot{"figure_4.2", "Figure 4.2: convergence of the simplex method", "iteration", "f", {ours, theirs}};
    plot.has_linear_x = true;
    report.add(table, std::vector<Plot>{plot});
    if (course.steps.empty()) return;
    const auto& last = published::convergence_steps().back();
    const double end = course.steps.back().objective.front();
    report.add(Target{"figure 4.2: f at the end", fmt::format("{:.4f} (to the tolerance, 0.01)", last.objective),
                      fmt::format("{:.4f}", end), std::abs(end - last.objective) <= 0.01});
}

}  // namespace curvewright::benchmarks
