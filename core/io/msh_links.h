#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/task.h"
#include "core/io/msh_scanner.h"
#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// Gathers the sections $Periodic of an MSH file, wherever they stand, until the nodes are known.
class MshPeriodic {
  public:
    /// Reads a section up to its $End. Throws InvalidInput with file and line.
    void read(MshScanner& in, double version, const TaskContext& context);
    /// Puts the links into data.periodic. find: position of a node tag, -1 = none. Pairs of nodes that the file does
    /// not have are passed over, of which a note tells.
    void attach(MeshData& data, const std::function<Index(std::int64_t)>& find, std::vector<std::string>& notes);

  private:
    struct Section {
        PeriodicLink link;  ///< without nodes
        std::vector<std::pair<std::int64_t, std::int64_t>> tags;
    };
    std::vector<Section> sections_;
};

/// What stands at the beginning of $PartitionedEntities: partitions and ghost entities.
void read_partition_head(MshScanner& in, Partitioning& partitioning);
/// What stands before the box of an entity there: its parent and partitions.
void read_entity_parent(MshScanner& in, Entity& entity);
/// Reads the section $GhostElements up to its $End.
void read_ghost_elements(MshScanner& in, Partitioning& partitioning, const TaskContext& context);
/// Reads what follows the first two tags of an element of MSH 2: number of partitions and partitions. count: of tags.
std::vector<int> read_element_partitions(MshScanner& in, std::size_t count);

/// Turns partitions that are told element by element (MSH 2) into entities that are parts of others (MSH 4): blocks are
/// cut where the partition changes, and elements that are ghost cells elsewhere become ghost elements. Elements keep
/// their order. pre: every block is on an entity that data.entities has.
void make_partition_entities(MeshData& data);

/// Partitions of the elements of a mesh as MSH 2 tells them, whichever way the mesh has them.
class PartitionsByElement {
  public:
    explicit PartitionsByElement(const MeshData& data);
    /// " 2 1 -3": how many, and which; "" for an element without partitions.
    std::string text(const ElementBlock& block, std::size_t element) const;
    /// The entity that the elements of the block are said to be on: the one that theirs is a part of.
    int elementary(const ElementBlock& block) const;

  private:
    std::map<std::pair<int, int>, const Entity*> parts_;                                         ///< by dimension, tag
    std::vector<std::pair<std::pair<int, std::int64_t>, const ElementPartitions*>> by_element_;  ///< sorted
    std::vector<std::pair<std::int64_t, const GhostElement*>> ghosts_;                           ///< sorted
    int dimension_ = 0;
};

/// $PartitionedEntities apart from the entities themselves: the two lines of its head.
std::string partition_head_text(const Partitioning& partitioning);
/// The section $GhostElements; "" if there are none.
std::string ghost_elements_text(const Partitioning& partitioning);
/// The section $Periodic of MSH 4.1 or 2.2; "" if there are no links.
std::string periodic_text(const MeshData& data, bool is_version_4);

}  // namespace curvewright
