#pragma once

#include <vector>

#include "core/boundary/boundary_shape.h"
#include "core/quality/quality.h"
#include "core/untangle/distortion.h"
#include "core/untangle/standing.h"

namespace curvewright {

/// The positions of all nodes, the places of the sliding ones on the boundary, and the qualities of all elements:
/// what untangling changes.
struct MeshState {
    Coordinates coordinates;
    std::vector<Foot> feet;  ///< per node; empty if none slides
    std::vector<ElementQuality> qualities;
};

/// The best state of a patch that has been seen, beginning with the one it has.
class BestOfPatch {
  public:
    BestOfPatch(const FreePatch& patch, const MeshState& state);
    /// Takes the patch's part of the positions if it stands better, and says so. feet: of the patch's sliding nodes.
    bool offer(const Coordinates& x, const std::vector<Foot>& feet, std::vector<ElementQuality> qualities);
    /// Takes the patch's part of the positions whatever it was before.
    void take(const Coordinates& x, const std::vector<Foot>& feet, std::vector<ElementQuality> qualities);
    /// Makes the best state the present one.
    void restore(MeshState& state) const;
    const Standing& standing() const { return standing_; }

  private:
    const FreePatch* patch_;
    std::vector<ElementQuality> qualities_;
    Standing standing_;
    Coordinates positions_;
    std::vector<Foot> feet_;
};

/// Positions of some nodes, one row each; feet of those of them that slide.
Coordinates positions_of(const std::vector<Index>& nodes, const Coordinates& x);
/// Feet of those of the nodes that slide; empty if there are none at all.
std::vector<Foot> feet_of(const std::vector<Index>& nodes, const std::vector<Foot>& feet);

/// Worst mean ratio of a patch's elements against the straight-sided elements of the ideal (see assess_shape).
class PatchShape {
  public:
    PatchShape(const MeshTopology& topology, const std::vector<Index>& elements, const Coordinates& ideal);
    double worst(const Coordinates& x) const;

  private:
    std::vector<Index> nodes_;  ///< of the whole mesh
    CurvedMesh ideal_;          ///< the patch's elements as a mesh of these nodes
};

}  // namespace curvewright
