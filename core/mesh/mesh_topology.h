#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/base/ids.h"
#include "core/basis/element_type.h"
#include "core/mesh/partitioning.h"
#include "core/mesh/periodic.h"
#include "core/mesh/winding.h"

namespace curvewright {

/// A geometric entity of the file (MSH "entity"): point, curve, surface or volume that elements and nodes lie on.
struct Entity {
    int dimension = 0;
    int tag = 0;
    /// Tags of the physical groups (of the same dimension) that the entity belongs to.
    std::vector<int> physical_tags;
    /// min x, y, z, max x, y, z as the file has it; a point has its position twice.
    std::array<double, 6> bounding_box{};
    /// Signed tags of the entities of dimension - 1 that bound it.
    std::vector<int> bounding_entities;
    /// Of a part of an entity of a partitioned mesh (MSH 4): the entity that it is a part of, and the partitions it
    /// belongs to. A border between partitions has a parent of higher dimension. Empty: no part of another entity.
    std::vector<int> partitions{};
    int parent_dimension = -1;
    int parent_tag = 0;

    bool is_partition() const { return !partitions.empty(); }
    /// Whether it was cut out of an entity of higher dimension, between partitions: no geometry.
    bool is_partition_border() const { return is_partition() && parent_dimension > dimension; }
};

/// A named set of entities of one dimension (MSH "physical group"). The name may be empty.
struct PhysicalGroup {
    int dimension = 0;
    int tag = 0;
    std::string name;
};

/// Elements of one type on one entity, in the order of the file.
struct ElementBlock {
    ElementType type;
    /// Entity of dimension(type.shape); 0 = none.
    int entity_tag = 0;
    /// count × node_count(type), row-major: positions of the nodes, in this program's (VTK's) order.
    std::vector<Index> nodes;
    /// count
    std::vector<ElementTag> tags;

    Index size() const { return static_cast<Index>(tags.size()); }
};

/// The entity that a node was classified on.
struct NodeEntity {
    int dimension = -1;  ///< -1: the file does not say
    int tag = 0;
    friend bool operator==(const NodeEntity&, const NodeEntity&) = default;
};

/// Everything of a mesh but its coordinates, as a reader gathers it.
struct MeshData {
    std::vector<NodeTag> node_tags;
    /// Empty, or one per node.
    std::vector<NodeEntity> node_entities;
    std::vector<ElementBlock> blocks;
    std::vector<Entity> entities;
    std::vector<PhysicalGroup> groups;
    /// Entities whose nodes correspond; what it means is up to who reads it.
    std::vector<PeriodicLink> periodic{};
    Partitioning partitioning{};
};

/// A facet (edge in 2D, face in 3D) of an element.
struct Facet {
    Index element = 0;
    int local = 0;  ///< position in reference_element(type).facets
};

/// Connectivity, tags and groups of a mesh: immutable, shared by all states of the same mesh.
///
/// "Elements" are the cells of the highest dimension present (the mesh's dimension), numbered from 0 in the order of
/// the blocks. Cells of lower dimension (boundary lines, corner points) are kept in blocks() and give groups their
/// nodes.
class MeshTopology {
  public:
    /// Checks the data: node positions in range, tags unique, no element twice the same node, entities unique,
    /// periodic nodes in range.
    /// Throws InvalidInput with the tag of the offending thing; no file name (the reader adds it).
    explicit MeshTopology(MeshData data);

    const std::vector<ElementBlock>& blocks() const { return data_.blocks; }
    const std::vector<Entity>& entities() const { return data_.entities; }
    const std::vector<PhysicalGroup>& groups() const { return data_.groups; }
    const MeshData& data() const { return data_; }

    Index node_count() const { return static_cast<Index>(data_.node_tags.size()); }
    NodeTag node_tag(Index node) const { return data_.node_tags[node]; }
    std::optional<Index> find_node(NodeTag tag) const;

    /// Dimension of the elements: 1, 2 or 3; 0 for a mesh without cells.
    int dimension() const { return dimension_; }
    Index element_count() const { return static_cast<Index>(element_block_.size()); }
    ElementType element_type(Index element) const { return data_.blocks[element_block_[element]].type; }
    ElementTag element_tag(Index element) const;
    /// The element's nodes in this program's order.
    std::span<const Index> element_nodes(Index element) const;
    /// Entity (of the mesh's dimension) that the element lies on; 0 = none.
    int element_entity(Index element) const { return data_.blocks[element_block_[element]].entity_tag; }
    std::optional<Index> find_element(ElementTag tag) const;
    /// Highest order of the elements; 1 for an empty mesh.
    int order() const { return order_; }
    /// The type that all elements share; none if the mesh mixes types or is empty.
    std::optional<ElementType> uniform_type() const { return uniform_type_; }

    /// Whether the element is numbered against the majority of its part of the mesh, see Winding. Its facets and its J
    /// have the other sign then, whatever the coordinates; nothing is wrong with it.
    bool is_reversed(Index element) const { return winding_.reversed_count > 0 && winding_.is_reversed[element]; }
    Index reversed_count() const { return winding_.reversed_count; }
    const Winding& winding() const { return winding_; }

    /// Facets that belong to one element only (all of their nodes, not the corners alone), in the order of the
    /// elements.
    const std::vector<Facet>& boundary_facets() const { return boundary_facets_; }
    /// Positions (in the element) to nodes: the facet's nodes in its own order.
    std::vector<Index> facet_nodes(Facet facet) const;
    bool is_boundary_node(Index node) const { return role_[node] == Role::boundary; }
    bool is_interior_node(Index node) const { return role_[node] == Role::interior; }
    /// Ascending. Boundary nodes lie on a boundary facet; interior nodes are an element's other nodes. Nodes of no
    /// element are neither.
    const std::vector<Index>& boundary_nodes() const { return boundary_nodes_; }
    const std::vector<Index>& interior_nodes() const { return interior_nodes_; }

    /// Facets inside the domain that are geometry all the same: those whose elements on the two sides are in different
    /// physical groups, and those on which the file has a cell (an element of a curve or surface). One of the pair (or
    /// more) of coinciding facets each, that of the lowest element, in the order of the elements. Borders between
    /// partitions are none.
    const std::vector<Facet>& interface_facets() const { return interface_facets_; }
    /// Per interface facet: the element on its other side (the lowest, if there are several).
    const std::vector<Index>& interface_neighbours() const { return interface_neighbours_; }
    /// Nodes inside the domain that are geometry: those of interface facets, and those of the cells of still lower
    /// dimension (curves in 3D, points) that a physical group names. They are interior nodes, too.
    bool is_interface_node(Index node) const { return is_interface_node_[node] != 0; }
    /// Ascending.
    const std::vector<Index>& interface_nodes() const { return interface_nodes_; }

    /// Nodes of the cells of every group of that name, ascending. "boundary" and "all_boundary" stand for all boundary
    /// nodes and "all" for all nodes, unless the file has a group of that name. None if there is no such group.
    std::optional<std::vector<Index>> find_group_nodes(std::string_view name) const;
    /// Name of a group for people: its name, or "dimension:tag" if it has none.
    static std::string display_name(const PhysicalGroup& group);

  private:
    enum class Role : char { unused, interior, boundary };
    /// A facet's sorted corner nodes (unused places -1): the key by which the elements on its two sides meet.
    struct FacetKey {
        std::array<Index, 4> corners;
        Facet facet;
    };

    void check_nodes_and_blocks();
    void number_elements();
    std::vector<FacetKey> facet_keys() const;
    /// The boundary, and how the elements that meet in the other facets are numbered against each other.
    void find_boundary(const std::vector<FacetKey>& keys);
    void find_interfaces(const std::vector<FacetKey>& keys);
    std::optional<bool> are_numbered_alike(Facet a, Facet b) const;

    MeshData data_;
    std::unordered_map<NodeTag, Index> node_of_tag_;
    std::unordered_map<ElementTag, Index> element_of_tag_;
    int dimension_ = 0;
    int order_ = 1;
    std::optional<ElementType> uniform_type_;
    std::vector<Index> element_block_;     ///< per element: its block
    std::vector<Index> element_in_block_;  ///< per element: its position in the block
    Winding winding_;
    std::vector<Facet> boundary_facets_;
    std::vector<Role> role_;
    std::vector<Index> boundary_nodes_, interior_nodes_;
    std::vector<Facet> interface_facets_;
    std::vector<Index> interface_neighbours_;
    std::vector<char> is_interface_node_;
    std::vector<Index> interface_nodes_;
};

}  // namespace curvewright
