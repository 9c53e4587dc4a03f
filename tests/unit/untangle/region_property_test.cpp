/// Random meshes with random interfaces, windings and orders, of domains that may overlap themselves, tangled by moves
/// of those nodes only that may move: the mesh before the moves is a witness that every element can be mended. So no
/// proof that one cannot may be found, no node that stays may move, and no result may be called valid as a mesh that a
/// count of preimages, which shares nothing with the search for crossings, finds to overlap.

#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"
#include "core/mesh/renumbering.h"
#include "core/quality/global_validity.h"
#include "core/quality/quality.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/improve.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/unsigned_angles.h"
#include "tests/support/mesh_factory.h"
#include "tests/support/region_meshes.h"

namespace curvewright {
namespace {

using Random = std::mt19937;

double uniform(Random& random, double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random);
}
bool happens(Random& random, double probability) {
    return uniform(random, 0.0, 1.0) < probability;
}

bool is_valid(const CurvedMesh& mesh) {
    return assess_quality(mesh).summary.valid == mesh.topology().element_count();
}

/// A case: the valid mesh, the same one tangled, and which nodes may not move.
struct Case {
    CurvedMesh witness, tangled;
    std::set<Index> staying;
    bool overlaps_nowhere = false;  ///< known from how it was made
    bool is_large = false;          ///< too large to be improved here
};

/// Bends the unit square or cube around the origin: x becomes an angle, and with a pitch the radius grows with it.
Coordinates rolled(const Coordinates& x, double angle, double pitch) {
    Coordinates result = x;
    for (Eigen::Index node = 0; node < x.rows(); ++node) {
        const double a = angle * x(node, 0), r = 1.0 + 0.5 * x(node, 1) + pitch * x(node, 0);
        result.row(node) << -r * std::sin(a), r * std::cos(a), x(node, 2);
    }
    return result;
}

/// far_around: with elements enough for a bend by more than a full turn.
CurvedMesh random_linear_mesh(Random& random, bool is_3d, bool far_around) {
    const double kind = uniform(random, 0.0, 1.0);
    if (is_3d)
        return far_around   ? testing::hex_mesh(4, 1)
               : kind < 0.3 ? testing::cube_mesh(2, 1)
               : kind < 0.6 ? testing::hex_mesh(3, 1)
                            : testing::prism_mesh(2, 1);
    const int n = far_around ? 6 : 3 + static_cast<int>(random() % 2);
    return kind < 0.4   ? testing::square_mesh(n, 1)
           : kind < 0.7 ? testing::quad_mesh(n, 1)
                        : testing::mixed_square_mesh(2 * (n / 2), 1);
}

int facet_count(const MeshTopology& topology, Index element) {
    return static_cast<int>(reference_element(topology.element_type(element)).facets.size());
}

/// Nodes of facets between elements of different groups, by their nodes alone.
std::set<Index> nodes_between(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    std::map<std::set<Index>, int> first_region;
    std::set<Index> result;
    for (Index element = 0; element < topology.element_count(); ++element)
        for (int f = 0; f < facet_count(topology, element); ++f) {
            const std::vector<Index> nodes = topology.facet_nodes({element, f});
            const int region = topology.element_entity(element);
            const auto [found, is_new] = first_region.try_emplace({nodes.begin(), nodes.end()}, region);
            if (!is_new && found->second != region) result.insert(nodes.begin(), nodes.end());
        }
    return result;
}

std::optional<Case> random_case(Random& random) {
    const bool is_3d = happens(random, 0.3), far_around = happens(random, 0.4);
    const CurvedMesh linear = random_linear_mesh(random, is_3d, far_around);
    const int order = far_around ? (is_3d ? 2 : 3) : 1 + static_cast<int>(random() % (is_3d ? 3 : 5));
    const double size = 0.1;
    CurvedMesh mesh = testing::with_shaken_corners(linear, 0.5 * size, order, random);

    // Two regions: what is on one side of a random wavy surface, or any elements at all.
    const bool is_scattered = happens(random, 0.3);
    const Eigen::RowVector3d normal =
        Eigen::RowVector3d(uniform(random, -1, 1), uniform(random, -1, 1), is_3d ? uniform(random, -1, 1) : 0.0)
            .normalized();
    std::vector<char> is_near;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        const Eigen::RowVector3d centre =
            mesh.element_center(element) - Eigen::RowVector3d(0.5, 0.5, is_3d ? 0.5 : 0.0);
        is_near.push_back(is_scattered ? happens(random, 0.25) : centre.dot(normal) < 0.1 * std::sin(9 * centre[0]));
    }
    const auto cells = static_cast<testing::InterfaceCells>(random() % 3);
    mesh = testing::with_regions(mesh, cells, [&](Index element) { return is_near[element] != 0; });
    const double turned = happens(random, 0.5) ? uniform(random, 0.0, 0.5) : 0.0;
    mesh = renumbered(mesh, [&](Index) { return happens(random, turned); });

    // Curved edges and faces; then the domain as a whole is bent, perhaps further than around once.
    const double turn = far_around ? uniform(random, 1.5, 2.7) : uniform(random, 0.2, 1.0);
    const double angle = turn * std::numbers::pi, pitch = far_around ? uniform(random, 0.0, 0.5) : 0.0;
    for (double amplitude = 0.3 * size / order;; amplitude /= 2) {
        Coordinates x = mesh.coordinates();
        for (Eigen::Index node = 0; node < x.rows(); ++node)
            for (int d = 0; d < mesh.topology().dimension(); ++d) x(node, d) += uniform(random, -amplitude, amplitude);
        const CurvedMesh curved = mesh.with_coordinates(rolled(x, angle, pitch));
        if (!is_valid(curved)) {
            if (amplitude < 1e-3 * size) return std::nullopt;  // too few elements around the bend
            continue;
        }
        Case result{curved, curved, nodes_between(curved), turn < 1.7, is_3d && far_around};
        const std::vector<Index>& boundary = curved.topology().boundary_nodes();
        result.staying.insert(boundary.begin(), boundary.end());
        const double share = uniform(random, 0.05, 0.6), throws = size * uniform(random, 0.1, 4.0) / order;
        x = curved.coordinates();
        for (Index node = 0; node < curved.topology().node_count(); ++node)
            if (!result.staying.contains(node) && happens(random, share))
                for (int d = 0; d < curved.topology().dimension(); ++d) x(node, d) += throws * uniform(random, -1, 1);
        result.tangled = curved.with_coordinates(std::move(x));
        return result;
    }
}

Eigen::MatrixX3d positions(const CurvedMesh& mesh, const std::vector<Index>& nodes) {
    Eigen::MatrixX3d x(nodes.size(), 3);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        x.row(static_cast<Eigen::Index>(i)) = mesh.coordinates().row(nodes[i]);
    return x;
}

/// How often the boundary of an element winds around a point, from many straight pieces of it: the preimages that the
/// point has in it if J > 0. NaN near the boundary, where pieces may not decide.
double preimages(const CurvedMesh& mesh, Index element, const Eigen::RowVector3d& point) {
    const MeshTopology& topology = mesh.topology();
    const ReferenceElement& reference = reference_element(topology.element_type(element));
    const double sign = topology.is_reversed(element) ? -1.0 : 1.0;
    const int n = topology.dimension() == 2 ? 60 : 12;
    double total = 0.0;
    for (int f = 0; f < static_cast<int>(reference.facets.size()); ++f) {
        const ElementType type = reference.facets[f].type;
        const Eigen::MatrixX3d x = positions(mesh, topology.facet_nodes({element, f}));
        const bool is_line = type.shape == Shape::line, is_triangle = type.shape == Shape::triangle;
        Eigen::MatrixX3d at = Eigen::MatrixX3d::Zero((n + 1) * (is_line ? 1 : n + 1), 3);
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= (is_line ? 0 : n); ++j) {
                const double u = double(i) / n, v = double(j) / n;
                at.row(is_line ? i : i * (n + 1) + j) << u, is_triangle ? v * (1 - u) : v, 0.0;
            }
        const Eigen::MatrixX3d on = (lagrange_basis(type, at).values * x).rowwise() - point;
        double near = 0.0;  // the longest piece
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < (is_line ? 1 : n); ++j) {
                if (is_line) {
                    const Eigen::RowVector3d a = on.row(i), b = on.row(i + 1);
                    total += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b)) / (2 * std::numbers::pi);
                    near = std::max(near, (b - a).norm());
                    continue;
                }
                const Eigen::RowVector3d a = on.row(i * (n + 1) + j), b = on.row((i + 1) * (n + 1) + j),
                                         c = on.row((i + 1) * (n + 1) + j + 1), d = on.row(i * (n + 1) + j + 1);
                const auto angle = [](const auto& p, const auto& q, const auto& r) {  // Van Oosterom and Strackee, 1983
                    const double lp = p.norm(), lq = q.norm(), lr = r.norm();
                    return 2 *
                           std::atan2(p.dot(q.cross(r)), lp * lq * lr + p.dot(q) * lr + q.dot(r) * lp + r.dot(p) * lq);
                };
                total += (angle(a, b, c) + angle(a, c, d)) / (4 * std::numbers::pi);
                near = std::max({near, (b - a).norm(), (d - a).norm(), (c - b).norm(), (c - d).norm()});
            }
        if (on.rowwise().norm().minCoeff() < 0.2 * near) return std::nan("");  // a piece bulges by less
    }
    return sign * total;
}

/// Where the middle of the reference element is.
Eigen::RowVector3d middle(const CurvedMesh& mesh, Index element) {
    const ElementType type = mesh.topology().element_type(element);
    const bool is_simplex = type.shape == Shape::triangle || type.shape == Shape::tetrahedron;
    Eigen::RowVector3d at = Eigen::RowVector3d::Constant(is_simplex ? 0.25 : 0.5);
    if (type.shape == Shape::prism) at.head<2>().setConstant(0.3);
    return lagrange_basis(type, at).values * mesh.element_coordinates(element);
}

/// A place that is covered more than once, looked for at random.
bool overlaps(const CurvedMesh& mesh, Random& random) {
    const MeshTopology& topology = mesh.topology();
    std::vector<Eigen::AlignedBox3d> boxes;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const Eigen::MatrixX3d x = mesh.element_coordinates(element);
        Eigen::AlignedBox3d box;
        for (Eigen::Index i = 0; i < x.rows(); ++i) box.extend(x.row(i).transpose());
        box.extend(box.max() + 0.5 * box.sizes());  // curved elements reach beyond their nodes
        box.extend(box.min() - 0.5 * box.sizes());
        boxes.push_back(box);
    }
    int decided = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const auto start = static_cast<Index>(random() % topology.element_count());
        const Eigen::RowVector3d point = middle(mesh, start);
        double sum = 0.0;
        for (Index element = 0; element < topology.element_count(); ++element)
            if (boxes[element].contains(point.transpose())) sum += preimages(mesh, element, point);
        if (std::isnan(sum)) continue;
        ++decided;
        EXPECT_NEAR(sum, std::round(sum), 0.02);
        EXPECT_GT(std::abs(sum), 0.5);  // the element that the point is from
        if (std::abs(sum) > 1.5) return true;
    }
    EXPECT_GT(decided, 10);
    return false;
}

struct Tally {
    int cases = 0, tangled = 0, mended = 0, interfaces = 0, reversed = 0, overlapping = 0, globally_valid = 0,
        improved = 0;
};

void expect_stays(const Case& one, const Coordinates& x, const char* what) {
    for (const Index node : one.staying) ASSERT_EQ(x.row(node), one.tangled.coordinates().row(node)) << what;
}

void expect_vertices_stay(const CurvedMesh& mesh, const Coordinates& x) {
    const MeshTopology& topology = mesh.topology();
    for (Index element = 0; element < topology.element_count(); ++element)
        for (const Index node :
             topology.element_nodes(element).first(corner_count(topology.element_type(element).shape)))
            ASSERT_EQ(x.row(node), mesh.coordinates().row(node));
}

void check(const Case& one, Random& random, Tally& tally) {
    const CurvedMesh& mesh = one.tangled;
    const MeshTopology& topology = mesh.topology();
    ++tally.cases;
    tally.reversed += topology.reversed_count() > 0 ? 1 : 0;
    tally.interfaces += topology.interface_nodes().empty() ? 0 : 1;
    const bool was_tangled = !is_valid(mesh);
    tally.tangled += was_tangled ? 1 : 0;

    GuaranteedOptions options;
    options.improves = !one.is_large && happens(random, 0.5);
    options.target = uniform(random, 0.1, 0.4);
    options.nodes.keeps_vertices = happens(random, 0.3);
    const GuaranteedResult result = untangle_guaranteed(mesh, options);
    expect_stays(one, result.coordinates, "guaranteed");
    if (options.nodes.keeps_vertices) expect_vertices_stay(mesh, result.coordinates);
    // Vertices that were thrown about may be what cannot be mended; of all else the witness is the proof.
    for (const UnmendedElement& element : result.unmended)
        EXPECT_FALSE(element.is_proved && !options.nodes.keeps_vertices) << element.reason;
    if (!was_tangled) {
        EXPECT_EQ(result.coordinates, mesh.coordinates());
    }
    const CurvedMesh mended = mesh.with_coordinates(result.coordinates);
    const bool is_mended = is_valid(mended);
    EXPECT_EQ(is_mended, result.unmended.empty());
    tally.mended += was_tangled && is_mended ? 1 : 0;

    const GlobalValidityReport global = assess_global_validity(mended, assess_quality(mended));
    if (!is_mended) {
        EXPECT_NE(global.answer, GlobalValidity::yes);
    } else {
        const bool has_overlap = overlaps(mended, random);
        tally.overlapping += has_overlap ? 1 : 0;
        tally.globally_valid += global.answer == GlobalValidity::yes ? 1 : 0;
        if (has_overlap) {
            EXPECT_EQ(global.answer, GlobalValidity::no) << global.reason;
        }
        if (one.overlaps_nowhere) {
            EXPECT_EQ(global.answer, GlobalValidity::yes) << global.reason;
        }
        const GlobalValidityReport witness = assess_global_validity(one.witness, assess_quality(one.witness));
        EXPECT_EQ(global.answer, witness.answer) << global.reason << witness.reason;  // by the boundary alone

        if (one.is_large) return;
        ImproveOptions improving;
        improving.goal = happens(random, 0.5) ? ImproveGoal::jacobian : ImproveGoal::shape;
        improving.target = uniform(random, 0.2, 0.5);
        if (happens(random, 0.5)) improving.max_move = uniform(random, 0.0, 0.05);
        improving.nodes.keeps_vertices = happens(random, 0.3);
        const ImproveResult improved = improve(mended, improving);
        expect_stays({mended, mended, one.staying, false, false}, improved.coordinates, "improve");
        EXPECT_TRUE(is_valid(mended.with_coordinates(improved.coordinates)));
        if (improving.nodes.keeps_vertices) expect_vertices_stay(mended, improved.coordinates);
        tally.improved += improved.coordinates != mended.coordinates() ? 1 : 0;
    }

    bool is_triangular = topology.order() >= 2;
    for (Index element = 0; element < topology.element_count(); ++element)
        is_triangular = is_triangular && topology.element_type(element).shape == Shape::triangle;
    if (!is_triangular) return;
    expect_stays(one, untangle_unsigned_angles(mesh).coordinates, "unsigned angles");
    expect_stays(one, untangle_signed_angles(mesh).coordinates, "signed angles");
}

TEST(RegionProperties, HoldOnRandomMeshesWithInterfaces) {
    Tally tally;
    for (unsigned seed = 0; seed < 110; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        if (const std::optional<Case> one = random_case(random)) check(*one, random, tally);
        if (HasFatalFailure()) return;
    }
    std::cout << tally.cases << " cases, " << tally.tangled << " tangled, " << tally.mended << " mended, "
              << tally.interfaces << " with interfaces, " << tally.reversed << " with reversed elements, "
              << tally.overlapping << " overlap, " << tally.globally_valid << " valid as meshes, " << tally.improved
              << " improved\n";
    EXPECT_GT(tally.cases, 80);
    EXPECT_GT(tally.tangled, 50);
    EXPECT_GT(tally.mended, tally.tangled / 2);
    EXPECT_GT(tally.interfaces, 70);
    EXPECT_GT(tally.reversed, 30);
    EXPECT_GT(tally.overlapping, 5);
    EXPECT_GT(tally.globally_valid, 40);
    EXPECT_GT(tally.improved, 20);
}

}  // namespace
}  // namespace curvewright
