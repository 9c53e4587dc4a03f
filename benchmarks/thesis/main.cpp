// The tables of docs/thesis: every table of the thesis with what this program makes of it.

#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "benchmarks/thesis/measurements.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"

namespace curvewright::benchmarks {
namespace {

/// The options of the run that change its numbers.
std::string arguments(const Settings& settings) {
    std::string text;
    if (settings.is_quick) text += " --quick";
    if (!settings.only.empty()) text += fmt::format(" --only \"{}\"", fmt::join(settings.only, ","));
    if (settings.example_lu_limit != Settings().example_lu_limit)
        text += fmt::format(" --lu-limit {}", settings.example_lu_limit);
    return text;
}

std::string introduction(const Settings& settings, double seconds) {
    return fmt::format(
        R"(# The thesis's tables

Every table of M. Stees, "Optimization-based Methods in High-Order Mesh Generation and Untangling", and every figure with
numbers, next to what this program makes of it. [pictures.md](pictures.md) shows the meshes.

Written by `curvewright-thesis{}` in {:.0f} s ({}, {} threads, compiler {}).{}
All numbers but those of the thesis and of the peers come from this one run; short measurements are the best of several.

- **thesis**: what is printed there, measured on its meshes and machines.
- **here**: the remade example before any method. The thesis gives names, counts and results of its examples, but no
  dimensions: the meshes are remade so that counts and starting minima agree ([MANIFEST](../../sample_meshes/MANIFEST)).
- **literal**: the thesis's method as published, on the remade mesh. Its displacement term has a unit of length, so the
  thesis's beta belongs to the thesis's meshes; the tables show it as well as those that suit the remade mesh.
  [METHODS.md](../METHODS.md) says where the literal methods stall, and why.
- **best**: what this program has beyond the thesis.
- **peer**: other programs on the same files, measured once ([peers.csv](../../benchmarks/thesis/peers.csv) says how).

```
cmake --preset release -DCURVEWRIGHT_BUILD_BENCHMARKS=ON && cmake --build build --target curvewright-thesis
sample_meshes/families/generate.sh                        # meshes of figures 2.2 and 2.3, with Gmsh
/usr/bin/python3 sample_meshes/generate.py moving_spheres # the largest example, with Gmsh
build/bin/curvewright-thesis{}
```

`--quick` takes the small meshes, `--only 2.1,4.6` some tables. `--lu-limit 90000` runs SparseLU on the moving sphere too,
which takes minutes: without it the run takes less than ten on two idle cores.

)",
        arguments(settings), seconds, processor(), settings.threads, __VERSION__, load_remark(settings.load_before),
        arguments(settings));
}

}  // namespace
}  // namespace curvewright::benchmarks

int main(int argc, char** argv) {
    using namespace curvewright;
    using namespace curvewright::benchmarks;
    CLI::App app("Runs every table of the thesis and writes docs/thesis: Markdown, CSV and SVG.", "curvewright-thesis");
    Settings settings;
    settings.samples = CURVEWRIGHT_SAMPLES;
    settings.families = "build/families";
    settings.peers = CURVEWRIGHT_THESIS_PEERS;
    std::optional<std::filesystem::path> out;
    app.add_option("--out", out,
                   "Folder for README.md, CSV and SVG files; \"\" writes none. Default: docs/thesis, or build/thesis "
                   "with --quick or --only");
    app.add_option("--samples", settings.samples, "The folder sample_meshes");
    app.add_option("--families", settings.families, "Meshes made by sample_meshes/families/generate.sh")
        ->capture_default_str();
    app.add_option("--only", settings.only, "These tables and figures only: 2.1,4.6 or \"table 2.1\",\"figure 4.6\"")
        ->delimiter(',');
    app.add_option("--threads", settings.threads, "Threads")->capture_default_str()->check(CLI::Range(1, 256));
    app.add_option("--lu-limit", settings.example_lu_limit,
                   "Most interior nodes of an example for which SparseLU is run")
        ->capture_default_str();
    app.add_flag("--quick", settings.is_quick, "Small meshes and fewer repetitions, less than a minute");
    CLI11_PARSE(app, argc, argv);
    settings.load_before = load_before_run();
    try {
        check_selection(settings);
        set_thread_count(settings.threads);
        const Stopwatch watch;
        const Peers peers(settings.peers);
        ThesisReport report(settings);
        measure_sparsity(settings, report);
        count_families(settings, report);
        measure_families(settings, report);
        measure_warps(settings, peers, report);
        measure_unsigned_angles(settings, peers, report);
        measure_signed_angles(settings, peers, report);
        measure_convergence(settings, report);
        report.finish({"README", introduction(settings, watch.seconds())},
                      out.value_or(settings.is_quick || !settings.only.empty() ? "build/thesis" : "docs/thesis"));
        tell(fmt::format("{:.0f} s.", watch.seconds()));
        if (!report.lacking().empty()) {
            tell(fmt::format("Meshes are missing for {}; the remarks there say how to make them.",
                             fmt::join(report.lacking(), ", ")));
            return 2;
        }
    } catch (const std::exception& error) {
        tell(error.what());
        return 1;
    }
}
