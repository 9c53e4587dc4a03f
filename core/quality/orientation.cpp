#include <fmt/format.h>

#include "core/base/error.h"
#include "core/mesh/renumbering.h"
#include "core/quality/quality.h"

namespace curvewright {
const char* to_string(Validity validity) {
    switch (validity) {
        case Validity::valid:
            return "valid";
        case Validity::invalid:
            return "invalid";
        case Validity::undecided:
            return "undecided";
        case Validity::not_assessed:
            return "not assessed";
    }
    return "";
}

const char* to_string(Orientation orientation) {
    switch (orientation) {
        case Orientation::positive:
            return "positive";
        case Orientation::negative:
            return "negative";
        case Orientation::mixed:
            return "mixed";
    }
    return "";
}

namespace {

bool is_in_plane_of_constant_z(const Eigen::Matrix<double, 2, 3>& box) {
    return box(1, 2) - box(0, 2) <= 1e-9 * (box.row(1) - box.row(0)).norm();
}

}  // namespace

void require_assessable(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    if (topology.dimension() < 2)
        throw Unsupported("The mesh has no elements of dimension 2 or 3; its quality is not defined.");
    if (topology.dimension() == 2 && topology.element_count() > 0) {
        const auto box = bounding_box(mesh);
        if (!is_in_plane_of_constant_z(box))
            throw Unsupported(
                fmt::format("The surface mesh is not in a plane of constant z (z goes from {} to {}); 2D "
                            "meshes must be.",
                            box(0, 2), box(1, 2)));
    }
}

CurvedMesh flip_orientation(const CurvedMesh& mesh) {
    require_assessable(mesh);
    return renumbered(mesh, [](Index) { return true; });
}

Reorientation reorient(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    const bool has_signs =
        topology.dimension() == 3 || (topology.dimension() == 2 && is_in_plane_of_constant_z(bounding_box(mesh)));
    const OrientationSigns signs = has_signs ? orientation_signs(mesh) : OrientationSigns();
    const auto is_to_be = [&](Index element) { return signs.of_element(topology, element) < 0.0; };
    Reorientation result{renumbered(mesh, is_to_be), topology.reversed_count(), 0};
    for (Index element = 0; element < topology.element_count(); ++element)
        if (is_to_be(element)) ++result.renumbered;
    return result;
}

}  // namespace curvewright
