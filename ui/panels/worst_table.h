#pragma once

#include <vector>

#include <QWidget>

#include "ui/document/mesh_document.h"
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

  signals:
    void element_chosen(Index element);

  private:
    void refresh();

    MeshDocument& document_;
    const Theme& theme_;
    QTreeWidget* table_ = nullptr;
    std::vector<Index> elements_;
};

}  // namespace curvewright
