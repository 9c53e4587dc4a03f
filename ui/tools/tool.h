#pragma once

#include <QObject>
#include <QPointF>
#include <QString>

#include "ui/document/edit_state.h"
#include "ui/jobs/live_drag.h"
#include "ui/tools/canvas.h"

namespace curvewright {

/// What a tool works on.
struct ToolContext {
    Canvas& canvas;
    EditState& edit;
    LiveDrag& drag;
    MeshDocument& document() const { return edit.document(); }
};

struct PointerEvent {
    QPointF position;
    Qt::KeyboardModifiers modifiers;
    Qt::MouseButton button = Qt::NoButton;
};

/// What the left button, the wheel and some keys do in the view. What a tool does not take goes to the camera; the
/// other buttons always do.
class Tool : public QObject {
    Q_OBJECT

  public:
    explicit Tool(const ToolContext& context, QObject* parent) : QObject(parent), context_(context) {}

    virtual void enter() {}
    /// The tool is put away; a drag in progress has been given up before.
    virtual void leave() {}
    /// The mouse moves without button; none: it has left the view.
    virtual void hover(const std::optional<PointerEvent>& event) = 0;
    /// Whether the tool takes the press; only then it gets the moves and the release that follow.
    virtual bool press(const PointerEvent& event) = 0;
    virtual void move(const PointerEvent& event) = 0;
    virtual void release(const PointerEvent& event) = 0;
    /// steps: notches away from the user. Whether the tool takes it.
    virtual bool wheel(const PointerEvent&, double /*steps*/) { return false; }
    /// Whether the tool takes the key.
    virtual bool key(int /*key*/, Qt::KeyboardModifiers) { return false; }
    /// Gives up what is being done; whether there was anything.
    virtual bool cancel() { return false; }
    /// Mesh, camera, selection or settings have changed: the marks are to be drawn anew.
    virtual void refresh() = 0;
    /// What the mouse will do now, for the status bar.
    virtual QString hint() const = 0;

  signals:
    void hint_changed();

  protected:
    ToolContext context_;
};

/// Selected and pinned nodes, and the weights of a node that is looked at, as marks; positions: of the nodes.
void add_state_marks(Marks& marks, const EditState& edit, const Coordinates& positions);
void add_points(Marks& marks, const IndexSet& nodes, const Coordinates& positions, MarkRole role);

}  // namespace curvewright
