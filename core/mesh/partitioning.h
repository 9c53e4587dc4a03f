#pragma once

#include <utility>
#include <vector>

#include "core/base/ids.h"

namespace curvewright {

/// The parts of a partitioned mesh that an element belongs to, as MSH 2 tells it, element by element.
struct ElementPartitions {
    int dimension = 0;  ///< of the element; its tag is unique among those of its dimension
    ElementTag tag;
    /// From 1; negative: the element is a ghost cell of that part.
    std::vector<int> partitions;
};

/// An element that other parts know as a ghost cell, as MSH 4 tells it ("$GhostElements").
struct GhostElement {
    ElementTag tag;  ///< of an element of the mesh's dimension
    int partition = 0;
    std::vector<int> ghost_partitions;
};

/// What a file says about the partitions of its mesh besides the parts' entities (Entity::partitions). Nothing here
/// computes with it: it is kept, and written again.
struct Partitioning {
    int count = 0;  ///< number of partitions that the file announces
    /// Tag of an entity of the mesh's dimension that stands for the ghost cells of a partition, and that partition.
    std::vector<std::pair<int, int>> ghost_entities;
    std::vector<GhostElement> ghost_elements;
    std::vector<ElementPartitions> element_partitions;

    bool is_empty() const {
        return count == 0 && ghost_entities.empty() && ghost_elements.empty() && element_partitions.empty();
    }
};

}  // namespace curvewright
