#pragma once

#include "ui/tools/tool.h"

namespace curvewright {

/// Selects nodes and elements: by a click (twice: the side, three times: the whole boundary), by a box or a lasso.
/// Shift adds, Ctrl takes away or adds one by one.
class SelectTool : public Tool {
    Q_OBJECT

  public:
    using Tool::Tool;

    void enter() override;
    void leave() override;
    void hover(const std::optional<PointerEvent>& event) override;
    bool press(const PointerEvent& event) override;
    void move(const PointerEvent& event) override;
    void release(const PointerEvent& event) override;
    bool cancel() override;
    void refresh() override;
    QString hint() const override;

  private:
    struct Found {
        IndexSet nodes, elements;
        bool operator==(const Found&) const = default;
    };
    Found found_at(QPointF position) const;
    /// The outline drawn so far, closed; empty while it is still a click.
    std::vector<QPointF> outline() const;
    void take(const Found& found, Qt::KeyboardModifiers modifiers);

    Found hovered_;
    bool is_drawing_ = false;
    std::vector<QPointF> path_;  ///< of the mouse since the press
    int clicks_ = 0;             ///< at one place, one after another
};

}  // namespace curvewright
