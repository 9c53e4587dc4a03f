#include "ui/tools/look_tool.h"

namespace curvewright {

void LookTool::refresh() {
    Marks marks;
    if (context_.document().has_mesh())
        add_state_marks(marks, context_.edit, context_.document().state().mesh->coordinates());
    context_.canvas.show_marks(std::move(marks), {});
}

QString LookTool::hint() const {
    return context_.canvas.is_flat() ? tr("drag: move · wheel: zoom to the pointer · click: what is this element?")
                                     : tr("drag: turn · shift+drag: move · wheel: zoom · click: what is this element?");
}

}  // namespace curvewright
