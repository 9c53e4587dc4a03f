#pragma once

#include <optional>
#include <string>

#include "app/cli/output.h"
#include "core/quality/global_validity.h"

namespace curvewright::cli {

/// Whether the mesh is valid as a whole, and the same sentence for everybody who asks. Timed as "global".
class GlobalCheck {
  public:
    /// known: what was found about the boundary that the mesh still has; null: to be found. Notes why the answer is not
    /// yes, unless that is said of the elements anyway.
    GlobalCheck(const CurvedMesh& mesh, const QualityReport& quality, Work& work,
                const BoundaryEmbedding* known = nullptr);

    const GlobalValidityReport& report() const { return report_; }
    /// Adds "globally_valid", "globally_valid_reason", "crossing_facets" and "crossing_facet_pairs".
    void add_to(Json& json, const CurvedMesh& mesh) const;
    /// "globally valid: yes".
    std::string line() const;
    /// exit_not_valid where the answer is no, exit_done otherwise.
    int status() const;
    /// The same, of the boundary alone: whatever is inside, a mesh with this boundary cannot be valid.
    int boundary_status() const;

  private:
    GlobalValidityReport report_;
};

/// GlobalCheck of a mesh; none if its quality is not assessed.
std::optional<GlobalCheck> check_globally(const CurvedMesh& mesh, const Assessment& quality, Work& work);

}  // namespace curvewright::cli
