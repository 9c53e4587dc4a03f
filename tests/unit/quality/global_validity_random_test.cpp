#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"
#include "core/quality/global_validity.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::hex_mesh;
using testing::quad_mesh;
using testing::square_mesh;

/// Points of a facet at parameters of a fine grid, by the shape functions: (n + 1)^d × 3. Those of lines lie closest at
/// the ends: curves may cross a hundred-thousandth of their length from a common end.
Eigen::MatrixX3d sampled(const CurvedMesh& mesh, Facet facet, int n) {
    const MeshTopology& topology = mesh.topology();
    const ElementType type = reference_element(topology.element_type(facet.element)).facets[facet.local].type;
    const bool is_line = type.shape == Shape::line;
    Eigen::MatrixX3d at(is_line ? n + 1 : (n + 1) * (n + 1), 3);
    at.setZero();
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= (is_line ? 0 : n); ++j) {
            double u = double(i) / n, v = double(j) / n;
            if (type.shape == Shape::triangle) v *= 1 - u;
            if (is_line) u = u * u * u / (u * u * u + (1 - u) * (1 - u) * (1 - u));
            at.row(is_line ? i : i * (n + 1) + j) << u, v, 0;
        }
    const std::vector<Index> nodes = topology.facet_nodes(facet);
    Eigen::MatrixX3d x(nodes.size(), 3);
    for (std::size_t k = 0; k < nodes.size(); ++k)
        x.row(static_cast<Eigen::Index>(k)) = mesh.coordinates().row(nodes[k]);
    return lagrange_basis(type, at).values * x;
}

/// Whether polylines through many points of the facets cross: segments that are not neighbours.
bool polylines_cross(const CurvedMesh& mesh, const std::vector<Facet>& facets, int n) {
    const auto side = [](const Eigen::RowVector3d& a, const Eigen::RowVector3d& b, const Eigen::RowVector3d& c) {
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    };
    std::vector<std::array<Eigen::RowVector3d, 2>> segments;
    for (const Facet& facet : facets) {
        const Eigen::MatrixX3d points = sampled(mesh, facet, n);
        for (int i = 0; i < n; ++i) segments.push_back({points.row(i), points.row(i + 1)});
    }
    for (std::size_t i = 0; i < segments.size(); ++i)
        for (std::size_t j = i + 1; j < segments.size(); ++j) {
            const auto& [a, b] = segments[i];
            const auto& [c, d] = segments[j];
            if (std::max(a[0], b[0]) < std::min(c[0], d[0]) || std::max(c[0], d[0]) < std::min(a[0], b[0])) continue;
            if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
        }
    return false;
}

TEST(GlobalValidity, RandomCurvesAgreeWithPolylines) {
    std::mt19937 random(20);
    int crossing = 0, embedded = 0;
    for (int order = 1; order <= 5; ++order)
        for (int round = 0; round < 60; ++round) {
            const CurvedMesh regular = round % 2 == 0 ? square_mesh(2, order) : quad_mesh(2, order);
            std::uniform_real_distribution<double> uniform(-1, 1);
            Coordinates x = regular.coordinates();
            const double amplitude = 0.02 * (1 + round % 12);
            for (const Index node : regular.topology().boundary_nodes())
                for (int d = 0; d < 2; ++d) x(node, d) += amplitude * uniform(random);
            const CurvedMesh mesh = regular.with_coordinates(x);
            const BoundaryEmbedding found = assess_boundary_embedding(mesh, 1.0);
            const bool crosses = polylines_cross(mesh, mesh.topology().boundary_facets(), 60);
            EXPECT_NE(found.answer, GlobalValidity::undecided) << found.reason;
            if (found.answer == GlobalValidity::yes) {
                EXPECT_FALSE(crosses) << order << " " << round;
            }
            for (const FacetPair& pair : found.crossings) {
                EXPECT_TRUE(polylines_cross(mesh, {pair.a, pair.b}, 60) ||
                            polylines_cross(mesh, {pair.a, pair.b}, 2000))
                    << order << " " << round << " " << describe(mesh.topology(), pair);
            }
            ++(found.answer == GlobalValidity::no ? crossing : embedded);
        }
    EXPECT_GT(crossing, 50);
    EXPECT_GT(embedded, 50);
}

/// Whether fine triangulations of different facets cross: a side of a triangle through another one's inside.
bool triangulations_cross(const CurvedMesh& mesh, int n) {
    using Vector = Eigen::Vector3d;
    std::vector<std::vector<std::array<Vector, 3>>> facets;
    for (const Facet& facet : mesh.topology().boundary_facets()) {
        const Eigen::MatrixX3d points = sampled(mesh, facet, n);
        const auto at = [&](int i, int j) -> Vector { return points.row(i * (n + 1) + j).transpose(); };
        auto& triangles = facets.emplace_back();
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    }
    const auto pierces = [](const Vector& p, const Vector& q, const std::array<Vector, 3>& t) {
        const auto volume = [](const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
            return (b - a).cross(c - a).dot(d - a);
        };
        const double small = 1e-9;
        const double below = volume(t[0], t[1], t[2], p), above = volume(t[0], t[1], t[2], q);
        if (below * above >= 0 || std::min(std::abs(below), std::abs(above)) < small) return false;
        const double a = volume(p, q, t[0], t[1]), b = volume(p, q, t[1], t[2]), c = volume(p, q, t[2], t[0]);
        return (a > small && b > small && c > small) || (a < -small && b < -small && c < -small);
    };
    for (std::size_t f = 0; f < facets.size(); ++f)
        for (std::size_t g = 0; g < facets.size(); ++g)
            for (const auto& s : facets[f])
                for (const auto& t : facets[g])
                    if (f != g)
                        for (int k = 0; k < 3; ++k)
                            if (pierces(s[k], s[(k + 1) % 3], t)) return true;
    return false;
}

TEST(GlobalValidity, RandomSurfacesAgreeWithTriangulations) {
    std::mt19937 random(21);
    int crossing = 0, embedded = 0;
    for (int order = 1; order <= 3; ++order)
        for (int round = 0; round < 16; ++round) {
            const CurvedMesh regular = round % 2 == 0 ? cube_mesh(1, order) : hex_mesh(1, order);
            std::uniform_real_distribution<double> uniform(-1, 1);
            Coordinates x = regular.coordinates();
            const double amplitude = 0.05 * (1 + round % 8);
            for (const Index node : regular.topology().boundary_nodes())
                for (int d = 0; d < 3; ++d) x(node, d) += amplitude * uniform(random);
            const CurvedMesh mesh = regular.with_coordinates(x);
            const BoundaryEmbedding found = assess_boundary_embedding(mesh, 1.0);
            const bool crosses = triangulations_cross(mesh, 8);
            if (found.answer == GlobalValidity::yes) {
                EXPECT_FALSE(crosses) << order << " " << round;
            }
            if (crosses) {
                EXPECT_EQ(found.answer, GlobalValidity::no) << order << " " << round << found.reason;
            }
            crossing += found.answer == GlobalValidity::no ? 1 : 0;
            embedded += found.answer == GlobalValidity::yes ? 1 : 0;
        }
    EXPECT_GT(crossing, 8);
    EXPECT_GT(embedded, 8);
}

}  // namespace
}  // namespace curvewright
