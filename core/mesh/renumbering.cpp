#include "core/mesh/renumbering.h"

#include "core/basis/reference_element.h"

namespace curvewright {

CurvedMesh renumbered(const CurvedMesh& mesh, const std::function<bool(Index element)>& is_to_be) {
    const MeshTopology& topology = mesh.topology();
    std::optional<MeshData> data;
    Index element = 0;
    for (std::size_t b = 0; b < topology.blocks().size(); ++b) {
        const ElementBlock& block = topology.blocks()[b];
        const int dim = dimension(block.type.shape);
        if (dim != topology.dimension() || dim == 0) continue;
        const std::vector<int>& mirrored = reference_element(block.type).mirrored;
        for (std::size_t first = 0; first < block.nodes.size(); first += mirrored.size(), ++element) {
            if (!is_to_be(element)) continue;
            if (!data) data = topology.data();
            for (std::size_t i = 0; i < mirrored.size(); ++i)
                data->blocks[b].nodes[first + i] = block.nodes[first + static_cast<std::size_t>(mirrored[i])];
        }
    }
    if (!data) return mesh;
    return {std::make_shared<const MeshTopology>(std::move(*data)), mesh.coordinates()};
}

CurvedMesh numbered_alike(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    if (topology.reversed_count() == 0) return mesh;
    return renumbered(mesh, [&](Index element) { return topology.is_reversed(element); });
}

}  // namespace curvewright
