#pragma once

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
};

/// Small bar over the view: axis, side, position.
class ClipBar : public QWidget {
    Q_OBJECT

  public:
    explicit ClipBar(const Theme& theme, QWidget* parent = nullptr);
    ClipSetting setting() const;
    void set_setting(const ClipSetting& setting);
    /// Moves the plane, at most a step of the slider farther than told, so that what lies at `position` along the axis
    /// (a fraction of the mesh's extent) is just not hidden.
    void show_layer(double position);

  signals:
    void changed();

  private:
    QButtonGroup* axes_ = nullptr;
    QToolButton* flip_ = nullptr;
    QSlider* slider_ = nullptr;
};

}  // namespace curvewright
