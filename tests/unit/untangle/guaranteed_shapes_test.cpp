/// The guaranteed method on quadrilaterals, hexahedra, prisms and mixed meshes.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/quality/quality.h"
#include "core/untangle/guaranteed.h"
#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

/// The unit square or cube carried by a smooth map onto a curved one; J of the map is positive everywhere.
Coordinates bent(const Coordinates& x, int dim) {
    Coordinates result = x;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        result(i, 0) += 0.15 * x(i, 1) * x(i, 1) - 0.1 * x(i, 0) * x(i, 1);
        result(i, 1) += 0.12 * std::sin(3.0 * x(i, 0));
        if (dim == 3) result(i, 2) += 0.15 * x(i, 0) * x(i, 1);
    }
    return result;
}

struct Start {
    CurvedMesh mesh;  ///< tangled inside
    Index invalid = 0;
};

/// A mesh with a curved boundary whose interior nodes lie at random within some distance of where the bent mesh has
/// them: the bent mesh is a valid one with the same boundary.
Start tangled(const CurvedMesh& flat, double amplitude, std::mt19937& random) {
    const CurvedMesh smooth = flat.with_coordinates(bent(flat.coordinates(), flat.topology().dimension()));
    EXPECT_EQ(assess_quality(smooth).summary.valid, flat.topology().element_count());
    CurvedMesh mesh = testing::shaken(smooth, amplitude, random);
    return {mesh, assess_quality(mesh).summary.invalid};
}

void expect_mended(const Start& start) {
    const CurvedMesh& mesh = start.mesh;
    const GuaranteedResult result = untangle_guaranteed(mesh);
    QualityOptions options;
    options.orientation_sign = 1.0;
    const QualitySummary after = assess_quality(mesh.with_coordinates(result.coordinates), options).summary;
    EXPECT_EQ(after.valid, mesh.topology().element_count());
    EXPECT_TRUE(result.unmended.empty());
    if (start.invalid > 0)
        EXPECT_GT(after.min, assess_quality(mesh).summary.min);
    else
        EXPECT_EQ(result.coordinates, mesh.coordinates());
    for (const Index node : mesh.topology().boundary_nodes())
        for (int d = 0; d < 3; ++d) ASSERT_EQ(result.coordinates(node, d), mesh.coordinates()(node, d));
}

TEST(GuaranteedShapes, MendsQuadrilateralsOfEveryOrderInsideCurvedBoundaries) {
    std::mt19937 random(1);
    Index tangles = 0;
    for (const int order : {1, 2, 3, 4})
        for (const double amplitude : {0.05, 0.1, 0.2}) {
            SCOPED_TRACE("order " + std::to_string(order) + ", amplitude " + std::to_string(amplitude));
            const Start start = tangled(testing::quad_mesh(5, order), amplitude, random);
            tangles += start.invalid;
            expect_mended(start);
        }
    EXPECT_GT(tangles, 50);
}

TEST(GuaranteedShapes, MendsTrianglesBesideQuadrilaterals) {
    std::mt19937 random(2);
    Index tangles = 0;
    for (const int order : {1, 2, 3, 4}) {
        SCOPED_TRACE("order " + std::to_string(order));
        const Start start = tangled(testing::mixed_square_mesh(4, order), 0.12, random);
        tangles += start.invalid;
        expect_mended(start);
    }
    EXPECT_GT(tangles, 20);
}

TEST(GuaranteedShapes, MendsHexahedraPrismsAndBothTogether) {
    std::mt19937 random(3);
    Index tangles = 0;
    for (const int order : {1, 2, 3})
        for (const CurvedMesh& flat :
             {testing::hex_mesh(order < 3 ? 3 : 2, order), testing::prism_mesh(order < 3 ? 3 : 2, order),
              testing::mixed_cube_mesh(2, order)}) {
            SCOPED_TRACE(name(flat.topology().element_type(0)));
            const Start start = tangled(flat, order == 1 ? 0.2 : 0.1, random);
            tangles += start.invalid;
            expect_mended(start);
        }
    EXPECT_GT(tangles, 50);
}

}  // namespace
}  // namespace curvewright
