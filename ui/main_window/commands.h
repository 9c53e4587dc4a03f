#pragma once

#include <map>
#include <span>

#include <QObject>

#include "ui/panels/theme.h"

class QAction;

namespace curvewright {

class Shortcuts;

enum class CommandId {
    open,
    load_deformation,
    open_session,
    save,
    save_as,
    export_mesh,
    save_picture,
    export_film,
    export_quality,
    report,
    save_session,
    close_mesh,
    quit,
    undo,
    redo,
    copy_command,
    find,
    preferences,
    tool_look,
    tool_select,
    tool_drag,
    tool_transform,
    tool_pin,
    soft,
    select_all,
    select_none,
    select_invert,
    select_grow,
    select_shrink,
    select_side,
    select_feature,
    select_boundary,
    select_tangled,
    pin_selection,
    unpin_all,
    deform,
    warp,
    untangle,
    improve,
    flip,
    renumber,
    timeline_show,
    timeline_open,
    timeline_save,
    timeline_close,
    stop,
    fit,
    fit_selection,
    zoom_in,
    zoom_out,
    look_front,
    look_back,
    look_left,
    look_right,
    look_top,
    look_bottom,
    look_isometric,
    bookmark_add,
    bookmark_edit,
    edges,
    nodes,
    legend,
    colors,
    clip,
    shrink,
    worst_only,
    compare,
    node_numbers,
    element_numbers,
    orthographic,
    theme_system,
    theme_light,
    theme_dark,
    panel_mesh,
    panel_operations,
    panel_quality,
    panel_log,
    next_area,
    previous_area,
    reset_layout,
    palette,
    shortcuts,
    about,
};

/// Where a command stands in the menu bar.
enum class CommandMenu { file, edit, select, mesh, view, look, bookmarks, theme, help, panels };

/// One command of the window. Menus, tool bar, tool tips, the page of shortcuts and the tests all read commands().
struct Command {
    CommandId id;
    CommandMenu menu;
    const char* name;       ///< object name of its QAction
    const char* text;       ///< as in the menu, with its mnemonic
    const char* help;       ///< what it does, one phrase
    const char* icon;       ///< in resources/icons; "" = none
    const char* shortcuts;  ///< separated by "; ", the first one is shown; "" = none
    bool is_checkable = false;
    bool starts_section = false;  ///< a line above it in the menu
    /// Position in the tool bar: group and, within it, the order of this list; 0 = not there.
    int tool_group = 0;
    /// Its tool button shows the text beside the icon.
    bool has_tool_text = false;
};

std::span<const Command> commands();

/// The text of a command for people: translated, without mnemonic and dots.
QString plain_text(const Command& command);
QString help_text(const Command& command);
/// When or why one wants it, a sentence; "" = its help says it all.
QString lesson_text(const Command& command);
/// What a pointer on the command tells: its name and key, what it does, when one wants it. name: instead of the
/// command's own.
QString tool_tip(const Command& command, const QString& key, const QString& name = {});

/// One QAction per command, child of the given object; they have the keys that Shortcuts says.
class CommandActions : public QObject {
    Q_OBJECT

  public:
    CommandActions(const Theme& theme, QObject* parent);

    QAction* operator[](CommandId id) const { return actions_.at(id); }
    Shortcuts& shortcuts() const { return *shortcuts_; }

  private:
    void refresh_icons(const Theme& theme);
    void refresh_keys();

    std::map<CommandId, QAction*> actions_;
    Shortcuts* shortcuts_;
};

}  // namespace curvewright
