#include "core/tessellate/plane_cut.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"
#include "core/mesh/elevate.h"
#include "core/tessellate/solid_basis.h"

#include "tests/support/mesh_factory.h"

namespace curvewright {
namespace {

using testing::cube_mesh;
using testing::hex_mesh;
using testing::prism_mesh;
using testing::pyramid_mesh;
using testing::random_element;
using testing::single_element;

CuttingPlane plane_through(const Eigen::RowVector3d& point, Eigen::RowVector3d normal) {
    normal.normalize();
    return {normal, normal.dot(point)};
}

Eigen::RowVector3d point_of(const std::vector<float>& points, Index point) {
    return {points[3 * point], points[3 * point + 1], points[3 * point + 2]};
}

/// Signed: positive where the triangles turn counter-clockwise seen from beyond the plane.
double area(const PlaneCut& cut, Index element = -1) {
    double sum = 0.0;
    for (std::size_t t = 0; t < cut.triangle_elements().size(); ++t) {
        if (element >= 0 && cut.triangle_elements()[t] != element) continue;
        const Eigen::Vector3d a = point_of(cut.points(), cut.triangles()[3 * t]).transpose();
        const Eigen::Vector3d b = point_of(cut.points(), cut.triangles()[3 * t + 1]).transpose();
        const Eigen::Vector3d c = point_of(cut.points(), cut.triangles()[3 * t + 2]).transpose();
        sum += 0.5 * (b - a).cross(c - a).dot(cut.plane().normal.transpose());
    }
    return sum;
}

double total_length(const PlaneCut& cut, bool first_only) {
    double sum = 0.0;
    for (std::size_t line = 0; line < cut.line_elements().size(); ++line) {
        if (first_only && !cut.line_is_first()[line]) continue;
        for (Index i = cut.line_offsets()[line]; i + 1 < cut.line_offsets()[line + 1]; ++i)
            sum += (point_of(cut.line_points(), i + 1) - point_of(cut.line_points(), i)).norm();
    }
    return sum;
}

/// Largest distance of the section's points from the plane.
double off_plane(const PlaneCut& cut) {
    double most = 0.0;
    for (const auto* points : {&cut.points(), &cut.line_points()})
        for (Index i = 0; i < static_cast<Index>(points->size() / 3); ++i)
            most = std::max(most, std::abs(cut.plane().distance(point_of(*points, i) + cut.origin())));
    return most;
}

/// The unit cube's meshes made into a ball of radius 1 about the origin.
CurvedMesh rounded(const CurvedMesh& cube) {
    Coordinates x = 2.0 * cube.coordinates();
    x.array() -= 1.0;
    for (Eigen::Index i = 0; i < x.rows(); ++i)
        if (const double length = x.row(i).norm(); length > 0.0) x.row(i) *= x.row(i).cwiseAbs().maxCoeff() / length;
    return cube.with_coordinates(x);
}

/// How far outside the reference element the nearest preimage of a point is (0 = inside), by Newton's method from many
/// starts, since a bent element can cover a point from outside of it as well.
double outside(const CurvedMesh& mesh, const Eigen::RowVector3d& point) {
    const Eigen::MatrixX3d nodes = mesh.element_coordinates(0);
    const ElementType type = mesh.topology().element_type(0);
    double least = 1e9;
    for (int start = 0; start < 27 && least > 1e-4; ++start) {
        Eigen::Vector3d at = Eigen::Vector3d(start % 3, start / 3 % 3, start / 9) / 2.2;
        double distance = 1e9;
        for (int step = 0; step < 25 && distance > 1e-12; ++step) {
            const BasisTable table = lagrange_basis(type, Eigen::MatrixX3d(at.transpose()));
            const Eigen::Vector3d rest = (table.values * nodes - point).transpose();
            distance = rest.norm();
            Eigen::Matrix3d jacobian;
            for (int d = 0; d < 3; ++d) jacobian.col(d) = (table.gradients[d] * nodes).transpose();
            at -= jacobian.fullPivLu().solve(rest);
        }
        if (distance > 1e-9) continue;
        double its = std::max(-at.minCoeff(), at.maxCoeff() - 1.0);
        if (type.shape == Shape::tetrahedron) its = std::max(its, at.sum() - 1.0);
        if (type.shape == Shape::prism) its = std::max(its, at[0] + at[1] - 1.0);
        least = std::min(least, std::max(its, 0.0));
    }
    return least;
}

TEST(SolidBasis, AgreesWithTheTables) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 0.33);
    for (const Shape shape : {Shape::tetrahedron, Shape::hexahedron, Shape::prism})
        for (int order = 1; order <= max_order; ++order) {
            const SolidBasis basis({shape, order});
            const Eigen::MatrixX3d point{{unit(random), unit(random), unit(random)}};
            const BasisTable table = lagrange_basis({shape, order}, point);
            Eigen::VectorXd values(basis.node_count());
            basis.evaluate({point(0, 0), point(0, 1), point(0, 2)}, values.data());
            EXPECT_LT((values - table.values.transpose()).cwiseAbs().maxCoeff(), 1e-10) << name(basis.type());
        }
    EXPECT_THROW(SolidBasis({Shape::triangle, 2}), Unsupported);
}

TEST(SolidBasis, PyramidsInterpolateAndMatchTheirFaces) {
    for (int order = 1; order <= max_order; ++order) {
        const ElementType type{Shape::pyramid, order};
        const SolidBasis basis(type);
        const ReferenceElement& element = reference_element(type);
        Eigen::VectorXd values(basis.node_count());
        for (int node = 0; node < basis.node_count(); ++node) {
            const LatticePoint& at = element.lattice[node];
            basis.evaluate({at[0] / double(order), at[1] / double(order), at[2] / double(order)}, values.data());
            values[node] -= 1.0;
            EXPECT_LT(values.cwiseAbs().maxCoeff(), 1e-8) << order;
        }
        // On a face the functions are those of the face.
        for (const SubElement& facet : element.facets) {
            Eigen::MatrixX3d corners(3, 3);
            for (int i = 0; i < 3; ++i) {
                const LatticePoint& at =
                    element.lattice[facet.nodes[facet.type.shape == Shape::quadrilateral && i == 2 ? 3 : i]];
                corners.row(i) << at[0] / double(order), at[1] / double(order), at[2] / double(order);
            }
            const Eigen::MatrixX3d inside{{0.23, 0.41, 0.0}};
            const Eigen::RowVector3d at =
                corners.row(0) + 0.23 * (corners.row(1) - corners.row(0)) + 0.41 * (corners.row(2) - corners.row(0));
            basis.evaluate({at[0], at[1], at[2]}, values.data());
            const BasisTable face = lagrange_basis(facet.type, inside);
            for (std::size_t i = 0; i < facet.nodes.size(); ++i) {
                EXPECT_NEAR(values[facet.nodes[i]], face.values(0, static_cast<Eigen::Index>(i)), 1e-8) << order;
                values[facet.nodes[i]] = 0.0;
            }
            EXPECT_LT(values.cwiseAbs().maxCoeff(), 1e-8) << order;
        }
    }
}

TEST(PlaneCut, SectionsOfStraightMeshesAreExact) {
    // The cube's section through its middle across the diagonal is a regular hexagon of side 1 / sqrt 2.
    const CuttingPlane diagonal = plane_through({0.5, 0.5, 0.5}, {1.0, 1.0, 1.0});
    const double hexagon = 0.75 * std::sqrt(3.0);
    const CuttingPlane across = plane_through({0.3, 0.0, 0.0}, {1.0, 0.0, 0.0});
    std::vector<CurvedMesh> meshes{pyramid_mesh(2)};
    for (int order = 1; order <= 4; ++order)
        for (const auto& mesh : {cube_mesh(2, order), hex_mesh(2, order), prism_mesh(2, order)}) meshes.push_back(mesh);
    for (const CurvedMesh& mesh : meshes) {
        const PlaneCut cut(mesh, diagonal), straight(mesh, across);
        EXPECT_NEAR(area(cut), hexagon, 1e-6);
        EXPECT_NEAR(area(straight), 1.0, 1e-6);
        EXPECT_LT(off_plane(cut), 2e-7);
        EXPECT_LT(off_plane(straight), 2e-7);
    }
    // Each element of a straight mesh is one polygon.
    const PlaneCut cut(cube_mesh(1, 3), across);
    EXPECT_LE(cut.triangle_elements().size(), 12u);
    EXPECT_EQ(total_length(PlaneCut(hex_mesh(1, 1), across), true), 4.0);
}

TEST(PlaneCut, SectionsOfABallAreDiscs) {
    for (int order = 2; order <= 4; ++order) {
        const std::vector<std::pair<CurvedMesh, const char*>> balls{{rounded(cube_mesh(4, order)), "tetrahedra"},
                                                                    {rounded(hex_mesh(4, order)), "hexahedra"},
                                                                    {rounded(prism_mesh(4, order)), "prisms"}};
        for (const auto& [ball, shape] : balls)
            for (const double height : {0.0, 0.3, 0.61}) {
                const Eigen::RowVector3d normal = Eigen::RowVector3d(0.3, -0.5, 0.8).normalized();
                const PlaneCut cut(ball, {normal, height});
                const double disc = std::numbers::pi * (1.0 - height * height);
                EXPECT_NEAR(area(cut), disc, 6e-3 * disc) << shape << order << " at " << height;
                EXPECT_LT(off_plane(cut), 4e-7);
            }
    }
}

/// The points of the section lie in the element that they are said to belong to.
TEST(PlaneCut, PointsLieInTheCurvedElement) {
    std::mt19937 random(3);
    for (const Shape shape : {Shape::tetrahedron, Shape::hexahedron, Shape::prism})
        for (const int order : {1, 2, 3, 5}) {
            const CurvedMesh mesh = single_element({shape, order}, random_element({shape, order}, 0.15, random));
            const PlaneCut cut(mesh, plane_through(mesh.element_center(0), {0.2, 1.0, -0.4}));
            ASSERT_GT(cut.triangle_elements().size(), 0u);
            EXPECT_EQ(cut.sides().front(), PlaneCut::Side::cut);
            for (Index i = 0; i < static_cast<Index>(cut.points().size() / 3); i += 7)
                EXPECT_LT(outside(mesh, point_of(cut.points(), i) + cut.origin()), 1e-3)
                    << name(ElementType{shape, order});
        }
}

/// The area of the section is the derivative of the volume on one side: that volume is counted on a dense lattice.
TEST(PlaneCut, AreaIsTheDerivativeOfTheVolume) {
    std::mt19937 random(5);
    for (const Shape shape : {Shape::hexahedron, Shape::prism, Shape::tetrahedron}) {
        const CurvedMesh mesh = single_element({shape, 3}, random_element({shape, 3}, 0.2, random));
        const CuttingPlane plane = plane_through(mesh.element_center(0), {1.0, 0.6, 0.3});
        constexpr int n = 60;
        const SolidBasis basis({shape, 3});
        const Eigen::MatrixX3d nodes = mesh.element_coordinates(0);
        const auto box = bounding_box(mesh);
        const double slab = 0.04 * (box.row(1) - box.row(0)).norm();
        double volume = 0.0;
        for (int k = 0; k < n; ++k) {
            Eigen::MatrixX3d points(n * n, 3);
            Eigen::Index count = 0;
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const Eigen::RowVector3d at((i + 0.5) / n, (j + 0.5) / n, (k + 0.5) / n);
                    const double sum = shape == Shape::tetrahedron ? at.sum() : at[0] + at[1];
                    if (shape == Shape::hexahedron || sum <= 1.0) points.row(count++) = at;
                }
            if (count == 0) continue;
            const BasisTable table = lagrange_basis({shape, 3}, points.topRows(count));
            const Eigen::MatrixX3d x = table.values * nodes;
            Eigen::MatrixX3d d[3];
            for (int axis = 0; axis < 3; ++axis) d[axis] = table.gradients[axis] * nodes;
            for (Eigen::Index i = 0; i < count; ++i)
                if (std::abs(plane.distance(x.row(i))) < slab)
                    volume += d[0].row(i).cross(d[1].row(i)).dot(d[2].row(i)) / double(n * n * n);
        }
        // Compared with the mean of the areas through the slab.
        double mean = 0.0;
        constexpr int slices = 41;
        for (int i = 0; i < slices; ++i) {
            CuttingPlane its = plane;
            its.offset += slab * (2.0 * (i + 0.5) / slices - 1.0);
            mean += area(PlaneCut(mesh, its)) / slices;
        }
        EXPECT_NEAR(mean, volume / (2.0 * slab), 0.015 * mean) << name(shape);
    }
}

TEST(PlaneCut, CurvedPyramidsFillWhatHexahedraDo) {
    // Six pyramids of order 3 per cube, bent by a map that they represent exactly: the section is that of the bent cube
    // made of hexahedra.
    const CurvedMesh straight = pyramid_mesh(2);
    MeshData data;
    std::vector<Eigen::RowVector3d> points;
    const ElementType type{Shape::pyramid, 3};
    ElementBlock block{type, 0, {}, {}};
    const SolidBasis linear({Shape::pyramid, 1});
    for (Index element = 0; element < straight.topology().element_count(); ++element) {
        const Eigen::MatrixX3d corners = straight.element_coordinates(element);
        for (const LatticePoint& at : reference_element(type).lattice) {
            Eigen::VectorXd values(5);
            linear.evaluate({at[0] / 3.0, at[1] / 3.0, at[2] / 3.0}, values.data());
            block.nodes.push_back(static_cast<Index>(points.size()));
            points.push_back(values.transpose() * corners);
            data.node_tags.push_back({static_cast<std::int64_t>(points.size())});
        }
        block.tags.push_back({element + 1});
    }
    data.blocks.push_back(block);
    const auto bend = [](const Eigen::RowVector3d& p) {
        return Eigen::RowVector3d(p[0] + 0.3 * p[1] * p[1], p[1] - 0.2 * p[2] * p[2] * p[2], p[2] + 0.15 * p[0] * p[1]);
    };
    Coordinates x(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = bend(points[i]);
    const CurvedMesh pyramids(std::make_shared<MeshTopology>(std::move(data)), x);
    CurvedMesh cube = hex_mesh(2, 3);
    Coordinates bent = cube.coordinates();
    for (Eigen::Index i = 0; i < bent.rows(); ++i) bent.row(i) = bend(bent.row(i));
    cube = cube.with_coordinates(bent);
    for (const double height : {0.2, 0.5, 0.71}) {
        const CuttingPlane plane = plane_through({height, height, 0.5}, {1.0, 0.4, -0.3});
        const PlaneCut ours(pyramids, plane);
        EXPECT_NEAR(area(ours), area(PlaneCut(cube, plane)), 1e-3);
        EXPECT_LT(off_plane(ours), 4e-7);
    }
}

TEST(PlaneCut, PlanesThroughNodesAndFacesCutOnce) {
    for (const CurvedMesh& mesh :
         {cube_mesh(2, 1), cube_mesh(2, 3), hex_mesh(2, 2), prism_mesh(2, 2), pyramid_mesh(2)}) {
        for (int axis = 0; axis < 3; ++axis) {
            const Eigen::RowVector3d normal = Eigen::RowVector3d::Unit(axis);
            const PlaneCut middle(mesh, {normal, 0.5});
            EXPECT_NEAR(area(middle), 1.0, 1e-6);
            for (std::size_t t = 0; t < middle.triangle_elements().size(); ++t)
                EXPECT_LT(mesh.element_center(middle.triangle_elements()[t])[axis], 0.5);
            // The upper side of the mesh is the face of what is kept, its lower side cuts nothing.
            EXPECT_NEAR(area(PlaneCut(mesh, {normal, 1.0})), 1.0, 1e-6);
            EXPECT_EQ(area(PlaneCut(mesh, {normal, 0.0})), 0.0);
        }
        // Through the nodes along a diagonal, from both sides.
        for (const double sign : {1.0, -1.0})
            EXPECT_NEAR(area(PlaneCut(mesh, plane_through({0.5, 0.5, 0.5}, sign * Eigen::RowVector3d(1.0, -1.0, 0.0)))),
                        std::sqrt(2.0), 1e-6);
    }
}

TEST(PlaneCut, TellsOnWhichSideElementsAre) {
    const CurvedMesh ball = rounded(cube_mesh(3, 3));
    const CuttingPlane plane = plane_through({0.1, 0.05, 0.0}, {0.2, -0.4, 1.0});
    std::vector<bool> visible(static_cast<std::size_t>(ball.topology().element_count()), true);
    for (std::size_t i = 0; i < visible.size(); i += 3) visible[i] = false;
    const PlaneCut cut(ball, plane, visible);
    int counts[3] = {};
    for (Index element = 0; element < ball.topology().element_count(); ++element) {
        const auto side = cut.sides()[static_cast<std::size_t>(element)];
        const auto& owner = cut.triangle_elements();
        EXPECT_EQ(std::find(owner.begin(), owner.end(), element) != owner.end(), side == PlaneCut::Side::cut);
        if (!visible[static_cast<std::size_t>(element)]) {
            EXPECT_EQ(side, PlaneCut::Side::removed);
            continue;
        }
        ++counts[static_cast<int>(side)];
        const Eigen::VectorXd heights =
            (ball.element_coordinates(element) * plane.normal.transpose()).array() - plane.offset;
        if (heights.minCoeff() * heights.maxCoeff() < -1e-6) {
            EXPECT_EQ(side, PlaneCut::Side::cut);
        }
        if (side == PlaneCut::Side::kept) {
            EXPECT_LT(heights.minCoeff(), 0.0);
        }
    }
    for (const int count : counts) EXPECT_GT(count, 0);
}

TEST(PlaneCut, FacesHaveOneCurveEach) {
    const CurvedMesh mesh = hex_mesh(3, 2);
    const PlaneCut cut(mesh, {{0.0, 0.0, 1.0}, 0.4});
    // Nine squares: 36 sides, of which 24 are different.
    EXPECT_EQ(cut.line_elements().size(), 36u);
    EXPECT_EQ(std::count(cut.line_is_first().begin(), cut.line_is_first().end(), 1), 24);
    EXPECT_NEAR(total_length(cut, true), 8.0, 1e-5);
    EXPECT_NEAR(total_length(cut, false), 12.0, 1e-5);
    // The curve of a bent face is one polyline that begins and ends where its neighbours do.
    const CurvedMesh ball = rounded(cube_mesh(3, 3));
    const PlaneCut round(ball, plane_through({0.07, 0.0, 0.1}, {0.1, 0.3, 1.0}));
    std::map<std::array<long, 3>, int> ends;
    for (std::size_t line = 0; line < round.line_elements().size(); ++line) {
        if (!round.line_is_first()[line]) continue;
        for (const Index end : {round.line_offsets()[line], round.line_offsets()[line + 1] - 1}) {
            const Eigen::RowVector3d at = point_of(round.line_points(), end);
            ++ends[{std::lround(1e4 * at[0]), std::lround(1e4 * at[1]), std::lround(1e4 * at[2])}];
        }
    }
    for (const auto& [at, count] : ends) EXPECT_GE(count, 2);
}

TEST(PlaneCut, ShrunkElementsLeaveGaps) {
    const CurvedMesh mesh = hex_mesh(2, 2);
    PlaneCutOptions options;
    options.element_size = 0.8;
    const PlaneCut cut(mesh, {{0.0, 1.0, 0.0}, 0.25}, {}, options);
    EXPECT_NEAR(area(cut), 0.64, 1e-6);
    EXPECT_EQ(area(PlaneCut(mesh, {{0.0, 1.0, 0.0}, 0.52}, {}, options)), 0.0);
    EXPECT_EQ(std::count(cut.line_is_first().begin(), cut.line_is_first().end(), 1), 16);
}

TEST(PlaneCut, UnitOffsetAndThreadsDoNotMatter) {
    const CurvedMesh ball = rounded(cube_mesh(3, 3));
    const CuttingPlane plane = plane_through({0.1, 0.0, 0.1}, {0.3, 0.2, 1.0});
    const PlaneCut reference(ball, plane);
    for (const double unit : {1e-6, 1e6}) {
        Coordinates x = unit * ball.coordinates();
        const Eigen::RowVector3d shift(1e3 * unit, -2e3 * unit, 0.0);
        x.rowwise() += shift;
        const PlaneCut cut(ball.with_coordinates(x), {plane.normal, plane.offset * unit + plane.normal.dot(shift)});
        EXPECT_NEAR(area(cut) / (unit * unit), area(reference), 1e-5);
    }
    set_thread_count(1);
    const PlaneCut alone(ball, plane);
    set_thread_count(0);
    EXPECT_EQ(alone.points(), reference.points());
    EXPECT_EQ(alone.triangles(), reference.triangles());
    EXPECT_EQ(alone.line_points(), reference.line_points());
}

TEST(PlaneCut, BadInputIsTold) {
    const CurvedMesh mesh = cube_mesh(1, 1);
    EXPECT_THROW(PlaneCut(mesh, {{2.0, 0.0, 0.0}, 0.0}), InvalidInput);
    EXPECT_THROW(PlaneCut(mesh, {{1.0, 0.0, 0.0}, 0.0}, {true}), InvalidInput);
    // Flat meshes have no inside.
    const PlaneCut flat(testing::square_mesh(2, 2), {{1.0, 0.0, 0.0}, 0.5});
    EXPECT_TRUE(flat.triangles().empty());
}

}  // namespace
}  // namespace curvewright
