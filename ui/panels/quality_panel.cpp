#include "ui/panels/quality_panel.h"

#include <algorithm>

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSettings>
#include <QStyle>
#include <QVBoxLayout>

#include "ui/document/mesh_text.h"
#include "ui/document/number_format.h"
#include "ui/panels/histogram_widget.h"
#include "ui/panels/widgets.h"

namespace curvewright {

QualityPanel::QualityPanel(MeshDocument& document, const Theme& theme, QWidget* parent)
    : QWidget(parent), document_(document), theme_(theme) {
    reference_ = new QComboBox;
    reference_->setObjectName(QStringLiteral("compare_with"));
    reference_->addItems({tr("the last step"), tr("the mesh as opened")});
    reference_->setToolTip(tr("What the present mesh is compared with"));
    logarithmic_ = new QCheckBox(tr("Log counts"));
    logarithmic_->setObjectName(QStringLiteral("log_counts"));
    logarithmic_->setToolTip(
        tr("Draw the counts logarithmically, so that a few bad elements show among many good ones"));
    logarithmic_->setChecked(QSettings().value(QStringLiteral("quality/log_counts"), true).toBool());

    before_ = make_side(QStringLiteral("before"));
    after_ = make_side(QStringLiteral("after"));
    after_.title->setText(tr("Now"));

    auto* sides = new QHBoxLayout;
    sides->setSpacing(24);
    for (const Side& side : {before_, after_}) {
        auto* head = new QHBoxLayout;
        head->setSpacing(8);
        head->addStrut(reference_->sizeHint().height());
        head->addWidget(side.title);
        if (side.histogram == before_.histogram) head->addWidget(reference_);
        head->addStretch();
        if (side.histogram == after_.histogram) head->addWidget(logarithmic_);
        auto* foot = new QHBoxLayout;
        foot->setSpacing(12);
        foot->addWidget(side.figures);
        foot->addStretch();
        foot->addWidget(side.validity);
        auto* column = new QVBoxLayout;
        column->setSpacing(4);
        column->addLayout(head);
        column->addWidget(side.histogram, 1);
        column->addLayout(foot);
        sides->addLayout(column, 1);
    }
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(12, 8, 12, 8);
    layout->addLayout(sides);

    connect(&document, &MeshDocument::state_changed, this, &QualityPanel::refresh);
    connect(reference_, &QComboBox::currentIndexChanged, this, &QualityPanel::refresh);
    connect(logarithmic_, &QCheckBox::toggled, this, [this](bool is_on) {
        QSettings().setValue(QStringLiteral("quality/log_counts"), is_on);
        refresh();
    });
    for (const Side& side : {before_, after_})
        connect(side.histogram, &HistogramWidget::bar_clicked, this, &QualityPanel::elements_chosen);
    refresh();
}

QualityPanel::Side QualityPanel::make_side(const QString& object_name) {
    Side side;
    side.title = make_label(tr("Before"), "title");
    side.histogram = new HistogramWidget(theme_);
    side.histogram->setObjectName(object_name + QStringLiteral("_histogram"));
    side.figures = make_label(QString(), "");
    side.figures->setObjectName(object_name + QStringLiteral("_figures"));
    side.figures->setTextInteractionFlags(Qt::TextSelectableByMouse);
    side.validity = make_label(QString(), "");
    side.validity->setObjectName(object_name + QStringLiteral("_validity"));
    return side;
}

void QualityPanel::show_figures(const Side& side, const MeshState& state) {
    side.histogram->set_report(state.quality);
    if (!state.quality) {
        side.histogram->setToolTip(state.quality_note);
        side.figures->clear();
        side.validity->clear();
        return;
    }
    side.histogram->setToolTip(QString());
    const QualitySummary& summary = state.quality->summary;
    side.figures->setText(
        tr("min %1   mean %2   max %3")
            .arg(format_number(summary.min), format_number(summary.mean), format_number(summary.max)));
    side.figures->setToolTip(
        tr("Scaled Jacobian: min %1, mean %2, max %3")
            .arg(exact_number(summary.min), exact_number(summary.mean), exact_number(summary.max)));
    side.validity->setText(describe_validity(summary));
    side.validity->setToolTip(
        tr("%1 valid, %2 tangled, %3 undecided")
            .arg(format_count(summary.valid), format_count(summary.invalid), format_count(summary.undecided)));
    set_tone(side.validity, summary.invalid > 0 ? "alarm" : summary.undecided > 0 ? "warning" : "good");
}

void QualityPanel::show_live(const QualityReport& report) {
    // Large meshes: no more than a fifth of the time.
    const auto start = std::chrono::steady_clock::now();
    if (start < next_live_) return;
    MeshState state;
    state.quality = std::make_shared<const QualityReport>(report);
    show_figures(after_, state);
    const Index limit = std::max(before_.histogram->limit(), after_.histogram->bars().highest());
    for (const Side& side : {before_, after_}) side.histogram->set_scale(limit, logarithmic_->isChecked());
    const auto end = std::chrono::steady_clock::now();
    next_live_ = end + 4 * (end - start);
}

void QualityPanel::set_scale(const ColorScale& scale) {
    for (const Side& side : {before_, after_}) side.histogram->set_colors(scale);
}

void QualityPanel::refresh() {
    const bool from_opened = reference_->currentIndex() == 1;
    show_figures(before_, from_opened ? document_.original() : document_.before());
    show_figures(after_, document_.state());
    const Index limit = std::max(before_.histogram->bars().highest(), after_.histogram->bars().highest());
    for (const Side& side : {before_, after_}) side.histogram->set_scale(limit, logarithmic_->isChecked());
}

}  // namespace curvewright
