#pragma once

#include <optional>
#include <span>
#include <vector>

#include <QWidget>

#include "ui/panels/histogram_drawing.h"

namespace curvewright {

/// Bars of the scaled Jacobian of some elements. Two of them given the same limit and scale can be compared at a
/// glance; one can have the other's as an outline. A click takes a bar, a brush over several takes all of them.
class HistogramWidget : public QWidget {
    Q_OBJECT

  public:
    explicit HistogramWidget(const Theme& theme, QWidget* parent = nullptr);

    /// None: empty. least: the smallest scaled Jacobian.
    void set_elements(std::optional<std::span<const ElementQuality>> elements, double least);
    /// What the bars are compared with, drawn as a line over them.
    void set_outline(std::optional<HistogramBars> outline);
    void set_title(const QString& title);
    /// Elements that are selected: a darker part of each bar.
    void set_selected(const IndexSet& elements);
    const HistogramBars& bars() const { return drawing_.bars; }
    bool has_data() const { return drawing_.has_data; }
    /// Count at the top of the scale, and whether counts are drawn logarithmically.
    void set_scale(Index limit, bool is_logarithmic);
    Index limit() const { return drawing_.limit; }
    /// Map and range of the bars' colours.
    void set_colors(const ColorScale& colors);
    /// What is drawn, in whatever frame it has on the screen.
    const HistogramDrawing& drawing() const { return drawing_; }

    QSize sizeHint() const override { return {280, 112}; }
    QSize minimumSizeHint() const override { return {180, 88}; }

  signals:
    /// The elements of the bars that were taken, once more whenever a brush reaches another one; with Ctrl those that
    /// were selected before too.
    void elements_taken(const IndexSet& elements);

  protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

  private:
    /// How many elements, in which range.
    QString describe(int first, int last) const;
    /// From the anchor to where the hand or the keyboard is.
    void take();
    void tell_range(QPoint place);
    /// The next bar with elements in it to the right (1) or to the left (-1); the same one if there is none.
    int next_bar(int bar, int step) const;
    void go_to(int bar, bool extends);

    const Theme& theme_;
    HistogramDrawing drawing_;
    IndexSet selected_;
    IndexSet kept_;  ///< stays selected beside what is taken
    int hovered_ = HistogramBars::no_bar;
    int current_ = HistogramBars::no_bar;  ///< where the keyboard is
    int anchor_ = HistogramBars::no_bar;   ///< where the range begins that ends at current_
    bool is_brushing_ = false;
};

}  // namespace curvewright
