/// What the user chooses once: it counts at once, is there at the next start, and nothing in the settings can stop one.

#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QSpinBox>
#include <QSplitter>
#include <QTabWidget>

#include "tests/gui/drag_under_test.h"
#include "ui/document/journal.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

struct PreferencesUnderTest : DragUnderTest {
    explicit PreferencesUnderTest(const char* mesh = "square.msh") : DragUnderTest(mesh) {
        QTest::keyClick(window.get(), Qt::Key_Comma, Qt::ControlModifier);
    }
    void choose(const char* box_name, int value) {
        auto* box = find<QComboBox>(box_name);
        box->setCurrentIndex(box->findData(value));
    }
    void check(const char* box_name, bool is_on) { find<QCheckBox>(box_name)->setChecked(is_on); }
};

}  // namespace

class PreferencesTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void everything_is_there_at_the_next_start() {
        Preferences all;
        all.start = StartAction::last_mesh;
        all.recent_count = 3;
        all.keeps_work = false;
        all.remembers_tool = false;
        all.remembers_drawing = false;
        all.starts_with_edges = false;
        all.starts_with_nodes = true;
        all.starts_with_legend = false;
        all.wheel_is_reversed = true;
        all.mouse = MouseHabits::gmsh;
        all.soft_radius_percent = 12.5;
        QVERIFY(!(all == Preferences::load()));
        QVERIFY(Preferences::load() == Preferences());
        {
            PreferencesUnderTest test;
            test.choose("preferred_start", int(all.start));
            test.find<QSpinBox>("recent_count")->setValue(all.recent_count);
            test.check("keeps_work", all.keeps_work);
            test.check("remembers_tool", all.remembers_tool);
            test.check("remembers_drawing", all.remembers_drawing);
            test.check("starts_with_edges", all.starts_with_edges);
            test.check("starts_with_nodes", all.starts_with_nodes);
            test.check("starts_with_legend", all.starts_with_legend);
            test.check("wheel_is_reversed", all.wheel_is_reversed);
            test.choose("preferred_mouse", int(all.mouse));
            test.find<QDoubleSpinBox>("soft_radius_percent")->setValue(all.soft_radius_percent);
            QVERIFY(all == Preferences::load());
            test.window->close();
        }
        PreferencesUnderTest again;
        QVERIFY(!again.find<QCheckBox>("keeps_work")->isChecked());
        QCOMPARE(again.find<QSpinBox>("recent_count")->value(), 3);
        QCOMPARE(again.find<QComboBox>("preferred_mouse")->currentData().toInt(), int(MouseHabits::gmsh));
        QVERIFY(!again.window->action(CommandId::edges)->isChecked());
        QVERIFY(again.window->action(CommandId::nodes)->isChecked());
        QVERIFY(!again.window->action(CommandId::legend)->isChecked());
        // 12.5 % of the square's diagonal, to two digits.
        QCOMPARE(again.window->edit().settings().soft.radius, 0.18);
    }

    void the_editing_page_and_the_edit_tab_say_the_same_and_stay() {
        {
            PreferencesUnderTest test;
            test.choose("preferred_unit", int(GrabUnit::side));
            test.choose("preferred_falloff", int(Falloff::sharp));
            test.check("preferred_soft", true);
            test.check("preferred_along", false);
            test.choose("preferred_select", int(SelectWhat::elements));
            test.choose("preferred_shape", 1);
            QCOMPARE(test.find<QComboBox>("grab_unit")->currentData().toInt(), int(GrabUnit::side));
            QCOMPARE(test.find<QComboBox>("falloff")->currentData().toInt(), int(Falloff::sharp));
            QCOMPARE(test.find<QComboBox>("select_shape")->currentData().toInt(), 1);
            auto* tab = test.find<QComboBox>("falloff");
            tab->setCurrentIndex(tab->findData(int(Falloff::root)));
            QCOMPARE(test.find<QComboBox>("preferred_falloff")->currentData().toInt(), int(Falloff::root));
        }
        const WindowUnderTest again;
        const EditSettings& settings = again.window->edit().settings();
        QVERIFY(settings.unit == GrabUnit::side && settings.soft.falloff == Falloff::root);
        QVERIFY(settings.is_soft && !settings.soft.follows_boundary);
        QVERIFY(settings.select.what == SelectWhat::elements && settings.select.is_lasso);
        QVERIFY(settings.direction == DragDirection::view_plane);
    }

    void the_last_mesh_comes_back() {
        WindowUnderTest first;
        first.open(first.inputs.path(QStringLiteral("square.msh")));
        Preferences preferences;
        preferences.start = StartAction::last_mesh;
        preferences.store();
        const WindowUnderTest second;
        QTRY_VERIFY(second.window->document().has_mesh());
        QCOMPARE(second.window->document().file_name(), QStringLiteral("square.msh"));
        // Not in place of what was asked for.
        MainWindow third(theme());
        third.open_file(first.inputs.path(QStringLiteral("cube.msh")));
        QTRY_VERIFY(third.document().has_mesh());
        QTest::qWait(50);
        QCOMPARE(third.document().file_name(), QStringLiteral("cube.msh"));
    }

    void as_many_files_are_remembered_as_one_wants() {
        PreferencesUnderTest test;
        test.find<QSpinBox>("recent_count")->setValue(1);
        test.open(test.inputs.path(QStringLiteral("quad.msh")));
        QCOMPARE(RecentFiles().paths(), QStringList(test.inputs.path(QStringLiteral("quad.msh"))));
        test.click("clear_recent");
        QVERIFY(RecentFiles().paths().isEmpty());
        QVERIFY(!test.find<QPushButton>("clear_recent")->isEnabled());
        test.find<QSpinBox>("recent_count")->setValue(0);
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(RecentFiles().paths().isEmpty());
    }

    void work_is_kept_on_disk_only_if_one_wants() {
        PreferencesUnderTest test;
        QCOMPARE(QDir(test.text("journal_folder")), QDir(Journal::standard_folder()));
        const auto kept = [] {
            return QDir(Journal::standard_folder()).entryList({QStringLiteral("*.journal")}, QDir::Files).size();
        };
        test.drag_node(test.node_at(0.5, 0.0), {0, -20});
        QTRY_COMPARE(kept(), 1);
        test.check("keeps_work", false);
        QTRY_COMPARE(kept(), 0);
        test.drag_node(test.node_at(0.5, 1.0), {0, -20});
        QTest::qWait(20);
        QCOMPARE(kept(), 0);
        test.check("keeps_work", true);
        QTRY_COMPARE(kept(), 1);
    }

    void the_mouse_does_what_one_is_used_to() {
        PreferencesUnderTest test("cube.msh");
        test.window->action(CommandId::tool_look)->trigger();
        const QPoint middle = test.view().rect().center();
        const auto drag = [&](Qt::MouseButton button, Qt::KeyboardModifiers modifiers = {}) {
            QTest::mousePress(&test.view(), button, modifiers, middle);
            for (int step = 1; step <= 3; ++step) {
                const QPoint at = middle + QPoint(0, -20 * step);
                QMouseEvent event(QEvent::MouseMove, at, test.view().mapToGlobal(at), Qt::NoButton, button, modifiers);
                QApplication::sendEvent(&test.view(), &event);
            }
            QTest::mouseRelease(&test.view(), button, modifiers, middle + QPoint(0, -60));
            QTest::qWait(30);
        };
        struct View {
            Eigen::Matrix3d axes;
            double unit;
            QPointF place;
        };
        const Eigen::RowVector3d center(0.5, 0.5, 0.5);
        const auto now = [&] {
            return View{test.view().view_axes(), test.view().units_per_pixel(center), test.view().to_display(center)};
        };
        const auto kind = [&](Qt::MouseButton button, Qt::KeyboardModifiers modifiers = {}) -> QString {
            test.window->action(CommandId::look_isometric)->trigger();
            QTest::qWait(30);
            const View before = now();
            drag(button, modifiers);
            const View after = now();
            if ((after.axes - before.axes).norm() > 1e-3) return QStringLiteral("turn");
            if (after.unit < 0.9 * before.unit) return QStringLiteral("zoom");
            return (after.place - before.place).manhattanLength() > 20 ? QStringLiteral("pan") : QStringLiteral("none");
        };
        const struct {
            MouseHabits habits;
            const char *left, *middle, *right, *shift_middle, *control_middle;
        } cases[] = {{MouseHabits::curvewright, "turn", "pan", "turn", "pan", "pan"},
                     {MouseHabits::paraview, "turn", "pan", "zoom", "turn", "turn"},
                     {MouseHabits::gmsh, "turn", "zoom", "pan", "zoom", "zoom"},
                     {MouseHabits::blender, "turn", "turn", "turn", "pan", "zoom"}};
        for (const auto& entry : cases) {
            test.choose("preferred_mouse", int(entry.habits));
            QCOMPARE(kind(Qt::LeftButton), QLatin1String(entry.left));
            QCOMPARE(kind(Qt::MiddleButton), QLatin1String(entry.middle));
            QCOMPARE(kind(Qt::RightButton), QLatin1String(entry.right));
            QCOMPARE(kind(Qt::MiddleButton, Qt::ShiftModifier), QLatin1String(entry.shift_middle));
            QCOMPARE(kind(Qt::MiddleButton, Qt::ControlModifier), QLatin1String(entry.control_middle));
        }
        test.mouse = middle;
        for (const bool is_reversed : {false, true}) {
            test.check("wheel_is_reversed", is_reversed);
            const double before = now().unit;
            test.turn_wheel(1);
            QTest::qWait(30);
            QCOMPARE(now().unit < before, !is_reversed);
        }
    }

    void the_layout_comes_back_and_can_be_reset() {
        {
            WindowUnderTest test;
            test.open(test.inputs.path(QStringLiteral("square.msh")));
            test.window->show_tab(QStringLiteral("warp"));
            test.find<QSplitter>("right_splitter")->setSizes({250, 406});
            test.window->action(CommandId::panel_mesh)->trigger();
            QVERIFY(!test.find<QWidget>("groups")->isVisible());
            test.window->close();
        }
        WindowUnderTest again;
        again.open(again.inputs.path(QStringLiteral("square.msh")));
        auto* tabs = again.find<QTabWidget>("operations_tabs");
        QCOMPARE(tabs->currentWidget()->objectName(), QStringLiteral("warp_tab"));
        QVERIFY(!again.find<QWidget>("groups")->isVisible());
        QVERIFY(!again.window->action(CommandId::panel_mesh)->isChecked());
        const QList<int> sizes = again.find<QSplitter>("right_splitter")->sizes();
        QVERIFY(sizes[0] < sizes[1]);
        again.window->action(CommandId::reset_layout)->trigger();
        QVERIFY(again.find<QWidget>("groups")->isVisible());
        QVERIFY(again.window->action(CommandId::panel_mesh)->isChecked());
        QCOMPARE(tabs->currentIndex(), 0);
        const QList<int> reset = again.find<QSplitter>("right_splitter")->sizes();
        QVERIFY(reset[0] > reset[1]);
        again.window->close();
        WindowUnderTest last;
        last.open(last.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(last.find<QWidget>("groups")->isVisible());
    }

    void broken_settings_keep_nobody_from_starting() {
        {
            QSettings settings;
            for (const char* key : {"preferences/start",
                                    "preferences/mouse",
                                    "preferences/recent_count",
                                    "preferences/worst_count",
                                    "preferences/keeps_work",
                                    "preferences/soft_radius_percent",
                                    "edit/unit",
                                    "edit/falloff",
                                    "edit/select_what",
                                    "edit/is_soft",
                                    "window/geometry",
                                    "window/state",
                                    "window/right_splitter",
                                    "window/tab",
                                    "view/edges",
                                    "theme",
                                    "recent_files",
                                    "tool/flat",
                                    "shortcuts/preset",
                                    "shortcuts/own/undo",
                                    "last_folder"})
                settings.setValue(QLatin1String(key), QStringLiteral("-99 ✗ nonsense"));
        }
        {
            WindowUnderTest test;
            test.open(test.inputs.path(QStringLiteral("square.msh")));
            QVERIFY(Preferences::load() == Preferences());
            QVERIFY(test.window->edit().settings().unit == GrabUnit::node);
        }
        // Not even a file that is none.
        QSettings settings;
        settings.sync();
        QFile file(settings.fileName());
        QVERIFY(file.open(QIODevice::WriteOnly));
        file.write(QByteArrayLiteral("\x00\xff[[[]==\n[preferences\nstart=@Variant(\x00\x01"));
        file.close();
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(test.window->action(CommandId::undo)->shortcut() == QKeySequence(QStringLiteral("Ctrl+Z")));
    }
};

QObject* make_test() {
    return new PreferencesTest;
}

#include "preferences_test.moc"
