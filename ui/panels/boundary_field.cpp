#include "ui/panels/boundary_field.h"

#include <algorithm>
#include <set>
#include <string>

#include <QApplication>
#include <QFormLayout>
#include <QHeaderView>
#include <QKeyEvent>
#include <QMenu>
#include <QPainter>
#include <QStyledItemDelegate>
#include <QTreeWidget>

#include "ui/panels/form_fields.h"

namespace curvewright {
namespace {

constexpr int group_row_height = 34, mode_width = 110;
constexpr int mode_role = Qt::UserRole;  ///< a BoundaryMode, of the second column

/// Draws a cell as a box of choices. A box in each of hundreds of rows would be thousands of widgets.
class ChoiceDelegate : public QStyledItemDelegate {
  public:
    /// model: a box that looks as the cells shall.
    explicit ChoiceDelegate(const QComboBox* model, QObject* parent) : QStyledItemDelegate(parent), model_(model) {}

    void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
        QStyleOptionComboBox box;
        box.rect = option.rect.adjusted(0, 3, -2, -3);
        box.palette = option.palette;
        box.fontMetrics = option.fontMetrics;
        box.state = option.state & (QStyle::State_Enabled | QStyle::State_Active);
        // The row that the keys are in.
        if (option.state & QStyle::State_HasFocus) box.state |= QStyle::State_HasFocus;
        box.currentText = index.data().toString();
        QStyle* style = model_->style();
        style->drawComplexControl(QStyle::CC_ComboBox, &box, painter, model_);
        style->drawControl(QStyle::CE_ComboBoxLabel, &box, painter, model_);
    }

  private:
    const QComboBox* model_;
};

}  // namespace

BoundaryField::BoundaryField(const QString& name, const Texts& texts, QObject* parent)
    : QObject(parent), name_(name), has_interfaces_(texts.has_interfaces) {
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
    groups_->setItemDelegateForColumn(1, new ChoiceDelegate(choice_, this));
    groups_->setAllColumnsShowFocus(true);
    groups_->installEventFilter(this);
    connect(groups_, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item, int column) {
        if (column == 1) offer_modes(item);
    });
    connect(groups_, &QTreeWidget::itemActivated, this, &BoundaryField::offer_modes);
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
    QStringList inside;
    if (topology && has_interfaces_) {
        std::set<std::string> all;
        for (const auto& [node, its] : names_of_interface_nodes(*topology)) all.insert(its.begin(), its.end());
        for (const std::string& its : all) inside << QString::fromStdString(its);
        names += inside;
    }
    names.removeDuplicates();
    if (names == group_names_ && inside == inside_names_ && is_listed_) return;
    is_listed_ = true;
    group_names_ = names;
    inside_names_ = inside;
    groups_->clear();
    for (const QString& group : names) {
        auto* item = new QTreeWidgetItem(groups_, {group});
        item->setToolTip(0, inside.contains(group)
                                ? tr("%1, inside the domain: stays unless this says otherwise").arg(group)
                                : group);
        item->setSizeHint(1, {mode_width, group_row_height});
        set_mode(item, BoundaryMode::fixed);
    }
    constexpr qsizetype rows_shown = 4;  // more can be scrolled to
    groups_->setFixedHeight(static_cast<int>(std::clamp<qsizetype>(names.size(), 1, rows_shown)) * group_row_height +
                            4);
    emit changed();
}

void BoundaryField::set_mode(QTreeWidgetItem* item, BoundaryMode mode) {
    const QString text = mode_text(mode);
    item->setText(1, text);
    item->setData(1, mode_role, int(mode));
    item->setData(1, Qt::AccessibleTextRole, tr("Boundary %1: %2").arg(item->text(0), text));
}

void BoundaryField::offer_modes(QTreeWidgetItem* item) {
    // On some desktops a click activates, too.
    if (QApplication::activePopupWidget()) return;
    auto* menu = new QMenu(groups_);
    menu->setAttribute(Qt::WA_DeleteOnClose);
    menu->setObjectName(QStringLiteral("boundary_modes"));
    for (const auto mode : {BoundaryMode::fixed, BoundaryMode::slide, BoundaryMode::free}) {
        // The list may be made anew while the menu is open.
        QAction* action = menu->addAction(mode_text(mode), this, [this, name = item->text(0), mode] {
            const auto items = groups_->findItems(name, Qt::MatchExactly | Qt::MatchCaseSensitive);
            if (items.isEmpty() || mode_of(items.front()) == mode) return;
            set_mode(items.front(), mode);
            emit changed();
        });
        action->setCheckable(true);
        action->setChecked(mode == mode_of(item));
        if (action->isChecked()) menu->setActiveAction(action);
    }
    const QRect cell = groups_->visualItemRect(item);
    menu->popup(groups_->viewport()->mapToGlobal(QPoint(cell.right() - mode_width, cell.bottom())));
}

bool BoundaryField::eventFilter(QObject* watched, QEvent* event) {
    if (watched == groups_ && event->type() == QEvent::KeyPress && groups_->currentItem()) {
        const auto* key = static_cast<QKeyEvent*>(event);
        const bool opens_list =
            key->modifiers() == Qt::AltModifier && (key->key() == Qt::Key_Down || key->key() == Qt::Key_Up);
        if (opens_list || (key->modifiers() == Qt::NoModifier &&
                           (key->key() == Qt::Key_Space || key->key() == Qt::Key_F2 || key->key() == Qt::Key_F4))) {
            offer_modes(groups_->currentItem());
            return true;
        }
    }
    return QObject::eventFilter(watched, event);
}

BoundaryMode BoundaryField::mode_of(const QTreeWidgetItem* item) {
    return static_cast<BoundaryMode>(item->data(1, mode_role).toInt());
}

QString BoundaryField::mode_text(BoundaryMode mode) {
    switch (mode) {
        case BoundaryMode::fixed:
            return tr("Stays");
        case BoundaryMode::slide:
            return tr("Slides");
        case BoundaryMode::free:
            return tr("Free");
    }
    return {};
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
                const auto mode = mode_of(groups_->topLevelItem(static_cast<int>(i)));
                if (mode != BoundaryMode::fixed) rules.groups.push_back({group_names_[i].toStdString(), mode});
            }
            break;
    }
    return rules;
}

void BoundaryField::set_rules(const BoundaryRules& rules) {
    const auto choose = [this](Mode mode) { choice_->setCurrentIndex(choice_->findData(int(mode))); };
    if (rules.groups.empty()) {
        choose(rules.otherwise == BoundaryMode::fixed   ? Mode::fixed
               : rules.otherwise == BoundaryMode::slide ? Mode::slide
                                                        : Mode::free);
        return;
    }
    choose(Mode::by_group);
    for (int row = 0; row < groups_->topLevelItemCount(); ++row) {
        QTreeWidgetItem* item = groups_->topLevelItem(row);
        BoundaryMode mode = inside_names_.contains(item->text(0)) ? BoundaryMode::fixed : rules.otherwise;
        for (const BoundaryRules::Rule& rule : rules.groups)
            if (rule.group == item->text(0).toStdString()) mode = rule.mode;
        set_mode(item, mode);
    }
    emit changed();
}

}  // namespace curvewright
