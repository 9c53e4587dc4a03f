#include "ui/scene/orientation_axes.h"

#include <algorithm>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <Eigen/Geometry>

namespace curvewright {
namespace {

constexpr double axis_length = 30.0, label_distance = 10.0, corner_distance = 50.0, text_size = 12.0;
/// x, y, z: told apart by lightness as well, and by their labels.
constexpr std::array<Color, 3> axis_colors{{{0.76, 0.24, 0.18}, {0.24, 0.55, 0.26}, {0.16, 0.36, 0.72}}};

}  // namespace

OrientationAxes::OrientationAxes(vtkRenderer* renderer) : renderer_(renderer) {
    strokes_.set_style({.color = {1, 1, 1}, .width = 2.2, .is_on_top = true, .is_in_pixels = true});
    renderer->AddActor(strokes_.actor());
    for (auto& label : labels_) label = std::make_unique<OverlayText>(renderer);
}

void OrientationAxes::set_colors(const Color& background, const Color& foreground) {
    background_ = background;
    foreground_ = foreground;
}

double OrientationAxes::size(double pixel_ratio) const {
    return is_visible_ ? (corner_distance + axis_length + label_distance + 0.5 * text_size) * pixel_ratio : 0.0;
}

void OrientationAxes::update(const ViewMetrics& view) {
    const bool fits = view.size[0] > 240.0 * view.pixel_ratio && view.size[1] > 160.0 * view.pixel_ratio;
    if (!is_visible_ || !fits) {
        strokes_.clear();
        for (auto& label : labels_) label->hide();
        return;
    }
    vtkCamera* camera = renderer_->GetActiveCamera();
    const Eigen::Vector3d backward = -Eigen::Vector3d(camera->GetDirectionOfProjection());
    const Eigen::Vector3d right = Eigen::Vector3d(camera->GetViewUp()).cross(backward).normalized();
    const Eigen::Vector3d up = backward.cross(right);
    std::array<int, 3> order{0, 1, 2};
    // Those that point away come first.
    std::sort(order.begin(), order.end(), [&](int a, int b) { return backward[a] < backward[b]; });
    const double x = corner_distance * view.pixel_ratio, y = x;
    Polylines lines;
    for (int axis : order) {
        const double length = axis_length * view.pixel_ratio;
        lines.add({{x, y, 0.0}, {x + length * right[axis], y + length * up[axis], 0.0}});
        Color color = axis_colors[axis];
        const double fading = 0.35 * std::clamp(-backward[axis], 0.0, 1.0);
        for (std::size_t c = 0; c < 3; ++c) color[c] += fading * (background_[c] - color[c]);
        lines.colors.push_back(color);
        const double reach = length + label_distance * view.pixel_ratio;
        labels_[axis]->show(std::string(1, "xyz"[axis]), x + reach * right[axis], y + reach * up[axis],
                            text_size * view.pixel_ratio, foreground_, TextAnchor::center, true);
    }
    strokes_.set_lines(lines, 1.0);
    strokes_.update(view);
}

}  // namespace curvewright
