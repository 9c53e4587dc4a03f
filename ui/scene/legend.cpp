#include "ui/scene/legend.h"

#include <algorithm>
#include <cmath>

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "ui/palette/quality_colors.h"
#include "ui/scene/legend_ticks.h"

namespace curvewright {
namespace {

// All lengths in units of the pixel ratio.
constexpr double column_width = 98.0, right_pad = 12.0, bar_width = 14.0, label_gap = 7.0, text_size = 12.0;
constexpr double title_height = 40.0, swatch_height = 14.0, swatch_gap = 8.0, min_height_below = 16.0;

/// A line that fits the column: at most so many letters (not bytes: the text is UTF-8).
std::string shortened(const std::string& text) {
    constexpr std::size_t most = 16;
    std::size_t letters = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if ((static_cast<unsigned char>(text[i]) & 0xC0) == 0x80) continue;
        if (++letters == most) {
            // The last letter stays if the text ends with it.
            std::size_t end = i + 1;
            while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
            return end == text.size() ? text : text.substr(0, i) + "\u2026";
        }
    }
    return text;
}

Color mix(const Color& a, const Color& b, double share_of_b) {
    Color result{};
    for (std::size_t c = 0; c < 3; ++c) result[c] = (1.0 - share_of_b) * a[c] + share_of_b * b[c];
    return result;
}

}  // namespace

Legend::Legend(vtkRenderer* renderer) : renderer_(renderer) {
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(data_);
    mapper->SetScalarModeToUsePointData();
    actor_->SetMapper(mapper);
    actor_->PickableOff();
    actor_->GetPositionCoordinate()->SetCoordinateSystemToViewport();
    colors_->SetNumberOfComponents(4);
    renderer->AddViewProp(actor_);
}

Legend::~Legend() = default;

void Legend::set_colors(const Color& background, const Color& foreground) {
    background_ = background;
    foreground_ = foreground;
}

bool Legend::is_drawn() const {
    return is_visible_ && (content_.has_bar || is_tangled()) && !(content_.is_quality && !summary_);
}

double Legend::width(double pixel_ratio) const {
    return is_drawn() ? (column_width + right_pad + label_gap) * pixel_ratio : 0.0;
}

bool Legend::contains(double x, double y) const {
    return x >= panel_.left && x < panel_.right && y >= panel_.bottom && y < panel_.top;
}

void Legend::begin() {
    points_->Reset();
    cells_->Reset();
    colors_->Reset();
    used_texts_ = 0;
}

void Legend::add_polygon(const std::vector<std::array<double, 2>>& corners, const Color& color, double opacity) {
    std::vector<vtkIdType> ids;
    for (const auto& corner : corners) ids.push_back(points_->InsertNextPoint(corner[0], corner[1], 0.0));
    cells_->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    // One colour per point (every polygon has its own): colours of cells need texture buffers, which not every driver
    // has.
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (double channel : {color[0], color[1], color[2], opacity})
            colors_->InsertNextValue(static_cast<unsigned char>(std::lround(255.0 * std::clamp(channel, 0.0, 1.0))));
}

void Legend::add_box(const Box& box, const Color& color, double opacity) {
    add_polygon({{box.left, box.bottom}, {box.right, box.bottom}, {box.right, box.top}, {box.left, box.top}}, color,
                opacity);
}

void Legend::add_frame(const Box& box, double line) {
    const Color color = mix(background_, foreground_, 0.55);
    add_box({box.left, box.bottom, box.right, box.bottom + line}, color);
    add_box({box.left, box.top - line, box.right, box.top}, color);
    add_box({box.left, box.bottom, box.left + line, box.top}, color);
    add_box({box.right - line, box.bottom, box.right, box.top}, color);
}

void Legend::add_hatch(const Box& box, double ratio) {
    const Color color = mix(tangled_color(), {1.0, 1.0, 1.0}, 0.75);
    // The stripes of the view: x + y constant, here cut off by the box.
    const double step = 6.0 * std::sqrt(2.0) * ratio, thick = 1.8 * std::sqrt(2.0) * ratio;
    const double width = box.right - box.left, height = box.top - box.bottom;
    const auto at = [&](double sum, bool is_low_end) -> std::array<double, 2> {
        const double x = is_low_end ? std::min(sum, width) : std::max(0.0, sum - height);
        return {box.left + x, box.bottom + sum - x};
    };
    for (double sum = 0.5 * step; sum + thick < width + height; sum += step)
        add_polygon({at(sum, true), at(sum + thick, true), at(sum + thick, false), at(sum, false)}, color);
}

void Legend::add_dots(const Box& box, double ratio) {
    const double dot = std::round(2.0 * ratio), step = 2.0 * dot;
    const Color color = mix(undecided_color(), {0.0, 0.0, 0.0}, 0.35);
    for (double x = box.left; x < box.right; x += step)
        for (double y : {box.bottom, box.top - dot}) add_box({x, y, std::min(x + dot, box.right), y + dot}, color);
    for (double y = box.bottom; y < box.top; y += step)
        for (double x : {box.left, box.right - dot}) add_box({x, y, x + dot, std::min(y + dot, box.top)}, color);
}

OverlayText& Legend::next_text() {
    if (used_texts_ == texts_.size()) texts_.push_back(std::make_unique<OverlayText>(renderer_));
    texts_[used_texts_]->set_font(font_);
    return *texts_[used_texts_++];
}

void Legend::finish() {
    for (std::size_t i = used_texts_; i < texts_.size(); ++i) texts_[i]->hide();
    // The arrays are filled in place: unless told, the mapper goes on drawing what it has on the graphics card.
    points_->Modified();
    colors_->Modified();
    data_->Initialize();
    data_->SetPoints(points_);
    data_->SetPolys(cells_);
    data_->GetPointData()->SetScalars(colors_);
    data_->Modified();
    actor_->SetVisibility(cells_->GetNumberOfCells() > 0);
}

void Legend::draw_marker(double left, double height, double ratio) {
    const double size = 4.5 * ratio;
    add_polygon({{left, height}, {left + size, height - size}, {left + size, height + size}}, foreground_);
    next_text().show("min " + format_value(summary_->min), left + size + 4.0 * ratio, height, text_size * ratio,
                     foreground_, TextAnchor::left, true);
}

void Legend::draw_ticks(const Box& bar, double line, std::optional<double> taken, double ratio) {
    const ColorScale& scale = content_.scale;
    const double height = bar.top - bar.bottom;
    double last = -1e9;
    for (const Tick& tick : legend_ticks(scale.lower, scale.upper)) {
        const double y = std::round(bar.bottom + scale.position(tick.value) * (height - line));
        if (taken && std::abs(y - *taken) < 14.0 * ratio) continue;
        if (y - last < 14.0 * ratio) continue;
        last = y;
        add_box({bar.right, y, bar.right + std::round(3.0 * ratio), y + line}, mix(background_, foreground_, 0.55));
        next_text().show(tick.label, bar.right + label_gap * ratio, y, text_size * ratio, foreground_);
    }
}

void Legend::update(const ViewMetrics& view) {
    begin();
    panel_ = {0, 0, 0, 0};
    if (!is_drawn() || (content_.is_quality && summary_->elements() == 0)) return finish();
    const double ratio = view.pixel_ratio, line = std::max(1.0, std::round(ratio));
    const bool is_quality = content_.is_quality, has_bar = content_.has_bar;
    const bool has_alarm = is_quality || is_tangled();
    const bool has_undecided = is_quality && summary_->undecided > 0;
    // Below the bar where it is not on it.
    const bool is_minimum_below =
        is_quality && (is_tangled() || summary_->min < content_.scale.lower || summary_->min > content_.scale.upper);
    const int swatches = (has_alarm ? 1 : 0) + (has_undecided ? 1 : 0) + (content_.has_missing ? 1 : 0);
    const double below =
        ((swatch_gap + swatch_height) * swatches + (is_minimum_below ? min_height_below : 0.0)) * ratio;
    const double above = has_bar ? title_height * ratio : 0.0;
    const double free = view.size[1] - (title_height + 24.0) * ratio - below;
    if (free < 40.0 * ratio || view.size[0] < 240.0 * ratio) return finish();
    const double bar_height = has_bar ? std::round(std::min({free, 0.52 * view.size[1], 320.0 * ratio})) : 0.0;
    const double total = above + bar_height + below;
    const double left = std::round(view.size[0] - (column_width + right_pad) * ratio);
    const double top = std::round(0.5 * (view.size[1] + total));
    const double bar_top = std::round(top - above), bar_bottom = bar_top - bar_height;
    const Box bar{left, bar_bottom, left + std::round(bar_width * ratio), bar_top};

    const double pad = 8.0 * ratio;
    panel_ = {left - pad, bar_bottom - below - pad, static_cast<double>(view.size[0]), top + pad};
    add_box(panel_, background_, 0.8);
    const Color dim = mix(background_, foreground_, 0.72);
    if (has_bar) {
        const bool is_named = !content_.title.empty();
        next_text().show(is_named ? shortened(content_.title) : "Scaled Jacobian", left, top - 7.0 * ratio,
                         text_size * ratio, foreground_, TextAnchor::left, true);
        next_text().show(is_named ? shortened(content_.detail) : "min J / max J", left, top - 22.0 * ratio,
                         0.92 * text_size * ratio, dim);
        constexpr int bands = 128;
        const double extent = content_.scale.upper - content_.scale.lower;
        for (int i = 0; i < bands; ++i)
            add_box(
                {bar.left, bar.bottom + bar_height * i / bands, bar.right, bar.bottom + bar_height * (i + 1) / bands},
                content_.scale.color_of(content_.scale.lower + extent * ((i + 0.5) / bands)));
        add_frame(bar, line);
        std::optional<double> minimum;
        if (is_quality) {
            const double position = std::clamp(content_.scale.position(summary_->min), 0.0, 1.0);
            if (!is_minimum_below) minimum = bar.bottom + position * (bar_height - line) + 0.5 * line;
        }
        if (minimum) draw_marker(bar.right + 2.0 * ratio, *minimum, ratio);
        draw_ticks(bar, line, minimum, ratio);
    }

    double swatch_top = bar.bottom;
    const double height = std::round(swatch_height * ratio), text_x = bar.right + label_gap * ratio;
    const auto next_swatch = [&](const char* text, const Color& color, const Color& text_color) {
        swatch_top = std::round(swatch_top - swatch_gap * ratio);
        const Box box{bar.left, swatch_top - height, bar.right, swatch_top};
        add_box(box, color);
        next_text().show(text, text_x, 0.5 * (box.top + box.bottom), text_size * ratio, text_color);
        swatch_top = box.bottom;
        return box;
    };
    if (has_alarm)
        add_hatch(
            next_swatch(is_quality ? "\u2264 0 tangled" : "tangled", tangled_color(), is_tangled() ? foreground_ : dim),
            ratio);
    if (is_minimum_below) {
        swatch_top -= std::round(min_height_below * ratio);
        next_text().show("min " + format_value(summary_->min), text_x, swatch_top + 4.0 * ratio, text_size * ratio,
                         foreground_, TextAnchor::left, true);
    }
    if (has_undecided) add_dots(next_swatch("undecided", undecided_color(), foreground_), ratio);
    if (content_.has_missing) add_frame(next_swatch("no value", no_value_color(), foreground_), line);
    finish();
}

}  // namespace curvewright
