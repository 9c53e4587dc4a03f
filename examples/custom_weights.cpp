// A weighting of one's own: custom_weights MESH DEFORMATION
// For instance: custom_weights moving_circle.msh deformation.json
//
// Warps the mesh with Curvewright's convex weights and with inverse-distance weights written here, and compares.

#include <cstdio>
#include <exception>

#include <curvewright/curvewright.h>

namespace {

using namespace curvewright;

/// Each neighbour counts by the inverse of its distance; the weights sum to 1. Unlike convex weights these do not
/// reproduce the node's position: sum w_j offset_j is not zero. The warp is still exact for affine motions, because it
/// takes the affine part of a motion as it is and gives the weights only the rest.
PatchStatus inverse_distance(const Patch& patch, Eigen::Ref<Eigen::VectorXd> weights) {
    weights = patch.offsets.rowwise().norm().cwiseInverse();
    weights /= weights.sum();
    return PatchStatus::regular;
}

void compare(const char* name, const CurvedMesh& mesh, const Coordinates& boundary, const WarpOptions& options) {
    const WarpResult warped = warp(mesh, boundary, options);
    QualityOptions same_orientation;
    same_orientation.orientation_sign = assess_quality(mesh).orientation_sign;
    const QualitySummary quality = assess_quality(mesh.with_coordinates(warped.coordinates), same_orientation).summary;
    std::printf("%-17s min %.4f, mean %.4f; %d invalid. %s\n", name, quality.min, quality.mean, quality.invalid,
                warped.report.solver_note.c_str());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "Usage: custom_weights MESH DEFORMATION\n");
        return 2;
    }
    try {
        const CurvedMesh mesh = read_mesh(argv[1]).mesh;
        const Coordinates boundary = apply_deformation(mesh, read_deformation(argv[2]));
        WarpOptions options;
        compare("convex", mesh, boundary, options);
        options.weighting = Weighting::custom;
        options.custom_weights = inverse_distance;
        compare("inverse distance", mesh, boundary, options);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
