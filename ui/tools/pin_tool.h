#pragma once

#include "ui/tools/tool.h"

namespace curvewright {

/// Pins nodes: they stay, whatever is dragged. A click pins the unit under the mouse, or frees it.
class PinTool : public Tool {
    Q_OBJECT

  public:
    using Tool::Tool;

    void enter() override;
    void leave() override;
    void hover(const std::optional<PointerEvent>& event) override;
    bool press(const PointerEvent& event) override;
    void move(const PointerEvent&) override {}
    void release(const PointerEvent&) override {}
    void refresh() override;
    QString hint() const override;

  private:
    IndexSet unit_around(Index node) const;

    std::optional<Index> hovered_;
};

}  // namespace curvewright
