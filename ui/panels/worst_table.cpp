#include "ui/panels/worst_table.h"

#include <QElapsedTimer>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPainter>
#include <QSpinBox>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
#include "ui/document/preferences.h"
#include "ui/palette/quality_colors.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

/// A swatch in the element's colour; a cross or a question mark says in shape what the colour says.
QIcon swatch(const ElementQuality& quality, const ColorScale& scale, const QColor& outline, qreal ratio) {
    const Color color = quality_color(quality.scaled_jacobian, quality.validity, scale);
    QPixmap pixmap(QSize(16, 16) * ratio);
    pixmap.setDevicePixelRatio(ratio);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    painter.setPen(outline);
    painter.setBrush(QColor::fromRgbF(float(color[0]), float(color[1]), float(color[2])));
    painter.drawRect(2, 2, 11, 11);
    if (quality.validity == Validity::invalid) {
        painter.setPen(QPen(Qt::white, 1.5));
        painter.drawLine(5, 5, 10, 10);
        painter.drawLine(10, 5, 5, 10);
    } else if (quality.validity == Validity::undecided) {
        painter.setPen(Qt::white);
        painter.drawText(QRect(2, 2, 12, 12), Qt::AlignCenter, QStringLiteral("?"));
    }
    QIcon icon(pixmap);
    icon.addPixmap(pixmap, QIcon::Selected);  // untinted: the colour is what it shows
    return icon;
}

QString describe(Validity validity) {
    switch (validity) {
        case Validity::valid:
            return WorstTable::tr("proved valid");
        case Validity::invalid:
            return WorstTable::tr("tangled");
        case Validity::undecided:
            return WorstTable::tr("undecided");
        case Validity::not_assessed:
            return WorstTable::tr("not assessed");
    }
    return {};
}

}  // namespace

WorstTable::WorstTable(MeshDocument& document, const Theme& theme, QWidget* parent)
    : QWidget(parent), document_(document), theme_(theme) {
    table_ = new QTreeWidget;
    table_->setObjectName(QStringLiteral("worst_elements"));
    table_->setHeaderLabels({tr("Element"), tr("Scaled J"), tr("Proof")});
    table_->headerItem()->setTextAlignment(1, Qt::AlignRight | Qt::AlignVCenter);
    table_->setRootIsDecorated(false);
    table_->setUniformRowHeights(true);
    table_->setAllColumnsShowFocus(true);
    table_->header()->setStretchLastSection(true);
    table_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
    table_->setToolTip(tr("Click a row to look at the element"));
    count_ = new QSpinBox;
    count_->setObjectName(QStringLiteral("worst_count"));
    count_->setRange(1, Preferences::most_worst);
    count_->setValue(Preferences().worst_count);
    count_->setKeyboardTracking(false);
    count_->setToolTip(tr("How many elements stand in the table, and how many View > Only the worst shows"));
    count_->setAccessibleName(tr("How many of the worst elements"));

    auto* head = new QHBoxLayout;
    head->addWidget(make_label(tr("Worst elements"), "section"));
    head->addStretch();
    head->addWidget(count_);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(12, 4, 12, 12);
    layout->setSpacing(4);
    layout->addLayout(head);
    layout->addWidget(table_);

    pause_.setSingleShot(true);
    connect(&pause_, &QTimer::timeout, this, &WorstTable::show_rows);
    connect(&document, &MeshDocument::opened, &pause_, [this] { shown_.clear(); });  // other tags
    connect(&document, &MeshDocument::state_changed, this, &WorstTable::show_state);
    connect(&theme, &Theme::changed, this, [this] {
        shown_.clear();
        show_rows();
    });
    connect(count_, &QSpinBox::valueChanged, this, [this](int count) {
        show_state();
        emit count_changed(count);
    });
    const auto choose = [this](QTreeWidgetItem* item) {
        if (item) emit element_chosen(shown_[static_cast<std::size_t>(table_->indexOfTopLevelItem(item))].element);
    };
    connect(table_, &QTreeWidget::itemClicked, this, choose);
    connect(table_, &QTreeWidget::itemActivated, this, choose);
    show_state();
}

int WorstTable::count() const {
    return count_->value();
}

void WorstTable::set_count(int count) {
    count_->setValue(count);
}

void WorstTable::set_scale(const ColorScale& scale) {
    if (scale == scale_) return;
    scale_ = scale;
    shown_.clear();
    show_rows();
}

void WorstTable::show_live(const QualityReport& report) {
    find_rows(&report);
    if (pause_.isActive()) return;
    QElapsedTimer watch;
    watch.start();
    show_rows();
    // No more than a fifth of the time.
    pause_.start(static_cast<int>(4 * watch.elapsed()));
}

void WorstTable::show_state() {
    pause_.stop();
    find_rows(document_.state().quality.get());
    show_rows();
}

void WorstTable::find_rows(const QualityReport* report) {
    rows_.clear();
    if (!report) return;
    for (const Index element : report->worst(static_cast<std::size_t>(count())))
        rows_.push_back({element, report->elements[static_cast<std::size_t>(element)]});
}

void WorstTable::show_rows() {
    while (table_->topLevelItemCount() > static_cast<int>(rows_.size()))
        delete table_->takeTopLevelItem(table_->topLevelItemCount() - 1);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        QTreeWidgetItem* item = table_->topLevelItem(static_cast<int>(i));
        if (!item) item = new QTreeWidgetItem(table_);
        const Row& row = rows_[i];
        // The mark stands for an element, not for a place in the table.
        if (item == table_->currentItem() && i < shown_.size() && shown_[i].element != row.element)
            table_->selectionModel()->clear();
        const bool is_shown = i < shown_.size() && shown_[i].element == row.element &&
                              shown_[i].quality.scaled_jacobian == row.quality.scaled_jacobian &&
                              shown_[i].quality.validity == row.quality.validity;
        if (!is_shown) show_row(*item, row);
    }
    shown_ = rows_;
}

void WorstTable::show_row(QTreeWidgetItem& item, const Row& row) const {
    const ElementQuality& quality = row.quality;
    item.setIcon(0, swatch(quality, scale_, theme_.color(QStringLiteral("border_strong")), devicePixelRatioF()));
    item.setText(0, QString::number(document_.state().mesh->topology().element_tag(row.element).value));
    item.setText(1, format_number(quality.scaled_jacobian));
    item.setTextAlignment(1, Qt::AlignRight | Qt::AlignVCenter);
    item.setToolTip(1, exact_number(quality.scaled_jacobian));
    item.setText(2, describe(quality.validity));
    const bool is_tangled = quality.validity == Validity::invalid;
    item.setForeground(1, is_tangled ? QBrush(theme_.color(QStringLiteral("alarm"))) : QBrush());
}

}  // namespace curvewright
