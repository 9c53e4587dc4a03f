#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <vtkNew.h>

#include "ui/palette/quality_colors.h"
#include "ui/scene/picking.h"
#include "ui/scene/text_font.h"

class vtkPolyData;
class vtkPolyDataMapper2D;
class vtkRenderer;
class vtkTexture;
class vtkTexturedActor2D;

namespace curvewright {

enum class NumberKind : std::uint8_t { node, element };

/// A number to be shown at a point.
struct NumberLabel {
    NumberKind kind = NumberKind::node;
    std::int64_t number = 0;
    Index owner = 0;           ///< node or element; of each at most one label is shown
    Eigen::RowVector3d world;  ///< where it stands
};

/// Numbers over the mesh: upright digits of constant size with a halo, so that they are legible on any colour. They
/// never overlap; where room is short those nearest the eye are shown, the fewer the more there are. Digits come from
/// one texture, and all numbers are one batch of rectangles, made anew when the view or the numbers change.
class NumberLabels {
  public:
    explicit NumberLabels(vtkRenderer* renderer);
    ~NumberLabels();
    NumberLabels(const NumberLabels&) = delete;
    NumberLabels& operator=(const NumberLabels&) = delete;

    void set_colors(const Color& background, const Color& foreground, const Color& accent);
    void set_font(const TextFont& font);
    void set_labels(std::vector<NumberLabel> labels);
    /// What is not for numbers, device pixels: a strip at the right and a square in the lower left corner.
    struct Margins {
        double right = 0.0, corner = 0.0;
        friend bool operator==(const Margins&, const Margins&) = default;
    };
    /// Before every frame. hiding: what numbers can be behind; null = nothing hides them.
    void update(const ViewMetrics& view, const DrawnSurface* hiding, const WorldFrame& frame, const Margins& margins);

    struct Placed {
        NumberKind kind = NumberKind::node;
        std::int64_t number = 0;
        Index owner = 0;
        std::array<int, 4> box{};  ///< left, bottom, right, top, device pixels
    };
    /// What the last update shows.
    const std::vector<Placed>& placed() const { return placed_; }

  private:
    /// Width and height, device pixels.
    std::array<int, 2> size_of(const NumberLabel& label) const;
    void make_digits(double pixel_ratio);
    void place(const ViewMetrics& view, const DrawnSurface* hiding, const WorldFrame& frame);
    void draw();

    std::vector<NumberLabel> labels_;
    std::vector<Placed> placed_;
    Color background_{1.0, 1.0, 1.0}, foreground_{0.0, 0.0, 0.0}, accent_{0.0, 0.0, 1.0};

    TextFont font_;
    bool is_stale_ = false;
    std::array<int, 2> seen_size_{0, 0};
    Eigen::Matrix4d seen_matrix_ = Eigen::Matrix4d::Zero();
    Margins margins_;

    double digits_ratio_ = 0.0;  ///< pixel ratio that the texture was made for; 0 = none yet
    /// Per kind, device pixels: advance of a digit, height of its ink, room for the halo around it.
    std::array<int, 2> advance_{}, height_{};
    int halo_ = 0;
    int cell_width_ = 0, cell_height_ = 0;  ///< of the texture
    vtkNew<vtkPolyData> data_;
    vtkNew<vtkPolyDataMapper2D> mapper_;
    vtkNew<vtkTexture> texture_;
    vtkNew<vtkTexturedActor2D> actor_;
};

}  // namespace curvewright
