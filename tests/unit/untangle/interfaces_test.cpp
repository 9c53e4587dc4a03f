// What lies between two regions stays where it is, or on itself, or goes, as the rules say.

#include <random>

#include <gtest/gtest.h>

#include "core/quality/quality.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/unsigned_angles.h"
#include "core/warp/straight_start.h"
#include "tests/support/mesh_factory.h"
#include "tests/support/region_meshes.h"

namespace curvewright {
namespace {

using namespace testing;

/// Interior nodes that are on no interface thrown about, so that elements tangle.
CurvedMesh tangled_between(const CurvedMesh& mesh, double amplitude, std::mt19937& random) {
    const CurvedMesh thrown = shaken(mesh, amplitude, random);
    Coordinates x = thrown.coordinates();
    for (const Index node : mesh.topology().interface_nodes()) x.row(node) = mesh.coordinates().row(node);
    return mesh.with_coordinates(std::move(x));
}

void expect_interface_stays(const CurvedMesh& mesh, const Coordinates& x) {
    ASSERT_FALSE(mesh.topology().interface_nodes().empty());
    for (const Index node : mesh.topology().interface_nodes()) EXPECT_EQ(x.row(node), mesh.coordinates().row(node));
}

TEST(Interfaces, EveryMethodLeavesThemBitForBit) {
    std::mt19937 random(3);
    for (const int order : {2, 3, 4}) {
        const CurvedMesh bent = with_bent_middle(with_regions(square_mesh(4, order), InterfaceCells::named), 0.12);
        const CurvedMesh mesh = tangled_between(bent, 0.16 / order, random);
        ASSERT_GT(assess_quality(mesh).summary.invalid, 0);
        expect_interface_stays(mesh, untangle_guaranteed(mesh).coordinates);
        expect_interface_stays(mesh, untangle_signed_angles(mesh).coordinates);
        expect_interface_stays(mesh, untangle_unsigned_angles(mesh).coordinates);
        expect_interface_stays(mesh, warp_from_straight(mesh).coordinates);
    }
}

TEST(Interfaces, RegionsKeepTheirSizeWhenAMeshIsMended) {
    std::mt19937 random(5);
    const std::vector<CurvedMesh> meshes{square_mesh(4, 3), quad_mesh(4, 2), cube_mesh(2, 2), hex_mesh(2, 2),
                                         prism_mesh(2, 2)};
    for (const CurvedMesh& plain : meshes)
        for (const InterfaceCells cells : {InterfaceCells::none, InterfaceCells::named}) {
            const CurvedMesh bent = with_bent_middle(with_regions(plain, cells), 0.1);
            const double near = size_of_group(bent, "near");
            EXPECT_GT(near, 0.52);
            const CurvedMesh mesh = tangled_between(bent, 0.12, random);
            const GuaranteedResult result = untangle_guaranteed(mesh);
            EXPECT_TRUE(result.unmended.empty());
            expect_interface_stays(mesh, result.coordinates);
            EXPECT_NEAR(size_of_group(mesh.with_coordinates(result.coordinates), "near"), near, 1e-12);
        }
}

TEST(Interfaces, SlideAlongThemselvesWhereARuleSaysSo) {
    std::mt19937 random(7);
    for (const char* rule : {"interface=slide", "interfaces=slide", "near=slide"}) {
        // The middle node of an edge of the interface folds it back at its end.
        const bool is_named = std::string(rule) == "interface=slide";
        const CurvedMesh plain =
            with_regions(square_mesh(4, 2), is_named ? InterfaceCells::named : InterfaceCells::none);
        Coordinates x = plain.coordinates();
        x(node_at(plain, 0.5, 0.375), 1) = 0.27;
        const CurvedMesh mesh = plain.with_coordinates(x);
        const GuaranteedResult fixed = untangle_guaranteed(mesh);
        ASSERT_FALSE(fixed.unmended.empty());
        for (const UnmendedElement& element : fixed.unmended)
            EXPECT_EQ(element.fixed_interfaces, std::vector<std::string>{is_named ? "interface" : "interfaces"});
        GuaranteedOptions options;
        options.boundary.add(rule);
        const GuaranteedResult result = untangle_guaranteed(mesh, options);
        EXPECT_TRUE(result.unmended.empty()) << rule;
        EXPECT_GT(result.sliding_nodes, 0);
        for (const Index node : mesh.topology().interface_nodes()) EXPECT_NEAR(result.coordinates(node, 0), 0.5, 1e-14);
        EXPECT_LT(result.largest_boundary_distance, 1e-12);
        EXPECT_NEAR(size_of_group(mesh.with_coordinates(result.coordinates), "near"), 0.5, 1e-12);
    }
}

TEST(Interfaces, CurvedOnesSlideOnThemselvesIn2DAnd3D) {
    std::mt19937 random(11);
    const std::vector<CurvedMesh> meshes{square_mesh(4, 3), cube_mesh(2, 2), hex_mesh(2, 2)};
    for (const CurvedMesh& plain : meshes) {
        const CurvedMesh bent = with_bent_middle(with_regions(plain, InterfaceCells::named), 0.08);
        const double near = size_of_group(bent, "near");
        const CurvedMesh mesh = tangled_between(bent, 0.12, random);
        GuaranteedOptions options;
        options.boundary.add("interface=slide");
        const GuaranteedResult result = untangle_guaranteed(mesh, options);
        EXPECT_TRUE(result.unmended.empty());
        bool any_moved = false;
        for (const Index node : mesh.topology().interface_nodes())
            any_moved = any_moved || result.coordinates.row(node) != mesh.coordinates().row(node);
        EXPECT_TRUE(any_moved);
        for (const Index node : mesh.topology().boundary_nodes())
            EXPECT_EQ(result.coordinates.row(node), mesh.coordinates().row(node));
        // Nodes are on the interface as it was read; its facets interpolate it.
        EXPECT_LT(result.largest_boundary_distance, 5e-3);
        EXPECT_NEAR(size_of_group(mesh.with_coordinates(result.coordinates), "near"), near, 2e-3);
    }
}

TEST(Interfaces, TheBoundaryMaySlideWithoutThem) {
    std::mt19937 random(13);
    const CurvedMesh bent = with_bent_middle(with_regions(square_mesh(4, 3), InterfaceCells::named), 0.1);
    const CurvedMesh mesh = tangled_between(bent, 0.05, random);
    GuaranteedOptions options;
    options.boundary.add("slide");
    expect_interface_stays(mesh, untangle_guaranteed(mesh, options).coordinates);
    options.boundary.add("interface=free");
    const Coordinates x = untangle_guaranteed(mesh, options).coordinates;
    bool any_moved = false;
    for (const Index node : mesh.topology().interface_nodes())
        any_moved = any_moved || x.row(node) != mesh.coordinates().row(node);
    EXPECT_TRUE(any_moved);
}

TEST(Interfaces, NamedPointsAndCurvesInsideStay) {
    std::mt19937 random(17);
    const CurvedMesh square = square_mesh(4, 2);
    const CurvedMesh with_point = with_named_cell(square, {Shape::vertex, 1}, {node_at(square, 0.25, 0.5)}, "probe");
    expect_interface_stays(with_point, untangle_guaranteed(tangled_between(with_point, 0.1, random)).coordinates);

    const CurvedMesh cube = cube_mesh(4, 1);
    const std::vector<Index> wire{node_at(cube, 0.25, 0.5, 0.5), node_at(cube, 0.5, 0.5, 0.5)};
    const CurvedMesh with_wire = with_named_cell(cube, {Shape::line, 1}, wire, "wire");
    const CurvedMesh mesh = tangled_between(with_wire, 0.12, random);
    expect_interface_stays(mesh, untangle_guaranteed(mesh).coordinates);
    GuaranteedOptions options;
    options.boundary.add("wire=free");
    const Coordinates x = untangle_guaranteed(mesh, options).coordinates;
    EXPECT_NE(x.row(wire[0]), mesh.coordinates().row(wire[0]));
    options = {};
    options.boundary.add("wire=slide");  // its ends are corners
    expect_interface_stays(mesh, untangle_guaranteed(mesh, options).coordinates);
}

}  // namespace
}  // namespace curvewright
