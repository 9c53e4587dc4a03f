#pragma once

#include <optional>

#include <QWidget>

#include "ui/jobs/step_player.h"
#include "ui/panels/theme.h"
#include "ui/panels/timeline_curve.h"

namespace curvewright {

/// A recording as a track that can be zoomed: passes, patches, and over them the least scaled Jacobian and the number
/// of elements that are not valid. A press goes to a step, and scrubs; the wheel zooms.
class TimelineTrack : public QWidget {
    Q_OBJECT

  public:
    TimelineTrack(StepPlayer& player, const Theme& theme, QWidget* parent = nullptr);

    QSize sizeHint() const override { return {600, 96}; }
    QSize minimumSizeHint() const override { return {200, 84}; }

    /// The stretch that is seen, in steps; a step is one long.
    double first() const { return first_; }
    double length() const { return length_; }
    void set_stretch(double first, double length);
    void show_all();
    /// Where a step is drawn.
    double x_of(StepNumber step) const;
    StepNumber step_at(double x) const;
    /// What the pointer is told.
    QString describe(QPointF position) const;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;

  private:
    QRectF plot() const;  ///< of the curves
    double pixels_per_step() const;
    /// Moves the stretch if the playhead has left it.
    void follow();
    void zoom(double factor, double x);
    StepNumber last_step() const;

    void paint_ruler(QPainter& painter) const;
    void paint_passes(QPainter& painter) const;
    void paint_patches(QPainter& painter) const;
    void paint_span(QPainter& painter, QRectF box, std::size_t number, const QString& text) const;
    void paint_scales(QPainter& painter) const;
    void paint_curves(QPainter& painter) const;
    void paint_marks(QPainter& painter) const;
    double y_of_jacobian(double value) const;
    double y_of_count(Index count) const;

    StepPlayer& player_;
    const Theme& theme_;
    TimelineCurve curve_;
    double first_ = 0.0, length_ = 1.0;
    bool is_scrubbing_ = false;
    std::optional<double> panned_at_;  ///< where the middle button holds the track
};

}  // namespace curvewright
