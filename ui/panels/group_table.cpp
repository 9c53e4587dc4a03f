#include "ui/panels/group_table.h"

#include <QHeaderView>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

enum Column { name_column, elements_column, min_column, mean_column, tangled_column, columns };

/// "0.122 → 0.68", or the number alone if there is one only or nothing has changed.
QString change(const QString& before, const QString& now, bool has_before, bool has_now) {
    if (!has_now) return has_before ? before : QStringLiteral("–");
    return !has_before || before == now ? now : before + QStringLiteral(" → ") + now;
}

}  // namespace

GroupTable::GroupTable(const Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
    table_ = new QTreeWidget;
    table_->setObjectName(QStringLiteral("group_figures"));
    table_->setHeaderLabels({tr("Group"), tr("Elements"), tr("Min"), tr("Mean"), tr("Tangled")});
    table_->setRootIsDecorated(false);
    table_->setUniformRowHeights(true);
    table_->setAllColumnsShowFocus(true);
    table_->setFont(Theme::small_font());
    table_->setToolTip(
        tr("Scaled Jacobian of the elements of every group (of a group of sides: those that have one of them), before "
           "and now. Click a group to select its elements."));
    QHeaderView* header = table_->header();
    header->setFont(Theme::small_font());
    header->setMinimumSectionSize(56);
    header->setStretchLastSection(false);
    header->setSectionResizeMode(name_column, QHeaderView::Stretch);
    // Of one width whatever the numbers, which change while one looks.
    const QFontMetrics metrics(Theme::small_font());
    const QString widest[] = {{},
                              QStringLiteral("0,000,000"),
                              QStringLiteral("−0.000 → −0.000"),
                              QStringLiteral("0.000 → 0.000"),
                              QStringLiteral("0,000 → 0,000")};
    for (int column = elements_column; column < columns; ++column) {
        table_->headerItem()->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
        header->setSectionResizeMode(column, QHeaderView::Fixed);
        const QString head = table_->headerItem()->text(column);
        header->resizeSection(
            column, std::max(metrics.horizontalAdvance(widest[column]), metrics.horizontalAdvance(head)) + 12);
    }
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(table_);
    const auto choose = [this](QTreeWidgetItem* item) {
        if (item) emit elements_taken(elements_[static_cast<std::size_t>(table_->indexOfTopLevelItem(item))]);
    };
    connect(table_, &QTreeWidget::itemClicked, this, choose);
    connect(table_, &QTreeWidget::itemActivated, this, choose);
}

void GroupTable::show_groups(const std::vector<GroupFigures>& groups, bool has_before, bool has_now) {
    const auto count = static_cast<int>(groups.size());
    while (table_->topLevelItemCount() > count) delete table_->takeTopLevelItem(count);
    elements_.resize(groups.size());
    for (int row = 0; row < count; ++row) {
        const GroupFigures& group = groups[static_cast<std::size_t>(row)];
        auto* item = table_->topLevelItem(row);
        if (!item) {
            item = new QTreeWidgetItem(table_);
            for (int column = elements_column; column < columns; ++column)
                item->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
        }
        if (elements_[static_cast<std::size_t>(row)] != group.elements)
            elements_[static_cast<std::size_t>(row)] = group.elements;
        const QualitySummary &before = group.before, &now = group.now;
        item->setText(name_column, group.name);
        item->setToolTip(name_column, group.name);
        item->setText(elements_column, format_count(static_cast<long long>(group.elements.size())));
        item->setText(min_column, change(format_number(before.min), format_number(now.min), has_before, has_now));
        item->setText(mean_column, change(format_number(before.mean), format_number(now.mean), has_before, has_now));
        item->setText(tangled_column,
                      change(format_count(before.invalid), format_count(now.invalid), has_before, has_now));
        const bool is_tangled = has_now && now.invalid > 0;
        for (const int column : {min_column, tangled_column})
            item->setForeground(column, is_tangled ? QBrush(theme_.color(QStringLiteral("alarm"))) : QBrush());
    }
}

}  // namespace curvewright
