#include "ui/main_window/commands.h"

#include <QAction>
#include <QCoreApplication>
#include <QKeySequence>

#include "ui/main_window/shortcuts.h"

namespace curvewright {
namespace {

#define TEXT(text) QT_TRANSLATE_NOOP("Command", text)

// clang-format off
const Command command_list[] = {
    {CommandId::open, CommandMenu::file, "open", TEXT("&Open…"), TEXT("Open a mesh"), "open", "Ctrl+O", false, false, 1},
    {CommandId::load_deformation, CommandMenu::file, "load_deformation", TEXT("Load &deformation…"), TEXT("Load a boundary deformation, a node table or a mesh with final positions"), "deformation", "Ctrl+L"},
    {CommandId::open_session, CommandMenu::file, "open_session", TEXT("Op&en session…"), TEXT("Open a mesh and do again what a session says, with its steps in the history"), "", "Ctrl+Shift+O"},
    {CommandId::save, CommandMenu::file, "save", TEXT("&Save"), TEXT("Save the mesh"), "save", "Ctrl+S", false, true, 1},
    {CommandId::save_as, CommandMenu::file, "save_as", TEXT("Save &as…"), TEXT("Save the mesh under another name"), "", "Ctrl+Shift+S"},
    {CommandId::export_mesh, CommandMenu::file, "export", TEXT("&Export…"), TEXT("Write a copy as VTU (with quality and displacement), MSH or VTK"), "export", "Ctrl+Shift+E", false, false, 1},
    {CommandId::save_picture, CommandMenu::file, "save_picture", TEXT("Save &picture…"), TEXT("Save or copy what the view shows as a picture of any size"), "picture", "F12", false, false, 1},
    {CommandId::export_film, CommandMenu::file, "export_film", TEXT("Export ani&mation…"), TEXT("Write a film of the way to the present mesh or of the steps of the timeline: pictures for a video, or an animated WebP"), "", "Shift+F12"},
    {CommandId::export_quality, CommandMenu::file, "export_quality", TEXT("Export &histogram…"), TEXT("Write before and after as a table (CSV) or as a drawing (SVG, PNG)"), "", ""},
    {CommandId::report, CommandMenu::file, "report", TEXT("Repor&t…"), TEXT("Write a page about the last untangling: pictures, numbers, what was proved, how it went"), "", ""},
    {CommandId::save_session, CommandMenu::file, "save_session", TEXT("Save sessi&on…"), TEXT("Save everything that was done, for curvewright-cli replay"), "", ""},
    {CommandId::close_mesh, CommandMenu::file, "close_mesh", TEXT("&Close mesh"), TEXT("Close the mesh and go back to the start page"), "", "Ctrl+W", false, true},
    {CommandId::quit, CommandMenu::file, "quit", TEXT("&Quit"), TEXT("Leave the program"), "quit", "Ctrl+Q"},
    {CommandId::undo, CommandMenu::edit, "undo", TEXT("&Undo"), TEXT("Undo the last step"), "undo", "Ctrl+Z", false, false, 2},
    {CommandId::redo, CommandMenu::edit, "redo", TEXT("&Redo"), TEXT("Redo the step undone last"), "redo", "Ctrl+Y; Ctrl+Shift+Z", false, false, 2},
    {CommandId::copy_command, CommandMenu::edit, "copy_command", TEXT("Copy as &command line"), TEXT("Copy what leads to this mesh as a command for a terminal"), "", "Ctrl+Shift+C"},
    {CommandId::find, CommandMenu::edit, "find", TEXT("&Find node or element…"), TEXT("Select nodes and elements by their tags"), "", "Ctrl+F"},
    {CommandId::preferences, CommandMenu::edit, "preferences", TEXT("Pr&eferences…"), TEXT("Choose look, keys and habits of the program"), "", "Ctrl+,"},
    {CommandId::tool_look, CommandMenu::edit, "tool_look", TEXT("&Look around"), TEXT("The mouse moves the view and asks about elements"), "look", "V", true, true, 3},
    {CommandId::tool_select, CommandMenu::edit, "tool_select", TEXT("&Select"), TEXT("Select nodes and elements by click, box or lasso"), "select", "S", true, false, 3},
    {CommandId::tool_drag, CommandMenu::edit, "tool_drag", TEXT("&Drag the boundary"), TEXT("Take hold of the boundary; the mesh follows"), "drag", "D", true, false, 3},
    {CommandId::tool_transform, CommandMenu::edit, "tool_transform", TEXT("&Move, rotate and scale"), TEXT("Handles on the selection; the mesh follows"), "transform", "T", true, false, 3},
    {CommandId::tool_pin, CommandMenu::edit, "tool_pin", TEXT("&Pin nodes"), TEXT("Pinned nodes stay, whatever is dragged"), "pin", "P", true, false, 3},
    {CommandId::soft, CommandMenu::edit, "soft", TEXT("Take &neighbours along"), TEXT("Boundary nodes near those that are dragged follow (proportional editing)"), "soft", "O", true, true, 3},
    {CommandId::select_all, CommandMenu::select, "select_all", TEXT("&All elements"), TEXT("Select all elements"), "", "Ctrl+A"},
    {CommandId::select_none, CommandMenu::select, "select_none", TEXT("&Nothing"), TEXT("Select nothing"), "", "Ctrl+Shift+A"},
    {CommandId::select_invert, CommandMenu::select, "select_invert", TEXT("&Invert"), TEXT("Select what is not selected"), "", "Ctrl+I"},
    {CommandId::select_grow, CommandMenu::select, "select_grow", TEXT("&Grow"), TEXT("Select one layer more"), "", "+; =", false, true},
    {CommandId::select_shrink, CommandMenu::select, "select_shrink", TEXT("S&hrink"), TEXT("Select one layer less"), "", "-"},
    {CommandId::select_side, CommandMenu::select, "select_side", TEXT("&Sides of the selection"), TEXT("Select the smooth parts of the boundary that the selected nodes are on"), "", "Ctrl+E"},
    {CommandId::select_feature, CommandMenu::select, "select_feature", TEXT("&Feature lines of the selection"), TEXT("Select the edges between smooth parts of a solid's boundary that the selected nodes are on"), "", "Ctrl+Alt+E"},
    {CommandId::select_boundary, CommandMenu::select, "select_boundary", TEXT("Whole &boundaries of the selection"), TEXT("Select the connected boundaries that the selected nodes are on"), "", "Ctrl+B"},
    {CommandId::select_tangled, CommandMenu::select, "select_tangled", TEXT("&Tangled elements"), TEXT("Select the elements that are not proved valid"), "", "Ctrl+T"},
    {CommandId::pin_selection, CommandMenu::select, "pin_selection", TEXT("&Pin the selected nodes"), TEXT("They stay, whatever is dragged"), "", "Ctrl+P", false, true},
    {CommandId::unpin_all, CommandMenu::select, "unpin_all", TEXT("&Free all pinned nodes"), TEXT("No node is pinned any more"), "", "Ctrl+Shift+P"},
    {CommandId::deform, CommandMenu::mesh, "deform", TEXT("&Deform boundary"), TEXT("Move the boundary as the deformation says; the interior stays"), "deform", "Ctrl+D", false, false, 4, true},
    {CommandId::warp, CommandMenu::mesh, "warp", TEXT("&Warp"), TEXT("Move the boundary as the deformation says; the interior follows"), "warp", "Ctrl+R", false, false, 4, true},
    {CommandId::untangle, CommandMenu::mesh, "untangle", TEXT("&Untangle"), TEXT("Move interior nodes until no element is tangled"), "untangle", "Ctrl+U", false, false, 4, true},
    {CommandId::improve, CommandMenu::mesh, "improve", TEXT("&Improve"), TEXT("Raise the quality of a mesh whose elements are all valid"), "improve", "Ctrl+Shift+I", false, false, 4},
    {CommandId::flip, CommandMenu::mesh, "flip", TEXT("&Flip numbering"), TEXT("Number every element the other way round"), "flip", "", false, true},
    {CommandId::renumber, CommandMenu::mesh, "renumber", TEXT("&Renumber reversed elements"), TEXT("Number the elements that run against their neighbours as these are; nothing moves"), "", ""},
    {CommandId::timeline_show, CommandMenu::mesh, "timeline_show", TEXT("Show &how it went"), TEXT("Go through the last untangling or warp in increments step by step"), "", "Ctrl+H", false, true},
    {CommandId::timeline_open, CommandMenu::mesh, "timeline_open", TEXT("&Open trace…"), TEXT("Go through a trace that curvewright-cli wrote of an untangling of this mesh"), "", ""},
    {CommandId::timeline_save, CommandMenu::mesh, "timeline_save", TEXT("Sa&ve trace…"), TEXT("Write the steps of the timeline as lines of JSON"), "", ""},
    {CommandId::timeline_close, CommandMenu::mesh, "timeline_close", TEXT("&Close timeline"), TEXT("Show the present mesh again"), "", "Ctrl+Shift+H"},
    {CommandId::stop, CommandMenu::mesh, "stop", TEXT("&Stop"), TEXT("Stop the running job; the mesh stays as it is"), "stop", "Esc", false, true, 4, true},
    {CommandId::fit, CommandMenu::view, "fit", TEXT("&Fit"), TEXT("Show the whole mesh"), "fit", "F; Home", false, false, 5},
    {CommandId::fit_selection, CommandMenu::view, "fit_selection", TEXT("Fit the &selection"), TEXT("Show what is selected as large as it goes"), "", "Shift+F"},
    {CommandId::zoom_in, CommandMenu::view, "zoom_in", TEXT("Zoom &in"), TEXT("Come closer"), "", "Ctrl++; Ctrl+="},
    {CommandId::zoom_out, CommandMenu::view, "zoom_out", TEXT("Zoom &out"), TEXT("Go back a little"), "", "Ctrl+-"},
    {CommandId::look_front, CommandMenu::look, "look_front", TEXT("From the &front (+y)"), TEXT("Look along +y"), "", "Alt+Y"},
    {CommandId::look_back, CommandMenu::look, "look_back", TEXT("From the &back (−y)"), TEXT("Look along −y"), "", "Alt+Shift+Y"},
    {CommandId::look_left, CommandMenu::look, "look_left", TEXT("From the &left (+x)"), TEXT("Look along +x"), "", "Alt+X"},
    {CommandId::look_right, CommandMenu::look, "look_right", TEXT("From the &right (−x)"), TEXT("Look along −x"), "", "Alt+Shift+X"},
    {CommandId::look_top, CommandMenu::look, "look_top", TEXT("From the &top (−z)"), TEXT("Look along −z"), "", "Alt+Z"},
    {CommandId::look_bottom, CommandMenu::look, "look_bottom", TEXT("From b&elow (+z)"), TEXT("Look along +z"), "", "Alt+Shift+Z"},
    {CommandId::look_isometric, CommandMenu::look, "look_isometric", TEXT("&Isometric"), TEXT("Look from a corner"), "cube", "Alt+I"},
    {CommandId::bookmark_add, CommandMenu::bookmarks, "bookmark_add", TEXT("&Add a bookmark…"), TEXT("Keep this view, to go back to it"), "", "Ctrl+Shift+B"},
    {CommandId::bookmark_edit, CommandMenu::bookmarks, "bookmark_edit", TEXT("&Edit bookmarks…"), TEXT("Rename, remove and sort the kept views"), "", ""},
    {CommandId::edges, CommandMenu::view, "edges", TEXT("&Edges"), TEXT("Show the edges of the elements"), "edges", "E", true, true, 5},
    {CommandId::nodes, CommandMenu::view, "nodes", TEXT("&Nodes"), TEXT("Show the nodes"), "nodes", "N", true, false, 5},
    {CommandId::clip, CommandMenu::view, "clip", TEXT("&Cut open"), TEXT("Hide the elements on one side of a plane (3D)"), "clip", "C", true, false, 5},
    {CommandId::shrink, CommandMenu::view, "shrink", TEXT("&Shrink elements"), TEXT("Leave gaps between the elements"), "shrink", "F3", true, false, 5},
    {CommandId::worst_only, CommandMenu::view, "worst_only", TEXT("Only the &worst"), TEXT("Show the elements of the lowest scaled Jacobian alone, as many as stand in their table"), "worst", "W", true, false, 5},
    {CommandId::compare, CommandMenu::view, "compare", TEXT("&Before and now"), TEXT("Show the mesh before and after the last step side by side"), "compare", "B", true, false, 5},
    {CommandId::legend, CommandMenu::view, "legend", TEXT("&Legend"), TEXT("Show the scale of colours"), "legend", "L", true, false, 5},
    {CommandId::node_numbers, CommandMenu::view, "node_numbers", TEXT("N&ode numbers"), TEXT("Write the tags of the nodes beside them"), "node_numbers", "Ctrl+Shift+N", true, true},
    {CommandId::element_numbers, CommandMenu::view, "element_numbers", TEXT("Element n&umbers"), TEXT("Write the tags of the elements on them"), "element_numbers", "Ctrl+Shift+M", true},
    {CommandId::orthographic, CommandMenu::view, "orthographic", TEXT("Ortho&graphic"), TEXT("Show solid meshes without perspective (3D)"), "orthographic", "5", true},
    {CommandId::colors, CommandMenu::view, "colors", TEXT("&Colours"), TEXT("Choose what the colours show, their map and their range"), "", "K", true},
    {CommandId::theme_system, CommandMenu::theme, "theme_system", TEXT("Follow the &system"), TEXT("Light or dark, as the system is"), "", "", true},
    {CommandId::theme_light, CommandMenu::theme, "theme_light", TEXT("&Light"), TEXT("Dark text on light ground"), "", "", true},
    {CommandId::theme_dark, CommandMenu::theme, "theme_dark", TEXT("&Dark"), TEXT("Light text on dark ground"), "", "", true},
    {CommandId::panel_mesh, CommandMenu::panels, "panel_mesh", TEXT("&Mesh and history"), TEXT("Show or hide the panel of the mesh, its groups and its history"), "", "F7", true},
    {CommandId::panel_operations, CommandMenu::panels, "panel_operations", TEXT("&Operations"), TEXT("Show or hide the panel of the tabs and of the worst elements"), "", "F8", true},
    {CommandId::panel_quality, CommandMenu::panels, "panel_quality", TEXT("&Histograms"), TEXT("Show or hide the panel of the histograms"), "", "F9", true},
    {CommandId::panel_log, CommandMenu::panels, "panel_log", TEXT("M&essages"), TEXT("Show or hide everything that was told in this session"), "", "Shift+F9", true},
    {CommandId::next_area, CommandMenu::panels, "next_area", TEXT("Keyboard to the &next area"), TEXT("Move the keyboard from the view to the panels, one after another"), "", "F6", false, true},
    {CommandId::previous_area, CommandMenu::panels, "previous_area", TEXT("Keyboard to the &previous area"), TEXT("Move the keyboard the other way round"), "", "Shift+F6"},
    {CommandId::reset_layout, CommandMenu::view, "reset_layout", TEXT("&Reset layout"), TEXT("Put all panels back where they were at first"), "", "", false, true},
    {CommandId::palette, CommandMenu::help, "palette", TEXT("&Find a command…"), TEXT("Type what you want to do"), "", "Ctrl+K"},
    {CommandId::shortcuts, CommandMenu::help, "shortcuts", TEXT("&Keyboard and mouse"), TEXT("List all shortcuts"), "help", "F1"},
    {CommandId::about, CommandMenu::help, "about", TEXT("&About Curvewright"), TEXT("What this program is"), "", ""},
};
// clang-format on

#undef TEXT

QString translated(const char* text) {
    return QCoreApplication::translate("Command", text);
}

}  // namespace

std::span<const Command> commands() {
    return command_list;
}

QString plain_text(const Command& command) {
    return translated(command.text).remove(QLatin1Char('&')).remove(QChar(0x2026));
}

QString help_text(const Command& command) {
    return translated(command.help);
}

QString tool_tip(const Command& command, const QString& key, const QString& name) {
    // Rich text is the only kind that wraps.
    QString head = QStringLiteral("<b>%1</b>").arg((name.isEmpty() ? plain_text(command) : name).toHtmlEscaped());
    if (!key.isEmpty()) head += QStringLiteral("&nbsp;&nbsp; ") + key.toHtmlEscaped();
    QString text = help_text(command).toHtmlEscaped() + QLatin1Char('.');
    if (const QString lesson = lesson_text(command); !lesson.isEmpty())
        text += QStringLiteral("<br/>") + lesson.toHtmlEscaped();
    return QStringLiteral("<p style='margin:0'>%1</p><p style='margin:0'>%2</p>").arg(head, text);
}

CommandActions::CommandActions(const Theme& theme, QObject* parent) : QObject(parent), shortcuts_(new Shortcuts(this)) {
    for (const Command& command : commands()) {
        auto* action = new QAction(translated(command.text), parent);
        action->setObjectName(QLatin1String(command.name));
        action->setCheckable(command.is_checkable);
        // The blank keeps the text of a tool button off its icon: style sheets have no word for that distance.
        action->setIconText(QLatin1Char(' ') + plain_text(command));
        action->setStatusTip(help_text(command));
        actions_[command.id] = action;
    }
    actions_.at(CommandId::quit)->setMenuRole(QAction::QuitRole);
    actions_.at(CommandId::about)->setMenuRole(QAction::AboutRole);
    refresh_icons(theme);
    connect(&theme, &Theme::changed, this, [this, &theme] { refresh_icons(theme); });
    refresh_keys();
    connect(shortcuts_, &Shortcuts::changed, this, &CommandActions::refresh_keys);
}

void CommandActions::refresh_keys() {
    // First none: two actions must not have the same key even for a moment.
    for (const Command& command : commands()) actions_.at(command.id)->setShortcuts(QList<QKeySequence>());
    for (const Command& command : commands()) {
        QAction* action = actions_.at(command.id);
        action->setShortcuts(shortcuts_->keys(command.id));
        action->setToolTip(tool_tip(command, action->shortcut().toString(QKeySequence::NativeText)));
    }
}

void CommandActions::refresh_icons(const Theme& theme) {
    for (const Command& command : commands())
        if (*command.icon) actions_.at(command.id)->setIcon(theme.icon(QLatin1String(command.icon)));
}

}  // namespace curvewright
