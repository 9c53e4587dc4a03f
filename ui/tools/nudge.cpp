#include "ui/tools/nudge.h"

#include <cmath>
#include <utility>

#include <QKeyEvent>
#include <QWidget>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

constexpr double step_pixels = 8.0;
constexpr int longest_pause = 1000;  ///< milliseconds

/// Right and up; null: no arrow.
QPoint arrow(int key) {
    switch (key) {
        case Qt::Key_Left:
            return {-1, 0};
        case Qt::Key_Right:
            return {1, 0};
        case Qt::Key_Up:
            return {0, 1};
        case Qt::Key_Down:
            return {0, -1};
        default:
            return {};
    }
}

}  // namespace

Nudge::Nudge(const ToolContext& context, QWidget* view, QObject* parent) : QObject(parent), context_(context) {
    view->installEventFilter(this);
    pause_.setSingleShot(true);
    pause_.setInterval(longest_pause);
    connect(&pause_, &QTimer::timeout, this, &Nudge::end);
    connect(&context_.drag, &LiveDrag::ended, this, [this] {
        if (!is_mine_) return;
        is_mine_ = is_ending_ = false;
        pause_.stop();
        if (waiting_.empty()) return;
        // When the document has its new state.
        QTimer::singleShot(0, this, [this] {
            for (const auto& [direction, is_large] : std::exchange(waiting_, {})) step(direction, is_large);
        });
    });
}

bool Nudge::eventFilter(QObject*, QEvent* event) {
    switch (event->type()) {
        case QEvent::KeyPress: {
            const auto* key = static_cast<QKeyEvent*>(event);
            if (is_mine_ && key->key() == Qt::Key_Escape) {
                waiting_.clear();
                context_.drag.cancel();
                return true;
            }
            const Qt::KeyboardModifiers held = key->modifiers() & ~Qt::KeypadModifier;
            const QPoint direction = arrow(key->key());
            if (direction.isNull()) return false;
            if (held != Qt::AltModifier && held != (Qt::AltModifier | Qt::ShiftModifier)) return false;
            step(direction, held.testFlag(Qt::ShiftModifier));
            return true;
        }
        case QEvent::KeyRelease:
            if (static_cast<QKeyEvent*>(event)->key() == Qt::Key_Alt) end();
            return false;
        case QEvent::FocusOut:
            end();
            return false;
        default:
            return false;
    }
}

Eigen::RowVector3d Nudge::middle_of(const IndexSet& nodes) const {
    const Coordinates& x = context_.document().state().mesh->coordinates();
    Eigen::RowVector3d low = x.row(nodes.front()), high = low;
    for (const Index node : nodes) {
        low = low.cwiseMin(x.row(node));
        high = high.cwiseMax(x.row(node));
    }
    return 0.5 * (low + high);
}

Eigen::Vector3d Nudge::shift_of(QPoint direction, bool is_large, const Eigen::RowVector3d& middle) const {
    const SnapSettings& snap = context_.edit.settings().snap;
    const Eigen::Matrix3d axes = context_.canvas.view_axes();
    Eigen::Vector3d along = axes * Eigen::Vector3d(direction.x(), direction.y(), 0.0);
    double length = step_pixels * context_.canvas.units_per_pixel(middle);
    if (snap.target == SnapTarget::grid && snap.grid_spacing > 0.0) {
        // From grid point to grid point: along the axis that comes closest.
        Eigen::Index axis = 0;
        along.cwiseAbs().maxCoeff(&axis);
        along = std::copysign(1.0, along[axis]) * Eigen::Vector3d::Unit(axis);
        length = snap.grid_spacing;
    }
    if (context_.canvas.is_flat()) along[2] = 0.0;
    return (is_large ? 10.0 : 1.0) * length * along;
}

void Nudge::step(QPoint direction, bool is_large) {
    if (!context_.document().has_mesh()) return;
    if (is_mine_ && is_ending_) {
        waiting_.emplace_back(direction, is_large);
        return;
    }
    if (!is_mine_) {
        if (context_.drag.is_active()) return;
        if (!context_.drag.can_begin()) {
            emit refused(tr("A job works on the mesh: stop it first, or wait."));
            return;
        }
        const IndexSet nodes = without(context_.edit.nodes(), context_.edit.pins());
        if (nodes.empty()) {
            emit refused(context_.edit.nodes().empty()
                             ? tr("Alt and an arrow key nudge selected nodes: select some first.")
                             : tr("All selected nodes are pinned: free them to nudge them."));
            return;
        }
        from_ = middle_of(nodes);
        shift_.setZero();
        is_mine_ = true;
        const auto count = static_cast<long long>(nodes.size());
        context_.drag.begin({context_.edit.dragged(nodes), ResponseKind::translation, from_.transpose(),
                             count == 1 ? tr("Nudge 1 node") : tr("Nudge %1 nodes").arg(format_count(count))});
        if (!is_mine_) return;  // it failed at once
    }
    shift_ += shift_of(direction, is_large, from_);
    context_.drag.move(AffineMotion::translation(shift_));
    pause_.start();
    emit moved_to(context_.canvas.to_display(from_ + shift_.transpose()));
}

void Nudge::end() {
    if (!is_mine_ || is_ending_) return;
    is_ending_ = true;
    pause_.stop();
    context_.drag.finish();
}

}  // namespace curvewright
