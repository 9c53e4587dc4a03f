#pragma once

#include <QTimer>
#include <QWidget>

#include "ui/jobs/job_runner.h"

class QLabel;
class QProgressBar;
class QPushButton;

namespace curvewright {

/// Progress and Cancel of the running job, and "Stop and keep" where the job can. Jobs that end at once never show it.
class JobBar : public QWidget {
    Q_OBJECT

  public:
    explicit JobBar(JobRunner& runner, QWidget* parent = nullptr);

  private:
    QLabel* text_ = nullptr;
    QProgressBar* progress_ = nullptr;
    QPushButton *keep_ = nullptr, *cancel_ = nullptr;
    QTimer delay_;
};

}  // namespace curvewright
