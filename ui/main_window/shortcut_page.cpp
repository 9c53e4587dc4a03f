#include "ui/main_window/shortcut_page.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QKeyEvent>
#include <QKeySequenceEdit>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSignalBlocker>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

/// Takes one key, at once: Qt's own waits a second for the next one.
class KeyField : public QKeySequenceEdit {
  protected:
    void keyPressEvent(QKeyEvent* event) override {
        switch (event->key()) {
            case Qt::Key_Shift:
            case Qt::Key_Control:
            case Qt::Key_Alt:
            case Qt::Key_AltGr:
            case Qt::Key_Meta:
            case Qt::Key_unknown:
                return;
            default:
                break;
        }
        // Shift is part of "+" and the like already.
        Qt::KeyboardModifiers held = event->modifiers();
        const QString text = event->text();
        if (!text.isEmpty() && (text[0].isPunct() || text[0].isSymbol())) held &= ~Qt::ShiftModifier;
        setKeySequence(QKeySequence(QKeyCombination(held, static_cast<Qt::Key>(event->key()))));
    }
    void keyReleaseEvent(QKeyEvent*) override {}
};

QPushButton* make_button(const QString& text, const QString& tip, const char* object_name) {
    auto* button = new QPushButton(text);
    button->setObjectName(QLatin1String(object_name));
    button->setToolTip(tip);
    button->setAutoDefault(false);
    return button;
}

}  // namespace

ShortcutPage::ShortcutPage(Shortcuts& shortcuts, QWidget* parent) : QWidget(parent), shortcuts_(shortcuts) {
    preset_ = new QComboBox;
    preset_->setObjectName(QStringLiteral("shortcut_preset"));
    preset_->setToolTip(tr("Keys that you know from another program; your own keys stay as they are"));
    for (const ShortcutPreset& preset : shortcut_presets())
        preset_->addItem(preset_text(preset), QLatin1String(preset.name));
    words_ = new QLineEdit;
    words_->setObjectName(QStringLiteral("shortcut_words"));
    words_->setPlaceholderText(tr("Search by name, by what it does, or by key"));
    words_->setClearButtonEnabled(true);
    table_ = new QTreeWidget;
    table_->setObjectName(QStringLiteral("shortcut_table"));
    table_->setHeaderLabels({tr("Command"), tr("Keys")});
    table_->setRootIsDecorated(false);
    table_->setUniformRowHeights(true);
    table_->setAllColumnsShowFocus(true);
    table_->header()->setStretchLastSection(true);
    table_->setMinimumHeight(160);

    name_ = make_label(QString(), "title");
    name_->setObjectName(QStringLiteral("shortcut_command"));
    name_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    key_ = new KeyField;
    key_->setObjectName(QStringLiteral("shortcut_key"));
    key_->setToolTip(tr("Press the key that the command is to have"));
    key_->setMinimumWidth(160);
    none_ =
        make_button(tr("No key"), tr("The command stays in the menus and in the list of commands"), "shortcut_none");
    reset_ = make_button(tr("As in the preset"), tr("Forget what you have changed of this command"), "shortcut_reset");
    reset_all_ = make_button(tr("All as in the preset"), tr("Forget all that you have changed"), "shortcut_reset_all");
    take_ = make_button(tr("Take it"), tr("The other command is left without this key"), "shortcut_take");
    message_ = make_paragraph(QString(), "");
    message_->setObjectName(QStringLiteral("shortcut_message"));

    auto* fields = new QHBoxLayout;
    fields->setSpacing(8);
    for (QWidget* field : std::initializer_list<QWidget*>{key_, none_, reset_}) fields->addWidget(field);
    fields->addStretch();
    fields->addWidget(reset_all_);
    auto* answer = new QHBoxLayout;
    answer->setSpacing(8);
    answer->addWidget(message_, 1);
    answer->addWidget(take_);
    QSizePolicy stays = take_->sizePolicy();
    stays.setRetainSizeWhenHidden(true);  // nothing moves when it comes
    take_->setSizePolicy(stays);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(8);
    column->addWidget(words_);
    column->addWidget(table_, 1);
    column->addWidget(name_);
    column->addLayout(fields);
    column->addLayout(answer);

    connect(preset_, &QComboBox::currentIndexChanged, this,
            [this] { shortcuts_.set_preset(preset_->currentData().toString()); });
    connect(words_, &QLineEdit::textChanged, this, &ShortcutPage::list_commands);
    connect(table_, &QTreeWidget::currentItemChanged, this, &ShortcutPage::show_current);
    connect(table_, &QTreeWidget::itemActivated, key_, [this] { key_->setFocus(Qt::ShortcutFocusReason); });
    connect(key_, &QKeySequenceEdit::keySequenceChanged, this, &ShortcutPage::give);
    connect(none_, &QPushButton::clicked, this, [this] {
        if (const auto id = current()) shortcuts_.set_own(*id, {});
    });
    connect(reset_, &QPushButton::clicked, this, [this] {
        if (const auto id = current()) shortcuts_.reset(*id);
    });
    connect(reset_all_, &QPushButton::clicked, &shortcuts_, &Shortcuts::reset_all);
    connect(take_, &QPushButton::clicked, this, [this] {
        const auto id = current();
        if (!id || wanted_.isEmpty()) return;
        key_->setFocus();
        shortcuts_.set_own(*id, QKeySequence(wanted_));
    });
    connect(&shortcuts, &Shortcuts::changed, this, &ShortcutPage::show_keys);
    list_commands();
    table_->setCurrentItem(table_->topLevelItem(0));
    table_->resizeColumnToContents(0);
}

std::optional<CommandId> ShortcutPage::current() const {
    const QTreeWidgetItem* item = table_->currentItem();
    if (!item) return std::nullopt;
    return static_cast<CommandId>(item->data(0, Qt::UserRole).toInt());
}

void ShortcutPage::list_commands() {
    const QStringList words = words_->text().toLower().split(QLatin1Char(' '), Qt::SkipEmptyParts);
    const auto chosen = current();
    table_->clear();
    for (const Command& command : commands()) {
        const QString all = plain_text(command) + QLatin1Char(' ') + help_text(command) + QLatin1Char(' ') +
                            keys_text(shortcuts_.keys(command.id));
        if (!std::all_of(words.begin(), words.end(),
                         [&](const QString& word) { return all.contains(word, Qt::CaseInsensitive); }))
            continue;
        auto* item = new QTreeWidgetItem(table_, {plain_text(command)});
        item->setData(0, Qt::UserRole, static_cast<int>(command.id));
        item->setToolTip(0, help_text(command));
        if (chosen == command.id) table_->setCurrentItem(item);
    }
    if (!table_->currentItem()) table_->setCurrentItem(table_->topLevelItem(0));
    show_keys();
}

void ShortcutPage::show_keys() {
    {
        const QSignalBlocker blocker(preset_);
        preset_->setCurrentIndex(preset_->findData(QLatin1String(shortcuts_.preset().name)));
    }
    for (int row = 0; row < table_->topLevelItemCount(); ++row) {
        QTreeWidgetItem* item = table_->topLevelItem(row);
        const auto id = static_cast<CommandId>(item->data(0, Qt::UserRole).toInt());
        item->setText(1, keys_text(shortcuts_.keys(id)));
        QFont font = table_->font();
        font.setBold(shortcuts_.is_own(id));
        item->setFont(1, font);
        item->setToolTip(1, shortcuts_.is_own(id) ? tr("Changed by you") : QString());
    }
    show_current();
}

void ShortcutPage::show_current() {
    const auto id = current();
    for (QWidget* field : std::initializer_list<QWidget*>{key_, none_}) field->setEnabled(id.has_value());
    reset_->setEnabled(id && shortcuts_.is_own(*id));
    reset_all_->setEnabled(shortcuts_.has_own());
    name_->setText(id ? table_->currentItem()->text(0) : tr("No command is called so or does so."));
    const QSignalBlocker blocker(key_);
    key_->setKeySequence(id ? shortcuts_.keys(*id).value(0) : QKeySequence());
    tell({}, false);
}

void ShortcutPage::tell(const QString& text, bool can_take) {
    message_->setText(text);
    set_tone(message_, "warning");
    take_->setVisible(can_take);
    if (!can_take) wanted_ = {};
}

void ShortcutPage::give(const QKeySequence& sequence) {
    const auto id = current();
    if (!id || sequence.isEmpty()) return;
    // One key: what is pressed after it is another one.
    const QKeySequence key(sequence[sequence.count() - 1]);
    const auto owner = shortcuts_.owner(key);
    const bool is_its_own = owner && owner->command == id;
    if (!owner || is_its_own) {
        // The field goes on listening otherwise.
        shortcuts_.set_own(*id, key);
        return;
    }
    const QString text = key.toString(QKeySequence::NativeText);
    show_current();
    wanted_ = key;
    if (owner->command && *owner->command != CommandId::stop)
        tell(tr("%1 is the key of “%2”.").arg(text, owner->text), true);
    else
        tell(tr("%1 cannot be given away: %2.").arg(text, owner->text), false);
}

}  // namespace curvewright
