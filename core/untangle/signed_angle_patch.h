#pragma once

#include <vector>

#include "core/quality/jacobian_bounds.h"
#include "core/untangle/edge_angles.h"
#include "core/untangle/observer.h"
#include "core/untangle/signed_angles.h"

namespace curvewright {

/// Minimum of (4.1) over one node.
struct SignedAngleMinimum {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();
    int iterations = 0;
    double objective_before = 0.0, objective_after = 0.0;
};

/// Minimises (4.1) over one node of an edge by Nelder-Mead. unit: length in which the node's displacement is measured:
/// 1, or the edge's length for the length-normalised variant. initial: where the node is; it stays there if the edge
/// has no length. Tells the observer, if there is one, every simplex; node: its index, for the observer.
SignedAngleMinimum minimise_signed_angles(const EdgeAngles& angles, const Eigen::Vector2d& initial, double unit,
                                          double beta, const SignedAngleOptions& options, UntangleObserver* observer,
                                          Index node);

/// Length in which displacements of an edge's nodes are measured.
double displacement_unit(const EdgeAngles& angles, const SignedAngleOptions& options);

/// Certified quality of the two triangles at an edge.
struct PatchQuality {
    int not_valid = 0;     ///< of the two, those that are not proved valid
    double minimum = 0.0;  ///< of the scaled Jacobian
    /// Soft minimum of the Jacobian's Bézier coefficients over the two, each relative to its straight-sided triangle.
    /// Unlike the scaled Jacobian of a tangled triangle it rises when one of several bad places gets better.
    double soft_minimum = 0.0;
};
/// Judges the two triangles at an edge. signs: of the mesh's orientation.
PatchQuality assess_patch(const MeshTopology& topology, const Coordinates& x, const EdgeNode& edge_node,
                          const OrientationSigns& signs, JacobianBounds& bounds);

/// More elements that are not proved valid, or as many and a lower minimum.
bool is_worse(const QualitySummary& after, const QualitySummary& before);

/// Batches of edge nodes, in order; those of one batch share no triangle, so they may be moved at the same time.
/// Whatever the order within the batches, the result is that of moving the nodes one after the other in the given
/// order: a node's batch comes after those of all earlier nodes with which it shares a triangle.
std::vector<std::vector<std::size_t>> batch_in_order(const std::vector<EdgeNode>& edge_nodes, Index element_count);

/// The high-order nodes of one interior edge, in the order in which they lie on it.
using EdgeNodes = std::vector<EdgeNode>;
/// All interior edges, by ascending lowest node. edge_nodes: see find_interior_edge_nodes.
std::vector<EdgeNodes> group_by_edge(const std::vector<EdgeNode>& edge_nodes);

/// Greedy colouring: edges (positions) of one colour share no triangle; at most five colours, each ascending.
std::vector<std::vector<std::size_t>> colour_edges(const std::vector<EdgeNodes>& edges, Index element_count);

/// The method with beta chosen for every edge, see BetaChoice::automatic. The arguments were checked.
UntangleResult untangle_with_chosen_beta(const CurvedMesh& mesh, const SignedAngleOptions& options,
                                         UntangleObserver* observer, const TaskContext& context);

}  // namespace curvewright
