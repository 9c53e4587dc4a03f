#pragma once

#include <memory>
#include <vector>

#include <QWidget>

#include "core/quality/quality.h"
#include "ui/palette/color_map.h"
#include "ui/panels/theme.h"

namespace curvewright {

/// Bars of one quality report: an alarm bin "≤ 0" of the tangled elements, then equal bins over [0, 1]. Undecided
/// elements are stacked in their own colour.
struct HistogramBars {
    static constexpr int bins = 25;
    struct Bar {
        std::vector<Index> decided, undecided;  ///< elements
        Index count() const { return static_cast<Index>(decided.size() + undecided.size()); }
    };
    Bar tangled;
    std::vector<Bar> bars;  ///< bins

    /// Largest count of any bar.
    Index highest() const;
};
HistogramBars make_bars(const QualityReport& report);

/// Draws the bars of a report. Two of them given the same limit and scale can be compared at a glance.
class HistogramWidget : public QWidget {
    Q_OBJECT

  public:
    explicit HistogramWidget(const Theme& theme, QWidget* parent = nullptr);

    /// Null: empty.
    void set_report(std::shared_ptr<const QualityReport> report);
    const HistogramBars& bars() const { return bars_; }
    /// Count at the top of the scale, and whether counts are drawn logarithmically.
    void set_scale(Index limit, bool is_logarithmic);
    Index limit() const { return limit_; }
    /// Map and range of the bars' colours.
    void set_colors(const ColorScale& colors);

    QSize sizeHint() const override { return {280, 104}; }
    QSize minimumSizeHint() const override { return {180, 80}; }

  signals:
    /// The elements of the bar that was clicked.
    void bar_clicked(const std::vector<Index>& elements);

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

  private:
    QRectF plot() const;
    QRectF bar_area(int bar) const;      ///< full height; bar -1 = the tangled one
    int bar_at(QPointF position) const;  ///< -2 = none
    const HistogramBars::Bar& bar(int index) const {
        return index < 0 ? bars_.tangled : bars_.bars[static_cast<std::size_t>(index)];
    }
    double height_of(Index count) const;  ///< fraction of the plot
    /// How many elements, in which range.
    QString describe(int bar) const;
    void choose(int bar);
    /// The next bar with elements in it to the right (1) or to the left (-1); the same one if there is none.
    int next_bar(int bar, int step) const;
    void go_to(int bar);

    const Theme& theme_;
    std::shared_ptr<const QualityReport> report_;
    HistogramBars bars_;
    ColorScale colors_;
    Index limit_ = 1;
    bool is_logarithmic_ = true;
    int hovered_ = -2;
    int current_ = -2;  ///< where the keyboard is
};

}  // namespace curvewright
