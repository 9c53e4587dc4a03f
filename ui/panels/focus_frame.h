#pragma once

#include <QWidget>

#include "ui/panels/theme.h"

namespace curvewright {

/// A frame inside another widget's border, seen while that widget has the keyboard and got it by the keyboard. Only the
/// frame itself is drawn, so that it costs nothing over a picture.
class FocusFrame : public QWidget {
    Q_OBJECT

  public:
    FocusFrame(QWidget* framed, const Theme& theme);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;

  private:
    void fit();

    const Theme& theme_;
};

}  // namespace curvewright
