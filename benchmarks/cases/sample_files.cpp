#include "benchmarks/cases/sample_files.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace curvewright::benchmarks {

std::filesystem::path sample_mesh_file(const std::filesystem::path& samples, const std::string& name) {
    for (const char* suffix : {".msh", ".msh.gz"})
        if (const auto file = samples / name / (name + suffix); std::filesystem::exists(file)) return file;
    throw InvalidInput(fmt::format("The mesh of '{0}' is missing; make it with {1}/generate.py {0} (needs Gmsh).", name,
                                   samples.string()));
}

}  // namespace curvewright::benchmarks
