#include "ui/scene/mesh_numbers.h"

namespace curvewright {

std::vector<NumberLabel> find_number_labels(const CurvedMesh& mesh, const DrawnSurface& drawn, const WorldFrame& frame,
                                            const SceneOptions& options) {
    std::vector<NumberLabel> labels;
    if (options.show_element_numbers)
        for (const FaceMiddle& middle : face_middles(drawn))
            labels.push_back({NumberKind::element, mesh.topology().element_tag(middle.element).value, middle.element,
                              frame.to_world(middle.at)});
    if (options.show_node_numbers)
        for (const Index node : drawn.skin.nodes()) {
            const Eigen::RowVector3d at = mesh.coordinates().row(node);
            if (drawn.section && drawn.section->plane().distance(at) > 0.0) continue;
            labels.push_back({NumberKind::node, mesh.topology().node_tag(node).value, node, frame.to_world(at)});
        }
    return labels;
}

}  // namespace curvewright
