#pragma once

#include <QWidget>

#include "core/warp/warp.h"
#include "ui/document/edit_state.h"
#include "ui/palette/color_map.h"
#include "ui/panels/theme.h"

class QComboBox;
class QCheckBox;
class QDoubleSpinBox;
class QLabel;
class QToolButton;
class QTreeWidget;

namespace curvewright {

class JacobianMap;

/// What is selected, how to select more, and everything there is to know about one of it.
class SelectionPanel : public QWidget {
    Q_OBJECT

  public:
    SelectionPanel(EditState& edit, const Theme& theme, QWidget* parent = nullptr);

    /// The options of a warp: whose weights a node's spokes show.
    void set_weights(const WarpOptions& options);
    /// Map and range of the colours of J inside an element.
    void set_scale(const ColorScale& scale);

    /// Longer lists are cut, with a line that says so.
    static constexpr int max_rows = 300;

  signals:
    /// An element or a node of the list was activated: it is to be looked at.
    void element_shown(Index element);
    void node_shown(Index node);

  private:
    void make_selecting();
    void show_settings();
    void read_settings();
    void show_selection();
    void show_details();
    void add_detail(const QString& name, const QString& value, const QString& tip = {});
    void show_element(Index element);
    void show_node(Index node);

    Spokes find_spokes(Index node) const;

    EditState& edit_;
    WarpOptions weights_;
    JacobianMap* map_ = nullptr;
    bool is_showing_ = false;
    QLabel* count_ = nullptr;
    QComboBox *what_ = nullptr, *shape_ = nullptr;
    QCheckBox* sees_through_ = nullptr;
    QDoubleSpinBox *lower_ = nullptr, *upper_ = nullptr;
    QWidget* range_ = nullptr;
    QToolButton *grow_ = nullptr, *shrink_ = nullptr, *invert_ = nullptr, *clear_ = nullptr;
    QTreeWidget *list_ = nullptr, *details_ = nullptr;
};

}  // namespace curvewright
