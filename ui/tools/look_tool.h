#pragma once

#include "ui/tools/tool.h"

namespace curvewright {

/// Leaves the mouse to the camera; shows what is selected and pinned.
class LookTool : public Tool {
    Q_OBJECT

  public:
    using Tool::Tool;

    void enter() override { refresh(); }
    void leave() override { context_.canvas.show_marks({}, {}); }
    void hover(const std::optional<PointerEvent>&) override {}
    bool press(const PointerEvent&) override { return false; }
    void move(const PointerEvent&) override {}
    void release(const PointerEvent&) override {}
    void refresh() override;
    QString hint() const override;
};

}  // namespace curvewright
