#include "ui/panels/job_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>

#include "ui/document/core_words.h"
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
    const auto make_link = [](const QString& text, const char* object_name, const QString& tip) {
        auto* button = new QPushButton(text);
        button->setObjectName(QLatin1String(object_name));
        button->setProperty("link", true);
        button->setCursor(Qt::PointingHandCursor);
        button->setToolTip(tip);
        return button;
    };
    keep_ = make_link(tr("Stop and keep"), "job_keep", tr("Stop the job and take the best mesh so far"));
    cancel_ = make_link(tr("Cancel"), "job_cancel", tr("Stop the job; the mesh stays as it is (Esc)"));

    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(8, 0, 8, 0);
    layout->setSpacing(8);
    layout->addWidget(text_);
    layout->addWidget(progress_);
    layout->addWidget(keep_);
    layout->addWidget(cancel_);
    hide();

    delay_.setSingleShot(true);
    delay_.setInterval(150);
    connect(&delay_, &QTimer::timeout, this, &QWidget::show);
    connect(&runner, &JobRunner::started, this, [this, &runner](const QString& title) {
        text_->setText(title + QStringLiteral("…"));
        progress_->setRange(0, 0);
        keep_->setVisible(runner.can_keep());
        keep_->setEnabled(true);
        cancel_->setEnabled(true);
        delay_.start();
    });
    connect(&runner, &JobRunner::progress, this, [this, &runner](const QString& phase, double fraction) {
        text_->setText(phase.isEmpty() ? runner.title() : runner.title() + QStringLiteral(": ") + phase_text(phase));
        progress_->setRange(0, 1000);
        progress_->setValue(qRound(qBound(0.0, fraction, 1.0) * 1000));
    });
    connect(&runner, &JobRunner::running_changed, this, [this](bool is_running) {
        if (is_running) return;
        delay_.stop();
        hide();
    });
    connect(keep_, &QPushButton::clicked, this, [this, &runner] {
        keep_->setEnabled(false);
        text_->setText(tr("Stopping…"));
        runner.stop_and_keep();
    });
    connect(cancel_, &QPushButton::clicked, this, [this, &runner] {
        keep_->setEnabled(false);
        cancel_->setEnabled(false);
        text_->setText(tr("Stopping…"));
        runner.cancel();
    });
}

}  // namespace curvewright
