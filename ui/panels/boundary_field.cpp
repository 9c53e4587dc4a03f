#include "ui/panels/boundary_field.h"

#include <algorithm>

#include <QFormLayout>
#include <QHeaderView>
#include <QTreeWidget>

#include "ui/panels/form_fields.h"

namespace curvewright {
namespace {

constexpr int group_row_height = 36, mode_width = 110;

}  // namespace

BoundaryField::BoundaryField(const QString& name, const Texts& texts, QObject* parent) : QObject(parent), name_(name) {
    std::vector<curvewright::Choice> choices{{tr("Stays"), int(Mode::fixed), texts.fixed},
                                             {tr("Slides along itself"), int(Mode::slide), texts.slide}};
    if (!texts.free.isEmpty()) choices.push_back({tr("Follows freely"), int(Mode::free), texts.free});
    choices.push_back({tr("By group"), int(Mode::by_group), texts.by_group});
    choice_ = make_choice(name.toLatin1().constData(), texts.tip, choices);
    groups_ = new QTreeWidget;
    groups_->setObjectName(name + QStringLiteral("_groups"));
    groups_->setColumnCount(2);
    groups_->setHeaderHidden(true);
    groups_->setRootIsDecorated(false);
    groups_->setUniformRowHeights(true);
    groups_->setSelectionMode(QAbstractItemView::NoSelection);
    groups_->header()->setStretchLastSection(false);
    groups_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
    groups_->header()->setSectionResizeMode(1, QHeaderView::Fixed);
    groups_->header()->resizeSection(1, mode_width);
    connect(choice_, &QComboBox::currentIndexChanged, this, [this] {
        set_visible(is_visible_);
        emit changed();
    });
    list_groups(nullptr);
}

void BoundaryField::add_to(QFormLayout* form, const QString& label) {
    form_ = form;
    form->addRow(label, choice_);
    form->addRow(groups_);
    set_visible(is_visible_);
}

void BoundaryField::set_visible(bool is_visible) {
    is_visible_ = is_visible;
    if (!form_) return;
    form_->setRowVisible(choice_, is_visible);
    form_->setRowVisible(groups_, is_visible && chosen<Mode>(choice_) == Mode::by_group);
}

void BoundaryField::list_groups(const MeshTopology* topology) {
    QStringList names;
    if (topology)
        for (const PhysicalGroup& group : topology->groups())
            if (group.dimension == topology->dimension() - 1 && !group.name.empty())
                names << QString::fromStdString(group.name);
    names.removeDuplicates();
    if (names == group_names_ && is_listed_) return;
    is_listed_ = true;
    group_names_ = names;
    groups_->clear();
    group_modes_.clear();
    for (const QString& group : names) {
        auto* item = new QTreeWidgetItem(groups_, {group});
        item->setToolTip(0, group);
        item->setSizeHint(1, {mode_width, group_row_height});
        // Where it will be from the start: a move to another parent would have it make its list at once.
        auto* mode = new QComboBox(groups_->viewport());
        mode->addItem(tr("Stays"), int(BoundaryMode::fixed));
        mode->addItem(tr("Slides"), int(BoundaryMode::slide));
        mode->addItem(tr("Free"), int(BoundaryMode::free));
        mode->setAccessibleName(tr("Boundary %1").arg(group));
        groups_->setItemWidget(item, 1, mode);
        group_modes_.push_back(mode);
        connect(mode, &QComboBox::currentIndexChanged, this, &BoundaryField::changed);
    }
    constexpr qsizetype rows_shown = 4;  // more can be scrolled to
    groups_->setFixedHeight(static_cast<int>(std::clamp<qsizetype>(names.size(), 1, rows_shown)) * group_row_height +
                            4);
    emit changed();
}

BoundaryRules BoundaryField::rules() const {
    BoundaryRules rules;
    switch (chosen<Mode>(choice_)) {
        case Mode::fixed:
            break;
        case Mode::slide:
            rules.otherwise = BoundaryMode::slide;
            break;
        case Mode::free:
            rules.otherwise = BoundaryMode::free;
            break;
        case Mode::by_group:
            for (qsizetype i = 0; i < group_names_.size(); ++i) {
                const auto mode = chosen<BoundaryMode>(group_modes_[static_cast<std::size_t>(i)]);
                if (mode != BoundaryMode::fixed) rules.groups.push_back({group_names_[i].toStdString(), mode});
            }
            break;
    }
    return rules;
}

}  // namespace curvewright
