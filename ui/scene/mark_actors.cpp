#include "ui/scene/mark_actors.h"

#include <algorithm>
#include <cmath>

#include <vtkActor.h>
#include <vtkRenderer.h>

#include "ui/scene/label_spacing.h"

namespace curvewright {
namespace {

constexpr double small_diameter = 7.5, large_diameter = 11.0, pin_diameter = 9.0;

bool is_large(MarkRole role) {
    return role == MarkRole::hovered || role == MarkRole::outcome || role == MarkRole::worst ||
           role == MarkRole::active_handle || role == MarkRole::handle || role == MarkRole::axis_x ||
           role == MarkRole::axis_y || role == MarkRole::axis_z;
}

bool is_thin(MarkRole role) {
    return role == MarkRole::spoke || role == MarkRole::ghost || role == MarkRole::tangent ||
           role == MarkRole::contour || role == MarkRole::path;
}

/// About how wide a text is, in sizes of its font: signs of UTF-8 are counted, not bytes.
double width_in_sizes(const std::string& text) {
    return 0.78 *
           static_cast<double>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

Color mix(const Color& a, const Color& b, double t) {
    Color result{};
    for (std::size_t c = 0; c < 3; ++c) result[c] = a[c] + t * (b[c] - a[c]);
    return result;
}

}  // namespace

MarkActors::Text::Text(vtkRenderer* renderer)
    : halo{OverlayText(renderer), OverlayText(renderer), OverlayText(renderer), OverlayText(renderer),
           OverlayText(renderer), OverlayText(renderer), OverlayText(renderer), OverlayText(renderer)},
      text(renderer) {}

void MarkActors::Text::hide() {
    text.hide();
    for (OverlayText& its : halo) its.hide();
}

MarkActors::MarkActors(vtkRenderer* renderer) : renderer_(renderer) {
    for (vtkActor* actor : {halo_.actor(), lines_.actor(), thin_lines_.actor(), small_.actor(), pins_.actor(),
                            large_.actor(), rubber_halo_.actor(), rubber_.actor()})
        renderer->AddActor(actor);
    large_.set_on_top();
    set_colors(ground_, accent_, ink_);
}

void MarkActors::set_colors(const Color& ground, const Color& accent, const Color& ink) {
    ground_ = ground;
    accent_ = accent;
    ink_ = ink;
    halo_.set_style(
        {.color = ground, .opacity = 0.85, .width = 6.0, .cap = 1.0, .depth_bias = 0.0112, .is_on_top = true});
    lines_.set_style({.color = accent, .width = 3.0, .cap = 1.0, .depth_bias = 0.0124, .is_on_top = true});
    thin_lines_.set_style({.color = ink, .width = 1.4, .cap = 1.0, .depth_bias = 0.0118, .is_on_top = true});
    rubber_halo_.set_style({.color = ground, .opacity = 0.8, .width = 3.6, .is_on_top = true, .is_in_pixels = true});
    rubber_.set_style({.color = accent, .width = 1.4, .is_on_top = true, .is_in_pixels = true});
    for (PointActor* points : {&small_, &large_, &pins_}) points->set_rim(ground);
    draw();
}

Color MarkActors::color_of(MarkRole role, double share) const {
    switch (role) {
        case MarkRole::soft:
            return mix(ground_, accent_, 0.15 + 0.85 * std::clamp(share, 0.0, 1.0));
        case MarkRole::pinned:
            return ink_;
        case MarkRole::axis_x:
            return {0.80, 0.20, 0.22};
        case MarkRole::axis_y:
            return {0.18, 0.55, 0.22};
        case MarkRole::axis_z:
            return {0.20, 0.38, 0.86};
        case MarkRole::active_handle:
            return {0.96, 0.66, 0.10};
        case MarkRole::spoke:
            return share < 0.0 ? Color{0.78, 0.20, 0.36} : mix(ground_, accent_, 0.25 + 0.75 * std::min(share, 1.0));
        case MarkRole::ghost:
            return mix(ground_, ink_, 0.45);
        case MarkRole::angle:
        case MarkRole::simplex:
            return accent_;
        case MarkRole::tangled_angle:
        case MarkRole::worst:
            return tangled_color();
        case MarkRole::tangent:
        case MarkRole::path:
            return ink_;
        case MarkRole::contour:
            return mix(ground_, accent_, 0.30 + 0.55 * std::clamp(share, 0.0, 1.0));
        case MarkRole::outcome:
            return {0.96, 0.66, 0.10};
        default:
            return accent_;
    }
}

void MarkActors::set_marks(const Marks& marks, const WorldFrame& frame) {
    marks_ = marks;
    frame_ = frame;
    draw();
}

void MarkActors::draw() {
    struct Points {
        std::vector<float> at;
        std::vector<Color> colors;
    };
    Points small, large, pins;
    for (const MarkPoint& point : marks_.points) {
        Points& set = point.role == MarkRole::pinned ? pins : is_large(point.role) ? large : small;
        for (int d = 0; d < 3; ++d)
            set.at.push_back(static_cast<float>(point.at[static_cast<std::size_t>(d)] - frame_.origin[d]));
        set.colors.push_back(color_of(point.role, point.share));
    }
    const auto show = [this](PointActor& actor, const Points& points) {
        actor.set_points(points.at, frame_.origin, frame_);
        actor.set_colors(points.colors);
        actor.actor()->SetVisibility(!points.at.empty());
    };
    show(small_, small);
    show(large_, large);
    show(pins_, pins);

    Polylines thick, thin, rubber;
    for (const MarkLine& line : marks_.lines) {
        const bool is_rubber = line.role == MarkRole::rubber;
        Polylines& set = is_rubber ? rubber : (is_thin(line.role) ? thin : thick);
        std::vector<std::array<double, 3>> points = line.points;
        if (!is_rubber)
            for (auto& point : points)
                for (std::size_t d = 0; d < 3; ++d) point[d] -= frame_.origin[static_cast<Eigen::Index>(d)];
        set.add(points);
        set.colors.push_back(color_of(line.role, line.share));
    }
    Polylines halo = thick;
    halo.colors.clear();
    halo_.set_lines(halo, 1.0 / frame_.size);
    lines_.set_lines(thick, 1.0 / frame_.size);
    thin_lines_.set_lines(thin, 1.0 / frame_.size);
    for (StrokeActor* stroke : {&halo_, &lines_, &thin_lines_}) frame_.place(stroke->actor(), frame_.origin);
    Polylines rubber_halo = rubber;
    rubber_halo.colors.clear();
    rubber_halo_.set_lines(rubber_halo, 1.0);
    rubber_.set_lines(rubber, 1.0);
}

void MarkActors::place_texts(const ViewMetrics& view) {
    while (texts_.size() < marks_.texts.size()) texts_.push_back(std::make_unique<Text>(renderer_));
    for (const auto& place : texts_) place->hide();
    const double size = 13.0 * view.pixel_ratio, rim = 1.3 * view.pixel_ratio;
    std::vector<LabelBox> boxes;
    std::vector<std::size_t> texts;
    for (std::size_t i = 0; i < marks_.texts.size(); ++i) {
        const auto& point = marks_.texts[i].at;
        const Eigen::Vector4d at = view.project(frame_.to_world({point[0], point[1], point[2]}));
        if (!(at[3] > 0.0)) continue;
        boxes.push_back({at[0], at[1], width_in_sizes(marks_.texts[i].text) * size, 1.15 * size});
        texts.push_back(i);
    }
    keep_apart(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        Text& place = *texts_[i];
        const MarkText& mark = marks_.texts[texts[i]];
        const LabelBox& at = boxes[i];
        place.text.set_font(font_);
        for (std::size_t k = 0; k < place.halo.size(); ++k) {
            place.halo[k].set_font(font_);
            const double angle = 0.25 * 3.14159265358979 * static_cast<double>(k);
            place.halo[k].show(mark.text, at.x + rim * std::cos(angle), at.y + rim * std::sin(angle), size, ground_,
                               TextAnchor::center, true);
        }
        place.text.show(mark.text, at.x, at.y, size, mark.role == MarkRole::angle ? ink_ : color_of(mark.role, 1.0),
                        TextAnchor::center, true);
    }
}

void MarkActors::update(const ViewMetrics& view) {
    place_texts(view);
    for (StrokeActor* stroke : {&halo_, &lines_, &thin_lines_, &rubber_halo_, &rubber_}) stroke->update(view);
    small_.set_diameter(small_diameter * view.pixel_ratio);
    large_.set_diameter(large_diameter * view.pixel_ratio);
    pins_.set_diameter(pin_diameter * view.pixel_ratio);
}

}  // namespace curvewright
