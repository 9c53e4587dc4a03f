#pragma once

#include <QWidget>

#include "ui/document/sample_catalog.h"
#include "ui/panels/theme.h"

class QLabel;

namespace curvewright {

/// What to look for in the sample that is open, in a strip over the view until it is closed.
class SampleNote : public QWidget {
    Q_OBJECT

  public:
    explicit SampleNote(const Theme& theme, QWidget* parent = nullptr);

    /// Nothing is shown of a sample that has nothing to say.
    void show_sample(const Sample& sample);

  private:
    QLabel *title_ = nullptr, *reference_ = nullptr, *look_for_ = nullptr;
};

}  // namespace curvewright
