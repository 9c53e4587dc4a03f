/// The window without a mouse.

#include <set>

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAction>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QSettings>
#include <QSignalSpy>
#include <QStatusBar>
#include <QTabWidget>
#include <QTreeWidget>
#include <QUndoView>
#include <QWindow>

#include "tests/gui/drag_under_test.h"
#include "ui/document/tag_query.h"
#include "ui/panels/histogram_widget.h"
#include "ui/panels/start_page.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

struct KeyboardUnderTest : DragUnderTest {
    using DragUnderTest::DragUnderTest;
    void press(int key, Qt::KeyboardModifiers modifiers = {}) {
        QTest::keyClick(&view(), static_cast<Qt::Key>(key), modifiers);
        QTest::qWait(20);
    }
    /// After the last nudge has become a step.
    void settle() {
        if (!QTest::qWaitFor([this] { return !drag().is_active(); }, 20000)) qFatal("The nudge did not end.");
        QTest::qWait(20);
    }
    QWidget* frame() { return view().findChild<QWidget*>(QStringLiteral("focus_frame")); }
};

bool takes_tab(const QWidget* widget) {
    return (widget->focusPolicy() & Qt::TabFocus) && widget->isVisible() && widget->isEnabled();
}

/// What Tab visits inside a widget, in its order.
QList<QWidget*> tab_order(QWidget* area) {
    QList<QWidget*> order;
    for (QWidget* widget = area->nextInFocusChain(); widget != area; widget = widget->nextInFocusChain())
        if (area->isAncestorOf(widget) && takes_tab(widget) && !widget->focusProxy()) order << widget;
    return order;
}

}  // namespace

class KeyboardTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void arrows_move_a_flat_mesh_and_turn_a_solid() {
        KeyboardUnderTest flat;
        const Eigen::RowVector3d point(0.5, 0.5, 0.0);
        QPointF before = flat.view().to_display(point);
        // Going right brings what is on the right: the mesh comes to the left.
        flat.press(Qt::Key_Right);
        QVERIFY(flat.view().to_display(point).x() < before.x() - 20);
        flat.press(Qt::Key_Left);
        QVERIFY(std::abs(flat.view().to_display(point).x() - before.x()) < 1.0);
        flat.press(Qt::Key_Up, Qt::ShiftModifier);
        QVERIFY(flat.view().to_display(point).y() > before.y() + 20);

        KeyboardUnderTest solid("cube.msh");
        const Eigen::RowVector3d center(0.5, 0.5, 0.5);
        const Eigen::Matrix3d axes = solid.view().view_axes();
        before = solid.view().to_display(center);
        solid.press(Qt::Key_Right, Qt::ShiftModifier);
        QVERIFY(solid.view().to_display(center).x() < before.x() - 20);
        QVERIFY((solid.view().view_axes() - axes).norm() < 1e-9);
        solid.press(Qt::Key_Right);
        QVERIFY((solid.view().view_axes() - axes).norm() > 0.05);
        solid.press(Qt::Key_Left);
        QVERIFY((solid.view().view_axes() - axes).norm() < 1e-6);
    }

    void page_keys_and_commands_zoom() {
        KeyboardUnderTest test;
        const double unit = test.unit();
        test.press(Qt::Key_PageUp);
        QVERIFY(test.unit() < 0.9 * unit);
        test.press(Qt::Key_PageDown);
        QVERIFY(std::abs(test.unit() / unit - 1.0) < 1e-6);
        test.press(Qt::Key_Plus, Qt::ControlModifier);
        QVERIFY(test.unit() < 0.9 * unit);
        test.press(Qt::Key_Minus, Qt::ControlModifier);
        QVERIFY(std::abs(test.unit() / unit - 1.0) < 1e-6);
    }

    void alt_and_arrows_nudge_what_is_selected() {
        KeyboardUnderTest test;
        const Index node = test.node_at(0.5, 0.0), interior = test.node_at(0.5, 0.5);
        const Coordinates opened = test.positions();
        QSignalSpy frames(&test.drag(), &LiveDrag::frame);
        test.window->edit().select_nodes({node});
        const double unit = test.unit();
        test.press(Qt::Key_Up, Qt::AltModifier);
        test.settle();
        QVERIFY(frames.count() > 0);
        QCOMPARE(test.document().history()->count(), 1);
        QCOMPARE(test.document().history()->text(0), QStringLiteral("Nudge 1 node"));
        const Coordinates nudged = test.positions();
        QVERIFY(std::abs(nudged(node, 1) - 8.0 * unit) < 1e-9 && std::abs(nudged(node, 0) - 0.5) < 1e-12);
        QVERIFY(test.distance_from_warp() < 1e-9);
        QVERIFY((nudged.row(interior) - opened.row(interior)).norm() > 0.0);
        test.window->action(CommandId::undo)->trigger();
        QCOMPARE(test.positions(), opened);
        // Ten times as far, and to the other side.
        test.press(Qt::Key_Left, Qt::AltModifier | Qt::ShiftModifier);
        test.settle();
        QVERIFY(std::abs(test.positions()(node, 0) - (0.5 - 80.0 * unit)) < 1e-9);
        test.window->action(CommandId::undo)->trigger();
    }

    void nothing_is_nudged_or_moved_while_a_job_works() {
        KeyboardUnderTest test;
        test.window->edit().select_nodes({test.node_at(0.5, 0.0)});
        test.window->show_tab(QStringLiteral("edit"));
        QVERIFY(test.find<QPushButton>("apply_motion")->isEnabled());
        test.drag().set_allowed(false);  // what a running job does
        QVERIFY(!test.find<QPushButton>("apply_motion")->isEnabled());
        test.press(Qt::Key_Up, Qt::AltModifier);
        QVERIFY(!test.drag().is_active());
        QCOMPARE(test.document().history()->count(), 0);
        test.drag().set_allowed(true);
        test.press(Qt::Key_Up, Qt::AltModifier);
        test.settle();
        QCOMPARE(test.document().history()->count(), 1);
        // A job does.
        test.window->jobs().load_deformation(test.inputs.path(QStringLiteral("gentle.json")));
        QVERIFY(test.drag().can_begin() != test.window->jobs().runner().is_running());
        QVERIFY(test.wait_for_job());
        QVERIFY(test.drag().can_begin());
    }

    void nudges_with_alt_held_are_one_step() {
        KeyboardUnderTest test;
        const Index node = test.node_at(0.5, 0.0);
        const Coordinates opened = test.positions();
        const double unit = test.unit();
        test.window->edit().select_nodes({node});
        const auto send = [&](QEvent::Type type, int key, Qt::KeyboardModifiers modifiers) {
            QKeyEvent event(type, key, modifiers);
            QApplication::sendEvent(&test.view(), &event);
        };
        for (int i = 0; i < 5; ++i) send(QEvent::KeyPress, Qt::Key_Up, Qt::AltModifier);
        QVERIFY(test.drag().is_active());
        QCOMPARE(test.document().history()->count(), 0);
        send(QEvent::KeyRelease, Qt::Key_Alt, {});
        // The next ones wait until these are a step.
        for (int i = 0; i < 2; ++i) send(QEvent::KeyPress, Qt::Key_Up, Qt::AltModifier);
        QTRY_COMPARE(test.document().history()->count(), 1);
        QVERIFY(std::abs(test.positions()(node, 1) - 40.0 * unit) < 1e-9);
        QTRY_VERIFY(test.drag().is_active());
        send(QEvent::KeyRelease, Qt::Key_Alt, {});
        test.settle();
        QCOMPARE(test.document().history()->count(), 2);
        QVERIFY(std::abs(test.positions()(node, 1) - 56.0 * unit) < 1e-9);
        // Escape puts back what is in hand and leaves the selection.
        send(QEvent::KeyPress, Qt::Key_Up, Qt::AltModifier);
        send(QEvent::KeyPress, Qt::Key_Escape, {});
        QVERIFY(!test.drag().is_active());
        QCOMPARE(test.document().history()->count(), 2);
        QCOMPARE(test.window->edit().nodes(), IndexSet{node});
        // There and back again is no step.
        send(QEvent::KeyPress, Qt::Key_Up, Qt::AltModifier);
        send(QEvent::KeyPress, Qt::Key_Down, Qt::AltModifier);
        send(QEvent::KeyRelease, Qt::Key_Alt, {});
        test.settle();
        QCOMPARE(test.document().history()->count(), 2);
    }

    void nudges_follow_the_grid_and_leave_pins() {
        KeyboardUnderTest test;
        EditSettings settings = test.window->edit().settings();
        settings.snap.target = SnapTarget::grid;
        settings.snap.grid_spacing = 0.05;
        test.window->edit().set_settings(settings);
        const Index node = test.node_at(0.5, 0.0);
        test.press(Qt::Key_Up, Qt::AltModifier);
        QVERIFY(test.window->statusBar()->currentMessage().contains(QStringLiteral("select some first")));
        test.window->edit().select_nodes({node});
        test.press(Qt::Key_Up, Qt::AltModifier);
        test.settle();
        QVERIFY(std::abs(test.positions()(node, 1) - 0.05) < 1e-12);
        test.window->edit().set_pins({node});
        test.press(Qt::Key_Up, Qt::AltModifier);
        QVERIFY(test.window->statusBar()->currentMessage().contains(QStringLiteral("pinned")));
        QVERIFY(!test.drag().is_active());
        QCOMPARE(test.document().history()->count(), 1);
    }

    void a_solid_is_nudged_in_the_plane_of_the_view() {
        KeyboardUnderTest test("cube.msh");
        const Index node = test.node_at(0.5, 0.5, 1.0);
        const Eigen::RowVector3d was = test.positions().row(node);
        test.window->edit().select_nodes({node});
        const Eigen::Matrix3d axes = test.view().view_axes();
        const double unit = test.view().units_per_pixel(was);
        test.press(Qt::Key_Right, Qt::AltModifier);
        test.settle();
        const Eigen::Vector3d way = (test.positions().row(node) - was).transpose();
        QVERIFY((way - 8.0 * unit * axes.col(0)).norm() < 1e-9);
    }

    void tags_are_understood() {
        const WindowUnderTest window;
        KeyboardUnderTest test;
        const MeshTopology& topology = test.topology();
        const auto find = [&](const char* text) { return find_tags(topology, QString::fromUtf8(text)); };
        const long long first = topology.node_tag(0).value, element = topology.element_tag(0).value;
        TagQuery query = find(qPrintable(QStringLiteral("%1, n%2 e%3").arg(first).arg(first + 1).arg(element)));
        QCOMPARE(query.nodes, (IndexSet{*topology.find_node(NodeTag{first}), *topology.find_node(NodeTag{first + 1})}));
        QCOMPARE(query.elements, (IndexSet{0}));
        QVERIFY(query.problem.isEmpty());
        query = find(
            qPrintable(QStringLiteral("E %1 - %2; %3–%4").arg(element).arg(element + 2).arg(first + 3).arg(first)));
        QCOMPARE(query.elements.size(), std::size_t(3));
        QCOMPARE(query.nodes.size(), std::size_t(4));
        QVERIFY2(query.problem.isEmpty(), qPrintable(query.problem));
        // What is missing is named, what is there is found.
        query = find(qPrintable(QStringLiteral("%1, 99999, e88888").arg(first)));
        QCOMPARE(query.nodes.size(), std::size_t(1));
        QCOMPARE(query.problem, QStringLiteral("There is no node 99999. There is no element 88888."));
        QCOMPARE(find("99998 99999").problem, QStringLiteral("There are no nodes 99998 and 99999."));
        QCOMPARE(find("99990-99999").problem, QStringLiteral("There are no nodes 99990–99999."));
        QVERIFY(find("1-999999999999").problem.isEmpty());
        QCOMPARE(static_cast<Index>(find("0-999999999999").nodes.size()), topology.node_count());
        QStringList many;
        for (int i = 0; i < 9; ++i) many << QString::number(90000 + i);
        QVERIFY(find(qPrintable(many.join(QLatin1Char(' ')))).problem.endsWith(QStringLiteral("90004 and 4 more.")));
        for (const char* nonsense : {"abc", "12x", "e", "-5", "1-2-3", "12.5", "99999999999999999999"}) {
            query = find(nonsense);
            QVERIFY2(query.problem.contains(QStringLiteral("is no tag")), nonsense);
        }
        QVERIFY(find(" , ; ").nodes.empty() && find("").problem.isEmpty());
    }

    void found_things_are_selected_and_flown_to() {
        KeyboardUnderTest test;
        const auto ask = [&](const QString& text) {
            QTest::keyClick(&test.view(), Qt::Key_F, Qt::ControlModifier);
            auto* tags = test.find<QLineEdit>("find_tags");
            QTest::keyClicks(tags, text);
            return tags;
        };
        const double unit = test.unit();
        const Index node = test.node_at(1.0, 1.0);
        QLineEdit* tags = ask(QString::number(test.topology().node_tag(node).value));
        QCOMPARE(test.text("find_answer"), QStringLiteral("Enter selects 1 node."));
        QTest::keyClick(tags, Qt::Key_Return);
        QCOMPARE(test.window->edit().nodes(), IndexSet{node});
        QTRY_VERIFY(test.unit() < 0.8 * unit);
        QTRY_VERIFY((test.view().to_display(test.positions().row(node)) - QPointF(test.view().rect().center()))
                        .manhattanLength() < 0.25 * test.view().width());
        QTRY_VERIFY(!test.window->findChild<QDialog*>(QStringLiteral("find_dialog")));
        // Enter on nothing keeps the question open, Escape gives it up.
        tags = ask(QStringLiteral("123456"));
        QCOMPARE(test.text("find_answer"), QStringLiteral("There is no node 123456."));
        QTest::keyClick(tags, Qt::Key_Return);
        QVERIFY(tags->isVisible());
        QCOMPARE(test.window->edit().nodes(), IndexSet{node});
        QTest::keyClick(tags, Qt::Key_Escape);
        QTRY_VERIFY(!test.window->findChild<QDialog*>(QStringLiteral("find_dialog")));
        tags = ask(QStringLiteral("e%1").arg(test.topology().element_tag(3).value));
        QTest::keyClick(tags, Qt::Key_Return);
        QCOMPARE(test.window->edit().elements(), IndexSet{3});
    }

    void the_view_is_reached_by_tab_and_shows_it() {
        KeyboardUnderTest test;
        QVERIFY(test.view().focusPolicy() & Qt::TabFocus);
        test.view().setFocus(Qt::MouseFocusReason);
        QVERIFY(!test.frame()->isVisible());
        test.find<QTreeWidget>("groups")->setFocus();
        test.view().setFocus(Qt::TabFocusReason);
        QVERIFY(test.frame()->isVisible());
        QCOMPARE(test.frame()->size(), test.view().size());
        QVERIFY(!test.frame()->mask().contains(test.frame()->rect().center()));
        QTest::keyClick(&test.view(), Qt::Key_Tab);
        QVERIFY(!test.view().hasFocus());
        QVERIFY(!test.frame()->isVisible());
    }

    void letters_typed_into_an_open_list_are_no_shortcuts() {
        KeyboardUnderTest test;
        test.window->show_tab(QStringLiteral("edit"));
        auto* box = test.find<QComboBox>("falloff");
        QAction* select = test.window->action(CommandId::tool_select);
        QAction* edges = test.window->action(CommandId::edges);
        const bool has_edges = edges->isChecked();
        QVERIFY(!select->isChecked());
        box->setCurrentIndex(0);
        box->setFocus();
        box->showPopup();
        QTRY_VERIFY(QApplication::activePopupWidget());
        // As a window manager has it: the keys go to the window, which passes them on to the list.
        QTest::keyClick(test.window->windowHandle(), Qt::Key_S);
        QVERIFY(!select->isChecked());
        QCOMPARE(box->view()->currentIndex().data().toString().left(1), QStringLiteral("S"));
        QTest::keyClick(test.window->windowHandle(), Qt::Key_E);
        QCOMPARE(edges->isChecked(), has_edges);
        QTest::keyClick(test.window->windowHandle(), Qt::Key_Escape);
        QTRY_VERIFY(!QApplication::activePopupWidget());
        QCOMPARE(box->currentIndex(), 0);
        // Closed, they are shortcuts again.
        QTest::keyClick(&test.view(), Qt::Key_S);
        QVERIFY(select->isChecked());
    }

    void one_key_goes_round_the_areas() {
        KeyboardUnderTest test;
        test.view().setFocus();
        const char* areas[] = {"groups", "operations_tabs", "worst_elements", "before_histogram", "mesh_view"};
        const auto is_in = [&](const char* name) {
            const QWidget* now = test.window->focusWidget();
            const auto* area = test.find<QWidget>(name);
            return now && (now == area || area->isAncestorOf(now) ||
                           (qstrcmp(name, "before_histogram") == 0 && now->objectName() == u"compare_with") ||
                           (qstrcmp(name, "worst_elements") == 0 && now->objectName() == u"worst_count"));
        };
        for (const char* area : areas) {
            QTest::keyClick(test.window->focusWidget(), Qt::Key_F6);
            QVERIFY2(is_in(area), qPrintable(test.window->focusWidget()->objectName()));
        }
        for (const char* area : {"before_histogram", "worst_elements", "operations_tabs", "groups", "mesh_view"}) {
            QTest::keyClick(test.window->focusWidget(), Qt::Key_F6, Qt::ShiftModifier);
            QVERIFY2(is_in(area), qPrintable(test.window->focusWidget()->objectName()));
        }
        // A panel that is put away is left out.
        test.window->action(CommandId::panel_mesh)->trigger();
        QTest::keyClick(test.window->focusWidget(), Qt::Key_F6);
        QVERIFY(is_in("operations_tabs"));
    }

    void tab_goes_down_every_panel() {
        KeyboardUnderTest test("cube.msh");
        const auto check = [](QWidget* area, const QString& name) {
            const QList<QWidget*> order = tab_order(area);
            QVERIFY2(!order.isEmpty(), qPrintable(name));
            QPoint last(-1, -1);
            int bottom = -1;
            for (QWidget* widget : order) {
                const QPoint at = widget->mapTo(area, QPoint(0, 0));
                // Down, or to the right in the same row.
                const bool is_below = at.y() >= bottom,
                           is_right = at.x() > last.x() && at.y() + widget->height() > last.y();
                QVERIFY2(is_below || is_right,
                         qPrintable(name + QStringLiteral(": ") + widget->objectName() + QLatin1Char(' ') +
                                    QLatin1String(widget->metaObject()->className())));
                last = at;
                bottom = at.y() + widget->height() / 2;
            }
        };
        auto* tabs = test.find<QTabWidget>("operations_tabs");
        for (int i = 0; i < tabs->count(); ++i) {
            tabs->setCurrentIndex(i);
            check(static_cast<QScrollArea*>(tabs->widget(i))->widget(), tabs->tabText(i));
            for (const char* more : {"more_options", "more_warp_options"})
                if (auto* button = tabs->widget(i)->findChild<QAbstractButton*>(QLatin1String(more))) {
                    button->setChecked(true);
                    check(static_cast<QScrollArea*>(tabs->widget(i))->widget(), tabs->tabText(i));
                }
        }
        check(test.find<QWidget>("mesh_dock"), QStringLiteral("mesh"));
        test.window->action(CommandId::preferences)->trigger();
        auto* pages = test.find<QTabWidget>("preferences_pages");
        for (int i = 0; i < pages->count(); ++i) {
            pages->setCurrentIndex(i);
            check(pages->widget(i), pages->tabText(i));
        }
    }

    void bars_groups_worst_elements_and_history_answer_to_keys() {
        KeyboardUnderTest test;
        test.drag_node(test.node_at(0.5, 0.0), {0, -30});
        EditState& edit = test.window->edit();

        auto* bars = test.find<HistogramWidget>("after_histogram");
        edit.select({}, {});
        bars->setFocus(Qt::TabFocusReason);
        QTest::keyClick(bars, Qt::Key_Home);
        QTest::keyClick(bars, Qt::Key_Return);
        const IndexSet worst = edit.elements();
        QVERIFY(!worst.empty());
        const auto& quality = test.document().state().quality->elements;
        QTest::keyClick(bars, Qt::Key_Right);
        QTest::keyClick(bars, Qt::Key_Space);
        QVERIFY(!edit.elements().empty() && edit.elements() != worst);
        for (const Index low : worst)
            for (const Index high : edit.elements())
                QVERIFY(quality[static_cast<std::size_t>(low)].scaled_jacobian <
                        quality[static_cast<std::size_t>(high)].scaled_jacobian);
        QTest::keyClick(bars, Qt::Key_Left);
        QTest::keyClick(bars, Qt::Key_Enter);
        QCOMPARE(edit.elements(), worst);

        auto* groups = test.find<QTreeWidget>("groups");
        edit.select({}, {});
        groups->setFocus(Qt::TabFocusReason);
        groups->setCurrentItem(groups->topLevelItem(0));
        QTest::keyClick(groups, Qt::Key_Return);
        QVERIFY(!edit.nodes().empty() || !edit.elements().empty());

        auto* table = test.find<QTreeWidget>("worst_elements");
        table->setFocus(Qt::TabFocusReason);
        table->setCurrentItem(table->topLevelItem(0));
        QTest::keyClick(table, Qt::Key_Down);
        QTest::keyClick(table, Qt::Key_Return);
        QCOMPARE(edit.elements(), IndexSet{test.document().state().quality->worst(2).back()});

        auto* history = test.find<QUndoView>("history");
        history->setFocus(Qt::TabFocusReason);
        QTest::keyClick(history, Qt::Key_Up);
        QCOMPARE(test.document().history()->index(), 0);
        QTest::keyClick(history, Qt::Key_Down);
        QCOMPARE(test.document().history()->index(), 1);
    }

    void samples_are_opened_by_keys() {
        WindowUnderTest test;
        QTest::keyClick(test.window.get(), Qt::Key_F6);
        const QList<QWidget*> order = tab_order(test.window->findChild<StartPage*>());
        QVERIFY(order.size() > 4);
        QCOMPARE(order.front()->objectName(), QStringLiteral("start_open"));
        QCOMPARE(test.window->focusWidget(), order.front());
        QTest::keyClick(order[1], Qt::Key_Return);
        QVERIFY(test.wait_for_job());
        QVERIFY(test.window->document().has_mesh());
    }
};

QObject* make_test() {
    return new KeyboardTest;
}

#include "keyboard_test.moc"
