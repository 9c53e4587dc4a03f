#include "benchmarks/thesis/manifest.h"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace curvewright::benchmarks {

double manifest_beta(const std::filesystem::path& samples, const std::string& name) {
    std::ifstream stream(samples / "MANIFEST");
    const auto manifest = nlohmann::json::parse(stream, nullptr, false);
    if (!manifest.is_discarded())
        for (const auto& sample : manifest.at("samples"))
            if (sample.at("name") == name && sample.contains("beta")) return sample.at("beta").get<double>();
    throw InvalidInput(fmt::format("{} has no beta for '{}'.", (samples / "MANIFEST").string(), name));
}

}  // namespace curvewright::benchmarks
