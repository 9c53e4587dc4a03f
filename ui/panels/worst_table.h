#pragma once

#include <vector>

#include <QTimer>
#include <QWidget>

#include "ui/document/mesh_document.h"
#include "ui/palette/color_map.h"
#include "ui/panels/theme.h"

class QSpinBox;
class QTreeWidget;
class QTreeWidgetItem;

namespace curvewright {

/// The elements of the lowest scaled Jacobian, as many as the user wants; a click asks to look at one.
class WorstTable : public QWidget {
    Q_OBJECT

  public:
    WorstTable(MeshDocument& document, const Theme& theme, QWidget* parent = nullptr);

    /// How many: 1 .. Preferences::most_worst.
    int count() const;
    void set_count(int count);
    /// The rows are of this report of the document's mesh while it is being moved; show_state() ends that.
    void show_live(const QualityReport& report);
    void show_state();
    /// Map and range of the scaled Jacobian's colours.
    void set_scale(const ColorScale& scale);

  signals:
    void element_chosen(Index element);
    void count_changed(int count);

  private:
    struct Row {
        Index element;
        ElementQuality quality;
    };
    void find_rows(const QualityReport* report);
    void show_rows();
    void show_row(QTreeWidgetItem& item, const Row& row) const;

    MeshDocument& document_;
    const Theme& theme_;
    ColorScale scale_;
    QSpinBox* count_ = nullptr;
    QTreeWidget* table_ = nullptr;
    std::vector<Row> rows_;   ///< worst first
    std::vector<Row> shown_;  ///< what the items say
    QTimer pause_;            ///< between live rows, so that long tables leave time for the rest
};

}  // namespace curvewright
