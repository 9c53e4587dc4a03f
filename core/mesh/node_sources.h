#pragma once

#include <string>
#include <vector>

#include "core/mesh/field_array.h"

namespace curvewright {

/// Where the nodes of a mesh come from that was made of another one: a sparse matrix, new nodes × old nodes, compressed
/// by rows. The value of a function at a new node is sum weights · (values at old nodes). A node that was taken over as
/// it is has one entry of weight 1.
struct NodeSources {
    std::vector<std::size_t> offsets{0};  ///< new nodes + 1
    std::vector<Index> nodes;             ///< positions in the old mesh
    std::vector<double> weights;

    std::size_t size() const { return offsets.size() - 1; }
    /// Appends a row of one entry of weight 1.
    void add_copy(Index old_node);
};

/// An array on the old nodes as one on the new nodes. Numbers are interpolated by the weights. Integers are labels as
/// often as numbers, so they are not averaged: a new node takes those of the old node that has the largest weight (of
/// several the first). pre: field.place is nodes, its size is that of the old mesh.
FieldArray carried_over(const FieldArray& field, const NodeSources& sources);

/// All arrays of a file for the new mesh: those on nodes carried over, those on elements as they are.
std::vector<FieldArray> carried_over(const std::vector<FieldArray>& fields, const NodeSources& sources);

}  // namespace curvewright
