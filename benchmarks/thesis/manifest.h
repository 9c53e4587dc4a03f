#pragma once

#include <filesystem>
#include <string>

namespace curvewright::benchmarks {

/// The beta that MANIFEST gives for a sample of chapter 4: the one that suits the remade mesh's unit of length. Throws
/// InvalidInput if there is none.
double manifest_beta(const std::filesystem::path& samples, const std::string& name);

}  // namespace curvewright::benchmarks
