#pragma once

#include <chrono>
#include <vector>

#include <QWidget>

#include "ui/document/mesh_document.h"
#include "ui/palette/color_map.h"
#include "ui/panels/theme.h"

class QCheckBox;
class QComboBox;
class QLabel;

namespace curvewright {

class HistogramWidget;

/// Before and after, side by side on one scale, with the figures of each.
class QualityPanel : public QWidget {
    Q_OBJECT

  public:
    QualityPanel(MeshDocument& document, const Theme& theme, QWidget* parent = nullptr);

    /// "Now" shows this report of the document's mesh while it is being moved; show_state() ends that.
    void show_live(const QualityReport& report);
    void show_state() { refresh(); }
    /// Map and range of the colours of both histograms.
    void set_scale(const ColorScale& scale);

  signals:
    /// Elements of the present mesh that the user picked in a histogram.
    void elements_chosen(const std::vector<Index>& elements);

  private:
    struct Side {
        QLabel* title = nullptr;
        HistogramWidget* histogram = nullptr;
        QLabel *figures = nullptr, *validity = nullptr;
    };
    Side make_side(const QString& object_name);
    void refresh();
    static void show_figures(const Side& side, const MeshState& state);

    MeshDocument& document_;
    const Theme& theme_;
    Side before_, after_;
    std::chrono::steady_clock::time_point next_live_{};  ///< before that, no live report is shown
    QComboBox* reference_ = nullptr;
    QCheckBox* logarithmic_ = nullptr;
};

}  // namespace curvewright
