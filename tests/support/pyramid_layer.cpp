#include "tests/support/pyramid_layer.h"

namespace curvewright::testing {

CurvedMesh pyramid_layer_mesh() {
    Coordinates x(31, 3);
    const auto id = [](int i, int j, int k) { return static_cast<Index>((k * 3 + j) * 3 + i); };
    const auto apex = [](int i, int j) { return static_cast<Index>(27 + j * 2 + i); };
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) x.row(id(i, j, k)) << i, j, k;
    ElementBlock hexahedra{{Shape::hexahedron, 1}, 1, {}, {}}, tetrahedra{{Shape::tetrahedron, 1}, 1, {}, {}},
        pyramids{{Shape::pyramid, 1}, 1, {}, {}};
    const auto add = [](ElementBlock& block, std::initializer_list<Index> nodes) {
        block.nodes.insert(block.nodes.end(), nodes);
    };
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                add(hexahedra, {id(i, j, k), id(i + 1, j, k), id(i + 1, j + 1, k), id(i, j + 1, k), id(i, j, k + 1),
                                id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)});
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            x.row(apex(i, j)) << i + 0.5, j + 0.5, 3.0;
            add(pyramids, {id(i, j, 2), id(i + 1, j, 2), id(i + 1, j + 1, 2), id(i, j + 1, 2), apex(i, j)});
        }
    for (int i = 0; i < 2; ++i) {
        add(tetrahedra, {id(i, 1, 2), id(i + 1, 1, 2), apex(i, 1), apex(i, 0)});
        add(tetrahedra, {id(1, i, 2), id(1, i + 1, 2), apex(0, i), apex(1, i)});
    }
    add(pyramids, {apex(0, 0), apex(0, 1), apex(1, 1), apex(1, 0), node_of_pyramids});

    MeshData data;
    data.groups.push_back({3, 1, "domain"});
    data.entities.push_back({3, 1, {1}, {}, {}});
    for (Index node = 0; node < 31; ++node) data.node_tags.push_back({node + 1});
    std::int64_t tag = 101;
    for (ElementBlock* block : {&hexahedra, &tetrahedra, &pyramids}) {
        const auto count = block->nodes.size() / static_cast<std::size_t>(node_count(block->type));
        for (std::size_t i = 0; i < count; ++i) block->tags.push_back({tag++});
        data.blocks.push_back(std::move(*block));
    }
    return {std::make_shared<const MeshTopology>(std::move(data)), std::move(x)};
}

}  // namespace curvewright::testing
