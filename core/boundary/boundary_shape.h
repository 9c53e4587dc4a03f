#pragma once

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "core/boundary/boundary_piece.h"
#include "core/boundary/boundary_rules.h"
#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// A place on the boundary as it was read.
struct Foot {
    int piece = -1;
    Closest closest;
};

/// The boundary of a mesh and the interfaces inside it as they were read, cut at their features into smooth parts, and
/// what their nodes may do there. Below, "boundary" means both.
///
/// Features. 2D: facets that meet at more than the feature angle, facets of different entity or mode, and the points
/// that the file calls points, are corners, and so are those where other than two facets meet. 3D: facets meet in a
/// feature edge where their normals turn by more than the angle, where they are of different entity or mode, and along
/// curves that a group names; a node is a corner where such edges meet but for two that go on in each other's
/// direction, and at points of the file. Tangents and normals are compared by the side to which the straight-sided
/// facet turns, so that a facet that folds back on itself is no feature.
class BoundaryShape {
  public:
    /// Throws like resolve.
    BoundaryShape(const CurvedMesh& mesh, const BoundaryRules& rules);

    /// Whether a node may move: interior nodes on no interface, free ones, and sliding ones that are not corners.
    bool may_move(Index node) const { return freedom_[node] > 0; }
    /// Directions a sliding node has: 1 along a curve, 2 on a surface; 0 for nodes that do not slide.
    int sliding_directions(Index node) const { return slides(node) ? freedom_[node] : 0; }
    bool slides(Index node) const { return feet_[node].piece >= 0; }
    /// Where a sliding node was read.
    const Foot& foot(Index node) const { return feet_[node]; }
    Index sliding_nodes() const { return sliding_nodes_; }
    Index free_nodes() const { return free_nodes_; }

    /// The closest point of the smooth part that the start lies on, found by going downhill from there: on to the
    /// neighbouring piece wherever a piece's edge holds the point.
    Foot project(const Eigen::Vector3d& y, const Foot& start) const;
    Eigen::Vector3d position(const Foot& foot) const { return pieces_[foot.piece].evaluate(foot.closest.at).value; }
    /// Derivative of project's position by y.
    Eigen::Matrix3d derivative(const Eigen::Vector3d& y, const Foot& foot) const {
        return pieces_[foot.piece].closest_derivative(y, foot.closest);
    }
    /// Orthonormal tangents, one column per direction; none where the boundary has no tangent.
    Eigen::Matrix<double, 3, Eigen::Dynamic> tangents(const Foot& foot) const;

    /// Largest distance of the boundary of the same mesh with other coordinates from this one, sampled on a lattice of
    /// each facet that moved; an upper bound of what the samples have. Mesh units.
    double largest_distance(const Coordinates& x) const;

  private:
    void add_surfaces(const CurvedMesh& mesh, const std::vector<Facet>& facets, const BoundaryModes& modes);
    void add_curves(const std::vector<std::vector<Index>>& lines, const std::vector<std::array<int, 2>>& labels,
                    const CurvedMesh& mesh, const BoundaryModes& modes);
    int add_piece(ElementType type, const std::vector<Index>& nodes, const Coordinates& x);
    /// Makes neighbours of the pieces from first on that belong to the same part and share a corner.
    void connect(int first, const std::vector<int>& parts, const std::vector<char>& is_corner);

    std::shared_ptr<const MeshTopology> topology_;
    std::size_t facet_count_ = 0;  ///< of the boundary and of interfaces; they are the first pieces
    Coordinates x_;                ///< as read
    double cosine_;                ///< of the feature angle
    std::vector<BoundaryPiece> pieces_;
    std::vector<std::vector<Index>> piece_nodes_;
    std::vector<std::vector<int>> neighbours_;
    std::vector<char> is_point_;  ///< per node: the file has a point there
    std::vector<int> freedom_;    ///< per node: directions
    std::vector<Foot> feet_;      ///< per node
    Index sliding_nodes_ = 0, free_nodes_ = 0;
};

}  // namespace curvewright
