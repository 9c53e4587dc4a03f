#include "core/quality/global_validity.h"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/basis/reference_element.h"
#include "core/mesh/elevate.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::hex_mesh;
using testing::quad_mesh;
using testing::square_mesh;

using Map = std::function<Eigen::RowVector3d(double x, double y, double z)>;
constexpr double pi = std::numbers::pi;

CurvedMesh mapped(const CurvedMesh& mesh, const Map& map) {
    Coordinates x = mesh.coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i) x.row(i) = map(x(i, 0), x(i, 1), x(i, 2));
    return mesh.with_coordinates(std::move(x));
}

/// The meshes beside each other, without common nodes.
CurvedMesh together(const std::vector<CurvedMesh>& meshes) {
    MeshData data;
    Index nodes = 0;
    std::int64_t element_tag = 1;
    for (const CurvedMesh& mesh : meshes) nodes += mesh.topology().node_count();
    Coordinates x(nodes, 3);
    Index first = 0;
    for (const CurvedMesh& mesh : meshes) {
        x.middleRows(first, mesh.topology().node_count()) = mesh.coordinates();
        for (const ElementBlock& block : mesh.topology().blocks()) {
            if (dimension(block.type.shape) != mesh.topology().dimension()) continue;
            ElementBlock copy{block.type, 0, block.nodes, {}};
            for (Index& node : copy.nodes) node += first;
            for (Index i = 0; i < block.size(); ++i) copy.tags.push_back({element_tag++});
            data.blocks.push_back(std::move(copy));
        }
        first += mesh.topology().node_count();
    }
    for (Index node = 0; node < nodes; ++node) data.node_tags.push_back({node + 1});
    return {std::make_shared<const MeshTopology>(std::move(data)), x};
}

/// A fan of P-order triangles around one point that turns the given number of times; the last one is joined to the
/// first.
CurvedMesh fan(int triangles, double turns, int order, const std::function<double(double)>& radius) {
    MeshData data;
    ElementBlock block{{Shape::triangle, order}, 0, {}, {}};
    const ReferenceElement& element = reference_element(block.type);
    std::map<std::tuple<int, int, int>, Index> numbers;
    std::vector<Eigen::RowVector3d> points;
    for (int t = 0; t < triangles; ++t) {
        for (const LatticePoint& at : element.lattice) {
            const int ring = at[0] + at[1];  // of p, from the middle
            const bool wraps = ring > 0 && at[0] == 0 && t + 1 == triangles;
            const int sector = ring == 0 || wraps ? 0 : (at[0] == 0 ? t + 1 : t);
            const int step = ring == 0 || at[0] == 0 ? 0 : at[1];
            const auto [known, is_new] = numbers.emplace(std::tuple(sector, ring, step), Index(points.size()));
            block.nodes.push_back(known->second);
            if (!is_new) continue;
            const double angle = 2 * pi * turns * (sector + (ring == 0 ? 0.0 : double(step) / ring)) / triangles;
            const double r = radius(angle) * ring / order;
            points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
        }
        block.tags.push_back({t + 1});
    }
    data.blocks.push_back(std::move(block));
    Coordinates x(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        data.node_tags.push_back({static_cast<std::int64_t>(i) + 1});
        x.row(static_cast<Eigen::Index>(i)) = points[i];
    }
    return {std::make_shared<const MeshTopology>(std::move(data)), x};
}

GlobalValidityReport assess(const CurvedMesh& mesh) {
    return assess_global_validity(mesh, assess_quality(mesh));
}

#define EXPECT_ANSWER(mesh, expected)                                                      \
    do {                                                                                   \
        const GlobalValidityReport answer_report = assess(mesh);                           \
        EXPECT_EQ(answer_report.answer, GlobalValidity::expected) << answer_report.reason; \
    } while (false)

/// A strip of the unit square bent around the origin, from the angle 0 to `angle`; seen from above it runs clockwise,
/// so that its elements stay positive.
CurvedMesh bent(const CurvedMesh& mesh, double angle, const std::function<double(double, double)>& radius) {
    return mapped(mesh, [&](double x, double y, double z) {
        const double r = radius(x, y), phi = -angle * x;
        return Eigen::RowVector3d(r * std::cos(phi), r * std::sin(phi), z);
    });
}

TEST(GlobalValidity, MeshesThatAreValidAsTheyAreBuilt) {
    for (int order = 1; order <= 4; ++order)
        for (const CurvedMesh& mesh :
             {square_mesh(4, order), cube_mesh(2, order), quad_mesh(3, order), hex_mesh(2, order),
              testing::prism_mesh(2, order), testing::mixed_square_mesh(2, order), testing::mixed_cube_mesh(2, order)})
            EXPECT_ANSWER(mesh, yes);
}

TEST(GlobalValidity, HighOrdersAndFarFromTheOrigin) {
    for (const int order : {6, 10}) {
        EXPECT_ANSWER(bent(quad_mesh(3, order), 1.0, [](double, double y) { return 1 + y; }), yes);
        EXPECT_ANSWER(bent(hex_mesh(1, order), 1.0, [](double, double y) { return 1 + y; }), yes);
    }
    const CurvedMesh mesh = bent(cube_mesh(2, 3), 2.0, [](double, double y) { return 1 + y; });
    EXPECT_ANSWER(mapped(mesh, [](double x, double y, double z) { return Eigen::RowVector3d(x + 1e6, y - 3e5, z); }),
                  yes);
    EXPECT_ANSWER(
        mapped(mesh, [](double x, double y, double z) { return Eigen::RowVector3d(1e-9 * x, 1e-9 * y, 1e-9 * z); }),
        yes);
}

TEST(GlobalValidity, AStripThatMeetsItselfIsClosedOrOverlaps) {
    for (int order = 2; order <= 4; ++order)
        for (const CurvedMesh& mesh : {quad_mesh(12, order), square_mesh(12, order)}) {
            const auto ring = [](double, double y) { return 1 + y; };
            EXPECT_ANSWER(bent(mesh, 1.9 * pi, ring), yes);
            EXPECT_ANSWER(bent(mesh, 2 * pi, ring), yes);  // its ends lie on each other
            EXPECT_ANSWER(bent(mesh, 2.3 * pi, [](double x, double y) { return 1 + y + 0.2 * x; }), no);
            const CurvedMesh twice = bent(mesh, 4 * pi, ring);
            const GlobalValidityReport report = assess(twice);
            EXPECT_EQ(report.elements, GlobalValidity::yes);
            EXPECT_EQ(report.answer, GlobalValidity::no);
        }
}

TEST(GlobalValidity, ABarThatPenetratesItself) {
    for (const CurvedMesh& mesh : {cube_mesh(8, 2), hex_mesh(8, 3), testing::prism_mesh(8, 2)}) {
        EXPECT_ANSWER(bent(mesh, 1.9 * pi, [](double, double y) { return 1 + y; }), yes);
        const CurvedMesh through = bent(mesh, 2.2 * pi, [](double x, double y) { return 1 + y + 0.3 * x; });
        const GlobalValidityReport report = assess(through);
        EXPECT_EQ(report.elements, GlobalValidity::yes);
        EXPECT_EQ(report.answer, GlobalValidity::no) << report.reason;
        EXPECT_GT(report.boundary.crossing_count, 0);
    }
}

TEST(GlobalValidity, ADiscIsWrappedOnceOrTwice) {
    for (int order = 1; order <= 4; ++order) {
        EXPECT_ANSWER(fan(9, 1, order, [](double) { return 1.0; }), yes);
        for (const double wave : {0.0, 0.2}) {
            // With a wave, the boundary crosses itself once; without one, it lies on itself all along.
            const CurvedMesh twice = fan(14, 2, order, [&](double phi) { return 1 + wave * std::cos(0.5 * phi); });
            const GlobalValidityReport report = assess(twice);
            EXPECT_EQ(report.elements, GlobalValidity::yes);
            EXPECT_EQ(report.conformity, GlobalValidity::yes);
            EXPECT_EQ(report.answer, GlobalValidity::no) << report.reason;
            EXPECT_EQ(report.boundary.crossing_count, wave == 0.0 ? 7 : 1) << order;
        }
    }
}

TEST(GlobalValidity, SeveralComponents) {
    const auto moved = [](const CurvedMesh& mesh, double size, double dx, double dy, double dz) {
        return mapped(mesh, [=](double x, double y, double z) {
            return Eigen::RowVector3d(size * x + dx, size * y + dy, size * z + dz);
        });
    };
    for (int order = 1; order <= 3; ++order) {
        const CurvedMesh square = square_mesh(3, order), cube = cube_mesh(2, order);
        const CurvedMesh ring = bent(quad_mesh(12, order), 2 * pi, [](double, double y) { return 1 + y; });
        EXPECT_ANSWER(together({square, moved(square, 1, 1.5, 0, 0)}), yes);
        EXPECT_ANSWER(together({square, moved(square, 1, 0.5, 0.3, 0)}), no);
        EXPECT_ANSWER(together({square, moved(square, 0.3, 0.31, 0.37, 0)}), no);  // one inside the other
        EXPECT_ANSWER(together({square, square}), no);
        EXPECT_ANSWER(together({ring, moved(square, 0.5, -0.2, -0.3, 0)}), yes);  // in the hole
        EXPECT_ANSWER(together({square, moved(square, 1, 1, 0, 0)}), yes);        // side by side
        EXPECT_ANSWER(together({square, moved(square, 1, 1, 1, 0)}), yes);        // at a corner
        EXPECT_ANSWER(together({square, moved(square, 1, 1, 0.4, 0)}), undecided);
        EXPECT_ANSWER(together({cube, moved(cube, 1, 1.5, 0, 0)}), yes);
        EXPECT_ANSWER(together({cube, moved(cube, 1, 0.5, 0.3, 0.2)}), no);
        EXPECT_ANSWER(together({cube, moved(cube, 0.3, 0.31, 0.37, 0.2)}), no);
        EXPECT_ANSWER(together({cube, moved(cube, 1, 1, 0, 0)}), yes);
        EXPECT_ANSWER(together({cube, moved(cube, 1, 1, 1, 0)}), yes);  // along an edge
        EXPECT_ANSWER(together({cube, moved(cube, 1, 1, 1, 1)}), yes);  // at a corner
        EXPECT_ANSWER(together({cube, moved(cube, 1, 1, 0.4, 0.3)}), undecided);
    }
}

/// The unit cube of n × n × n cells, wrapped as six blocks around a ball: a thick wall. The blocks meet with nodes of
/// their own.
CurvedMesh shell(const CurvedMesh& block, double inner, double outer) {
    std::vector<CurvedMesh> sides;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0})
            sides.push_back(mapped(block, [=](double x, double y, double z) {
                Eigen::RowVector3d direction;
                const double a = std::tan(0.25 * pi * (2 * x - 1)) * sign, b = std::tan(0.25 * pi * (2 * y - 1));
                direction[axis] = sign;
                direction[(axis + 1) % 3] = a;
                direction[(axis + 2) % 3] = b;
                return Eigen::RowVector3d((inner + (outer - inner) * z) * direction.normalized());
            }));
    return together(sides);
}

TEST(GlobalValidity, AThickWalledBallAndWhatIsInIt) {
    for (int order = 2; order <= 3; ++order) {
        const CurvedMesh block = hex_mesh(2, order);
        const CurvedMesh wall = shell(block, 1.0, 1.5);
        EXPECT_ANSWER(wall, yes);
        EXPECT_ANSWER(together({wall, shell(block, 0.5, 0.9)}), yes);
        EXPECT_ANSWER(together({wall, shell(block, 1.1, 1.3)}), no);
        EXPECT_ANSWER(together({wall, shell(block, 0.5, 1.2)}), no);
    }
    // The diagonals of tetrahedra do not match between the blocks.
    EXPECT_ANSWER(shell(cube_mesh(1, 2), 1.0, 1.5), undecided);
}

TEST(GlobalValidity, AThinGapAndAThinOverlap) {
    for (int order = 2; order <= 4; ++order) {
        const auto pair = [order](double gap) {
            const auto wave = [](double x) { return 0.1 * std::sin(3 * x); };
            const CurvedMesh mesh = square_mesh(3, order);
            return together(
                {mapped(mesh, [&](double x, double y, double) { return Eigen::RowVector3d(x, y + wave(x), 0); }),
                 mapped(mesh,
                        [&](double x, double y, double) { return Eigen::RowVector3d(x, y + 1 + gap + wave(x), 0); })});
        };
        EXPECT_ANSWER(pair(1e-6), yes);
        EXPECT_ANSWER(pair(0), yes);
        EXPECT_ANSWER(pair(-1e-6), no);
        const auto solid = [order](double gap) {
            const auto wave = [](double x, double y) { return 0.1 * std::sin(2 * x) * std::cos(y); };
            const CurvedMesh mesh = cube_mesh(1, order);
            return together(
                {mapped(mesh, [&](double x, double y, double z) { return Eigen::RowVector3d(x, y, z + wave(x, y)); }),
                 mapped(mesh, [&](double x, double y, double z) {
                     return Eigen::RowVector3d(x, y, z + 1 + gap + wave(x, y));
                 })});
        };
        EXPECT_ANSWER(solid(order == 2 ? 1e-4 : 1e-3), yes);
        EXPECT_ANSWER(solid(0), yes);
        EXPECT_ANSWER(solid(-1e-3), no);
    }
}

/// The mesh cut open along y = 1/2 for x < 1/2: the elements above have nodes of their own there.
CurvedMesh slit(const CurvedMesh& mesh) {
    MeshData data = mesh.topology().data();
    std::map<Index, Index> copies;
    std::vector<Eigen::RowVector3d> added;
    Index element = 0;
    std::vector<ElementBlock> kept;
    for (ElementBlock& block : data.blocks) {
        if (dimension(block.type.shape) != mesh.topology().dimension()) continue;
        const std::size_t count = block.nodes.size() / block.tags.size();
        for (Index i = 0; i < block.size(); ++i, ++element) {
            if (mesh.element_center(element)[1] < 0.5) continue;
            for (std::size_t k = 0; k < count; ++k) {
                Index& node = block.nodes[static_cast<std::size_t>(i) * count + k];
                const Eigen::RowVector3d x = mesh.coordinates().row(node);
                if (std::abs(x[1] - 0.5) > 1e-12 || x[0] > 0.5 - 1e-12) continue;
                const auto [copy, is_new] =
                    copies.emplace(node, mesh.topology().node_count() + static_cast<Index>(added.size()));
                if (is_new) {
                    data.node_tags.push_back({100000 + copy->second});
                    added.push_back(x);
                }
                node = copy->second;
            }
        }
        kept.push_back(block);
    }
    data.blocks = kept;
    data.node_entities.clear();
    Coordinates x(mesh.coordinates().rows() + static_cast<Eigen::Index>(added.size()), 3);
    x.topRows(mesh.coordinates().rows()) = mesh.coordinates();
    for (std::size_t i = 0; i < added.size(); ++i)
        x.row(mesh.coordinates().rows() + static_cast<Eigen::Index>(i)) = added[i];
    return {std::make_shared<const MeshTopology>(std::move(data)), x};
}

TEST(GlobalValidity, ASlitIsClosedOpenOrFoldedOver) {
    for (int order = 1; order <= 4; ++order)
        for (const CurvedMesh& whole : {square_mesh(4, order), quad_mesh(4, order), hex_mesh(4, std::min(order, 2))}) {
            const CurvedMesh closed = slit(whole);
            ASSERT_GT(closed.topology().boundary_facets().size(), whole.topology().boundary_facets().size());
            EXPECT_ANSWER(closed, yes);
            const auto opened = [&](double height) {
                Coordinates x = closed.coordinates();
                for (Index node = whole.topology().node_count(); node < closed.topology().node_count(); ++node)
                    x(node, 1) += height * (0.5 - x(node, 0));
                return closed.with_coordinates(std::move(x));
            };
            EXPECT_ANSWER(opened(0.05), yes);
            EXPECT_ANSWER(opened(-0.05), no);
        }
}

TEST(GlobalValidity, TangledElementsAreTold) {
    const GlobalValidityReport report = assess(testing::bulged_square_mesh(3, 3, 0.4));
    EXPECT_EQ(report.answer, GlobalValidity::no);
    EXPECT_EQ(report.elements, GlobalValidity::no);
    EXPECT_EQ(report.boundary.answer, GlobalValidity::yes) << report.boundary.reason;
}

TEST(GlobalValidity, NegativeOrientationIsNoFault) {
    EXPECT_ANSWER(flip_orientation(square_mesh(3, 3)), yes);
    EXPECT_ANSWER(flip_orientation(cube_mesh(2, 2)), yes);
}

TEST(GlobalValidity, NeighboursOfDifferentOrderMatchWhereTheyLieOnEachOther) {
    // A P2 triangle on a P1 triangle, with the nodes between them on the straight edge or off it.
    const auto pair = [](double height) {
        MeshData data;
        for (int node = 1; node <= 7; ++node) data.node_tags.push_back({node});
        data.blocks.push_back({{Shape::triangle, 1}, 0, {0, 3, 1}, {{1}}});
        data.blocks.push_back({{Shape::triangle, 2}, 0, {0, 1, 2, 4, 5, 6}, {{2}}});
        Coordinates x(7, 3);
        x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.6, -1, 0, 0.5, height, 0, 0.5, 0.5, 0, 0, 0.5, 0;
        return CurvedMesh(std::make_shared<const MeshTopology>(std::move(data)), x);
    };
    EXPECT_ANSWER(pair(0.0), yes);
    EXPECT_ANSWER(pair(0.1), no);
    EXPECT_EQ(assess(pair(0.1)).conflict_count, 1);
    EXPECT_EQ(assess(pair(-0.1)).boundary.answer, GlobalValidity::no);  // the P2 triangle reaches into the other one
}

TEST(GlobalValidity, FacetsOfManyElementsAndNodesInAnotherOrderAreConflicts) {
    MeshData data;
    for (int node = 1; node <= 5; ++node) data.node_tags.push_back({node});
    data.blocks.push_back({{Shape::triangle, 1}, 0, {0, 1, 2, 1, 0, 3, 0, 1, 4}, {{1}, {2}, {3}}});
    Coordinates x(5, 3);
    x << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, -1, 0, 0.5, 2, 0;
    const GlobalValidityReport many = assess({std::make_shared<const MeshTopology>(std::move(data)), x});
    EXPECT_EQ(many.conformity, GlobalValidity::no);
    EXPECT_EQ(many.answer, GlobalValidity::no);

    // Two P3 triangles; the second has the inner nodes of the common edge swapped.
    const CurvedMesh whole = square_mesh(1, 3);
    MeshData swapped = whole.topology().data();
    std::map<Index, int> uses;
    for (ElementBlock& block : swapped.blocks)
        if (block.type.shape == Shape::triangle)
            for (const Index node : block.nodes) ++uses[node];
    for (ElementBlock& block : swapped.blocks) {
        if (block.type.shape != Shape::triangle) continue;
        std::vector<Index*> common;
        for (std::size_t k = 13; k < 20; ++k)
            if (uses[block.nodes[k]] == 2) common.push_back(&block.nodes[k]);
        ASSERT_EQ(common.size(), 2u);
        std::swap(*common[0], *common[1]);
    }
    const CurvedMesh mesh(std::make_shared<const MeshTopology>(std::move(swapped)), whole.coordinates());
    EXPECT_EQ(assess(mesh).conformity, GlobalValidity::no);
}

TEST(GlobalValidity, WhatWasFoundAboutTheBoundaryIsInherited) {
    const CurvedMesh before = square_mesh(3, 2);
    Coordinates x = before.coordinates();
    x(before.topology().interior_nodes().front(), 0) += 0.01;
    const CurvedMesh after = before.with_coordinates(x);
    EXPECT_TRUE(has_same_boundary(before.topology(), before.coordinates(), after.coordinates()));
    BoundaryEmbedding known = assess_boundary_embedding(before, 1.0);
    EXPECT_EQ(assess_global_validity(after, assess_quality(after), {}, {}, &known).answer, GlobalValidity::yes);
    known.answer = GlobalValidity::no;
    known.reason = "As it was.";
    EXPECT_EQ(assess_global_validity(after, assess_quality(after), {}, {}, &known).reason, "As it was.");
    x(before.topology().boundary_nodes().front(), 0) += 1e-16 + 1e-3;
    EXPECT_FALSE(has_same_boundary(before.topology(), before.coordinates(), x));
}

TEST(GlobalValidity, IsTheSameForEveryThreadCountAndCanBeCancelled) {
    const CurvedMesh mesh = bent(cube_mesh(6, 2), 2.2 * pi, [](double x, double y) { return 1 + y + 0.3 * x; });
    set_thread_count(1);
    const BoundaryEmbedding one = assess_boundary_embedding(mesh, 1.0);
    set_thread_count(4);
    const BoundaryEmbedding four = assess_boundary_embedding(mesh, 1.0);
    set_thread_count(0);
    EXPECT_EQ(one.reason, four.reason);
    EXPECT_EQ(one.crossing_count, four.crossing_count);
    ASSERT_EQ(one.crossings.size(), four.crossings.size());
    for (std::size_t i = 0; i < one.crossings.size(); ++i)
        EXPECT_EQ(one.crossings[i].b.element, four.crossings[i].b.element);
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(assess_boundary_embedding(mesh, 1.0, {}, {source.get_token(), {}}), Cancelled);
}

TEST(GlobalValidity, ListsNoMorePairsThanAskedForAndCountsThemAll) {
    const CurvedMesh mesh = bent(cube_mesh(6, 1), 2.2 * pi, [](double x, double y) { return 1 + y + 0.3 * x; });
    GlobalValidityOptions options;
    options.most_listed = 2;
    const BoundaryEmbedding found = assess_boundary_embedding(mesh, 1.0, options);
    EXPECT_EQ(found.crossings.size(), 2u);
    EXPECT_GT(found.crossing_count, 2);
}

}  // namespace
}  // namespace curvewright
