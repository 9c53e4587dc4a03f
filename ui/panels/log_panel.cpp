#include "ui/panels/log_panel.h"

#include <algorithm>

#include <QClipboard>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QScrollBar>
#include <QStyledItemDelegate>
#include <QTableWidget>
#include <QVBoxLayout>

#include "ui/panels/notice_style.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

enum Column { time_column, step_column, text_column, columns };

/// The icon beside the first line of a text, not in the middle of all of them.
class TopIconDelegate : public QStyledItemDelegate {
  public:
    using QStyledItemDelegate::QStyledItemDelegate;

  protected:
    void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
        QStyledItemDelegate::initStyleOption(option, index);
        option->decorationAlignment = Qt::AlignHCenter | Qt::AlignTop;
    }
};

}  // namespace

LogPanel::LogPanel(MessageLog& log, const Theme& theme, QWidget* parent) : QWidget(parent), log_(log), theme_(theme) {
    setObjectName(QStringLiteral("log_panel"));
    table_ = new QTableWidget(0, columns);
    table_->setObjectName(QStringLiteral("log_table"));
    table_->setAccessibleName(tr("Messages of this session"));
    table_->setHorizontalHeaderLabels({tr("Time"), tr("Step"), tr("Message")});
    table_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
    table_->horizontalHeader()->setSectionResizeMode(time_column, QHeaderView::ResizeToContents);
    table_->horizontalHeader()->setSectionResizeMode(step_column, QHeaderView::Interactive);
    table_->horizontalHeader()->setSectionResizeMode(text_column, QHeaderView::Stretch);
    table_->horizontalHeader()->resizeSection(step_column, 176);
    table_->horizontalHeader()->setHighlightSections(false);
    table_->verticalHeader()->hide();
    table_->verticalHeader()->setMinimumSectionSize(24);
    table_->setItemDelegateForColumn(text_column, new TopIconDelegate(this));
    table_->setShowGrid(false);
    table_->setWordWrap(true);
    table_->setTabKeyNavigation(false);
    table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
    table_->setSelectionBehavior(QAbstractItemView::SelectRows);
    table_->setSelectionMode(QAbstractItemView::ExtendedSelection);
    table_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
    table_->setToolTip(tr("Double-click a message to select the elements or nodes that it speaks of"));
    table_->installEventFilter(this);
    table_->viewport()->installEventFilter(this);
    empty_ = make_paragraph(tr("Notes, warnings and errors of this session will be listed here."), "muted");
    empty_->setObjectName(QStringLiteral("log_empty"));
    copy_ = new QPushButton(tr("Copy"));
    copy_->setObjectName(QStringLiteral("log_copy"));
    copy_->setToolTip(tr("Copies the selected messages, or all if none is selected"));
    clear_ = new QPushButton(tr("Clear"));
    clear_->setObjectName(QStringLiteral("log_clear"));
    clear_->setToolTip(tr("Empties this list; the notes over the view stay"));

    auto* buttons = new QVBoxLayout;
    buttons->setSpacing(8);
    buttons->addWidget(copy_);
    buttons->addWidget(clear_);
    buttons->addStretch();
    auto* content = new QVBoxLayout;
    content->setSpacing(4);
    content->addWidget(empty_);
    content->addWidget(table_, 1);
    auto* layout = new QHBoxLayout(this);
    layout->setContentsMargins(12, 8, 12, 8);
    layout->setSpacing(8);
    layout->addLayout(content, 1);
    layout->addLayout(buttons);

    connect(&log, &MessageLog::added, this, &LogPanel::add_row);
    connect(&log, &MessageLog::last_changed, this, [this] {
        fill_row(table_->rowCount() - 1);
        fit_rows();
    });
    connect(&log, &MessageLog::cleared, this, [this] {
        table_->setRowCount(0);
        refresh();
    });
    connect(copy_, &QPushButton::clicked, this, &LogPanel::copy);
    connect(clear_, &QPushButton::clicked, &log, &MessageLog::clear);
    connect(table_, &QTableWidget::cellDoubleClicked, this, [this](int row) { choose(row); });
    connect(table_->horizontalHeader(), &QHeaderView::sectionResized, this, &LogPanel::fit_rows);
    connect(&theme, &Theme::changed, this, [this] {
        for (int row = 0; row < table_->rowCount(); ++row) fill_row(row);
    });
    for (std::size_t i = 0; i < log.entries().size(); ++i) add_row();
    refresh();
}

void LogPanel::add_row() {
    const int row = table_->rowCount();
    const QScrollBar* bar = table_->verticalScrollBar();
    const bool was_at_end = bar->value() >= bar->maximum();
    table_->insertRow(row);
    for (int column = 0; column < columns; ++column) {
        auto* item = new QTableWidgetItem;
        item->setTextAlignment(Qt::AlignLeft | Qt::AlignTop);
        table_->setItem(row, column, item);
    }
    fill_row(row);
    table_->resizeRowToContents(row);
    refresh();
    // Who reads further up is left there.
    if (was_at_end) table_->scrollToBottom();
}

void LogPanel::fill_row(int row) {
    if (row < 0) return;
    const LogEntry& entry = log_.entries()[static_cast<std::size_t>(row)];
    table_->item(row, time_column)->setText(entry.time.toString(QStringLiteral("HH:mm:ss")));
    table_->item(row, time_column)->setToolTip(entry.time.toString(QStringLiteral("yyyy-MM-dd HH:mm:ss")));
    table_->item(row, step_column)->setText(entry.step);
    table_->item(row, step_column)->setToolTip(entry.step);
    QTableWidgetItem* text = table_->item(row, text_column);
    text->setText(entry.text);
    text->setIcon(severity_icon(theme_, entry.severity));
    text->setData(Qt::AccessibleTextRole, tr("%1: %2").arg(severity_text(entry.severity), entry.text));
}

void LogPanel::fit_rows() {
    table_->resizeRowsToContents();
}

void LogPanel::choose(int row) {
    if (row >= 0) emit entry_chosen(log_.entries()[static_cast<std::size_t>(row)]);
}

void LogPanel::copy() {
    QStringList lines;
    const QModelIndexList selected = table_->selectionModel()->selectedRows();
    std::vector<int> rows;
    for (const QModelIndex& index : selected) rows.push_back(index.row());
    std::sort(rows.begin(), rows.end());
    if (rows.empty())
        for (int row = 0; row < table_->rowCount(); ++row) rows.push_back(row);
    for (const int row : rows) lines << MessageLog::line(log_.entries()[static_cast<std::size_t>(row)]);
    QGuiApplication::clipboard()->setText(lines.join(QLatin1Char('\n')));
}

void LogPanel::refresh() {
    const bool is_empty = table_->rowCount() == 0;
    empty_->setVisible(is_empty);
    copy_->setEnabled(!is_empty);
    clear_->setEnabled(!is_empty);
}

bool LogPanel::eventFilter(QObject* watched, QEvent* event) {
    if (watched == table_->viewport() && event->type() == QEvent::Resize) fit_rows();
    if (watched == table_ && event->type() == QEvent::KeyPress) {
        const auto* key = static_cast<QKeyEvent*>(event);
        if (key->matches(QKeySequence::Copy)) {
            copy();
            return true;
        }
        if (key->key() == Qt::Key_Return || key->key() == Qt::Key_Enter) {
            choose(table_->currentRow());
            return true;
        }
    }
    return QWidget::eventFilter(watched, event);
}

}  // namespace curvewright
