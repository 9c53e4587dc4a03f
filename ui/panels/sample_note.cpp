#include "ui/panels/sample_note.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>

#include "ui/document/number_format.h"
#include "ui/panels/widgets.h"

namespace curvewright {

SampleNote::SampleNote(const Theme& theme, QWidget* parent) : QWidget(parent) {
    setObjectName(QStringLiteral("sample_note"));
    setAttribute(Qt::WA_StyledBackground);
    title_ = make_label(QString(), "title");
    title_->setObjectName(QStringLiteral("sample_note_title"));
    reference_ = make_label(QString(), "muted");
    reference_->setObjectName(QStringLiteral("sample_note_reference"));
    reference_->setToolTip(tr("Where it is in the thesis that the methods come from"));
    look_for_ = make_paragraph(QString(), "");
    look_for_->setObjectName(QStringLiteral("sample_note_text"));
    for (QLabel* label : {title_, reference_, look_for_}) label->setTextFormat(Qt::PlainText);
    auto* close = new QToolButton;
    close->setObjectName(QStringLiteral("sample_note_close"));
    close->setToolTip(tr("Hide; choosing the sample again brings it back"));

    auto* head = new QHBoxLayout;
    head->setSpacing(8);
    head->addWidget(title_);
    head->addWidget(reference_, 1);
    auto* text = new QVBoxLayout;
    text->setSpacing(0);
    text->addLayout(head);
    text->addWidget(look_for_);
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(12, 8, 8, 8);
    layout->setSpacing(8);
    layout->addLayout(text, 1);
    layout->addWidget(close, 0, Qt::AlignTop);
    hide();

    const auto paint_icon = [close, &theme] { close->setIcon(theme.icon(QStringLiteral("close"))); };
    paint_icon();
    connect(&theme, &Theme::changed, this, paint_icon);
    connect(close, &QToolButton::clicked, this, &QWidget::hide);
}

void SampleNote::show_sample(const Sample& sample) {
    title_->setText(sample.title);
    reference_->setText(sample.reference());
    QString text = sample.look_for;
    if (sample.result_minimum)
        text +=
            QLatin1Char(' ') + tr("As set up here, the minimum becomes %1.").arg(format_number(*sample.result_minimum));
    look_for_->setText(text);
    setVisible(!sample.look_for.isEmpty());
}

}  // namespace curvewright
