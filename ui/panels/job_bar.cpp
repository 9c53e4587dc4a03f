#include "ui/panels/job_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>

#include "ui/panels/widgets.h"

namespace curvewright {

JobBar::JobBar(JobRunner& runner, QWidget* parent) : QWidget(parent) {
    text_ = make_label(QString(), "");
    text_->setObjectName(QStringLiteral("job_text"));
    progress_ = new QProgressBar;
    progress_->setObjectName(QStringLiteral("job_progress"));
    progress_->setTextVisible(false);
    progress_->setRange(0, 1000);
    progress_->setFixedWidth(160);
    cancel_ = new QPushButton(tr("Cancel"));
    cancel_->setObjectName(QStringLiteral("job_cancel"));
    cancel_->setProperty("link", true);
    cancel_->setCursor(Qt::PointingHandCursor);
    cancel_->setToolTip(tr("Stop the job; the mesh stays as it is (Esc)"));

    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(8, 0, 8, 0);
    layout->setSpacing(8);
    layout->addWidget(text_);
    layout->addWidget(progress_);
    layout->addWidget(cancel_);
    hide();

    delay_.setSingleShot(true);
    delay_.setInterval(150);
    connect(&delay_, &QTimer::timeout, this, &QWidget::show);
    connect(&runner, &JobRunner::started, this, [this](const QString& title) {
        text_->setText(title + QStringLiteral("…"));
        progress_->setRange(0, 0);
        cancel_->setEnabled(true);
        delay_.start();
    });
    connect(&runner, &JobRunner::progress, this, [this, &runner](const QString& phase, double fraction) {
        text_->setText(phase.isEmpty() ? runner.title() : runner.title() + QStringLiteral(": ") + phase);
        progress_->setRange(0, 1000);
        progress_->setValue(qRound(qBound(0.0, fraction, 1.0) * 1000));
    });
    connect(&runner, &JobRunner::running_changed, this, [this](bool is_running) {
        if (is_running) return;
        delay_.stop();
        hide();
    });
    connect(cancel_, &QPushButton::clicked, this, [this, &runner] {
        cancel_->setEnabled(false);
        text_->setText(tr("Stopping…"));
        runner.cancel();
    });
}

}  // namespace curvewright
