#include "benchmarks/warp_tables/report.h"

#include <fstream>

#include "core/io/atomic_file.h"

namespace curvewright::benchmarks {
namespace {

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

}  // namespace

void Report::add(const Table& table, const std::vector<Plot>& plots) {
    fmt::print("{}\n", as_text(table));
    std::fflush(stdout);
    sections_.emplace_back(table, plots);
}

void Report::finish(const Settings& settings, const std::filesystem::path& folder) {
    Table targets{"targets", "Targets", "", {"what", "promised", "measured", "met"}, {}};
    for (const Target& target : targets_)
        targets.add({target.what, target.promised, target.measured, target.is_met ? "yes" : "no"});
    fmt::print("{}\n", as_text(targets));
    if (folder.empty()) return;

    std::filesystem::create_directories(folder);
    const std::string load =
        settings.load_before > 0.5
            ? fmt::format(
                  " Other programs used the processors during this run (load {:.1f} before it): times are too long, "
                  "and ratios uncertain.",
                  settings.load_before)
            : std::string();
    std::string page = fmt::format(
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
        settings.is_quick ? " --quick" : "", processor(), settings.threads, __VERSION__, load,
        settings.reference_limit);
    const auto write = [&](const std::string& name, const std::string& content) {
        write_text_file(folder / name, content);
    };
    page += as_markdown(targets);
    for (const auto& [table, plots] : sections_) {
        page += "\n" + as_markdown(table);
        write(table.name + ".csv", as_csv(table));
        for (const Plot& plot : plots) {
            const std::string svg = as_svg(plot);
            if (svg.empty()) continue;
            write(plot.name + ".svg", svg);
            page += fmt::format("\n![{}]({}.svg)\n", plot.title, plot.name);
        }
    }
    write("warp.md", page);
}

}  // namespace curvewright::benchmarks
