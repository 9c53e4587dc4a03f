// The tables of docs/benchmarks/warp.md: how long warps take, against the methods of the literature in the same run.

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "benchmarks/warp_tables/measure.h"
#include "benchmarks/warp_tables/measurements.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace curvewright::benchmarks {
namespace {

std::string introduction(const Settings& settings) {
    return fmt::format(
        R"(# The speed of warps

Written by `curvewright-warp-tables{}` ({}, {} threads, compiler {}).{} All numbers
of a table come from one run; short measurements are the best of several. The reference is the method of the literature:
Algorithm 3 (Newton's method on the full KKT system of every node) for convex weights, Eigen's SparseLU with COLAMD on the
matrix of all interior nodes for the linear system. SparseLU uses one thread, whatever there is.

```
cmake --preset release -DCURVEWRIGHT_BUILD_BENCHMARKS=ON && cmake --build build --target curvewright-warp-tables
sample_meshes/families/generate.sh          # meshes of the families, with Gmsh
build/bin/curvewright-warp-tables --out docs/benchmarks --reference-limit {}
```

)",
        settings.is_quick ? " --quick" : "", processor(), settings.threads, __VERSION__,
        load_remark(settings.load_before), settings.reference_limit);
}

}  // namespace
}  // namespace curvewright::benchmarks

int main(int argc, char** argv) {
    using namespace curvewright;
    using namespace curvewright::benchmarks;
    CLI::App app("Measures warps and prints the tables of docs/benchmarks/warp.md.", "curvewright-warp-tables");
    Settings settings;
    settings.families = "build/families";
    settings.samples = CURVEWRIGHT_SAMPLES;
    std::filesystem::path out;
    std::vector<std::string> only;
    const std::set<std::string> names{"million", "weights", "circle", "sphere", "moving_sphere", "response"};
    app.add_option("--out", out, "Folder for warp.md, CSV and SVG files; none are written without it");
    app.add_option("--families", settings.families, "Meshes made by sample_meshes/families/generate.sh")
        ->capture_default_str();
    app.add_option("--samples", settings.samples, "The folder sample_meshes");
    app.add_option("--only", only, "Measure these only: million, weights, circle, sphere, moving_sphere, response")
        ->check(CLI::IsMember(names));
    app.add_option("--threads", settings.threads, "Threads of both sides")
        ->capture_default_str()
        ->check(CLI::Range(1, 256));
    app.add_option("--reference-limit", settings.reference_limit,
                   "Most interior nodes for which the reference solver runs in 3D; ten times as many in 2D")
        ->capture_default_str();
    app.add_flag("--quick", settings.is_quick, "Small meshes, less than a minute");
    CLI11_PARSE(app, argc, argv);
    settings.load_before = load_before_run();
    const auto is_wanted = [&](const char* name) {
        return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
    };
    try {
        Report report;
        if (is_wanted("million")) measure_million(settings, report);
        set_thread_count(settings.threads);
        if (is_wanted("weights")) measure_weights(settings, report);
        if (is_wanted("circle")) measure_scaling(settings, 2, report);
        if (is_wanted("sphere")) measure_scaling(settings, 3, report);
        if (is_wanted("moving_sphere")) measure_moving_sphere(settings, report);
        if (is_wanted("response")) measure_responses(settings, report);
        report.finish({"warp", introduction(settings)}, out);
    } catch (const std::exception& error) {
        tell(error.what());
        return 1;
    }
}
