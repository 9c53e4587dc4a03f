#include "ui/panels/banner.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>

#include "ui/panels/widgets.h"

namespace curvewright {

Banner::Banner(const Theme& theme, QWidget* parent) : QWidget(parent) {
    setObjectName(QStringLiteral("banner"));
    setAttribute(Qt::WA_StyledBackground);
    warning_icon_ = new QLabel;
    note_icon_ = new QLabel;
    text_ = make_paragraph(QString(), "");
    text_->setObjectName(QStringLiteral("banner_text"));
    action_ = new QPushButton;
    action_->setObjectName(QStringLiteral("banner_action"));
    auto* close = new QToolButton;
    close->setToolTip(tr("Hide"));

    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(12, 4, 8, 4);
    layout->setSpacing(8);
    layout->addWidget(warning_icon_);
    layout->addWidget(note_icon_);
    layout->addWidget(text_, 1);
    layout->addWidget(action_);
    layout->addWidget(close);
    hide();

    const auto paint_icons = [this, close, &theme] {
        warning_icon_->setPixmap(theme.icon(QStringLiteral("alert")).pixmap(16));
        note_icon_->setPixmap(theme.icon(QStringLiteral("check")).pixmap(16));
        close->setIcon(theme.icon(QStringLiteral("close")));
    };
    paint_icons();
    connect(&theme, &Theme::changed, this, paint_icons);
    connect(action_, &QPushButton::clicked, this, &Banner::action_triggered);
    connect(close, &QToolButton::clicked, this, &QWidget::hide);
}

void Banner::show_warning(const QString& text, const QString& action) {
    show_text(text, action, "warning");
}

void Banner::show_note(const QString& text, const QString& action) {
    show_text(text, action, "note");
}

void Banner::show_text(const QString& text, const QString& action, const char* tone) {
    const bool is_note = QLatin1String(tone) == QLatin1String("note");
    warning_icon_->setVisible(!is_note);
    note_icon_->setVisible(is_note);
    setProperty("tone", QLatin1String(tone));
    restyle(this);
    restyle(text_);
    text_->setText(text);
    action_->setText(action);
    action_->setVisible(!action.isEmpty());
    show();
}

QString Banner::text() const {
    return text_->text();
}

}  // namespace curvewright
