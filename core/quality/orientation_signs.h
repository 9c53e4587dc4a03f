#pragma once

#include <memory>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// The signs that the Jacobian determinants J of a mesh's elements are multiplied with, so that J > 0 is expected of
/// all of them. Every part of the mesh (see Winding) has its own, because parts that do not meet may be numbered in
/// opposite senses; within a part, reversed elements have the other sign. Cheap to copy; belongs to the connectivity,
/// so that it serves for everything that becomes of the mesh.
class OrientationSigns {
  public:
    /// The same sign, +1 or -1, for all parts.
    OrientationSigns(double sign = 1.0) : sign_(sign) {}
    /// Per element the sign of its part.
    explicit OrientationSigns(std::vector<signed char> of_parts);

    /// Sign of J of an element once it is numbered like most of its part: what belongs to numbered_alike(mesh).
    double of_part(Index element) const { return signs_ ? (*signs_)[static_cast<std::size_t>(element)] : sign_; }
    /// Sign of J of an element as it is numbered.
    double of_element(const MeshTopology& topology, Index element) const {
        return topology.is_reversed(element) ? -of_part(element) : of_part(element);
    }
    /// Whether not all parts have the same.
    bool is_mixed() const { return signs_ != nullptr; }

    friend bool operator==(const OrientationSigns& a, const OrientationSigns& b) {
        return a.signs_ && b.signs_ ? *a.signs_ == *b.signs_ : !a.signs_ && !b.signs_ && a.sign_ == b.sign_;
    }

  private:
    double sign_;
    std::shared_ptr<const std::vector<signed char>> signs_;  ///< none if all are sign_
};

/// The signs of a mesh: a part has the sign of the volume or area of its straight-sided elements, reversed ones counted
/// as if they were renumbered. An element that meets no other in a facet has no majority to belong to, and one that
/// touches others at nodes may be inside out there: it takes the sign of all that hangs together by nodes. Throws like
/// require_assessable.
OrientationSigns orientation_signs(const CurvedMesh& mesh);

}  // namespace curvewright
