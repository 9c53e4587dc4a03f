#pragma once

#include <filesystem>
#include <string>

namespace curvewright::benchmarks {

/// The mesh of a sample, compressed or not. Throws InvalidInput that says how to make it if it is not there.
std::filesystem::path sample_mesh_file(const std::filesystem::path& samples, const std::string& name);

}  // namespace curvewright::benchmarks
