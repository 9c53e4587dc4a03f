#pragma once

#include <optional>
#include <vector>

#include <QPolygonF>
#include <QWidget>

#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"
#include "ui/palette/color_map.h"
#include "ui/panels/theme.h"

namespace curvewright {

/// The Jacobian inside one element, in the colours of the scaled Jacobian: of a flat element as it lies, of a solid one
/// a cut through its reference element at the height of its worst point. A ring marks the worst point.
class JacobianMap : public QWidget {
    Q_OBJECT

  public:
    explicit JacobianMap(const Theme& theme, QWidget* parent = nullptr);

    void clear();
    /// Map and range of the colours.
    void set_scale(const ColorScale& scale);
    void show_element(const CurvedMesh& mesh, Index element, const QualityReport& report);

    QSize sizeHint() const override { return {240, 128}; }
    QSize minimumSizeHint() const override { return {160, 110}; }
    /// Least and largest sampled J over the element's largest, in what is drawn.
    double least() const { return least_; }
    double largest() const { return largest_; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    const Theme& theme_;
    ColorScale scale_;
    struct Piece {
        QPolygonF corners;  ///< y up, any unit
        double value = 0.0;
    };
    std::vector<Piece> pieces_;
    QPolygonF outline_;
    QPointF worst_;
    QString caption_;
    double least_ = 0.0, largest_ = 0.0;
};

}  // namespace curvewright
