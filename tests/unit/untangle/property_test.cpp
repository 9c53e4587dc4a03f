/// What every method of untangling promises, on random meshes of random order that random moves have tangled: fixed
/// nodes stay bit for bit, the mesh never gets worse where the method says so, and certificates are right, judged by an
/// evaluation of J that shares nothing with the Bézier form. A hang is found by ctest's time limit.

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "core/basis/lagrange.h"
#include "core/quality/quality.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/standing.h"
#include "core/untangle/unsigned_angles.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using Random = std::mt19937;

double uniform(Random& random, double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random);
}
bool happens(Random& random, double probability) {
    return uniform(random, 0.0, 1.0) < probability;
}

/// A number from [0, 1] that is often one of the ends.
double random_coordinate(Random& random) {
    return happens(random, 0.3) ? 0.0 : happens(random, 0.3) ? 1.0 : uniform(random, 0.0, 1.0);
}

/// A point of the reference element, biased to its boundary, where curved elements tangle.
std::array<double, 3> random_point(Shape shape, Random& random) {
    const int dim = dimension(shape);
    const bool is_simplex = shape == Shape::triangle || shape == Shape::tetrahedron;
    const int simplex_dim = is_simplex ? dim : shape == Shape::prism ? 2 : 0;
    std::array<double, 3> point{};
    std::array<double, 4> share{};
    double sum = 0.0;
    for (int i = 0; i <= simplex_dim; ++i) sum += share[i] = happens(random, 0.3) ? 0.0 : uniform(random, 0.0, 1.0);
    for (int i = 0; i < dim; ++i)
        point[i] = i >= simplex_dim ? random_coordinate(random) : sum > 0.0 ? share[i] / sum : 0.0;
    return point;
}

/// J at points of the reference element by the shape functions' own derivatives.
Eigen::VectorXd jacobians(const CurvedMesh& mesh, Index element, const Eigen::MatrixX3d& points) {
    const ElementType type = mesh.topology().element_type(element);
    const BasisTable basis = lagrange_basis(type, points);
    const Eigen::MatrixX3d x = mesh.element_coordinates(element);
    Eigen::VectorXd result(points.rows());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        Eigen::Matrix3d tangents = Eigen::Matrix3d::Identity();
        for (int k = 0; k < dimension(type.shape); ++k) tangents.row(k) = basis.gradients[k].row(i) * x;
        result[i] = tangents.determinant();
    }
    return result;
}

void expect_right_certificates(const CurvedMesh& mesh, const QualityReport& report, Random& random) {
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        const ElementQuality& quality = report.elements[element];
        Eigen::MatrixX3d points(12, 3);
        for (Eigen::Index i = 1; i < points.rows(); ++i) {
            const auto point = random_point(mesh.topology().element_type(element).shape, random);
            points.row(i) << point[0], point[1], point[2];
        }
        points.row(0) << quality.worst_point[0], quality.worst_point[1], quality.worst_point[2];
        const Eigen::VectorXd j = report.orientation_sign.of_element(mesh.topology(), element) * jacobians(mesh, element, points);
        const double slack = 1e-10 * std::max(std::abs(quality.max_upper), std::abs(quality.min_lower));
        EXPECT_GE(j.minCoeff(), quality.min_lower - slack);
        EXPECT_LE(j.maxCoeff(), quality.max_upper + slack);
        EXPECT_NEAR(j[0], quality.min_upper, 1e4 * slack);  // its a-priori rounding bound included
        EXPECT_TRUE(quality.validity != Validity::valid || j.minCoeff() > 0.0);
        EXPECT_TRUE(quality.validity != Validity::invalid || j[0] < 0.0);
    }
}

/// A random mesh that is valid.
CurvedMesh random_valid_mesh(Random& random) {
    const bool is_3d = happens(random, 0.3);
    const int n = is_3d ? 2 : 2 + static_cast<int>(random() % 3);
    const int order = 1 + static_cast<int>(random() % (is_3d ? 3 : 5));
    const bool is_simplicial = happens(random, 0.6);
    const CurvedMesh linear = is_3d           ? is_simplicial          ? testing::cube_mesh(n, 1)
                                                : happens(random, 0.5) ? testing::hex_mesh(n, 1)
                                                                       : testing::prism_mesh(n, 1)
                                        : is_simplicial ? testing::square_mesh(n, 1)
                                              : testing::quad_mesh(n, 1);
    for (double amplitude = 0.2 / n;; amplitude /= 2) {
        const CurvedMesh straight = testing::with_shaken_corners(linear, amplitude, order, random);
        const CurvedMesh curved = testing::shaken(straight, 0.3 * amplitude / order, random);
        if (assess_quality(curved).summary.valid == curved.topology().element_count()) return curved;
    }
}

/// The same mesh with some nodes moved far enough that elements may tangle.
CurvedMesh tangled(const CurvedMesh& mesh, Random& random) {
    const MeshTopology& topology = mesh.topology();
    Coordinates x = mesh.coordinates();
    const double size = 0.5 / std::pow(topology.element_count(), 1.0 / topology.dimension()) / topology.order();
    const double share = uniform(random, 0.02, 0.3), amplitude = size * std::pow(10.0, uniform(random, -1.0, 0.7));
    const bool moves_boundary = happens(random, 0.5);
    for (Index node = 0; node < topology.node_count(); ++node)
        if (happens(random, share) && (moves_boundary || topology.is_interior_node(node)))
            for (int d = 0; d < topology.dimension(); ++d) x(node, d) += amplitude * uniform(random, -1.0, 1.0);
    return mesh.with_coordinates(std::move(x));
}

struct Judged {
    QualityReport before, after;
};

Judged judge(const CurvedMesh& mesh, const Coordinates& x, Random& random, bool is_boundary_fixed = true) {
    Judged result{assess_quality(mesh), {}};
    QualityOptions options;
    options.orientation_sign = result.before.orientation_sign;
    const CurvedMesh moved = mesh.with_coordinates(x);
    result.after = assess_quality(moved, options);
    expect_right_certificates(moved, result.after, random);
    if (is_boundary_fixed) {
        for (const Index node : mesh.topology().boundary_nodes()) EXPECT_EQ(x.row(node), mesh.coordinates().row(node));
    }
    return result;
}

void expect_not_worse(const Judged& judged) {
    EXPECT_FALSE(Standing(judged.before.elements).is_better_than(Standing(judged.after.elements)));
}

TEST(UntanglingProperties, HoldOnRandomMeshes) {
    int tangled_meshes = 0, mended = 0;
    for (unsigned seed = 0; seed < 120; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const CurvedMesh mesh = tangled(random_valid_mesh(random), random);

        GuaranteedOptions guaranteed;
        guaranteed.improves = happens(random, 0.5);
        const GuaranteedResult result = untangle_guaranteed(mesh, guaranteed);
        const Judged judged = judge(mesh, result.coordinates, random);
        expect_not_worse(judged);
        // What is not listed is valid, and what is listed is not.
        Standing after(judged.after.elements);
        EXPECT_EQ(static_cast<std::size_t>(after.not_valid), result.unmended.size());
        for (const UnmendedElement& element : result.unmended)
            EXPECT_NE(judged.after.elements[element.element].validity, Validity::valid);
        const bool was_tangled = Standing(judged.before.elements).not_valid > 0;
        tangled_meshes += was_tangled ? 1 : 0;
        mended += was_tangled && after.not_valid == 0 ? 1 : 0;

        GuaranteedOptions sliding;
        sliding.improves = false;
        sliding.boundary.otherwise = happens(random, 0.5) ? BoundaryMode::slide : BoundaryMode::free;
        expect_not_worse(judge(mesh, untangle_guaranteed(mesh, sliding).coordinates, random, false));

        const MeshTopology& topology = mesh.topology();
        if (topology.element_type(0).shape != Shape::triangle || topology.order() < 2) continue;
        expect_not_worse(judge(mesh, untangle_unsigned_angles(mesh).coordinates, random));
        SignedAngleOptions signed_angles;
        signed_angles.beta_choice = BetaChoice::automatic;
        expect_not_worse(judge(mesh, untangle_signed_angles(mesh, signed_angles).coordinates, random));
        signed_angles.beta_choice = BetaChoice::given;
        signed_angles.beta = std::pow(10.0, uniform(random, -4.0, -0.1));
        signed_angles.max_passes = 5;
        signed_angles.reject_worse_pass = true;
        expect_not_worse(judge(mesh, untangle_signed_angles(mesh, signed_angles).coordinates, random));
    }
    EXPECT_GT(tangled_meshes, 40);
    EXPECT_GT(mended, tangled_meshes / 3);
}

}  // namespace
}  // namespace curvewright
