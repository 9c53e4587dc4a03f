#include "ui/scene/surface_parts.h"

#include <algorithm>
#include <span>

namespace curvewright {

std::vector<vtkActor*> SurfaceParts::actors() const {
    std::vector<vtkActor*> actors;
    for (const SurfaceActor& part : parts_) actors.push_back(part.actor());
    return actors;
}

void SurfaceParts::set_surface(const Tessellation& tessellation, bool is_new) {
    const std::size_t count = tessellation.triangle_elements().size();
    const std::size_t each = std::max(few_triangles, (count + parts_.size() - 1) / parts_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i)
        parts_[i].set_surface(tessellation, {std::min(count, i * each), std::min(count, (i + 1) * each)}, is_new);
}

void SurfaceParts::set_colors(const Tessellation& tessellation, const std::function<Color(Index)>& color_of) {
    for (SurfaceActor& part : parts_) part.set_colors(tessellation, color_of);
}

void SurfaceParts::set_field(const std::vector<double>& values, const ColorScale& scale) {
    for (SurfaceActor& part : parts_)
        part.set_field(std::span(values).subspan(part.first_point(), part.point_count()), scale);
}

void SurfaceParts::set_cut(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin,
                           double mesh_size) {
    for (SurfaceActor& part : parts_) part.set_cut(plane, origin, mesh_size);
}

void SurfaceParts::set_lit(bool is_lit) {
    for (SurfaceActor& part : parts_) part.set_lit(is_lit);
}

void SurfaceParts::place(const WorldFrame& frame, const Eigen::RowVector3d& origin) {
    for (SurfaceActor& part : parts_) frame.place(part.actor(), origin);
}

void SurfaceParts::update(const ViewMetrics& view) {
    for (SurfaceActor& part : parts_) part.update(view);
}

}  // namespace curvewright
