#include "tests/support/region_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/base/error.h"
#include "core/basis/reference_element.h"
#include "core/quality/element_size.h"

namespace curvewright::testing {
namespace {

constexpr int near_tag = 901, far_tag = 902, interface_tag = 903;

CurvedMesh assembled(MeshData data, const Coordinates& x) {
    return {std::make_shared<const MeshTopology>(std::move(data)), x};
}

std::int64_t highest_tag(const MeshData& data) {
    std::int64_t highest = 0;
    for (const ElementBlock& block : data.blocks)
        for (const ElementTag tag : block.tags) highest = std::max(highest, tag.value);
    return highest;
}

/// A facet between near and far, by its sorted nodes, and the type of it.
struct Shared {
    ElementType type;
    std::vector<Index> nodes;
    bool is_near = false, is_far = false;
};

std::map<std::vector<Index>, Shared> shared_facets(const MeshTopology& topology,
                                                   const std::function<bool(Index)>& is_near) {
    std::map<std::vector<Index>, Shared> facets;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto& local = reference_element(topology.element_type(element)).facets;
        for (int f = 0; f < static_cast<int>(local.size()); ++f) {
            const std::vector<Index> nodes = topology.facet_nodes({element, f});
            std::vector<Index> key = nodes;
            std::sort(key.begin(), key.end());
            Shared& shared = facets[key];
            shared.type = local[static_cast<std::size_t>(f)].type;
            shared.nodes = nodes;
            (is_near(element) ? shared.is_near : shared.is_far) = true;
        }
    }
    return facets;
}

}  // namespace

CurvedMesh with_regions(const CurvedMesh& mesh, InterfaceCells cells) {
    return with_regions(mesh, cells, [&mesh](Index element) { return mesh.element_center(element)[0] < 0.5; });
}

CurvedMesh with_regions(const CurvedMesh& mesh, InterfaceCells cells, const std::function<bool(Index)>& is_near) {
    const MeshTopology& topology = mesh.topology();
    const int dim = topology.dimension();
    MeshData data = topology.data();
    std::vector<ElementBlock> blocks;
    Index element = 0;
    for (const ElementBlock& block : data.blocks) {
        if (dimension(block.type.shape) != dim) {
            blocks.push_back(block);
            continue;
        }
        std::array<ElementBlock, 2> parts{ElementBlock{block.type, near_tag, {}, {}},
                                          ElementBlock{block.type, far_tag, {}, {}}};
        for (const ElementTag tag : block.tags) {
            ElementBlock& part = parts[is_near(element) ? 0 : 1];
            const auto nodes = topology.element_nodes(element++);
            part.tags.push_back(tag);
            part.nodes.insert(part.nodes.end(), nodes.begin(), nodes.end());
        }
        for (ElementBlock& part : parts)
            if (!part.tags.empty()) blocks.push_back(std::move(part));
    }
    data.entities.push_back({dim, near_tag, {near_tag}, {}, {}});
    data.entities.push_back({dim, far_tag, {far_tag}, {}, {}});
    data.groups.push_back({dim, near_tag, "near"});
    data.groups.push_back({dim, far_tag, "far"});
    if (cells != InterfaceCells::none) {
        data.entities.push_back({dim - 1, interface_tag, {}, {}, {}});
        if (cells == InterfaceCells::named) {
            data.entities.back().physical_tags = {interface_tag};
            data.groups.push_back({dim - 1, interface_tag, "interface"});
        }
        std::int64_t next = highest_tag(data) + 1;
        for (const auto& [key, shared] : shared_facets(topology, is_near)) {
            if (!shared.is_near || !shared.is_far) continue;
            blocks.push_back({shared.type, interface_tag, shared.nodes, {{next++}}});
        }
    }
    data.blocks = std::move(blocks);
    return assembled(std::move(data), mesh.coordinates());
}

CurvedMesh with_named_cell(const CurvedMesh& mesh, ElementType type, const std::vector<Index>& nodes,
                           const std::string& group) {
    constexpr int tag = 904;
    MeshData data = mesh.topology().data();
    data.entities.push_back({dimension(type.shape), tag, {tag}, {}, {}});
    data.groups.push_back({dimension(type.shape), tag, group});
    const std::int64_t next = highest_tag(data) + 1;
    data.blocks.push_back({type, tag, nodes, {{next}}});
    return assembled(std::move(data), mesh.coordinates());
}

CurvedMesh with_bent_middle(const CurvedMesh& mesh, double height) {
    Coordinates x = mesh.coordinates();
    for (Eigen::Index node = 0; node < x.rows(); ++node) {
        double way = height;
        for (int d = 0; d < mesh.topology().dimension(); ++d) way *= std::sin(std::numbers::pi * x(node, d));
        if (mesh.topology().is_interior_node(static_cast<Index>(node))) x(node, 0) += way;
    }
    return mesh.with_coordinates(std::move(x));
}

double size_of_group(const CurvedMesh& mesh, const std::string& group) {
    const MeshTopology& topology = mesh.topology();
    const std::vector<double> sizes = element_sizes(mesh);
    double size = 0.0;
    for (const PhysicalGroup& one : topology.groups()) {
        if (one.name != group || one.dimension != topology.dimension()) continue;
        for (const Entity& entity : topology.entities()) {
            const auto& tags = entity.physical_tags;
            if (entity.dimension != one.dimension || std::find(tags.begin(), tags.end(), one.tag) == tags.end())
                continue;
            for (Index element = 0; element < topology.element_count(); ++element)
                if (topology.element_entity(element) == entity.tag) size += sizes[static_cast<std::size_t>(element)];
        }
    }
    return size;
}

Index node_at(const CurvedMesh& mesh, double x, double y, double z) {
    for (Index node = 0; node < mesh.topology().node_count(); ++node)
        if ((mesh.coordinates().row(node) - Eigen::RowVector3d(x, y, z)).cwiseAbs().maxCoeff() < 1e-12) return node;
    throw InvalidInput("There is no node at that place.");
}

}  // namespace curvewright::testing
