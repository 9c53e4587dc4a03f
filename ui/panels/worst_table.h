#pragma once

#include <vector>

#include <QWidget>

#include "ui/document/mesh_document.h"
#include "ui/palette/color_map.h"
#include "ui/panels/theme.h"

class QLabel;
class QTreeWidget;

namespace curvewright {

/// The ten elements of the lowest scaled Jacobian; a click asks to look at one.
class WorstTable : public QWidget {
    Q_OBJECT

  public:
    WorstTable(MeshDocument& document, const Theme& theme, QWidget* parent = nullptr);

    static constexpr int max_rows = 10;
    /// Map and range of the scaled Jacobian's colours.
    void set_scale(const ColorScale& scale);

  signals:
    void element_chosen(Index element);

  private:
    void refresh();

    MeshDocument& document_;
    const Theme& theme_;
    ColorScale scale_;
    QTreeWidget* table_ = nullptr;
    std::vector<Index> elements_;
};

}  // namespace curvewright
