#pragma once

#include <memory>

#include <Eigen/Core>

#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// Node coordinates, nodes × 3 (x, y, z), row-major, in the file's unit of length. 2D meshes lie in a plane of constant
/// z.
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A mesh of curved elements: a value that is cheap to copy but for its coordinates. Nothing but the coordinates
/// changes after reading, so a state of the mesh is a coordinate array.
class CurvedMesh {
  public:
    /// Throws InvalidInput if the coordinates are not one finite row per node.
    CurvedMesh(std::shared_ptr<const MeshTopology> topology, Coordinates coordinates);

    const MeshTopology& topology() const { return *topology_; }
    const std::shared_ptr<const MeshTopology>& shared_topology() const { return topology_; }
    const Coordinates& coordinates() const { return coordinates_; }
    /// The same mesh with its nodes elsewhere. Throws like the constructor.
    CurvedMesh with_coordinates(Coordinates coordinates) const { return {topology_, std::move(coordinates)}; }

    /// The positions of an element's nodes: node_count × 3, in this program's order.
    Eigen::MatrixX3d element_coordinates(Index element) const;
    /// Mean of the element's corners.
    Eigen::RowVector3d element_center(Index element) const;

  private:
    std::shared_ptr<const MeshTopology> topology_;
    Coordinates coordinates_;
};

/// Smallest box around all nodes that elements use; rows min and max. Zero for a mesh without elements.
Eigen::Matrix<double, 2, 3> bounding_box(const CurvedMesh& mesh);

}  // namespace curvewright
