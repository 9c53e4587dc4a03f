/// The boundary in hand: real mouse events in the view, and what becomes of the mesh, the panels and the history.

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QMenu>
#include <QOpenGLWidget>
#include <QSettings>
#include <QSignalSpy>
#include <QTreeWidget>
#include <QWheelEvent>

#include "core/session/replay.h"
#include "core/warp/warp.h"
#include "tests/gui/drag_under_test.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/histogram_widget.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

/// But for sides that are cut finer in one of them.
bool is_alike(const QImage& a, const QImage& b, double most_differing = 0.0005) {
    if (a.size() != b.size() || a.isNull()) return false;
    int differing = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
            const int distance =
                std::abs(qRed(p) - qRed(q)) + std::abs(qGreen(p) - qGreen(q)) + std::abs(qBlue(p) - qBlue(q));
            differing += distance > 60;
        }
    return differing < most_differing * a.width() * a.height();
}

}  // namespace

class DragTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void a_node_follows_the_mouse_and_the_mesh_follows_the_node() {
        DragUnderTest test;
        const Index node = test.node_at(0.5, 0.0);
        const Coordinates opened = test.positions();
        QSignalSpy frames(&test.drag(), &LiveDrag::frame);
        test.take(node);
        QVERIFY(!test.find<QWidget>("pointer_tag")->isVisible());
        const double unit = test.unit();
        test.move_by({12, -16});
        QVERIFY(frames.count() > 0);
        // Nothing has happened to the document yet; the panels and the pointer's tag show what would.
        QCOMPARE(test.positions(), opened);
        QVERIFY(test.find<QWidget>("pointer_tag")->isVisible());
        const QString minimum = test.text("pointer_minimum");
        QVERIFY(minimum.startsWith(QStringLiteral("min 0.")));
        QVERIFY(test.text("after_figures").startsWith(minimum));
        QVERIFY(test.text("mesh_minimum").endsWith(minimum.mid(4)));
        auto* worst = test.find<QTreeWidget>("worst_elements");
        QCOMPARE(worst->topLevelItem(0)->text(1), minimum.mid(4));
        const QString worst_live = worst->topLevelItem(0)->text(0);
        QCOMPARE(test.text("pointer_validity"), QStringLiteral("✓ all proved valid"));
        test.let_go();
        QVERIFY(!test.find<QWidget>("pointer_tag")->isVisible());

        const Coordinates moved = test.positions();
        QVERIFY(std::abs(moved(node, 0) - 0.5 - 12 * unit) < 1.5 * unit);
        QVERIFY(std::abs(moved(node, 1) - 16 * unit) < 1.5 * unit);
        QCOMPARE(moved(node, 2), 0.0);
        for (const Index other : test.topology().boundary_nodes())
            if (other != node) QCOMPARE(moved.row(other), opened.row(other));
        QVERIFY(test.distance_from_warp() < 1e-10);
        QVERIFY((moved - opened).rowwise().norm().minCoeff() == 0.0);
        const QualityReport fresh = assess_quality(*test.document().state().mesh);
        QCOMPARE(test.document().state().quality->summary.min, fresh.summary.min);
        QVERIFY(test.text("after_figures").startsWith(minimum));
        QCOMPARE(worst->topLevelItem(0)->text(0), worst_live);
        for (int row = 0; row < 10; ++row)
            QCOMPARE(worst->topLevelItem(row)->text(0),
                     QString::number(test.topology().element_tag(fresh.worst(10)[std::size_t(row)]).value));

        // One step of the history, with a name; undo is exact.
        QUndoStack& history = *test.document().history();
        QCOMPARE(history.count(), 1);
        QCOMPARE(history.text(0), QStringLiteral("Drag node %1").arg(test.topology().node_tag(node).value));
        QVERIFY(test.window->isWindowModified());
        test.click("tool_undo");
        QCOMPARE(test.positions(), opened);
        QVERIFY(!test.window->isWindowModified());
        test.click("tool_redo");
        QCOMPARE(test.positions(), moved);
    }

    void escape_puts_everything_back() {
        DragUnderTest test;
        const Coordinates opened = test.positions();
        const QString before = test.text("after_figures");
        auto* worst = test.find<QTreeWidget>("worst_elements");
        const auto rows = [worst] {
            QStringList list;
            for (int row = 0; row < worst->topLevelItemCount(); ++row)
                list << worst->topLevelItem(row)->text(0) + worst->topLevelItem(row)->text(1);
            return list;
        };
        const QStringList rows_before = rows();
        const QImage untouched = test.view().picture(1);
        test.take(test.node_at(0.5, 0.0));
        test.move_by({0, -60});
        QVERIFY(test.text("after_figures") != before);
        QVERIFY(rows() != rows_before);
        QTest::keyClick(&test.view(), Qt::Key_Escape);
        QVERIFY(!test.drag().is_active());
        QCOMPARE(test.text("after_figures"), before);
        QCOMPARE(rows(), rows_before);
        QVERIFY(test.text("mesh_minimum").endsWith(QStringLiteral("1.00")));
        QCOMPARE(test.positions(), opened);
        QCOMPARE(test.document().history()->count(), 0);
        QVERIFY(!test.window->isWindowModified());
        // The rest of the way to the release does nothing.
        test.move_by({0, -10});
        QTest::mouseRelease(&test.view(), Qt::LeftButton, {}, test.mouse);
        QCOMPARE(test.document().history()->count(), 0);
        test.point_at({5, 5});
        QVERIFY(is_alike(test.view().picture(1), untouched));
    }

    void the_tag_leaves_the_legend_free() {
        DragUnderTest test;
        test.window->resize(1280, 800);
        for (const bool is_split : {false, true}) {
            test.window->action(CommandId::compare)->setChecked(is_split);
            QTest::qWait(100);
            test.take(test.node_at(1.0, 0.5));
            auto* tag = test.window->findChild<QWidget*>(QStringLiteral("pointer_tag"));
            const int right = test.view().free_area().toRect().right();
            // Into the legend, from the top to the bottom.
            test.move_by({test.view().width() - 30 - test.mouse.x(), 20 - test.mouse.y()});
            for (int step = 0; step < 5; ++step) {
                QVERIFY(test.mouse.x() > right);
                QVERIFY(tag->isVisible());
                QVERIFY2(tag->geometry().right() <= right,
                         qPrintable(QStringLiteral("%1 %2").arg(tag->geometry().right()).arg(right)));
                QVERIFY(test.view().rect().contains(tag->geometry()));
                QVERIFY(!tag->geometry().contains(test.mouse));
                test.move_by({0, test.view().height() / 5 - 5});
            }
            QTest::keyClick(&test.view(), Qt::Key_Escape);
            QTest::mouseRelease(&test.view(), Qt::LeftButton, {}, test.mouse);
        }
    }

    void frames_drawn_behind_are_the_same_frames() {
        QImage pictures[2];
        Coordinates ends[2];
        for (const DrawingMode mode : {DrawingMode::at_once, DrawingMode::behind}) {
            const int i = mode == DrawingMode::behind;
            DragUnderTest test;
            test.view().set_drawing_mode(mode);
            QSignalSpy begun(&test.view(), &MeshView::frame_begun), drawn(&test.view(), &MeshView::frame_drawn);
            test.take(test.node_at(0.5, 0.0));
            test.move_by({8, -24});
            QVERIFY(QTest::qWaitFor([&] { return drawn.count() > 0; }));
            QCOMPARE(begun.count() > 0, mode == DrawingMode::behind);
            test.let_go();
            ends[i] = test.positions();
            // The view's size changes while a frame may be under way.
            test.window->resize(test.window->size() + QSize(40, 0));
            test.window->resize(test.window->size() - QSize(40, 0));
            test.point_at({5, 5});
            QTest::qWait(100);
            // Views are fitted anew by as many changes of their size as they have drawn.
            test.window->action(CommandId::fit)->trigger();
            QTest::qWait(100);
            pictures[i] = test.view().grabFramebuffer();
            // The camera is drawn from anew; nothing is held back for good.
            const Eigen::RowVector3d middle(0.5, 0.5, 0.0);
            const QPointF before = test.view().to_display(middle);
            drawn.clear();
            QTest::mousePress(&test.view(), Qt::RightButton, {}, QPoint(100, 100));
            for (int step = 1; step <= 5; ++step) QTest::mouseMove(&test.view(), QPoint(100 + 10 * step, 100));
            QTest::mouseRelease(&test.view(), Qt::RightButton, {}, QPoint(150, 100));
            QVERIFY(std::abs(test.view().to_display(middle).x() - before.x() - 50.0) < 2.0);
            QVERIFY(drawn.count() > 0 || drawn.wait(2000));
            test.click("tool_undo");
            QVERIFY(QTest::qWaitFor([&] { return !test.view().has_frame_under_way(); }));
        }
        QCOMPARE(ends[0], ends[1]);
        QVERIFY(is_alike(pictures[0], pictures[1]));
    }

    void a_press_without_a_move_is_no_step() {
        DragUnderTest test;
        test.take(test.node_at(0.5, 0.0));
        test.let_go();
        QCOMPARE(test.document().history()->count(), 0);
    }

    void the_first_tangled_element_is_told_at_once() {
        DragUnderTest test;
        const Index node = test.node_at(0.5, 0.0);
        test.take(node);
        const int far = static_cast<int>(0.3 / test.unit());
        test.move_by({0, -far});
        QVERIFY2(test.text("pointer_validity").contains(QStringLiteral("tangled, worst: element")),
                 qPrintable(test.text("pointer_validity")));
        QVERIFY(test.text("verdict").contains(QStringLiteral("tangled")));
        QVERIFY(test.find<HistogramWidget>("after_histogram")->bars().tangled.count() > 0);
        const QImage live = test.view().picture(1);
        test.let_go();
        const QualitySummary summary = test.document().state().quality->summary;
        QVERIFY(summary.invalid > 0);
        QCOMPARE(test.find<HistogramWidget>("after_histogram")->bars().tangled.count(), summary.invalid);
        // What was seen in hand is what is there.
        test.point_at({5, 5});
        const QImage kept = test.view().picture(1);
        // But for the mark of the node in hand and of where it was.
        QVERIFY(is_alike(kept, live, 0.01));
    }

    void neighbours_are_taken_along_within_the_radius() {
        DragUnderTest test("square.msh", true);
        EditSettings settings = test.window->edit().settings();
        settings.soft.radius = 0.3;
        settings.soft.falloff = Falloff::linear;
        test.window->edit().set_settings(settings);
        const Index node = test.node_at(0.5, 0.0);
        const Coordinates opened = test.positions();
        test.take(node);
        test.turn_wheel(2);
        const double radius = test.window->edit().settings().soft.radius;
        QVERIFY(std::abs(radius - 0.3 * 1.12 * 1.12) < 1e-9);
        QVERIFY(QTest::qWaitFor([&] { return test.drag().is_live(); }, 20000));
        test.move_by({0, -20});
        test.let_go();
        const Eigen::RowVector3d way = test.positions().row(node) - opened.row(node);
        QVERIFY(way.norm() > 0.0);
        int along = 0;
        for (const Index other : test.topology().boundary_nodes()) {
            const double distance = opened(other, 1) == 0.0 ? std::abs(opened(other, 0) - 0.5) : 1.0;
            const double share = std::max(0.0, 1.0 - distance / radius);
            const Eigen::RowVector3d moved = test.positions().row(other) - opened.row(other);
            QVERIFY((moved - share * way).norm() < 1e-12);
            along += share > 0.0;
        }
        QVERIFY(along > 4);
    }

    void a_side_and_a_whole_boundary_can_be_taken() {
        DragUnderTest test;
        EditSettings settings = test.window->edit().settings();
        settings.unit = GrabUnit::side;
        test.window->edit().set_settings(settings);
        const Coordinates opened = test.positions();
        test.drag_node(test.node_at(0.5, 0.0), {0, 24});
        const auto bottom = test.topology().find_group_nodes("bottom").value();
        const Eigen::RowVector3d way = test.positions().row(bottom.front()) - opened.row(bottom.front());
        QVERIFY(way[1] < 0.0);
        for (const Index node : test.topology().boundary_nodes()) {
            const bool is_bottom = std::binary_search(bottom.begin(), bottom.end(), node);
            const Eigen::RowVector3d moved = test.positions().row(node) - opened.row(node);
            QVERIFY((moved - (is_bottom ? way : Eigen::RowVector3d::Zero().eval())).norm() < 1e-12);
        }
        QCOMPARE(test.document().history()->text(0), QStringLiteral("Drag a side"));

        settings.unit = GrabUnit::boundary;
        test.window->edit().set_settings(settings);
        const Coordinates before = test.positions();
        test.drag_node(test.topology().boundary_nodes().front(), {30, 0});
        const Eigen::RowVector3d all = test.positions().row(0) - before.row(0);
        QVERIFY(all[0] > 0.0);
        // Everything hangs on the boundary.
        QVERIFY(((test.positions() - before).rowwise() - all).cwiseAbs().maxCoeff() < 1e-10);
        QCOMPARE(test.document().history()->text(1), QStringLiteral("Drag a boundary"));
    }

    void a_selection_moves_as_one_and_pins_stay() {
        DragUnderTest test;
        const Index a = test.node_at(0.5, 0.0), b = test.node_at(1.0, 0.5), c = test.node_at(0.0, 0.5);
        IndexSet selected{a, b, c};
        std::sort(selected.begin(), selected.end());
        test.window->edit().select_nodes(selected);
        test.window->edit().set_pins({c});
        const Coordinates opened = test.positions();
        test.drag_node(a, {-10, 6});
        const Eigen::RowVector3d way = test.positions().row(a) - opened.row(a);
        QVERIFY(way.norm() > 0.0);
        QVERIFY((test.positions().row(b) - opened.row(b) - way).norm() < 1e-12);
        QCOMPARE(test.positions().row(c), opened.row(c));
        QCOMPARE(test.document().history()->text(0), QStringLiteral("Drag 2 selected nodes"));
        // A pinned node cannot be taken.
        const QPoint at = test.place_of(c);
        test.point_at(at);
        QVERIFY(test.text("hint").contains(QStringLiteral("pinned")));
        QTest::mousePress(&test.view(), Qt::LeftButton, {}, at);
        QVERIFY(!test.drag().is_active());
        QTest::mouseRelease(&test.view(), Qt::LeftButton, {}, at);
        QCOMPARE(test.document().history()->count(), 1);
    }

    void interior_nodes_can_be_pinned_and_dragged() {
        DragUnderTest test;
        const Index inside = test.node_at(0.5, 0.5), pinned = test.node_at(0.25, 0.25);
        const Index beside = test.node_at(0.5 + 1.0 / 12.0, 0.5);
        test.window->edit().select_nodes({inside});
        test.window->edit().set_pins({pinned});
        const Coordinates opened = test.positions();
        test.drag_node(inside, {9, 9});
        QVERIFY((test.positions().row(inside) - opened.row(inside)).norm() > 0.0);
        QCOMPARE(test.positions().row(pinned), opened.row(pinned));
        for (const Index node : test.topology().boundary_nodes())
            QCOMPARE(test.positions().row(node), opened.row(node));
        // Its neighbours follow.
        QVERIFY((test.positions().row(beside) - opened.row(beside)).norm() > 0.0);
    }

    void keys_keep_to_a_direction() {
        DragUnderTest test;
        const Index node = test.node_at(1.0, 0.5);
        const Coordinates opened = test.positions();
        const bool shows_nodes = test.window->action(CommandId::nodes)->isChecked();
        test.take(node);
        test.move_by({-20, -12});
        QTest::keyClick(&test.view(), Qt::Key_Y);
        test.move_by({-4, -4});
        QTest::qWait(20);
        test.let_go();
        QCOMPARE(test.positions()(node, 0), 1.0);
        QVERIFY(test.positions()(node, 1) > opened(node, 1));
        // N is the normal while something is in hand, not the shortcut of the nodes.
        test.click("tool_undo");
        test.take(node);
        QTest::keyClick(&test.view(), Qt::Key_N);
        test.move_by({-20, -12});
        test.let_go();
        QVERIFY(test.positions()(node, 0) < 1.0);
        QCOMPARE(test.positions()(node, 1), opened(node, 1));
        QCOMPARE(test.window->action(CommandId::nodes)->isChecked(), shows_nodes);
        // Shift is the normal too.
        test.click("tool_undo");
        test.take(node, Qt::ShiftModifier);
        test.move_by({20, -12}, Qt::ShiftModifier);
        QTest::mouseRelease(&test.view(), Qt::LeftButton, Qt::ShiftModifier, test.mouse);
        QVERIFY(QTest::qWaitFor([&] { return !test.drag().is_active(); }, 20000));
        QVERIFY(test.positions()(node, 0) > 1.0);
        QCOMPARE(test.positions()(node, 1), opened(node, 1));
    }

    void the_node_in_hand_snaps() {
        DragUnderTest test;
        EditSettings settings = test.window->edit().settings();
        settings.snap.target = SnapTarget::grid;
        settings.snap.grid_spacing = 0.05;
        test.window->edit().set_settings(settings);
        const Index node = test.node_at(0.5, 0.0);
        test.drag_node(node, {static_cast<int>(0.093 / test.unit()), -static_cast<int>(0.06 / test.unit())});
        QVERIFY(std::abs(test.positions()(node, 0) - 0.6) < 1e-12);
        QVERIFY(std::abs(test.positions()(node, 1) - 0.05) < 1e-12);

        settings.snap.target = SnapTarget::circle;
        settings.snap.center = {0.5, 0.5, 0.0};
        settings.snap.radius = 0.55;
        test.window->edit().set_settings(settings);
        const Index other = test.node_at(1.0, 0.5);
        test.drag_node(other, {10, -10});
        QVERIFY(std::abs((test.positions().row(other) - Eigen::RowVector3d(0.5, 0.5, 0.0)).norm() - 0.55) < 1e-12);
        QVERIFY(test.positions()(other, 1) > 0.5);
    }

    void beside_the_boundary_the_mouse_moves_the_view() {
        DragUnderTest test;
        const Index inside = test.node_at(0.5, 0.5);
        const QPoint at = test.place_of(inside);
        const Coordinates opened = test.positions();
        test.point_at(at);
        QTest::mousePress(&test.view(), Qt::LeftButton, {}, at);
        test.mouse = at;
        test.move_by({40, 25});
        QTest::mouseRelease(&test.view(), Qt::LeftButton, {}, test.mouse);
        QVERIFY((test.place_of(inside) - at - QPoint(40, 25)).manhattanLength() <= 2);
        QCOMPARE(test.positions(), opened);
        QCOMPARE(test.document().history()->count(), 0);
    }

    void a_hand_that_is_quicker_than_the_weights_gets_the_same() {
        DragUnderTest test;
        const Index node = test.node_at(0.5, 0.0);
        test.drag_node(node, {8, -12});
        const Coordinates slow = test.positions();
        test.click("tool_undo");
        const QPoint at = test.place_of(node);
        test.point_at(at);
        QTest::mousePress(&test.view(), Qt::LeftButton, {}, at);
        QMouseEvent move(QEvent::MouseMove, at + QPoint(8, -12), test.view().mapToGlobal(at + QPoint(8, -12)),
                         Qt::NoButton, Qt::LeftButton, {});
        QApplication::sendEvent(&test.view(), &move);
        QMouseEvent release(QEvent::MouseButtonRelease, at + QPoint(8, -12),
                            test.view().mapToGlobal(at + QPoint(8, -12)), Qt::LeftButton, Qt::NoButton, {});
        QApplication::sendEvent(&test.view(), &release);
        QVERIFY(QTest::qWaitFor([&] { return !test.drag().is_active(); }, 20000));
        QVERIFY((test.positions() - slow).cwiseAbs().maxCoeff() < 1e-12);
    }

    void a_drag_that_begins_at_a_dragged_mesh_goes_back_exactly() {
        DragUnderTest test;
        const Index node = test.node_at(0.5, 0.0);
        const Coordinates opened = test.positions();
        test.drag_node(node, {10, -14});
        test.drag_node(node, {-10, 14});
        // There and back: the response is linear in the displacement from the mesh as opened.
        QVERIFY((test.positions() - opened).cwiseAbs().maxCoeff() < 1.5 * test.unit());
        QCOMPARE(test.document().history()->count(), 2);
        QVERIFY(test.distance_from_warp() < 1e-10);
    }

    void solids_are_turned_until_the_tool_is_chosen() {
        WindowUnderTest window;
        window.open(window.inputs.path(QStringLiteral("cube.msh")));
        QVERIFY(window.window->action(CommandId::tool_look)->isChecked());
        window.open(window.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(window.window->action(CommandId::tool_drag)->isChecked());
    }

    void a_node_of_a_solid_moves_along_an_axis() {
        DragUnderTest test("cube.msh");
        // The corner that looks at the eye.
        Index nearest = 0;
        const Eigen::Vector3d eye = test.view().view_axes().col(2);
        for (const Index node : test.topology().boundary_nodes())
            if (test.positions().row(node).dot(eye) > test.positions().row(nearest).dot(eye)) nearest = node;
        const Coordinates opened = test.positions();
        test.take(nearest);
        QTest::keyClick(&test.view(), Qt::Key_Z);
        const QPointF up = test.view().to_display(opened.row(nearest) + Eigen::RowVector3d(0.0, 0.0, 0.1)) -
                           test.view().to_display(opened.row(nearest));
        test.move_by(up.toPoint());
        test.let_go();
        const Eigen::RowVector3d way = test.positions().row(nearest) - opened.row(nearest);
        QCOMPARE(way[0], 0.0);
        QCOMPARE(way[1], 0.0);
        QVERIFY(std::abs(way[2] - 0.1) < 0.02);
        for (const Index node : test.topology().boundary_nodes())
            if (node != nearest) QCOMPARE(test.positions().row(node), opened.row(node));
        QVERIFY(test.distance_from_warp() < 1e-10);
    }

    void the_rest_of_the_boundary_slides_where_it_is_told_to() {
        DragUnderTest test;
        EditSettings settings = test.window->edit().settings();
        settings.unit = GrabUnit::side;
        test.window->edit().set_settings(settings);
        test.window->show_tab(QStringLiteral("edit"));
        auto* rest = test.find<QComboBox>("other_boundary");
        rest->setCurrentIndex(rest->findText(QStringLiteral("By group")));
        auto* groups = test.find<QTreeWidget>("other_boundary_groups");
        QVERIFY(groups->isVisible());
        for (int row = 0; row < groups->topLevelItemCount(); ++row) {
            QTreeWidgetItem* item = groups->topLevelItem(row);
            if (item->text(0) == QLatin1String("top")) choose_in_row(groups, item, QStringLiteral("Slides"));
            if (item->text(0) == QLatin1String("bottom")) {
                // Without a mouse.
                groups->setFocus();
                groups->setCurrentItem(item);
                QTest::keyClick(groups, Qt::Key_Space);
                auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
                QVERIFY(menu);
                QCOMPARE(menu->activeAction()->text(), QStringLiteral("Stays"));
                QTest::keyClick(menu, Qt::Key_Down);
                QTest::keyClick(menu, Qt::Key_Return);
                QCOMPARE(item->text(1), QStringLiteral("Slides"));
            }
        }
        const Coordinates opened = test.positions();
        test.take(test.node_at(1.0, 0.5));
        QTest::keyClick(&test.view(), Qt::Key_X);
        test.move_by({20, 0});
        test.let_go();
        // The side goes, the sides beside it let the pull through, and all of the square is stretched.
        const double way = test.positions()(test.node_at(0.0, 0.0), 0) + test.positions().col(0).maxCoeff() - 1.0;
        QVERIFY(way > 10 * test.unit());
        for (Index node = 0; node < opened.rows(); ++node) {
            QVERIFY(std::abs(test.positions()(node, 0) - (1.0 + way) * opened(node, 0)) < 1e-9);
            QVERIFY(std::abs(test.positions()(node, 1) - opened(node, 1)) < 1e-9);
        }
        QCOMPARE(test.document().history()->count(), 1);
        // What the session says does the same.
        Replay replay;
        for (const Action& action : test.document().session()) replay.perform(action);
        QCOMPARE(replay.mesh().coordinates(), test.positions());
        test.click("tool_undo");
        QCOMPARE(test.positions(), opened);
    }

    void the_interior_is_solved_for_anew_when_asked() {
        DragUnderTest test;
        const Index node = test.node_at(0.5, 0.0);
        test.drag_node(node, {30, -40});
        const CurvedMesh start = *test.document().state().mesh;
        test.window->show_tab(QStringLiteral("edit"));
        test.find<QCheckBox>("solves_anew")->click();
        test.drag_node(node, {-20, -10});
        const Coordinates moved = test.positions();
        const Coordinates wanted = Warper(start).move(moved).coordinates;
        QVERIFY((moved - wanted).cwiseAbs().maxCoeff() < 1e-12);
        QVERIFY(test.distance_from_warp() > 1e-6);
        const QualityReport fresh = assess_quality(*test.document().state().mesh);
        QCOMPARE(test.document().state().quality->summary.min, fresh.summary.min);
        QCOMPARE(test.document().state().quality->summary.mean, fresh.summary.mean);
        Replay replay;
        for (const Action& action : test.document().session()) replay.perform(action);
        QCOMPARE(replay.mesh().coordinates(), moved);
        QCOMPARE(test.document().history()->count(), 2);
    }

    void meshes_without_quality_can_be_dragged() {
        DragUnderTest test("quad.msh");
        const Index corner = test.topology().boundary_nodes().front();
        const Coordinates opened = test.positions();
        test.drag_node(corner, {-12, 8});
        QVERIFY((test.positions().row(corner) - opened.row(corner)).norm() > 0.0);
        QCOMPARE(test.document().history()->count(), 1);
    }
};

QObject* make_test() {
    return new DragTest;
}

#include "drag_test.moc"
