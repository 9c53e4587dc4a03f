#include "benchmarks/tables/report.h"

#include <cstdlib>
#include <fstream>

#include "benchmarks/tables/measure.h"
#include "core/io/atomic_file.h"

namespace curvewright::benchmarks {

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

double load_before_run() {
    double load = 0.0;
    if (getloadavg(&load, 1) != 1) return 0.0;
    if (load > 0.5) tell(fmt::format("The machine is busy (load {:.1f}); times will be too long.", load));
    return load;
}

std::string load_remark(double load) {
    if (load <= 0.5) return {};
    return fmt::format(
        " Other programs used the processors during this run (load {:.1f} before it): times are too long, and ratios "
        "uncertain.",
        load);
}

void Report::add(const Table& table, const std::vector<Plot>& plots) {
    std::vector<Picture> pictures;
    for (const Plot& plot : plots)
        if (std::string svg = as_svg(plot); !svg.empty()) pictures.push_back({plot.name, plot.title, std::move(svg)});
    add(table, std::move(pictures));
}

void Report::add(const Table& table, std::vector<Picture> pictures) {
    fmt::print("{}\n", as_text(table));
    std::fflush(stdout);
    sections_.emplace_back(table, std::move(pictures));
}

void Report::finish(const Page& page, const std::filesystem::path& folder) {
    Table targets{"targets", "Targets", "", {"what", "promised", "measured", "met"}, {}};
    for (const Target& target : targets_)
        targets.add({target.what, target.promised, target.measured, target.is_met ? "yes" : "no"});
    fmt::print("{}\n", as_text(targets));
    if (folder.empty()) return;

    std::filesystem::create_directories(folder);
    std::string text = page.introduction;
    const auto write = [&](const std::string& name, const std::string& content) {
        write_text_file(folder / name, content);
    };
    text += as_markdown(targets);
    for (const auto& [table, pictures] : sections_) {
        text += "\n" + as_markdown(table);
        write(table.name + ".csv", as_csv(table));
        for (const Picture& picture : pictures) {
            write(picture.name + ".svg", picture.svg);
            text += fmt::format("\n![{}]({}.svg)\n", picture.title, picture.name);
        }
    }
    write(page.name + ".md", text);
}

}  // namespace curvewright::benchmarks
