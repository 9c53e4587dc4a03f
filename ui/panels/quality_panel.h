#pragma once

#include <optional>
#include <span>
#include <vector>

#include <QWidget>

#include "ui/document/mesh_document.h"
#include "ui/palette/color_map.h"
#include "ui/panels/group_table.h"
#include "ui/panels/quality_export.h"
#include "ui/panels/theme.h"

class QCheckBox;
class QComboBox;
class QGridLayout;
class QLabel;

namespace curvewright {

class HistogramWidget;

/// Before and after on one scale, side by side or one over the other, with the figures of each and of every group.
class QualityPanel : public QWidget {
    Q_OBJECT

  public:
    using Qualities = std::span<const ElementQuality>;

    QualityPanel(MeshDocument& document, const Theme& theme, QWidget* parent = nullptr);

    /// "Now" shows these elements of the document's mesh while it is being moved, or at a step of what was done to it;
    /// show_state() ends that. before: what they are compared with unless that is the mesh as opened; not given: the
    /// document's state, of which this is the next one. Takes what it needs: nothing has to live on. Costs a pass over
    /// the elements and one over every group.
    void show_live(Qualities now, std::optional<Qualities> before = std::nullopt);
    void show_live(const QualityReport& report) { show_live(report.elements); }
    void show_state() { refresh(); }
    /// Elements that are selected in the view: marked in the bars.
    void set_selected(const IndexSet& elements);
    /// Map and range of the colours of both histograms.
    void set_scale(const ColorScale& scale);

    /// What is shown now, for a file.
    QualityComparison comparison() const;

  signals:
    /// Elements of the present mesh that the user picked in a histogram or in the table.
    void elements_chosen(const std::vector<Index>& elements);
    void export_requested();
    /// The document's states are shown, perhaps in place of something live.
    void refreshed();

  private:
    struct Side {
        HistogramWidget* histogram = nullptr;
        QWidget* foot = nullptr;
        QLabel *title = nullptr, *figures = nullptr, *validity = nullptr;
        QualitySummary summary;
    };
    Side make_side(const QString& object_name, const QString& title);
    QCheckBox* make_check(const char* object_name, const char* setting, const QString& text, const QString& tip,
                          bool is_on);
    void find_groups();
    void arrange();
    void refresh();
    void show_both(std::optional<Qualities> before, std::optional<Qualities> now, Index least_limit);
    void show_side(Side& side, std::optional<Qualities> elements);

    MeshDocument& document_;
    const Theme& theme_;
    Side before_, after_;
    std::vector<GroupFigures> groups_;
    QGridLayout* grid_ = nullptr;
    QComboBox* reference_ = nullptr;
    QCheckBox *logarithmic_ = nullptr, *overlay_ = nullptr, *has_groups_ = nullptr;
    GroupTable* table_ = nullptr;
};

}  // namespace curvewright
