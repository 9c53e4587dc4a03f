#pragma once

#include <QApplication>
#include <QMouseEvent>
#include <QWheelEvent>

#include "core/warp/warp.h"
#include "tests/gui/gui_test_support.h"
#include "ui/main_window/mesh_view.h"

namespace curvewright::testing {

/// A window with a mesh and the drag tool, and a hand on the mouse.
struct DragUnderTest : WindowUnderTest {
    explicit DragUnderTest(const char* mesh = "square.msh", bool is_soft = false) {
        open(inputs.path(QLatin1String(mesh)));
        EditSettings settings = window->edit().settings();
        settings.unit = GrabUnit::node;
        settings.is_soft = is_soft;
        settings.direction = DragDirection::view_plane;
        window->edit().set_settings(settings);
        window->action(CommandId::tool_drag)->trigger();
        QTest::qWait(50);  // a first frame
    }

    MeshView& view() { return window->view(); }
    LiveDrag& drag() { return window->drag(); }
    MeshDocument& document() { return window->document(); }
    const MeshTopology& topology() { return document().state().mesh->topology(); }
    Coordinates positions() { return document().state().mesh->coordinates(); }

    Index node_at(double x, double y, double z = 0.0) {
        const Coordinates& at = document().state().mesh->coordinates();
        Eigen::Index best = 0;
        (at.rowwise() - Eigen::RowVector3d(x, y, z)).rowwise().norm().minCoeff(&best);
        if ((at.row(best) - Eigen::RowVector3d(x, y, z)).norm() > 1e-9) qFatal("There is no node at that place.");
        return static_cast<Index>(best);
    }
    QPoint place_of(Index node) { return view().to_display(positions().row(node)).toPoint(); }

    void point_at(QPoint at) {
        QTest::mouseMove(&view(), at + QPoint(40, 40));
        QTest::mouseMove(&view(), at);
        QTest::qWait(1);
    }
    /// Takes hold of a node and waits until the mesh would follow.
    void take(Index node, Qt::KeyboardModifiers modifiers = {}) {
        const QPoint at = place_of(node);
        point_at(at);
        QTest::mousePress(&view(), Qt::LeftButton, modifiers, at);
        if (!QTest::qWaitFor([this] { return drag().is_live(); }, 20000)) qFatal("The drag did not come to life.");
        mouse = at;
    }
    /// In some steps, as a hand does; waits for the last frame.
    void move_by(QPoint way, Qt::KeyboardModifiers modifiers = {}) {
        for (int step = 1; step <= 4; ++step) {
            QMouseEvent event(QEvent::MouseMove, mouse + way * step / 4, view().mapToGlobal(mouse + way * step / 4),
                              Qt::NoButton, Qt::LeftButton, modifiers);
            QApplication::sendEvent(&view(), &event);
            QTest::qWait(5);
        }
        mouse += way;
        QTest::qWait(30);
    }
    void let_go() {
        QTest::mouseRelease(&view(), Qt::LeftButton, {}, mouse);
        if (!QTest::qWaitFor([this] { return !drag().is_active(); }, 20000)) qFatal("The drag did not end.");
    }
    void drag_node(Index node, QPoint way) {
        take(node);
        move_by(way);
        let_go();
    }
    void turn_wheel(int notches, Qt::KeyboardModifiers modifiers = {}) {
        QWheelEvent event(mouse, view().mapToGlobal(mouse), {}, {0, 120 * notches}, Qt::LeftButton, modifiers,
                          Qt::NoScrollPhase, false);
        QApplication::sendEvent(&view(), &event);
    }
    double unit() { return view().units_per_pixel(positions().row(0)); }
    /// What a warp makes of the present boundary.
    double distance_from_warp() {
        const CurvedMesh& opened = *document().original().mesh;
        return (Warper(opened).move(positions()).coordinates - positions()).cwiseAbs().maxCoeff();
    }

    QPoint mouse;
};

}  // namespace curvewright::testing
