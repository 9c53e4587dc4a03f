#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/mesh/curved_mesh.h"
#include "core/untangle/node_rules.h"

namespace curvewright {

/// How the nodes inside a curved triangle follow from those on its edges.
enum class FaceRule {
    mean,   ///< the mean of the triangle's high-order edge nodes (thesis, Alg. 6, second pass); all nodes at one point
    blend,  ///< the edges' curves blended into the triangle, see FaceNodes
};

/// Places the nodes inside a curved triangle by a fixed affine combination of the nodes on its edges.
///
/// The blend adds to the straight triangle the extension of every edge's deviation from its chord. On the edge from
/// corner a to b the deviation is s (1 - s) g(s) with a polynomial g of degree order - 2; it is extended by
/// l_a l_b g((1 + l_b - l_a) / 2), l the barycentric coordinates (Szabó, Babuška, "Finite element analysis", 1991,
/// 6.2: edge modes of the triangle). The result has degree `order`, agrees with the three edges and is what it should
/// be if the element is affine or quadratic.
class FaceNodes {
  public:
    /// order: 1..max_order; with less than 3 there are no face nodes. The mean is for order 3 only, where there is one
    /// face node; throws std::invalid_argument for higher orders.
    FaceNodes(int order, FaceRule rule);

    /// Positions in the element of the nodes that place() moves.
    const std::vector<int>& local_nodes() const { return *local_nodes_; }
    /// nodes: the triangle's. Writes x and y of its face nodes, but for those that are kept (null: none is).
    void place(std::span<const Index> nodes, Coordinates& x, const KeptNodes* kept = nullptr) const;

  private:
    const std::vector<int>* local_nodes_;
    Eigen::MatrixXd weights_;  ///< face nodes × nodes; a row sums to 1, the columns of face nodes are 0
};

}  // namespace curvewright
