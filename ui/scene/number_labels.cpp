#include "ui/scene/number_labels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#include <vtkTexture.h>
#include <vtkTexturedActor2D.h>
#include <vtkTypeInt64Array.h>

#include "core/base/parallel.h"

namespace curvewright {
namespace {

constexpr char characters[] = "0123456789-";
constexpr int character_count = 11;
constexpr double digit_size = 11.5;    ///< units of the pixel ratio
constexpr double halo_radius = 1.9;    ///< units of the pixel ratio
constexpr double node_distance = 4.0;  ///< of a node's number from the node, units of the pixel ratio
constexpr double cell_size = 3.0;      ///< of the grid that tells what is taken, units of the pixel ratio
/// Where there are many numbers for the room that they have, so much stays free around those of nodes at most, units of
/// the pixel ratio; and the part of the room that they would take up from which on some, and from which on all of that
/// is.
constexpr double most_clearance = 12.0, few = 0.6, many = 1.6;
constexpr int depth_step = 4;  ///< pixels per sample of what hides numbers
/// Steps of the distance between the nearest and the farthest, and how many of them count as about the same.
constexpr int depth_steps = 4000, depth_layer = 200;
/// How far behind the surface a number may be and still be seen, world units: a little more than chords are off.
constexpr double hiding_depth = 0.004;

Color mix(const Color& a, const Color& b, double share_of_b) {
    Color result{};
    for (std::size_t c = 0; c < 3; ++c) result[c] = (1.0 - share_of_b) * a[c] + share_of_b * b[c];
    return result;
}

int character_index(char character) {
    return character == '-' ? 10 : character - '0';
}

/// How much of each pixel a character covers, rows from the bottom.
struct Glyph {
    int width = 0, height = 0;
    std::vector<float> coverage;

    float at(int x, int y) const {
        return x < 0 || y < 0 || x >= width || y >= height ? 0.0f : coverage[static_cast<std::size_t>(y * width + x)];
    }
};

Glyph render_glyph(char character, const TextFont& font, double pixels, bool is_bold) {
    vtkNew<vtkTextProperty> style;
    style->SetColor(1.0, 1.0, 1.0);
    constexpr int dpi = 72;  // font sizes are pixels then
    use_font(*style, font, pixels, is_bold, dpi);
    vtkNew<vtkImageData> image;
    int size[2] = {0, 0};
    Glyph glyph;
    if (!vtkTextRenderer::GetInstance()->RenderString(style, std::string(1, character), image, size, dpi)) return glyph;
    glyph.width = std::min(size[0], image->GetDimensions()[0]);
    glyph.height = std::min(size[1], image->GetDimensions()[1]);
    const int channels = image->GetNumberOfScalarComponents();
    const int* extent = image->GetExtent();
    for (int y = 0; y < glyph.height; ++y)
        for (int x = 0; x < glyph.width; ++x) {
            const auto* pixel =
                static_cast<const unsigned char*>(image->GetScalarPointer(extent[0] + x, extent[2] + y, 0));
            glyph.coverage.push_back(pixel[channels - 1] / 255.0f);
        }
    return glyph;
}

}  // namespace

NumberLabels::NumberLabels(vtkRenderer* renderer) {
    mapper_->SetInputData(data_);
    texture_->InterpolateOff();
    texture_->RepeatOff();
    texture_->EdgeClampOn();
    texture_->SetColorModeToDirectScalars();
    actor_->SetMapper(mapper_);
    actor_->SetTexture(texture_);
    actor_->PickableOff();
    actor_->GetPositionCoordinate()->SetCoordinateSystemToViewport();
    actor_->VisibilityOff();
    renderer->AddViewProp(actor_);
}

NumberLabels::~NumberLabels() = default;

void NumberLabels::set_colors(const Color& background, const Color& foreground, const Color& accent) {
    if (background == background_ && foreground == foreground_ && accent == accent_) return;
    background_ = background;
    foreground_ = foreground;
    accent_ = accent;
    digits_ratio_ = 0.0;
    is_stale_ = true;
}

void NumberLabels::set_font(const TextFont& font) {
    if (font == font_) return;
    font_ = font;
    digits_ratio_ = 0.0;
    is_stale_ = true;
}

void NumberLabels::set_labels(std::vector<NumberLabel> labels) {
    if (labels.empty() && labels_.empty()) return;
    labels_ = std::move(labels);
    is_stale_ = true;
}

void NumberLabels::make_digits(double pixel_ratio) {
    digits_ratio_ = pixel_ratio;
    halo_ = static_cast<int>(std::ceil(halo_radius * pixel_ratio));
    std::array<std::array<Glyph, character_count>, 2> glyphs;
    int width = 0, height = 0;
    std::array<int, 2> bottom{};
    for (std::size_t kind = 0; kind < 2; ++kind) {
        int low = 1 << 20, high = 0;  // rows with ink in any digit
        advance_[kind] = 0;
        for (int i = 0; i < character_count; ++i) {
            Glyph& glyph = glyphs[kind][static_cast<std::size_t>(i)];
            glyph = render_glyph(characters[i], font_, digit_size * pixel_ratio, kind == 1);
            advance_[kind] = std::max(advance_[kind], glyph.width);
            for (int y = 0; y < glyph.height; ++y)
                for (int x = 0; x < glyph.width; ++x)
                    if (glyph.at(x, y) > 0.1f) {
                        low = std::min(low, y);
                        high = std::max(high, y + 1);
                    }
        }
        bottom[kind] = high > low ? low : 0;
        height_[kind] = std::max(high - low, 1);
        width = std::max(width, advance_[kind]);
        height = std::max(height, height_[kind]);
    }
    // Cells: a column per character, rows of halos and digits of either kind.
    cell_width_ = width + 2 * halo_;
    cell_height_ = height + 2 * halo_;
    vtkNew<vtkImageData> image;
    image->SetDimensions(character_count * cell_width_, 4 * cell_height_, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
    // In the dark the accent alone would be too dark to read.
    const bool is_dark = background_[0] + background_[1] + background_[2] < 1.5;
    const Color inks[2] = {foreground_, mix(accent_, foreground_, is_dark ? 0.55 : 0.15)};
    const double radius = halo_radius * pixel_ratio;
    for (int kind = 0; kind < 2; ++kind)
        for (int i = 0; i < character_count; ++i) {
            const Glyph& glyph = glyphs[static_cast<std::size_t>(kind)][static_cast<std::size_t>(i)];
            const int left = halo_ + (advance_[static_cast<std::size_t>(kind)] - glyph.width) / 2;
            for (int y = 0; y < cell_height_; ++y)
                for (int x = 0; x < cell_width_; ++x) {
                    const int gx = x - left, gy = y - halo_ + bottom[static_cast<std::size_t>(kind)];
                    double halo = 0.0;
                    for (int dy = -halo_; dy <= halo_; ++dy)
                        for (int dx = -halo_; dx <= halo_; ++dx)
                            halo = std::max(halo, glyph.at(gx + dx, gy + dy) *
                                                      std::clamp(radius + 0.5 - std::hypot(dx, dy), 0.0, 1.0));
                    for (int layer = 0; layer < 2; ++layer) {
                        const Color& color = layer == 0 ? background_ : inks[kind];
                        const double opacity = layer == 0 ? 0.88 * halo : glyph.at(gx, gy);
                        auto* pixel = static_cast<unsigned char*>(
                            image->GetScalarPointer(i * cell_width_ + x, (2 * kind + layer) * cell_height_ + y, 0));
                        for (std::size_t c = 0; c < 3; ++c)
                            pixel[c] = static_cast<unsigned char>(std::lround(255.0 * std::clamp(color[c], 0.0, 1.0)));
                        pixel[3] = static_cast<unsigned char>(std::lround(255.0 * std::clamp(opacity, 0.0, 1.0)));
                    }
                }
        }
    texture_->SetInputData(image);
    texture_->Modified();
}

void NumberLabels::update(const ViewMetrics& view, const DrawnSurface* hiding, const WorldFrame& frame,
                          const Margins& margins) {
    if (labels_.empty()) {
        actor_->VisibilityOff();
        placed_.clear();
        return;
    }
    if (!is_stale_ && digits_ratio_ == view.pixel_ratio && seen_size_ == view.size && margins_ == margins &&
        seen_matrix_ == view.world_to_clip)
        return;
    if (digits_ratio_ != view.pixel_ratio) make_digits(view.pixel_ratio);
    is_stale_ = false;
    seen_size_ = view.size;
    margins_ = margins;
    seen_matrix_ = view.world_to_clip;
    place(view, hiding, frame);
    draw();
}

std::array<int, 2> NumberLabels::size_of(const NumberLabel& label) const {
    const auto kind = static_cast<std::size_t>(label.kind);
    const int length = static_cast<int>(std::to_string(label.number).size());
    return {length * advance_[kind] + 2 * halo_, height_[kind] + 2 * halo_};
}

void NumberLabels::place(const ViewMetrics& view, const DrawnSurface* hiding, const WorldFrame& frame) {
    struct Candidate {
        float x = 0.0f, y = 0.0f;
        int depth = -1;  ///< steps from the eye; -1 = not seen
    };
    std::optional<DepthMap> surface;
    ViewMetrics coarse = view;
    if (hiding) {
        for (int& side : coarse.size) side = std::max(1, side / depth_step);
        surface.emplace(*hiding, frame, coarse, std::array{0.0, 0.0},
                        std::array{static_cast<double>(coarse.size[0]), static_cast<double>(coarse.size[1])});
    }
    const double width = view.size[0] - margins_.right;
    std::vector<Candidate> candidates(labels_.size());
    parallel_for(labels_.size(), 2048, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Eigen::Vector4d at = view.project(labels_[i].world);
            if (!(at[3] > 0.0) || at[0] < 0.0 || at[1] < 0.0 || at[0] > width || at[1] > view.size[1]) continue;
            if (surface) {
                const Eigen::Vector4d there = coarse.project(labels_[i].world);
                if (surface->is_behind(there[0], there[1], labels_[i].world, hiding_depth)) continue;
            }
            candidates[i] = {static_cast<float>(at[0]), static_cast<float>(at[1]),
                             static_cast<int>(0.5 * depth_steps * (1.0 + std::clamp(at[2], -1.0, 1.0)))};
        }
    });
    std::vector<std::size_t> order;
    std::array<float, 4> area{0.0f, 0.0f, 0.0f, 0.0f};
    double ink = 0.0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Candidate& candidate = candidates[i];
        if (candidate.depth < 0) continue;
        if (order.empty()) area = {candidate.x, candidate.y, candidate.x, candidate.y};
        area = {std::min(area[0], candidate.x), std::min(area[1], candidate.y), std::max(area[2], candidate.x),
                std::max(area[3], candidate.y)};
        order.push_back(i);
        const auto size = size_of(labels_[i]);
        ink += double(size[0]) * size[1];
    }
    // In steps, so that panning does not have numbers come and go.
    constexpr double steps = 4.0;
    const double room = std::max(1.0, double(area[2] - area[0]) * double(area[3] - area[1]));
    const double crowd = std::round(steps * std::clamp((ink / room - few) / (many - few), 0.0, 1.0)) / steps;
    const double clearance = crowd * most_clearance * view.pixel_ratio;
    // Those of elements have one place only and go before those of nodes at about the same distance.
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const auto rank = [&](std::size_t i) {
            return std::tuple(candidates[i].depth / depth_layer, labels_[i].kind == NumberKind::node,
                              candidates[i].depth, i);
        };
        return rank(a) < rank(b);
    });

    const double cell = cell_size * view.pixel_ratio;
    const int columns = static_cast<int>(view.size[0] / cell) + 1, rows = static_cast<int>(view.size[1] / cell) + 1;
    std::vector<bool> is_taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), false);
    std::vector<bool> has_label;
    const auto try_place = [&](const std::array<int, 4>& box, double more_room) {
        if (box[0] < 0 || box[1] < 0 || box[2] > width || box[3] > view.size[1]) return false;
        if (box[0] < margins_.corner && box[1] < margins_.corner) return false;
        // Cells from .. to that the box touches, or that are less than `more` away from it.
        const auto range = [&](int from, int to, double more, int cells) {
            return std::array{std::max(0, static_cast<int>((from - more) / cell)),
                              std::min(cells - 1, static_cast<int>((to + more) / cell))};
        };
        const auto wide = range(box[0], box[2], more_room, columns), high = range(box[1], box[3], more_room, rows);
        for (int y = high[0]; y <= high[1]; ++y)
            for (int x = wide[0]; x <= wide[1]; ++x)
                if (is_taken[static_cast<std::size_t>(y * columns + x)]) return false;
        const auto own_wide = range(box[0], box[2], 0.0, columns), own_high = range(box[1], box[3], 0.0, rows);
        for (int y = own_high[0]; y <= own_high[1]; ++y)
            for (int x = own_wide[0]; x <= own_wide[1]; ++x) is_taken[static_cast<std::size_t>(y * columns + x)] = true;
        return true;
    };
    placed_.clear();
    for (const std::size_t i : order) {
        const NumberLabel& label = labels_[i];
        if (label.kind == NumberKind::element) {
            const auto owner = static_cast<std::size_t>(label.owner);
            if (owner >= has_label.size()) has_label.resize(owner + 1, false);
            if (has_label[owner]) continue;
        }
        const auto [box_width, box_height] = size_of(label);
        const int x = static_cast<int>(std::lround(candidates[i].x)),
                  y = static_cast<int>(std::lround(candidates[i].y));
        const auto box_at = [&, w = box_width, h = box_height](int left, int bottom) {
            return std::array{left, bottom, left + w, bottom + h};
        };
        const int gap = static_cast<int>(std::lround(node_distance * view.pixel_ratio)) - halo_;
        std::vector<std::array<int, 4>> boxes;
        if (label.kind == NumberKind::element)
            boxes = {box_at(x - box_width / 2, y - box_height / 2)};
        else if (crowd > 0.0)  // always the same side: else nobody knows whose number it is
            boxes = {box_at(x + gap, y + gap)};
        else
            boxes = {box_at(x + gap, y + gap), box_at(x + gap, y - gap - box_height),
                     box_at(x - gap - box_width, y + gap), box_at(x - gap - box_width, y - gap - box_height)};
        for (const auto& box : boxes) {
            // Those of elements stand in them, whatever is beside.
            if (!try_place(box, label.kind == NumberKind::node ? clearance : 0.0)) continue;
            placed_.push_back({label.kind, label.number, label.owner, box});
            if (label.kind == NumberKind::element) has_label[static_cast<std::size_t>(label.owner)] = true;
            break;
        }
    }
}

void NumberLabels::draw() {
    std::size_t digits = 0;
    for (const Placed& label : placed_) digits += std::to_string(label.number).size();
    const auto count = static_cast<vtkIdType>(2 * digits);
    actor_->SetVisibility(count > 0);
    vtkNew<vtkFloatArray> positions, coordinates;
    positions->SetNumberOfComponents(3);
    positions->SetNumberOfTuples(4 * count);
    coordinates->SetNumberOfComponents(2);
    coordinates->SetNumberOfTuples(4 * count);
    auto ids = vtkSmartPointer<vtkTypeInt64Array>::New(), starts = vtkSmartPointer<vtkTypeInt64Array>::New();
    ids->SetNumberOfValues(6 * count);
    starts->SetNumberOfValues(2 * count + 1);
    for (vtkIdType i = 0; i <= 2 * count; ++i) starts->SetValue(i, 3 * i);
    const float texture_width = static_cast<float>(character_count * cell_width_),
                texture_height = static_cast<float>(4 * cell_height_);
    vtkIdType quad = 0;
    for (const Placed& label : placed_) {
        const std::string text = std::to_string(label.number);
        const int kind = static_cast<int>(label.kind), advance = advance_[static_cast<std::size_t>(label.kind)];
        // All halos of a number first: they reach under the digits beside them.
        for (int layer = 0; layer < 2; ++layer)
            for (std::size_t i = 0; i < text.size(); ++i, ++quad) {
                const int left = label.box[0] + static_cast<int>(i) * advance, bottom = label.box[1];
                const int u = character_index(text[i]) * cell_width_, v = (2 * kind + layer) * cell_height_;
                for (int corner = 0; corner < 4; ++corner) {
                    const int dx = corner % 2 == 1 ? advance + 2 * halo_ : 0, dy = corner >= 2 ? cell_height_ : 0;
                    const float position[3] = {static_cast<float>(left + dx), static_cast<float>(bottom + dy), 0.0f};
                    const float coordinate[2] = {static_cast<float>(u + dx) / texture_width,
                                                 static_cast<float>(v + dy) / texture_height};
                    positions->SetTypedTuple(4 * quad + corner, position);
                    coordinates->SetTypedTuple(4 * quad + corner, coordinate);
                }
                const vtkIdType first = 4 * quad;
                const vtkIdType corners[6] = {first, first + 1, first + 2, first + 2, first + 1, first + 3};
                for (vtkIdType c = 0; c < 6; ++c) ids->SetValue(6 * quad + c, corners[c]);
            }
    }
    vtkNew<vtkPoints> points;
    points->SetData(positions);
    vtkNew<vtkCellArray> triangles;
    triangles->SetData(starts, ids);
    data_->Initialize();
    data_->SetPoints(points);
    data_->SetPolys(triangles);
    data_->GetPointData()->SetTCoords(coordinates);
    data_->Modified();
}

}  // namespace curvewright
