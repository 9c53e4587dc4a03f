#pragma once

#include <functional>
#include <optional>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// The same mesh with some elements numbered the other way round (ReferenceElement::mirrored): tags, entities, groups,
/// the order of the elements and nodes, and the cells of lower dimension stay. The mesh itself if there are none.
CurvedMesh renumbered(const CurvedMesh& mesh, const std::function<bool(Index element)>& is_to_be);

/// The same mesh with its reversed elements (see Winding) renumbered, so that there are none: what a mesh is worked on
/// as. Nodes and elements have the numbers that they had; local numbers in an element that was reversed are others. The
/// mesh itself, topology shared, if nothing is reversed.
CurvedMesh numbered_alike(const CurvedMesh& mesh);

/// numbered_alike without a copy of a mesh that is so already. mesh: must outlive this object.
class NumberedAlike {
  public:
    explicit NumberedAlike(const CurvedMesh& mesh) : mesh_(mesh) {
        if (mesh.topology().reversed_count() > 0) alike_ = numbered_alike(mesh);
    }
    const CurvedMesh& mesh() const { return alike_ ? *alike_ : mesh_; }
    /// The mesh as it was given.
    const CurvedMesh& given() const { return mesh_; }

  private:
    const CurvedMesh& mesh_;
    std::optional<CurvedMesh> alike_;
};

}  // namespace curvewright
