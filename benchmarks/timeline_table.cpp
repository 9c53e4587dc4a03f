// What the timeline of an untangling costs: recording, memory, jumps to any step. Prints a Markdown table.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/deform/deformation.h"
#include "core/io/deformation_file.h"
#include "core/io/mesh_io.h"
#include "core/timeline/cursor.h"
#include "core/timeline/explanation.h"
#include "core/timeline/recorder.h"
#include "core/timeline/search.h"
#include "core/untangle/untangle_options.h"

namespace {

using namespace curvewright;

/// Megabytes of the process that are in memory, and the most there ever were.
double resident_megabytes(const char* key) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(key)) return std::strtod(line.c_str() + std::string(key).size(), nullptr) / 1024.0;
    return 0.0;
}

CurvedMesh load(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path(CURVEWRIGHT_SAMPLES) / name;
    std::filesystem::path file = folder / (name + ".msh");
    if (!std::filesystem::exists(file)) file += ".gz";
    const CurvedMesh straight = read_mesh(file).mesh;
    return straight.with_coordinates(apply_deformation(straight, read_deformation(folder / "deformation.json")));
}

void untangle(const CurvedMesh& mesh, const UntangleOptions& options, UntangleObserver* observer) {
    if (const auto* o = std::get_if<GuaranteedOptions>(&options))
        untangle_guaranteed(mesh, *o, observer);
    else if (const auto* s = std::get_if<SignedAngleOptions>(&options))
        untangle_signed_angles(mesh, *s, observer);
    else
        untangle_unsigned_angles(mesh, std::get<UnsignedAngleOptions>(options), observer);
}

struct Spread {
    double median, most_of_all, largest;
};
Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {values[values.size() / 2], values[values.size() * 19 / 20], values.back()};
}

void measure(const std::string& name, const CurvedMesh& mesh, const UntangleOptions& options) {
    const Stopwatch plain;
    untangle(mesh, options, nullptr);
    const double plain_seconds = plain.seconds();
    const double before = resident_megabytes("VmRSS:");
    const Stopwatch watch;
    Recorder recorder;
    untangle(mesh, options, &recorder);
    const auto recording = recorder.finish();
    const double seconds = watch.seconds();
    const double held = resident_megabytes("VmRSS:") - before;

    TimelineCursor cursor(recording);
    StepExplainer explainer;
    std::mt19937 random(1);
    std::uniform_int_distribution<StepNumber> anywhere(0, recording->step_count() - 1);
    std::vector<double> jumps, steps, explanations;
    for (int i = 0; i < 300; ++i) {
        const Stopwatch jump;
        cursor.seek(anywhere(random));
        jumps.push_back(1e3 * jump.seconds());
        const Stopwatch explain;
        explainer.explain(cursor);
        explanations.push_back(1e3 * explain.seconds());
    }
    StepNumber step = recording->step_count() / 2;
    cursor.seek(step);
    for (int i = 0; i < 300 && step + 1 < recording->step_count(); ++i) {
        const Stopwatch next;
        cursor.seek(++step);
        steps.push_back(1e3 * next.seconds());
    }
    const Spread jump = spread_of(jumps), next = spread_of(steps), explain = spread_of(explanations);
    fmt::print(
        "| {} | {} | {} | {:.2f} | {:.2f} | {:.0f} | {:.0f} | {:.0f} | {:.2g} / {:.2g} / {:.2g} | {:.2g} / {:.2g} | "
        "{:.2g} / {:.2g} |\n",
        name, mesh.topology().element_count(), recording->step_count(), plain_seconds, seconds,
        static_cast<double>(recording->size()) / 1e6, static_cast<double>(recording->memory()) / 1e6, held, jump.median,
        jump.most_of_all, jump.largest, next.median, next.largest, explain.median, explain.largest);
    std::fflush(stdout);
}

void run() {
    fmt::print(
        "| run | elements | steps | untangling, s | recorded, s | log, MB | of it in memory, MB | process grew by, "
        "MB | jump anywhere, ms: median / 95 % / longest | next step, ms: median / longest | explanation, ms: median "
        "/ longest |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    SignedAngleOptions given, automatic, many;
    given.beta = 0.2;
    automatic.beta_choice = BetaChoice::automatic;
    for (const std::string name : {"annulus", "bike_gear", "gear", "bl_airfoil"}) {
        const CurvedMesh mesh = load(name);
        measure(name + ", signed angles", mesh, given);
        measure(name + ", signed angles, β chosen", mesh, automatic);
        measure(name + ", unsigned angles", mesh, UnsignedAngleOptions{});
        measure(name + ", guaranteed", mesh, GuaranteedOptions{});
    }
    // More than a million steps.
    many.beta = 0.2;
    many.max_passes = 12;
    many.convergence = 0.0;
    measure("gear, signed angles, 12 passes", load("gear"), many);
    measure("bl_airfoil, signed angles, 12 passes", load("bl_airfoil"), many);
    fmt::print("\nThe process never had more than {:.0f} MB.\n", resident_megabytes("VmHWM:"));
}

}  // namespace

int main() {
    try {
        run();
        return 0;
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
