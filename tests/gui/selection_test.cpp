/// Selecting, pinning, handles on the selection and the inspector, with real mouse events.

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QTreeWidget>

#include "tests/gui/drag_under_test.h"
#include "ui/panels/jacobian_map.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

struct SelectionUnderTest : DragUnderTest {
    explicit SelectionUnderTest(CommandId tool, const char* mesh = "square.msh") : DragUnderTest(mesh) {
        window->action(tool)->trigger();
    }
    EditState& edit() { return window->edit(); }
    void click_at(QPoint at, Qt::KeyboardModifiers modifiers = {}) {
        QTest::mouseMove(&view(), at);
        QTest::mousePress(&view(), Qt::LeftButton, modifiers, at);
        QTest::mouseRelease(&view(), Qt::LeftButton, modifiers, at);
    }
    void drag_from(QPoint from, const std::vector<QPoint>& way, Qt::KeyboardModifiers modifiers = {}) {
        QTest::mouseMove(&view(), from);
        QTest::mousePress(&view(), Qt::LeftButton, modifiers, from);
        for (const QPoint& at : way) {
            QMouseEvent event(QEvent::MouseMove, at, view().mapToGlobal(at), Qt::NoButton, Qt::LeftButton, modifiers);
            QApplication::sendEvent(&view(), &event);
        }
        QTest::mouseRelease(&view(), Qt::LeftButton, modifiers, way.back());
    }
    QPoint at(double x, double y) { return view().to_display(Eigen::RowVector3d(x, y, 0.0)).toPoint(); }
    IndexSet group(const char* name) { return topology().find_group_nodes(name).value(); }
};

}  // namespace

class SelectionTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void clicks_take_a_node_its_side_and_its_boundary() {
        SelectionUnderTest test(CommandId::tool_select);
        const Index node = test.node_at(0.5, 0.0);
        const QPoint at = test.place_of(node);
        test.click_at(at);
        QCOMPARE(test.edit().nodes(), IndexSet{node});
        test.click_at(at);
        QCOMPARE(test.edit().nodes(), test.group("bottom"));
        test.click_at(at);
        QCOMPARE(test.edit().nodes(), test.topology().boundary_nodes());
        QCOMPARE(test.text("selection_count"), QStringLiteral("%1 nodes").arg(test.topology().boundary_nodes().size()));
        // Into the background: nothing.
        test.click_at({4, 4});
        QVERIFY(test.edit().nodes().empty());
    }

    void modifiers_add_and_take_away() {
        SelectionUnderTest test(CommandId::tool_select);
        const Index a = test.node_at(0.5, 0.0), b = test.node_at(1.0, 0.5);
        test.click_at(test.place_of(a));
        test.click_at(test.place_of(b), Qt::ShiftModifier);
        QCOMPARE(test.edit().nodes(), (united({a}, {b})));
        test.click_at(test.place_of(a), Qt::ControlModifier);
        QCOMPARE(test.edit().nodes(), IndexSet{b});
        QTest::keyClick(&test.view(), Qt::Key_Escape);
        QVERIFY(test.edit().nodes().empty());
    }

    void a_click_beside_nodes_takes_the_element() {
        SelectionUnderTest test(CommandId::tool_select);
        const Eigen::RowVector3d center = test.document().state().mesh->element_center(7);
        test.click_at(test.view().to_display(center).toPoint());
        QCOMPARE(test.edit().elements(), IndexSet{7});
        QVERIFY(test.edit().nodes().empty());
    }

    void a_box_takes_what_is_in_it() {
        SelectionUnderTest test(CommandId::tool_select);
        const QPoint a = test.at(-0.04, -0.04), b = test.at(0.54, 1.04);
        test.drag_from(a, {QPoint(a.x() + 20, a.y()), b});
        IndexSet expected;
        for (const Index node : test.topology().boundary_nodes())
            if (test.positions()(node, 0) < 0.52) expected.push_back(node);
        QCOMPARE(test.edit().nodes(), expected);

        EditSettings settings = test.edit().settings();
        settings.select.what = SelectWhat::elements;
        test.edit().set_settings(settings);
        test.drag_from(a, {QPoint(a.x() + 20, a.y()), b});
        QVERIFY(test.edit().nodes().empty());
        for (Index element = 0; element < test.topology().element_count(); ++element)
            QCOMPARE(std::binary_search(test.edit().elements().begin(), test.edit().elements().end(), element),
                     test.document().state().mesh->element_center(element)[0] < 0.54);
        // With Ctrl the same box again takes all of it away.
        test.drag_from(a, {QPoint(a.x() + 20, a.y()), b}, Qt::ControlModifier);
        QVERIFY(test.edit().elements().empty());
    }

    void a_lasso_takes_what_is_in_it() {
        SelectionUnderTest test(CommandId::tool_select);
        test.window->show_tab(QStringLiteral("inspect"));
        auto* shape = test.find<QComboBox>("select_shape");
        shape->setCurrentIndex(shape->findText(QStringLiteral("Lasso")));
        auto* what = test.find<QComboBox>("select_what");
        what->setCurrentIndex(what->findText(QStringLiteral("All nodes")));
        // A triangle around the lower left half.
        test.drag_from(test.at(-0.05, -0.05), {test.at(0.4, -0.05), test.at(1.04, -0.05), test.at(-0.05, 1.04)});
        IndexSet expected;
        for (Index node = 0; node < test.topology().node_count(); ++node)
            if (test.positions()(node, 0) + test.positions()(node, 1) < 0.97) expected.push_back(node);
        QCOMPARE(test.edit().nodes(), expected);
    }

    void solids_hide_what_is_behind_unless_asked() {
        SelectionUnderTest test(CommandId::tool_select, "cube.msh");
        const QPoint corner(2, 2), opposite(test.view().width() - 150, test.view().height() - 2);
        test.drag_from(corner, {QPoint(60, 60), opposite});
        const std::size_t seen = test.edit().nodes().size(), all = test.topology().boundary_nodes().size();
        // Three of six faces.
        QVERIFY(seen > all / 3 && seen < all * 3 / 4);
        const Eigen::RowVector3d eye = test.view().view_axes().col(2).transpose();
        Index farthest = 0;
        for (const Index node : test.topology().boundary_nodes())
            if (test.positions().row(node).dot(eye) < test.positions().row(farthest).dot(eye)) farthest = node;
        QVERIFY(!std::binary_search(test.edit().nodes().begin(), test.edit().nodes().end(), farthest));
        EditSettings settings = test.edit().settings();
        settings.select.sees_through = true;
        test.edit().set_settings(settings);
        test.drag_from(corner, {QPoint(60, 60), opposite});
        QCOMPARE(test.edit().nodes().size(), all);
    }

    void commands_of_the_menu() {
        SelectionUnderTest test(CommandId::tool_select);
        const auto run = [&](CommandId id) {
            QVERIFY(test.window->action(id)->isEnabled());
            test.window->action(id)->trigger();
        };
        QVERIFY(!test.window->action(CommandId::select_grow)->isEnabled());
        run(CommandId::select_all);
        QCOMPARE(test.edit().elements().size(), std::size_t(test.topology().element_count()));
        run(CommandId::select_invert);
        QVERIFY(test.edit().elements().empty());
        test.edit().select_elements({0});
        run(CommandId::select_grow);
        const std::size_t grown = test.edit().elements().size();
        QVERIFY(grown > 3);
        run(CommandId::select_shrink);
        QVERIFY(test.edit().elements().size() < grown);
        test.edit().select_nodes({test.node_at(0.5, 1.0)});
        run(CommandId::select_side);
        QCOMPARE(test.edit().nodes(), test.group("top"));
        run(CommandId::select_boundary);
        QCOMPARE(test.edit().nodes(), test.topology().boundary_nodes());
        run(CommandId::pin_selection);
        QCOMPARE(test.edit().pins(), test.topology().boundary_nodes());
        run(CommandId::unpin_all);
        QVERIFY(test.edit().pins().empty());
        run(CommandId::select_none);
        QVERIFY(test.edit().nodes().empty());
        // A range of the quality; a straight mesh has 1 everywhere.
        test.window->show_tab(QStringLiteral("inspect"));
        test.click("select_range");
        QVERIFY(test.edit().elements().empty());
        test.find<QDoubleSpinBox>("range_upper")->setValue(1.0);
        test.click("select_range");
        QCOMPARE(test.edit().elements().size(), std::size_t(test.topology().element_count()));
    }

    void the_pin_tool_pins_and_frees() {
        SelectionUnderTest test(CommandId::tool_pin);
        const Index node = test.node_at(0.5, 0.0);
        test.click_at(test.place_of(node));
        QCOMPARE(test.edit().pins(), IndexSet{node});
        test.click_at(test.place_of(node));
        QVERIFY(test.edit().pins().empty());
    }

    void a_selection_goes_with_its_mesh() {
        SelectionUnderTest test(CommandId::tool_select);
        test.edit().select({3}, {4});
        test.edit().set_pins({5});
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(test.edit().nodes().empty() && test.edit().elements().empty() && test.edit().pins().empty());
    }

    void the_inspector_tells_about_elements_and_nodes() {
        SelectionUnderTest test(CommandId::tool_select);
        test.window->show_tab(QStringLiteral("inspect"));
        const auto detail = [&](const char* name) {
            const auto rows =
                test.find<QTreeWidget>("selection_details")->findItems(QLatin1String(name), Qt::MatchExactly);
            return rows.isEmpty() ? QString() : rows.front()->text(1);
        };
        test.edit().select_elements({3});
        QCOMPARE(test.find<QTreeWidget>("selection_list")->topLevelItemCount(), 1);
        QCOMPARE(detail("Element"), QString::number(test.topology().element_tag(3).value));
        QCOMPARE(detail("Type"), QStringLiteral("P3 triangle"));
        QCOMPARE(detail("Scaled J"), QStringLiteral("1.00"));
        QCOMPARE(detail("Validity"), QStringLiteral("proved valid"));
        QCOMPARE(detail("Nodes").split(QStringLiteral(", ")).size(), 10);
        const Index node = test.node_at(0.5, 0.0);
        test.edit().select_nodes({node});
        QCOMPARE(detail("Node"), QString::number(test.topology().node_tag(node).value));
        QCOMPARE(detail("x").toDouble(), 0.5);
        QCOMPARE(detail("Lies"), QStringLiteral("boundary"));
        QVERIFY(detail("Groups").contains(QStringLiteral("bottom")));
    }

    void the_jacobian_is_shown_inside_an_element() {
        SelectionUnderTest test(CommandId::tool_drag);
        test.drag_node(test.node_at(0.5, 0.0), {4, -22});
        test.window->show_tab(QStringLiteral("inspect"));
        const Index worst = test.document().state().quality->worst(1).front();
        test.edit().select_elements({worst});
        auto* map = test.find<JacobianMap>("jacobian_map");
        QVERIFY(map->isVisible());
        const ElementQuality& quality = test.document().state().quality->elements[static_cast<std::size_t>(worst)];
        // Sampled between what is proved.
        QVERIFY(map->least() * quality.max_upper >= quality.min_lower - 1e-12);
        QVERIFY(map->least() < quality.scaled_jacobian + 0.1);
        QVERIFY(map->largest() <= 1.0 + 1e-12 && map->largest() > 0.9);
        test.edit().select({}, {});
        QVERIFY(!map->isVisible());
    }

    void spokes_show_the_weights_of_a_node() {
        SelectionUnderTest test(CommandId::tool_select);
        test.window->show_tab(QStringLiteral("inspect"));
        const Index node = test.node_at(0.5, 0.5);
        const QImage before = test.view().picture(1);
        test.edit().select_nodes({node});
        const Spokes& spokes = test.edit().spokes();
        QCOMPARE(spokes.node, std::optional(node));
        QVERIFY(spokes.neighbours.size() > 6);
        double sum = 0.0;
        Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
        for (std::size_t i = 0; i < spokes.neighbours.size(); ++i) {
            QVERIFY(spokes.weights[i] > 0.0);  // convex
            sum += spokes.weights[i];
            middle += spokes.weights[i] * test.positions().row(spokes.neighbours[i]);
        }
        QVERIFY(std::abs(sum - 1.0) < 1e-9);
        QVERIFY((middle - test.positions().row(node)).norm() < 1e-9);
        const auto rows =
            test.find<QTreeWidget>("selection_details")->findItems(QStringLiteral("Weight of"), Qt::MatchStartsWith);
        QCOMPARE(rows.size(), qsizetype(spokes.neighbours.size()));
        QVERIFY(test.view().picture(1) != before);
        // Boundary nodes have none.
        test.edit().select_nodes({test.node_at(0.5, 0.0)});
        QVERIFY(!test.edit().spokes().node);
    }

    void the_selection_stays_when_the_tool_changes() {
        SelectionUnderTest test(CommandId::tool_select);
        test.point_at(test.at(0.9, -0.1));
        QTest::mousePress(&test.view(), Qt::LeftButton, {}, test.at(0.9, -0.1));
        test.mouse = test.at(0.9, -0.1);
        test.move_by(test.at(1.02, 1.1) - test.mouse);
        QTest::mouseRelease(&test.view(), Qt::LeftButton, {}, test.mouse);
        const IndexSet selected = test.edit().nodes();
        QVERIFY(selected.size() >= test.group("right").size());
        for (const CommandId tool : {CommandId::tool_transform, CommandId::tool_drag, CommandId::tool_pin,
                                     CommandId::tool_look, CommandId::tool_select}) {
            test.window->action(tool)->trigger();
            QCOMPARE(test.edit().nodes(), selected);
        }
        // A job takes the tool away for a while.
        test.window->action(CommandId::untangle)->trigger();
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.edit().nodes(), selected);
        QTest::keyClick(&test.view(), Qt::Key_Escape);
        QVERIFY(test.edit().nodes().empty());
    }

    void arrows_move_the_selection() {
        SelectionUnderTest test(CommandId::tool_transform);
        test.edit().select_nodes(test.group("right"));
        const Coordinates opened = test.positions();
        // Near the tip of the arrow to the right from the middle of the right side.
        const int rim = static_cast<int>(test.view().free_area().right()) - 56;
        const QPoint pivot(std::min(test.at(1.0, 0.5).x(), rim), test.at(1.0, 0.5).y()), tip = pivot + QPoint(45, 0);
        test.point_at(tip);
        QVERIFY(QTest::qWaitFor([&] { return test.text("hint").contains(QStringLiteral("along x")); }));
        QTest::mousePress(&test.view(), Qt::LeftButton, {}, tip);
        QVERIFY(QTest::qWaitFor([&] { return test.drag().is_live(); }, 20000));
        test.mouse = tip;
        test.move_by({-30, 9});
        test.let_go();
        for (const Index node : test.group("right")) {
            QCOMPARE(test.positions()(node, 1), opened(node, 1));
            QVERIFY(std::abs(test.positions()(node, 0) - opened(node, 0) + 30 * test.unit()) < 1.5 * test.unit());
        }
        QCOMPARE(test.document().history()->text(0), QStringLiteral("Move 13 nodes"));
        QVERIFY(test.distance_from_warp() < 1e-10);
    }

    void rings_turn_and_dots_scale_about_the_middle() {
        SelectionUnderTest test(CommandId::tool_transform);
        test.edit().select_nodes(test.topology().boundary_nodes());
        const Coordinates opened = test.positions();
        const QPoint pivot = test.at(0.5, 0.5), ring = pivot + QPoint(34, -34);
        test.point_at(ring);
        QVERIFY(test.text("hint").contains(QStringLiteral("about z")));
        QTest::mousePress(&test.view(), Qt::LeftButton, {}, ring);
        QVERIFY(QTest::qWaitFor([&] { return test.drag().is_live(); }, 20000));
        test.mouse = ring;
        test.move_by({-68, 0}, Qt::ControlModifier);  // from 45 to 135 degrees, in steps of 5
        test.let_go();
        for (Index node = 0; node < test.topology().node_count(); ++node) {
            QVERIFY(std::abs(test.positions()(node, 0) - (0.5 - (opened(node, 1) - 0.5))) < 1e-9);
            QVERIFY(std::abs(test.positions()(node, 1) - (0.5 + (opened(node, 0) - 0.5))) < 1e-9);
        }
        test.click("tool_undo");
        const QPoint box = pivot + QPoint(92, 0);
        test.point_at(box);
        QTest::mousePress(&test.view(), Qt::LeftButton, {}, box);
        QVERIFY(QTest::qWaitFor([&] { return test.drag().is_live(); }, 20000));
        test.mouse = box;
        test.move_by({-46, 0}, Qt::ControlModifier);  // to half, in steps of 0.05
        test.let_go();
        for (Index node = 0; node < test.topology().node_count(); ++node) {
            QVERIFY(std::abs(test.positions()(node, 0) - (0.5 + 0.5 * (opened(node, 0) - 0.5))) < 1e-9);
            QVERIFY(std::abs(test.positions()(node, 1) - opened(node, 1)) < 1e-12);
        }
        QCOMPARE(test.document().history()->text(0),
                 QStringLiteral("Scale %1 nodes").arg(test.topology().boundary_nodes().size()));
        test.click("tool_undo");
        QCOMPARE(test.positions(), opened);
    }

    void handles_of_a_selection_outside_the_view_are_at_its_rim() {
        SelectionUnderTest test(CommandId::tool_transform);
        test.edit().select_nodes(test.group("right"));
        // The camera goes to the left side; the right one is far out of the view.
        test.view().fit_to(Eigen::RowVector3d(0.0, 0.5, 0.0), 0.15);
        QTest::qWait(400);
        const Coordinates opened = test.positions();
        const QPoint middle = test.at(1.0, 0.5);
        QVERIFY(middle.x() > test.view().width() + 50);
        const int rim = static_cast<int>(test.view().free_area().right());
        QVERIFY(rim < test.view().width());  // the legend is there
        const QPoint tip(rim - 56 + 45, middle.y());
        test.point_at(tip);
        QVERIFY(QTest::qWaitFor([&] { return test.text("hint").contains(QStringLiteral("along x")); }));
        QTest::mousePress(&test.view(), Qt::LeftButton, {}, tip);
        QVERIFY(QTest::qWaitFor([&] { return test.drag().is_live(); }, 20000));
        test.mouse = tip;
        test.move_by({-40, 0});
        test.let_go();
        const Index node = test.group("right").front();
        QVERIFY(std::abs(opened(node, 0) - test.positions()(node, 0) - 40 * test.unit()) < 1.5 * test.unit());
        test.click("tool_undo");
        // A turn is about the middle of the selection, wherever its ring is.
        const QPoint ring(rim - 56 + 34, middle.y() - 34);
        test.point_at(ring);
        QTest::mousePress(&test.view(), Qt::LeftButton, {}, ring);
        QVERIFY(QTest::qWaitFor([&] { return test.drag().is_live(); }, 20000));
        test.mouse = ring;
        test.move_by({-68, 0}, Qt::ControlModifier);  // 90 degrees
        test.let_go();
        for (const Index turned : test.group("right")) {
            QVERIFY(std::abs(test.positions()(turned, 0) - (1.0 - (opened(turned, 1) - 0.5))) < 1e-9);
            QVERIFY(std::abs(test.positions()(turned, 1) - 0.5) < 1e-9);
        }
    }

    void feature_lines_of_a_solid_are_selected() {
        DragUnderTest test("cube.msh");
        QAction* command = test.window->action(CommandId::select_feature);
        QVERIFY(!command->isEnabled());
        test.window->edit().select_nodes({test.node_at(0.5, 0.0, 0.0)});
        command->trigger();
        for (const Index node : test.window->edit().nodes()) {
            QCOMPARE(test.positions()(node, 1), 0.0);
            QCOMPARE(test.positions()(node, 2), 0.0);
        }
        QCOMPARE(test.window->edit().nodes().size(), std::size_t(5));
    }

    void a_click_on_the_boundary_gives_the_handles_something() {
        SelectionUnderTest test(CommandId::tool_transform);
        EditSettings settings = test.edit().settings();
        settings.unit = GrabUnit::side;
        test.edit().set_settings(settings);
        test.click_at(test.place_of(test.node_at(0.5, 0.0)));
        QCOMPARE(test.edit().nodes(), test.group("bottom"));
    }

    void motions_by_numbers() {
        SelectionUnderTest test(CommandId::tool_select);
        test.window->show_tab(QStringLiteral("edit"));
        QVERIFY(!test.find<QPushButton>("apply_motion")->isEnabled());
        test.edit().select_nodes(test.group("top"));
        test.find<QDoubleSpinBox>("motion_x")->setValue(0.125);
        test.find<QDoubleSpinBox>("motion_y")->setValue(-0.25);
        const Coordinates opened = test.positions();
        test.click("apply_motion");
        QVERIFY(QTest::qWaitFor([&] { return !test.drag().is_active(); }, 20000));
        for (const Index node : test.group("top"))
            QVERIFY((test.positions().row(node) - opened.row(node) - Eigen::RowVector3d(0.125, -0.25, 0.0)).norm() <
                    1e-14);
        QVERIFY(test.distance_from_warp() < 1e-10);
        test.click("tool_undo");
        auto* motion = test.find<QComboBox>("motion");
        motion->setCurrentIndex(motion->findText(QStringLiteral("Rotate by")));
        test.find<QDoubleSpinBox>("motion_angle")->setValue(30.0);
        test.click("apply_motion");
        QVERIFY(QTest::qWaitFor([&] { return !test.drag().is_active(); }, 20000));
        const Index corner = test.node_at(0.5 + 0.5 * std::sqrt(0.75), 1.0 + 0.25);
        QVERIFY(std::abs(opened(corner, 0) - 1.0) < 1e-12 && std::abs(opened(corner, 1) - 1.0) < 1e-12);
        QCOMPARE(test.document().history()->text(0), QStringLiteral("Rotate 13 nodes by 30°"));
    }
};

QObject* make_test() {
    return new SelectionTest;
}

#include "selection_test.moc"
