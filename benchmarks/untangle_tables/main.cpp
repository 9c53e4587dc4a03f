// The tables of docs/benchmarks/untangle.md: what the three untangling methods reach, and how long they take.

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "benchmarks/tables/measure.h"
#include "benchmarks/untangle_tables/measurements.h"
#include "core/base/parallel.h"

namespace curvewright::benchmarks {
namespace {

std::string introduction(const Settings& settings) {
    return fmt::format(
        R"(# Untangling

Written by `curvewright-untangle-tables{}` ({}, {} threads, compiler {}).{} All numbers
come from one run; short measurements are the best of several. The cases remake the examples of chapters 3 and 4 of
M. Stees, "Optimization-based Methods in High-Order Mesh Generation and Untangling" (names, counts and starting minima are
the thesis's, dimensions are not: see [sample_meshes](../../sample_meshes/MANIFEST)).

```
cmake --preset release -DCURVEWRIGHT_BUILD_BENCHMARKS=ON && cmake --build build --target curvewright-untangle-tables
sample_meshes/cad/generate.py build/cad     # CAD shapes, with Gmsh
build/bin/curvewright-untangle-tables --out docs/benchmarks
```

)",
        settings.is_quick ? " --quick" : "", processor(), settings.threads, __VERSION__,
        load_remark(settings.load_before));
}

}  // namespace
}  // namespace curvewright::benchmarks

int main(int argc, char** argv) {
    using namespace curvewright;
    using namespace curvewright::benchmarks;
    CLI::App app("Measures the untangling methods and prints the tables of docs/benchmarks/untangle.md.",
                 "curvewright-untangle-tables");
    Settings settings;
    settings.samples = CURVEWRIGHT_SAMPLES;
    settings.cad = "build/cad";
    settings.python = "/usr/bin/python3";
    std::filesystem::path out;
    std::vector<std::string> only;
    const std::set<std::string> names{"guaranteed", "signed", "unsigned", "tetrahedra", "invariance", "certification"};
    app.add_option("--out", out, "Folder for untangle.md and CSV files; none are written without it");
    app.add_option("--samples", settings.samples, "The folder sample_meshes");
    app.add_option("--cad", settings.cad, "Meshes made by sample_meshes/cad/generate.py")->capture_default_str();
    app.add_option("--python", settings.python, "Interpreter with Gmsh's module; \"\" leaves Gmsh out")
        ->capture_default_str();
    app.add_option("--only", only,
                   "Measure these only: guaranteed, signed, unsigned, tetrahedra, invariance, certification")
        ->check(CLI::IsMember(names));
    app.add_option("--threads", settings.threads, "Threads (Gmsh's optimizers have one)")
        ->capture_default_str()
        ->check(CLI::Range(1, 256));
    app.add_option("--peer-limit", settings.peer_limit, "Seconds after which a run of Gmsh is given up")
        ->capture_default_str();
    app.add_flag("--quick", settings.is_quick, "Few cases, less than a minute");
    CLI11_PARSE(app, argc, argv);
    settings.load_before = load_before_run();
    const auto is_wanted = [&](const char* name) {
        return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
    };
    try {
        set_thread_count(settings.threads);
        const GmshPeer peer(settings);
        Report report;
        if (is_wanted("guaranteed")) measure_guaranteed(settings, peer, report);
        if (is_wanted("signed")) measure_signed_angles(settings, report);
        if (is_wanted("unsigned")) measure_unsigned_angles(settings, report);
        if (is_wanted("tetrahedra")) measure_tetrahedra(settings, peer, report);
        if (is_wanted("invariance")) measure_invariance(settings, report);
        if (is_wanted("certification")) measure_certification(settings, report);
        report.finish({"untangle", introduction(settings)}, out);
    } catch (const std::exception& error) {
        tell(error.what());
        return 1;
    }
}
