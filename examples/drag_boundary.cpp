// Drags a named boundary and lets the interior follow, frame by frame: drag_boundary MESH GROUP
// For instance: drag_boundary moving_circle.msh circle
//
// The equations are set up and solved once, when the drag begins; a frame is then a few multiplications per node.

#include <algorithm>
#include <cstdio>
#include <exception>

#include <curvewright/curvewright.h>

namespace {

using namespace curvewright;

void drag(const CurvedMesh& mesh, const std::string& group) {
    const auto nodes = mesh.topology().find_group_nodes(group);
    if (!nodes || nodes->empty()) throw InvalidInput("There is no group '" + group + "' with nodes in it.");
    DraggedSet set;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    for (const Index node : *nodes) {
        if (!mesh.topology().is_boundary_node(node)) continue;
        set.nodes.push_back(node);
        center += mesh.coordinates().row(node).transpose();
    }
    center /= static_cast<double>(std::max<std::size_t>(1, set.nodes.size()));

    const Warper warper(mesh);
    const ResponseField field(warper, set, ResponseKind::affine, center);
    const OrientationSigns orientation = assess_quality(mesh).orientation_sign;
    Coordinates frame = mesh.coordinates();
    for (int degrees = 10; degrees <= 90; degrees += 10) {
        const AffineMotion turn = AffineMotion::rotation(Eigen::Vector3d::UnitZ(), degrees * EIGEN_PI / 180.0);
        field.apply(turn, mesh.coordinates(), frame);
        QualityOptions same_orientation;
        same_orientation.orientation_sign = orientation;
        const QualitySummary quality = assess_quality(mesh.with_coordinates(frame), same_orientation).summary;
        std::printf("turned by %2d degrees: min %7.4f, %d invalid\n", degrees, quality.min, quality.invalid);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "Usage: drag_boundary MESH GROUP\n");
        return 2;
    }
    try {
        drag(read_mesh(argv[1]).mesh, argv[2]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
