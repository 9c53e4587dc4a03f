#include "ui/panels/worst_table.h"

#include <QHeaderView>
#include <QLabel>
#include <QPainter>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
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

    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(12, 4, 12, 12);
    layout->setSpacing(4);
    layout->addWidget(make_label(tr("Worst elements"), "section"));
    layout->addWidget(table_);

    connect(&document, &MeshDocument::state_changed, this, &WorstTable::refresh);
    connect(&theme, &Theme::changed, this, &WorstTable::refresh);
    const auto choose = [this](QTreeWidgetItem* item) {
        if (item) emit element_chosen(elements_[static_cast<std::size_t>(table_->indexOfTopLevelItem(item))]);
    };
    connect(table_, &QTreeWidget::itemClicked, this, choose);
    connect(table_, &QTreeWidget::itemActivated, this, choose);
    refresh();
}

void WorstTable::set_scale(const ColorScale& scale) {
    if (scale == scale_) return;
    scale_ = scale;
    refresh();
}

void WorstTable::refresh() {
    table_->clear();
    elements_.clear();
    const MeshState& state = document_.state();
    if (!state.quality) return;
    elements_ = state.quality->worst(max_rows);
    for (const Index element : elements_) {
        const ElementQuality& quality = state.quality->elements[static_cast<std::size_t>(element)];
        auto* item = new QTreeWidgetItem(table_);
        item->setIcon(0, swatch(quality, scale_, theme_.color(QStringLiteral("border_strong")), devicePixelRatioF()));
        item->setText(0, QString::number(state.mesh->topology().element_tag(element).value));
        item->setText(1, format_number(quality.scaled_jacobian));
        item->setTextAlignment(1, Qt::AlignRight | Qt::AlignVCenter);
        item->setToolTip(1, exact_number(quality.scaled_jacobian));
        item->setText(2, describe(quality.validity));
        if (quality.validity == Validity::invalid) item->setForeground(1, theme_.color(QStringLiteral("alarm")));
    }
}

}  // namespace curvewright
