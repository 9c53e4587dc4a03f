#pragma once

#include <vector>

#include <QVector>
#include <QWidget>

#include "core/quality/global_validity.h"
#include "ui/document/mesh_document.h"
#include "ui/document/mesh_text.h"

class QLabel;
class QTreeWidget;
class QUndoView;

namespace curvewright {

/// What is open: file, elements, validity, groups, and the history to jump in.
class MeshPanel : public QWidget {
    Q_OBJECT

  public:
    explicit MeshPanel(MeshDocument& document, QWidget* parent = nullptr);
    /// Of the mesh while it is being moved; show_state() ends that.
    void show_quality(const QualitySummary& summary);
    void show_state();
    /// Whether it is valid as a whole. report: null = not known; is_pending: it is being found out, so much is done.
    void show_global(const GlobalValidityReport* report, bool is_pending, double progress);

    /// The history cannot be walked while a job runs.
    void set_history_enabled(bool is_enabled);

  signals:
    /// Elements of a group of elements that the user clicked.
    void elements_chosen(const std::vector<Index>& elements);
    /// Nodes of a group of boundary or inner sides, or of points, that the user clicked.
    void nodes_chosen(const std::vector<Index>& nodes);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    QString history_tip(int row) const;
    void show_file();
    void show_groups();

    MeshDocument& document_;
    QLabel *file_ = nullptr, *elements_ = nullptr, *nodes_ = nullptr, *validity_ = nullptr, *minimum_ = nullptr,
           *global_ = nullptr;
    QTreeWidget* groups_ = nullptr;
    QUndoView* history_ = nullptr;
};

}  // namespace curvewright
