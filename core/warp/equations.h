#pragma once

#include <vector>

#include "core/base/task.h"
#include "core/linear/linear_solver.h"
#include "core/mesh/curved_mesh.h"
#include "core/warp/neighbours.h"
#include "core/warp/weights.h"

namespace curvewright {

/// How the nodes of a mesh are numbered in the equations of a warp: the unknowns that are solved for, then those that
/// are condensed (element by element), then the nodes whose motion is given.
struct Numbering {
    std::vector<Index> nodes;          ///< by number
    std::vector<Index> number_of;      ///< per node of the mesh; -1 for a node of no element
    Index solved = 0;                  ///< numbers [0, solved)
    Index free = 0;                    ///< numbers [solved, free) are condensed, the rest is given
    std::vector<Index> group_offsets;  ///< numbers of the first condensed node of each element, then free
    SweepOrder sweep;                  ///< pieces of solved nodes that share no element can be swept together

    Index given() const { return static_cast<Index>(nodes.size()) - free; }
    /// The free nodes in the order of their numbers.
    std::vector<Index> free_nodes() const { return {nodes.begin(), nodes.begin() + free}; }
};

/// is_given: per node. condense: whether nodes inside elements are set apart. Solved nodes are ordered along a
/// space-filling curve, so that what is close in space is close in memory; the curve is cut into pieces, and pieces
/// that share no element are gathered into stages of a sweep.
Numbering number_nodes(const CurvedMesh& mesh, const std::vector<bool>& is_given, bool condense);

/// The equations of all free nodes: rows = free, columns = all numbers; the diagonal is stored.
/// Weights: u_i - sum_j w_ij u_j = 0. sets.centers must be numbering.free_nodes().
BlockMatrix weight_equations(const Numbering& numbering, const NeighbourSets& sets, const WeightTable& table,
                             const TaskContext& context = {});

/// The equations after condensation, ready to be solved, and the way back.
struct CondensedEquations {
    BlockMatrix matrix;    ///< solved × solved
    BlockMatrix coupling;  ///< solved × given: what the motion of given nodes contributes, matrix u + coupling g = 0

    /// Displacement of the condensed nodes of one element: -factors × (that of the element's other nodes).
    struct Group {
        std::vector<Index> columns;  ///< numbers of the other nodes
        MultiVector factors;         ///< (condensed nodes · block) × (columns · block)
    };
    std::vector<Group> groups;
};

/// Eliminates the condensed nodes by static condensation: one small dense factorisation per element. Consumes the
/// equations. Multi-threaded. Throws SolverFailure when an element's block is singular, Cancelled.
CondensedEquations condense(const Numbering& numbering, BlockMatrix equations, const TaskContext& context = {});

/// The linear functions on the vertices of the solved nodes: coarse space of a multilevel solver. The near-null vectors
/// are constants for block 1 and rigid motions otherwise. row_scale is left empty.
CoarseSpace vertex_space(const CurvedMesh& mesh, const Numbering& numbering, int block);

}  // namespace curvewright
