#pragma once

#include <map>
#include <optional>
#include <span>

#include <QHash>
#include <QKeySequence>
#include <QList>
#include <QObject>
#include <QString>

#include "ui/main_window/commands.h"

namespace curvewright {

/// Other keys than the list of commands gives to a command.
struct PresetKeys {
    CommandId command;
    const char* keys;  ///< as Command::shortcuts
};

/// Keys for people who know another program: what differs from the list of commands. A key given here is taken from
/// whoever has it there.
struct ShortcutPreset {
    const char* name;  ///< in the settings
    const char* text;  ///< for people
    std::span<const PresetKeys> keys;
};
std::span<const ShortcutPreset> shortcut_presets();
QString preset_text(const ShortcutPreset& preset);

/// Keys that are no command's and cannot be given away.
struct FixedKeys {
    const char* keys;   ///< as Command::shortcuts
    const char* shown;  ///< for people
    const char* text;   ///< what they do
    bool
        is_in_hand_only;  ///< only while something is dragged, when all keys are the tool's: they may have commands too
    std::optional<CommandId> command = {};  ///< of which this is the key all the same
};
std::span<const FixedKeys> fixed_keys();
QString fixed_name(const FixedKeys& keys);
QString fixed_text(const FixedKeys& keys);
/// "Ctrl+Y; Ctrl+Shift+Z" as sequences.
QList<QKeySequence> parse_keys(const QString& keys);
/// For people, separated by " or ".
QString keys_text(const QList<QKeySequence>& keys);

/// Which keys the commands have now: those of the list of commands, changed by a preset, changed by the user. The
/// user's go before the preset's, and these before the list's: no key is ever two commands'. Kept in the settings;
/// what is broken there is passed over.
class Shortcuts : public QObject {
    Q_OBJECT

  public:
    explicit Shortcuts(QObject* parent = nullptr);

    const ShortcutPreset& preset() const { return *preset_; }
    /// pre: there is a preset of that name.
    void set_preset(const QString& name);

    /// The first one is shown.
    const QList<QKeySequence>& keys(CommandId id) const { return keys_.at(id); }
    /// The user has changed them.
    bool is_own(CommandId id) const { return own_.contains(id); }
    bool has_own() const { return !own_.empty(); }

    /// Who has a key; command none: it is no command's, and `text` says what it does.
    struct Owner {
        std::optional<CommandId> command;
        QString text;
    };
    std::optional<Owner> owner(const QKeySequence& key) const;
    /// Gives the command this key alone (empty: none); whatever command has it loses it. pre: no fixed or menu key.
    void set_own(CommandId id, const QKeySequence& key);
    /// Back to the preset's.
    void reset(CommandId id);
    void reset_all();

    /// Keys that open menus, with the menu's name: no command may have them.
    void set_menu_keys(QHash<QKeySequence, QString> keys) { menu_keys_ = std::move(keys); }

  signals:
    void changed();

  private:
    void store() const;
    void settle();

    const ShortcutPreset* preset_;
    std::map<CommandId, QList<QKeySequence>> own_, keys_;
    QHash<QKeySequence, QString> menu_keys_;
};

}  // namespace curvewright
