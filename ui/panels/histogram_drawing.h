#pragma once

#include <optional>

#include <QColor>
#include <QFont>
#include <QRectF>
#include <QString>

#include "ui/palette/color_map.h"
#include "ui/panels/histogram_bars.h"
#include "ui/panels/theme.h"

class QPainter;

namespace curvewright {

/// The colours that bars are drawn with, besides their own.
struct HistogramInk {
    QColor ground, text, muted, line, base, alarm, band;
};
HistogramInk screen_ink(const Theme& theme);
/// For white paper, whatever the theme.
HistogramInk paper_ink();

/// How bars are drawn and where they are: on the screen and in a file.
struct HistogramDrawing {
    QRectF frame;  ///< axis and title included
    HistogramBars bars;
    std::optional<HistogramBars> outline;  ///< what the bars are compared with, as a line over them
    std::optional<double> least;           ///< marked at the axis
    bool has_data = false;
    Index limit = 1;  ///< count at the top of the scale
    bool is_logarithmic = true;
    ColorScale colors;
    QString title;
    QFont font;
    int band_first = 0, band_last = HistogramBars::no_bar;  ///< bars with a band behind them
    int marked_bar = HistogramBars::no_bar;

    QRectF plot() const;
    /// Full height; of the tangled bar too.
    QRectF bar_area(int bar) const;
    /// no_bar = none.
    int bar_at(QPointF position) const;
    int nearest_bar(double x) const;
    /// Fraction of the plot.
    double height_of(Index count) const;
    void draw(QPainter& painter, const HistogramInk& ink) const;

  private:
    void draw_scale(QPainter& painter, const HistogramInk& ink) const;
    void draw_bar(QPainter& painter, const HistogramInk& ink, int bar) const;
    void draw_outline(QPainter& painter, const HistogramInk& ink) const;
    void draw_axis(QPainter& painter, const HistogramInk& ink) const;
};

}  // namespace curvewright
