#pragma once

#include <vector>

#include <QString>
#include <QWidget>

#include "core/edit/selection.h"
#include "ui/panels/theme.h"

class QTreeWidget;

namespace curvewright {

/// Figures of the elements of a physical group, before and now.
struct GroupFigures {
    QString name;
    IndexSet elements;
    bool is_whole = false;  ///< the whole mesh
    QualitySummary before, now;
};

/// A line per group: how its elements were and are. A click takes them.
class GroupTable : public QWidget {
    Q_OBJECT

  public:
    explicit GroupTable(const Theme& theme, QWidget* parent = nullptr);

    /// has_before, has_now: whether there are such figures.
    void show_groups(const std::vector<GroupFigures>& groups, bool has_before, bool has_now);

    QSize sizeHint() const override { return {484, 112}; }
    QSize minimumSizeHint() const override { return {240, 88}; }

  signals:
    void elements_taken(const IndexSet& elements);

  private:
    const Theme& theme_;
    std::vector<IndexSet> elements_;
    QTreeWidget* table_ = nullptr;
};

}  // namespace curvewright
