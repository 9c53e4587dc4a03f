#pragma once

#include <optional>

#include <QWidget>

#include "ui/panels/theme.h"

class QButtonGroup;
class QSlider;
class QToolButton;

namespace curvewright {

/// Where a 3D mesh is cut open.
struct ClipSetting {
    int axis = 0;             ///< 0, 1, 2 = x, y, z
    bool is_flipped = false;  ///< hide the lower side instead of the upper one
    double position = 0.5;    ///< along the axis, as a fraction of the mesh's extent
    bool is_through = false;  ///< cut through the elements instead of hiding whole ones
};

/// Small bar over the view: axis, position, side, and whether elements are hidden or cut (remembered).
class ClipBar : public QWidget {
    Q_OBJECT

  public:
    explicit ClipBar(const Theme& theme, QWidget* parent = nullptr);
    ClipSetting setting() const;
    void set_setting(const ClipSetting& setting);
    /// Moves the plane to what lies at `position` along the axis (a fraction of the mesh's extent): exactly, if it cuts
    /// through; else at most a step of the slider farther, so that it is just not hidden.
    void show_layer(double position);

  signals:
    void changed();

  private:
    QButtonGroup* axes_ = nullptr;
    QToolButton* flip_ = nullptr;
    QSlider* slider_ = nullptr;
    QButtonGroup* styles_ = nullptr;
    std::optional<double> exact_position_;  ///< between two steps of the slider, until it is moved
};

}  // namespace curvewright
