// When or why one wants a command: one sentence each, for the tool tips. A command whose help says it all has none.

#include <QCoreApplication>

#include "ui/main_window/commands.h"

namespace curvewright {
namespace {

#define TEXT(text) QT_TRANSLATE_NOOP("Command", text)

struct Lesson {
    CommandId command;
    const char* text;
};

// clang-format off
const Lesson lessons[] = {
    {CommandId::open, TEXT("Gmsh .msh and VTK .vtu or .vtk; a mesh can also be dropped on the window.")},
    {CommandId::load_deformation, TEXT("It says where the boundary is to go; then deform, or warp.")},
    {CommandId::save, TEXT("The file that was opened is not overwritten without asking.")},
    {CommandId::export_mesh, TEXT("To look at the mesh in ParaView, or to hand it to a solver.")},
    {CommandId::save_picture, TEXT("For a report: as large as the view, or twice as large.")},
    {CommandId::report, TEXT("To show somebody, or for your records; curvewright-cli untangle --report writes the same.")},
    {CommandId::save_session, TEXT("To do the same again, or to show somebody how you got there.")},
    {CommandId::undo, TEXT("As often as you like; a click in the history jumps.")},
    {CommandId::redo, TEXT("As long as nothing else has been done.")},
    {CommandId::copy_command, TEXT("To do by a script what you have tried out by hand.")},
    {CommandId::find, TEXT("When a solver complains about node 4711.")},
    {CommandId::tool_look, TEXT("When nothing is to be changed: a press never takes hold of anything.")},
    {CommandId::tool_select, TEXT("Click again for the whole side, once more for the whole boundary; Shift adds.")},
    {CommandId::tool_drag, TEXT("Press on a boundary node and pull; the interior and the proof follow at once.")},
    {CommandId::tool_transform, TEXT("For a side or a hole that is to move as a whole: select it, then use the handles.")},
    {CommandId::tool_pin, TEXT("To keep a corner or a hole in place while you drag what is next to it.")},
    {CommandId::soft, TEXT("Pulls a bump instead of a spike; the wheel changes how far it reaches while you drag.")},
    {CommandId::select_tangled, TEXT("To see where the trouble is, or to fit the view to it.")},
    {CommandId::deform, TEXT("To see how far the mesh tangles, or to untangle it from there; to avoid that, warp.")},
    {CommandId::warp, TEXT("The first choice for a mesh that has to follow a new boundary; needs a deformation.")},
    {CommandId::untangle, TEXT("When elements are hatched; every element ends with a proof, or with the reason why not.")},
    {CommandId::improve, TEXT("When a solver wants better elements; a limit keeps the nodes near where they are.")},
    {CommandId::flip, TEXT("When all elements are negative only because they are numbered clockwise.")},
    {CommandId::timeline_show, TEXT("To understand what moved where and when, and which element resisted.")},
    {CommandId::timeline_open, TEXT("To see here what happened on a machine without a window.")},
    {CommandId::timeline_save, TEXT("To study a run with your own tools.")},
    {CommandId::stop, TEXT("Nothing is lost by it.")},
    {CommandId::fit, TEXT("When you are lost.")},
    {CommandId::fit_selection, TEXT("To look closely at what you have chosen.")},
    {CommandId::edges, TEXT("Curved as the elements are; without them the colours are easier to compare.")},
    {CommandId::nodes, TEXT("To see where the high-order nodes lie.")},
    {CommandId::clip, TEXT("To look inside a solid; the plane moves while you watch.")},
    {CommandId::shrink, TEXT("To see single elements of a solid, and faces that do not fit.")},
    {CommandId::worst_only, TEXT("To find what limits the quality, also deep inside a solid.")},
    {CommandId::compare, TEXT("One camera moves both, so the same place can be compared.")},
    {CommandId::legend, TEXT("It also marks where the worst element is.")},
    {CommandId::panel_log, TEXT("To read again what has gone from the view, or to copy it for somebody else.")},
    {CommandId::palette, TEXT("Quicker than the menus, and it tells the keys.")},
};
// clang-format on

#undef TEXT

}  // namespace

QString lesson_text(const Command& command) {
    for (const Lesson& lesson : lessons)
        if (lesson.command == command.id) return QCoreApplication::translate("Command", lesson.text);
    return {};
}

}  // namespace curvewright
