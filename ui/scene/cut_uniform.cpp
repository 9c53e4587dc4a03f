#include "ui/scene/cut_uniform.h"

namespace curvewright {

std::array<float, 4> cut_coefficients(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin,
                                      double mesh_size) {
    if (!plane) return {0.0f, 0.0f, 0.0f, -1.0f};
    constexpr double room = 2e-6;
    // In units of the mesh's size, so that the coefficients are near 1 whatever the unit of length.
    const Eigen::RowVector3d normal = plane->normal / mesh_size;
    return {static_cast<float>(normal[0]), static_cast<float>(normal[1]), static_cast<float>(normal[2]),
            static_cast<float>((plane->normal.dot(origin) - plane->offset) / mesh_size - room)};
}

}  // namespace curvewright
