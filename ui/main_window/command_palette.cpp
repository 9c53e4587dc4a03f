#include "ui/main_window/command_palette.h"

#include <algorithm>

#include <QAction>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QPixmap>
#include <QVBoxLayout>

namespace curvewright {
namespace {

/// How well a command answers to the words; 0 = not at all. The beginning of its name counts most.
int match(const Command& command, const QStringList& words) {
    const QString name = plain_text(command).toLower(), help = help_text(command).toLower();
    int score = 1;
    for (const QString& word : words) {
        if (name.startsWith(word))
            score += 100;
        else if (name.contains(QLatin1Char(' ') + word))
            score += 50;
        else if (name.contains(word))
            score += 20;
        else if (help.contains(word))
            score += 5;
        else
            return 0;
    }
    return score;
}

}  // namespace

CommandPalette::CommandPalette(const CommandActions& actions, QWidget* parent)
    : QDialog(parent, Qt::Dialog | Qt::FramelessWindowHint), actions_(actions) {
    setObjectName(QStringLiteral("command_palette"));
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("Commands"));
    words_ = new QLineEdit;
    words_->setObjectName(QStringLiteral("palette_words"));
    words_->setPlaceholderText(tr("What do you want to do?"));
    words_->installEventFilter(this);
    list_ = new QListWidget;
    list_->setObjectName(QStringLiteral("palette_list"));
    list_->setFocusPolicy(Qt::NoFocus);
    list_->setIconSize({16, 16});
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(8, 8, 8, 8);
    layout->addWidget(words_);
    layout->addWidget(list_);
    connect(words_, &QLineEdit::textChanged, this, &CommandPalette::list_matches);
    connect(list_, &QListWidget::itemClicked, this, &CommandPalette::run_current);
    list_matches();
    resize(520, 360);
    // At the top of the window, where the tool bar is left to be seen.
    const QRect window = parent->window()->geometry();
    move(window.center().x() - width() / 2, window.top() + 96);
}

void CommandPalette::list_matches() {
    const QStringList words = words_->text().toLower().split(QLatin1Char(' '), Qt::SkipEmptyParts);
    std::vector<std::pair<int, const Command*>> found;
    for (const Command& command : commands()) {
        const int score = match(command, words);
        if (score > 0 && actions_[command.id]->isEnabled() && command.id != CommandId::palette)
            found.emplace_back(score, &command);
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    list_->clear();
    // Names stand below each other, with an icon before them or without.
    QPixmap nothing(list_->iconSize().isValid() ? list_->iconSize() : QSize(16, 16));
    nothing.fill(Qt::transparent);
    for (const auto& [score, command] : found) {
        const QString keys = actions_[command->id]->shortcut().toString(QKeySequence::NativeText);
        QString text = plain_text(*command);
        if (!keys.isEmpty()) text += QStringLiteral("    ") + keys;
        const QIcon icon = actions_[command->id]->icon();
        auto* item = new QListWidgetItem(icon.isNull() ? QIcon(nothing) : icon, text, list_);
        item->setToolTip(help_text(*command));
        item->setData(Qt::UserRole, static_cast<int>(command->id));
    }
    if (found.empty()) {
        auto* item = new QListWidgetItem(tr("No command of that kind can be used now."), list_);
        item->setFlags(Qt::NoItemFlags);
        return;
    }
    list_->setCurrentRow(0);
}

void CommandPalette::run_current() {
    const QListWidgetItem* item = list_->currentItem();
    if (!item) return;
    QAction* action = actions_[static_cast<CommandId>(item->data(Qt::UserRole).toInt())];
    // Away first: the command may ask something itself.
    connect(this, &QObject::destroyed, action, [action] {
        if (action->isEnabled()) action->trigger();
    });
    close();
}

bool CommandPalette::eventFilter(QObject* watched, QEvent* event) {
    if (watched == words_ && event->type() == QEvent::KeyPress) {
        const int key = static_cast<QKeyEvent*>(event)->key();
        const int row = list_->currentRow();
        switch (key) {
            case Qt::Key_Down:
                list_->setCurrentRow(std::min(row + 1, list_->count() - 1));
                return true;
            case Qt::Key_Up:
                list_->setCurrentRow(std::max(row - 1, 0));
                return true;
            case Qt::Key_Return:
            case Qt::Key_Enter:
                run_current();
                return true;
            default:
                break;
        }
    }
    return QDialog::eventFilter(watched, event);
}

}  // namespace curvewright
