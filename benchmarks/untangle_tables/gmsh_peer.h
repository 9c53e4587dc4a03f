#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmarks/untangle_tables/cases.h"

namespace curvewright::benchmarks {

/// A run of one of Gmsh's optimizers of high-order meshes.
struct PeerRun {
    std::string method;
    double seconds = 0.0;  ///< of the optimizer alone
    Judgement judgement;   ///< by our certificates
};

/// Gmsh's optimizers through its Python module, each run in a process of its own, with one thread (they have no more).
class GmshPeer {
  public:
    explicit GmshPeer(const Settings& settings);

    bool is_available() const { return is_available_; }
    /// Settings for the untangling cases: see gmsh_peer.py.
    static const std::vector<std::string>& methods();
    /// None if the peer fails or takes more than the limit.
    std::optional<PeerRun> run(const UntangleCase& problem, const std::string& method) const;

  private:
    std::string python_, script_;
    double limit_ = 0.0;
    bool is_available_ = false;
};

}  // namespace curvewright::benchmarks
