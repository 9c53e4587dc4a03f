#include "ui/panels/banner.h"

#include <algorithm>

#include <QAccessible>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
#include "ui/panels/notice_style.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

constexpr std::size_t rows_shown = 3;  ///< until somebody asks for more
constexpr int most_actions = 3;
constexpr int icon_size = 16, spacing = 8;
/// Of a text beside its buttons: with less room than this the buttons go below it.
constexpr int least_text_width = 360;

}  // namespace

/// One notice. Its buttons stand beside the text where there is room, else below it.
class Banner::Row : public QWidget {
  public:
    explicit Row(Banner& banner) : QWidget(&banner), banner_(banner) {
        setObjectName(QStringLiteral("banner_row"));
        setAttribute(Qt::WA_StyledBackground);
        icon_ = new QLabel;
        icon_->setFixedSize(icon_size, 22);  // as high as a line of text beside a button
        text_ = make_paragraph(QString(), "");
        text_->setObjectName(QStringLiteral("banner_text"));
        text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
        buttons_ = new QWidget;
        auto* of_buttons = new QHBoxLayout(buttons_);
        of_buttons->setContentsMargins(0, 0, 0, 0);
        of_buttons->setSpacing(spacing);
        for (int i = 0; i < most_actions; ++i) {
            auto* button = new QPushButton;
            button->setObjectName(i == 0 ? QStringLiteral("banner_action")
                                         : QStringLiteral("banner_action_%1").arg(i + 1));
            of_buttons->addWidget(button);
            connect(button, &QPushButton::clicked, this, [this, i] { emit banner_.action_triggered(id_, i); });
            actions_.push_back(button);
        }
        of_buttons->addStretch();
        close_ = new QToolButton;
        close_->setObjectName(QStringLiteral("banner_close"));
        close_->setToolTip(Banner::tr("Dismiss this note; it stays in View > Panels > Messages"));
        close_->setFocusPolicy(Qt::StrongFocus);
        connect(close_, &QToolButton::clicked, this, [this] { emit banner_.dismissed(id_); });

        grid_ = new QGridLayout(this);
        grid_->setContentsMargins(12, 4, 8, 4);
        grid_->setHorizontalSpacing(spacing);
        grid_->setVerticalSpacing(4);
        grid_->setColumnStretch(1, 1);
        grid_->addWidget(icon_, 0, 0, Qt::AlignTop);
        grid_->addWidget(close_, 0, 3, Qt::AlignTop);
        place();
    }

    void show_line(const NoticeBoard::Line& line) {
        const Notice& notice = line.notice;
        const bool is_new = id_ != line.id || text_->text() != notice.text;
        id_ = line.id;
        text_->setText(notice.text);
        const QString kind = severity_text(notice.severity);
        setAccessibleName(Banner::tr("%1: %2").arg(kind, notice.text));
        text_->setAccessibleName(accessibleName());
        close_->setAccessibleName(Banner::tr("Dismiss the %1").arg(kind));
        for (int i = 0; i < most_actions; ++i) {
            QPushButton* button = actions_[static_cast<std::size_t>(i)];
            const bool is_used = i < static_cast<int>(notice.actions.size());
            button->setVisible(is_used);
            if (!is_used) continue;
            const NoticeAction& action = notice.actions[static_cast<std::size_t>(i)];
            button->setText(action_text(action));
            button->setToolTip(action_tip(action));
            button->setAccessibleDescription(notice.text);
        }
        buttons_->setVisible(!notice.actions.empty());
        severity_ = notice.severity;
        paint_icons();
        setProperty("tone", QLatin1String(tone_name(severity_)));
        restyle(this);
        place();
        if (!is_new) return;
        QAccessibleEvent event(this, QAccessible::Alert);
        QAccessible::updateAccessibility(&event);
    }

    void paint_icons() {
        icon_->setPixmap(
            severity_icon(banner_.theme_, severity_).pixmap(QSize(icon_size, icon_size), devicePixelRatioF()));
        close_->setIcon(banner_.theme_.icon(QStringLiteral("close")));
    }

    int id() const { return id_; }
    QString text() const { return text_->text(); }
    bool has_focus() const {
        const QWidget* focus = window()->focusWidget();
        return focus && isAncestorOf(focus);
    }
    void take_focus() { close_->setFocus(); }

  protected:
    void resizeEvent(QResizeEvent* event) override {
        QWidget::resizeEvent(event);
        place();
    }

  private:
    /// Beside or below, by the width alone.
    void place() {
        const int taken = 12 + icon_size + close_->sizeHint().width() + 3 * spacing + 8;
        const int beside = width() - taken - buttons_->sizeHint().width() - spacing;
        const int wanted = std::min(least_text_width, text_->fontMetrics().horizontalAdvance(text_->text()));
        const bool is_below = !buttons_->isHidden() && beside < wanted;
        if (is_placed_ && is_below == is_below_) return;
        is_placed_ = true;
        is_below_ = is_below;
        grid_->removeWidget(text_);
        grid_->removeWidget(buttons_);
        grid_->addWidget(text_, 0, 1, 1, is_below ? 2 : 1);
        if (is_below)
            grid_->addWidget(buttons_, 1, 1, 1, 2);
        else
            grid_->addWidget(buttons_, 0, 2, Qt::AlignTop);
    }

    Banner& banner_;
    int id_ = 0;
    NoticeSeverity severity_ = NoticeSeverity::information;
    QLabel *icon_ = nullptr, *text_ = nullptr;
    QWidget* buttons_ = nullptr;
    std::vector<QPushButton*> actions_;
    QToolButton* close_ = nullptr;
    QGridLayout* grid_ = nullptr;
    bool is_below_ = false, is_placed_ = false;
};

Banner::Banner(const Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
    setObjectName(QStringLiteral("banner"));
    setAttribute(Qt::WA_StyledBackground);
    setAccessibleName(tr("Notes"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(0);
    more_ = make_fold_button(tr("more"), QStringLiteral("banner_more"));
    layout->addWidget(more_);
    connect(more_, &QPushButton::toggled, this, &Banner::fill);
    connect(&theme, &Theme::changed, this, [this] {
        for (Row* row : rows_) row->paint_icons();
    });
    hide();
}

Banner::~Banner() = default;

void Banner::show_lines(const std::vector<NoticeBoard::Line>& lines) {
    lines_ = lines;
    fill();
}

void Banner::fill() {
    const std::size_t fit = more_->isChecked() ? lines_.size() : std::min(lines_.size(), rows_shown);
    // Who has dismissed a notice with the keyboard goes on to the next.
    const auto focused = std::find_if(rows_.begin(), rows_.end(), [](const Row* row) { return row->has_focus(); });
    const bool had_focus = focused != rows_.end() && isVisible();
    const auto place = static_cast<std::size_t>(focused - rows_.begin());
    const int focused_id = had_focus ? (*focused)->id() : 0;
    while (rows_.size() < fit) {
        auto* row = new Row(*this);
        static_cast<QVBoxLayout*>(layout())->insertWidget(static_cast<int>(rows_.size()), row);
        rows_.push_back(row);
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (i < fit) rows_[i]->show_line(lines_[i]);
        rows_[i]->setVisible(i < fit);
    }
    const auto left = static_cast<long long>(lines_.size() - fit);
    more_->setVisible(lines_.size() > rows_shown);
    more_->setText(more_->isChecked() ? tr("▾ fewer notes") : tr("▸ %1 more").arg(format_count(left)));
    setVisible(!lines_.empty());
    if (had_focus && fit > 0 && (place >= fit || rows_[place]->id() != focused_id))
        rows_[std::min(place, fit - 1)]->take_focus();
}

QString Banner::text() const {
    QStringList texts;
    for (const Row* row : rows_)
        if (!row->isHidden()) texts << row->text();
    return texts.join(QLatin1Char('\n'));
}

}  // namespace curvewright
