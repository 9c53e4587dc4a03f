#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ids.h"

namespace curvewright::benchmarks {

/// What another program made of an example.
struct PeerResult {
    std::string sample;
    Index elements = 0;  ///< of the mesh it was run on
    std::string program, setting;
    double least = 0.0, mean = 0.0;
    std::optional<double> largest;
    Index not_valid = 0;
    double seconds = 0.0;

    std::string name() const { return program + ", " + setting; }
};

/// The file peers.csv, which says where its numbers come from.
class Peers {
  public:
    /// Throws InvalidInput that names the file and the line.
    explicit Peers(const std::filesystem::path& file);

    /// The result with the highest minimum among those without invalid elements, the quickest of them, and one by its
    /// setting; none if there is none.
    const PeerResult* best(const std::string& sample) const;
    const PeerResult* quickest(const std::string& sample) const;
    const PeerResult* find(const std::string& sample, const std::string& setting) const;

  private:
    std::vector<PeerResult> results_;
};

}  // namespace curvewright::benchmarks
