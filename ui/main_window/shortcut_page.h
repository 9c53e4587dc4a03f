#pragma once

#include <optional>

#include <QKeySequence>
#include <QWidget>

#include "ui/main_window/shortcuts.h"

class QComboBox;
class QKeySequenceEdit;
class QLabel;
class QLineEdit;
class QPushButton;
class QTreeWidget;

namespace curvewright {

/// Preferences > Keys: the preset, all commands with their keys to search in, and a field to give a command another
/// one. A key that somebody has is refused with a sentence that names them; it can be taken from a command.
class ShortcutPage : public QWidget {
    Q_OBJECT

  public:
    explicit ShortcutPage(Shortcuts& shortcuts, QWidget* parent = nullptr);

    /// The choice of the preset, for the form above the page: who makes the page puts it there.
    QComboBox* preset_box() const { return preset_; }

  private:
    void list_commands();
    void show_keys();
    void show_current();
    void give(const QKeySequence& key);
    void tell(const QString& text, bool can_take);
    std::optional<CommandId> current() const;

    Shortcuts& shortcuts_;
    QComboBox* preset_ = nullptr;
    QLineEdit* words_ = nullptr;
    QTreeWidget* table_ = nullptr;
    QLabel *name_ = nullptr, *message_ = nullptr;
    QKeySequenceEdit* key_ = nullptr;
    QPushButton *none_ = nullptr, *reset_ = nullptr, *reset_all_ = nullptr, *take_ = nullptr;
    QKeySequence wanted_;  ///< that somebody else has
};

}  // namespace curvewright
