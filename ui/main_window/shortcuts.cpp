#include "ui/main_window/shortcuts.h"

#include <algorithm>
#include <set>

#include <QCoreApplication>
#include <QSettings>

namespace curvewright {
namespace {

#define TEXT(text) QT_TRANSLATE_NOOP("Shortcuts", text)

// Only what is the same thing in the other program, and what has to make room for it.
const PresetKeys paraview_keys[] = {
    {CommandId::tool_select, "S; D"},            // "Select Cells On", "Select Points On"
    {CommandId::tool_drag, "M"},                 // D is taken
    {CommandId::palette, "Ctrl+Space; Ctrl+K"},  // quick launch
};
const PresetKeys gmsh_keys[] = {
    {CommandId::edges, "Alt+D; E"},        // mesh display mode
    {CommandId::nodes, "Alt+Shift+P; N"},  // mesh points
    {CommandId::preferences, "Ctrl+Shift+N; Ctrl+,"},
    {CommandId::node_numbers, "Ctrl+Alt+N"},
};
const PresetKeys glvis_keys[] = {
    {CommandId::edges, "M; E"},      // mesh
    {CommandId::clip, "I"},          // cutting plane
    {CommandId::legend, "C; L"},     // colour bar
    {CommandId::fit, "R; F; Home"},  // reset the view
    {CommandId::save_picture, "Shift+S; F12"},
};
const PresetKeys blender_keys[] = {
    {CommandId::tool_transform, "G; R; S; T"},  // grab, rotate, scale
    {CommandId::tool_select, "W"},
    {CommandId::worst_only, "Shift+W"},
    {CommandId::select_all, "A; Ctrl+A"},
    {CommandId::select_none, "Alt+A; Ctrl+Shift+A"},
    {CommandId::select_grow, "Ctrl+Num++; Ctrl++"},
    {CommandId::select_shrink, "Ctrl+Num+-; Ctrl+-"},
    {CommandId::zoom_in, "Num++; +; ="},
    {CommandId::zoom_out, "Num+-; -"},
    {CommandId::unpin_all, "Alt+P; Ctrl+Shift+P"},
    {CommandId::fit, "Home; F"},
    {CommandId::fit_selection, "Num+.; Shift+F"},
    {CommandId::look_front, "Num+1; Alt+Y"},
    {CommandId::look_back, "Ctrl+Num+1; Alt+Shift+Y"},
    {CommandId::look_right, "Num+3; Alt+Shift+X"},
    {CommandId::look_left, "Ctrl+Num+3; Alt+X"},
    {CommandId::look_top, "Num+7; Alt+Z"},
    {CommandId::look_bottom, "Ctrl+Num+7; Alt+Shift+Z"},
    {CommandId::clip, "Alt+B; C"},
    {CommandId::panel_operations, "N; F8"},  // side bar
    {CommandId::nodes, "Shift+N"},
    {CommandId::palette, "F3; Ctrl+K"},  // search
    {CommandId::shrink, "Shift+F3"},
    {CommandId::redo, "Ctrl+Shift+Z; Ctrl+Y"},
};
const ShortcutPreset presets[] = {
    {"curvewright", TEXT("Curvewright"), {}},        {"paraview", TEXT("Like ParaView"), paraview_keys},
    {"gmsh", TEXT("Like Gmsh"), gmsh_keys},          {"glvis", TEXT("Like GLVis"), glvis_keys},
    {"blender", TEXT("Like Blender"), blender_keys},
};

// clang-format off
const FixedKeys fixed_list[] = {
    {"Left; Right; Up; Down", TEXT("Arrows"), TEXT("Move a flat mesh, turn a solid"), false},
    {"Shift+Left; Shift+Right; Shift+Up; Shift+Down", TEXT("Shift+arrows"), TEXT("Move a solid"), false},
    {"PgUp; PgDown", TEXT("Page Up, Page Down"), TEXT("Zoom in and out"), false},
    {"Alt+Left; Alt+Right; Alt+Up; Alt+Down", TEXT("Alt+arrows"), TEXT("Nudge the selected nodes; the mesh follows"), false},
    {"Alt+Shift+Left; Alt+Shift+Right; Alt+Shift+Up; Alt+Shift+Down", TEXT("Alt+Shift+arrows"), TEXT("Nudge them ten times as far"), false},
    {"Ctrl+1; Ctrl+2; Ctrl+3; Ctrl+4; Ctrl+5; Ctrl+6; Ctrl+7; Ctrl+8; Ctrl+9", TEXT("Ctrl+1 … Ctrl+9"), TEXT("Go to a bookmark of a view"), false},
    {"Tab; Shift+Tab", TEXT("Tab, Shift+Tab"), TEXT("Go to the next or the previous field"), false},
    {"Return; Enter; Space", TEXT("Enter, Space"), TEXT("Choose what the keyboard is at"), false},
    {"Esc", TEXT("Esc"), TEXT("Put back what is in hand, stop a job, select nothing"), false, CommandId::stop},
    {"X; Y; Z; N", TEXT("X, Y, Z, N"), TEXT("While dragging: keep to an axis or to the normal; again: free"), true},
};
// clang-format on

#undef TEXT

const QString preset_setting = QStringLiteral("shortcuts/preset");
const QString own_settings = QStringLiteral("shortcuts/own");

const ShortcutPreset* find_preset(const QString& name) {
    const auto found = std::find_if(std::begin(presets), std::end(presets),
                                    [&](const ShortcutPreset& preset) { return name == QLatin1String(preset.name); });
    return found == std::end(presets) ? nullptr : found;
}

}  // namespace

std::span<const ShortcutPreset> shortcut_presets() {
    return presets;
}

QString preset_text(const ShortcutPreset& preset) {
    return QCoreApplication::translate("Shortcuts", preset.text);
}

std::span<const FixedKeys> fixed_keys() {
    return fixed_list;
}

QString fixed_text(const FixedKeys& keys) {
    return QCoreApplication::translate("Shortcuts", keys.text);
}

QString fixed_name(const FixedKeys& keys) {
    return QCoreApplication::translate("Shortcuts", keys.shown);
}

QList<QKeySequence> parse_keys(const QString& keys) {
    QList<QKeySequence> result;
    for (const QString& key : keys.split(QStringLiteral("; "), Qt::SkipEmptyParts)) {
        const QKeySequence sequence(key, QKeySequence::PortableText);
        if (!sequence.isEmpty() && sequence[0].key() != Qt::Key_unknown) result << sequence;
    }
    return result;
}

QString keys_text(const QList<QKeySequence>& keys) {
    QStringList texts;
    for (const QKeySequence& key : keys) texts << key.toString(QKeySequence::NativeText);
    return texts.join(QCoreApplication::translate("Shortcuts", " or "));
}

Shortcuts::Shortcuts(QObject* parent) : QObject(parent), preset_(presets) {
    QSettings settings;
    if (const auto* preset = find_preset(settings.value(preset_setting).toString())) preset_ = preset;
    settings.beginGroup(own_settings);
    for (const Command& command : commands()) {
        const QVariant value = settings.value(QLatin1String(command.name));
        if (!value.isValid()) continue;
        const QList<QKeySequence> keys = parse_keys(value.toString());
        if (!keys.isEmpty() || value.toString().isEmpty()) own_[command.id] = keys;
    }
    settle();
}

void Shortcuts::store() const {
    QSettings settings;
    settings.setValue(preset_setting, QLatin1String(preset_->name));
    settings.remove(own_settings);
    settings.beginGroup(own_settings);
    for (const Command& command : commands()) {
        const auto found = own_.find(command.id);
        if (found == own_.end()) continue;
        QStringList texts;
        for (const QKeySequence& key : found->second) texts << key.toString(QKeySequence::PortableText);
        settings.setValue(QLatin1String(command.name), texts.join(QStringLiteral("; ")));
    }
}

void Shortcuts::settle() {
    std::set<QKeySequence> taken;
    std::map<QKeySequence, CommandId> reserved;
    for (const FixedKeys& fixed : fixed_list)
        if (!fixed.is_in_hand_only)
            for (const QKeySequence& key : parse_keys(QLatin1String(fixed.keys))) {
                if (fixed.command)
                    reserved[key] = *fixed.command;
                else
                    taken.insert(key);
            }
    keys_.clear();
    const auto take = [&](CommandId id, const QList<QKeySequence>& wanted) {
        QList<QKeySequence>& keys = keys_[id];
        for (const QKeySequence& key : wanted) {
            const auto holder = reserved.find(key);
            if (holder != reserved.end() && holder->second != id) continue;
            if (taken.insert(key).second) keys << key;
        }
    };
    for (const Command& command : commands())
        if (own_.contains(command.id)) take(command.id, own_.at(command.id));
    for (const PresetKeys& entry : preset_->keys)
        if (!own_.contains(entry.command)) take(entry.command, parse_keys(QLatin1String(entry.keys)));
    for (const Command& command : commands())
        if (!keys_.contains(command.id)) take(command.id, parse_keys(QLatin1String(command.shortcuts)));
}

void Shortcuts::set_preset(const QString& name) {
    preset_ = find_preset(name);
    store();
    settle();
    emit changed();
}

std::optional<Shortcuts::Owner> Shortcuts::owner(const QKeySequence& key) const {
    for (const FixedKeys& fixed : fixed_list)
        if (!fixed.is_in_hand_only && parse_keys(QLatin1String(fixed.keys)).contains(key))
            return Owner{{}, fixed_text(fixed)};
    if (const auto menu = menu_keys_.constFind(key); menu != menu_keys_.constEnd())
        return Owner{{}, tr("Open the menu %1").arg(*menu)};
    for (const Command& command : commands())
        if (keys_.at(command.id).contains(key)) return Owner{command.id, plain_text(command)};
    return std::nullopt;
}

void Shortcuts::set_own(CommandId id, const QKeySequence& key) {
    own_[id] = key.isEmpty() ? QList<QKeySequence>() : QList<QKeySequence>{key};
    // Another command that the user had given this key is left without.
    if (!key.isEmpty())
        for (auto& [other, keys] : own_)
            if (other != id) keys.removeAll(key);
    store();
    settle();
    emit changed();
}

void Shortcuts::reset(CommandId id) {
    own_.erase(id);
    store();
    settle();
    emit changed();
}

void Shortcuts::reset_all() {
    own_.clear();
    store();
    settle();
    emit changed();
}

}  // namespace curvewright
