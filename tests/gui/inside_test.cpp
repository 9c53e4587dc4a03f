/// Looking inside: cutting through elements, numbers, the orthographic view.

#include <QSettings>
#include <QSignalSpy>
#include <QSlider>
#include <QToolButton>
#include <QTreeWidget>

#include "tests/gui/gui_test_support.h"
#include "ui/main_window/mesh_view.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

struct InsideUnderTest : WindowUnderTest {
    explicit InsideUnderTest(const char* mesh = "cube.msh") {
        open(inputs.path(QLatin1String(mesh)));
        window->action(CommandId::tool_look)->trigger();
        QTest::qWait(50);  // a first frame
    }
    MeshView& view() { return window->view(); }
    const CurvedMesh& mesh() { return *window->document().state().mesh; }
    QPoint place_of(const Eigen::RowVector3d& point) { return view().to_display(point).toPoint(); }
    void set_slider(int value) {
        find<QSlider>("clip_position")->setValue(value);
        QTest::qWait(30);
    }
    /// Extent of an element along an axis.
    std::array<double, 2> extent(Index element, int axis) {
        const Eigen::MatrixX3d x = mesh().element_coordinates(element);
        return {x.col(axis).minCoeff(), x.col(axis).maxCoeff()};
    }
};

}  // namespace

class InsideTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void the_bar_cuts_through_elements_and_remembers_it() {
        {
            InsideUnderTest test;
            test.click("tool_clip");
            QVERIFY(test.view().options().clip->style == ClipStyle::whole_elements);
            QVERIFY(test.find<QToolButton>("clip_whole")->isChecked());
            test.set_slider(70);  // 0.35: through the elements, whose layers end at 0.5
            const QImage whole = test.view().picture(1);
            test.click("clip_through");
            QVERIFY(test.view().options().clip->style == ClipStyle::cut);
            QVERIFY(!test.find<QToolButton>("clip_whole")->isChecked());
            QVERIFY(test.view().picture(1) != whole);
            for (Index element = 0; element < test.mesh().topology().element_count(); ++element) {
                const auto [low, high] = test.extent(element, 0);
                if (low < 0.34 && high > 0.36) QVERIFY(test.view().draws_element(element));
                if (low > 0.36) QVERIFY(!test.view().draws_element(element));
            }
            // The slider moves the section.
            const QImage before = test.view().picture(1);
            test.set_slider(150);
            QCOMPARE(test.view().options().clip->position, 0.75);
            QVERIFY(test.view().picture(1) != before);
        }
        InsideUnderTest again;
        again.click("tool_clip");
        QVERIFY(again.find<QToolButton>("clip_through")->isChecked());
        QVERIFY(again.view().options().clip->style == ClipStyle::cut);
        again.click("clip_whole");
        QVERIFY(again.view().options().clip->style == ClipStyle::whole_elements);
    }

    void the_bar_fits_into_half_the_window() {
        InsideUnderTest test;
        test.click("tool_clip");
        const int wide = test.find<QWidget>("clip_bar")->width();
        test.window->action(CommandId::compare)->trigger();
        QTest::qWait(100);
        auto* bar = test.find<QWidget>("clip_bar");
        QVERIFY(bar->width() < wide);
        QVERIFY2(bar->geometry().right() < test.view().width(),
                 qPrintable(QStringLiteral("%1 %2").arg(bar->geometry().right()).arg(test.view().width())));
        test.click("clip_through");
        QVERIFY(test.view().options().clip->style == ClipStyle::cut);
        test.window->action(CommandId::compare)->trigger();
        QTest::qWait(100);
        QCOMPARE(bar->width(), wide);
    }

    void a_click_on_the_section_tells_about_the_element_there() {
        InsideUnderTest test;
        test.click("tool_clip");
        test.click("clip_through");
        test.click("clip_z");
        test.set_slider(60);  // 0.3
        // To where the section is in front.
        test.window->action(CommandId::look_top)->trigger();
        QTest::qWait(50);
        QSignalSpy clicks(&test.view(), &MeshView::element_clicked);
        int told = 0;
        for (const double x : {0.17, 0.42, 0.61, 0.86})
            for (const double y : {0.13, 0.38, 0.64, 0.89}) {
                QTest::mouseClick(&test.view(), Qt::LeftButton, {}, test.place_of({x, y, 0.3}));
                const auto element = clicks.takeLast().at(0).value<std::optional<Index>>();
                QVERIFY(element.has_value());
                const auto [low, high] = test.extent(*element, 2);
                QVERIFY(low < 0.3 && high > 0.3);
                const auto [left, right] = test.extent(*element, 0);
                QVERIFY(left < x + 0.02 && right > x - 0.02);
                ++told;
            }
        QCOMPARE(told, 16);
        // Beside it, where the mesh was cut away, there is nothing.
        test.window->action(CommandId::look_left)->trigger();
        QTest::qWait(50);
        QTest::mouseClick(&test.view(), Qt::LeftButton, {}, test.place_of({0.5, 0.5, 0.6}));
        QVERIFY(!clicks.takeLast().at(0).value<std::optional<Index>>().has_value());
    }

    void flying_to_an_element_puts_the_plane_through_it() {
        InsideUnderTest test;
        test.click("tool_clip");
        test.click("clip_through");
        auto* table = test.find<QTreeWidget>("worst_elements");
        auto* slider = test.find<QSlider>("clip_position");
        for (const char* side : {"", "clip_flip"}) {
            if (*side) test.click(side);
            for (int row = 0; row < table->topLevelItemCount(); ++row) {
                slider->setValue(*side ? slider->maximum() : slider->minimum());  // hides all
                const Index element = test.window->document().state().quality->worst(row + 1).back();
                QVERIFY(!test.view().draws_element(element));
                QTest::mouseClick(table->viewport(), Qt::LeftButton, {},
                                  table->visualItemRect(table->topLevelItem(row)).center());
                QVERIFY(test.view().draws_element(element));
                QVERIFY(test.view().options().clip.has_value());
                const double at = test.mesh().element_center(element)[0];
                const auto& clip = *test.view().options().clip;
                QVERIFY(std::abs((*side ? 1.0 - clip.position : clip.position) - at) < 1e-9);
            }
        }
    }

    void keys_show_the_numbers() {
        for (const char* mesh : {"square.msh", "cube.msh"}) {
            InsideUnderTest test(mesh);
            const QImage plain = test.view().picture(1);
            QTest::keyClick(test.window.get(), Qt::Key_N, Qt::ControlModifier | Qt::ShiftModifier);
            QVERIFY(test.view().options().show_node_numbers);
            const QImage nodes = test.view().picture(1);
            QVERIFY(nodes != plain);
            QTest::keyClick(test.window.get(), Qt::Key_M, Qt::ControlModifier | Qt::ShiftModifier);
            QVERIFY(test.view().options().show_element_numbers);
            QVERIFY(test.view().picture(1) != nodes);
            // A larger picture has them larger, and the view is as before after it.
            const QImage now = test.view().picture(1);
            QVERIFY(!test.view().picture(2).isNull());
            QVERIFY(test.view().picture(1) == now);
            QTest::keyClick(test.window.get(), Qt::Key_N, Qt::ControlModifier | Qt::ShiftModifier);
            QTest::keyClick(test.window.get(), Qt::Key_M, Qt::ControlModifier | Qt::ShiftModifier);
            QVERIFY(test.view().picture(1) == plain);
        }
    }

    void the_orthographic_view_is_remembered() {
        const auto depth_shows = [](InsideUnderTest& test) {
            const auto edge = [&](double y) {
                return test.view().to_display({0.0, y, 1.0}) - test.view().to_display({0.0, y, 0.0});
            };
            return (edge(0.0) - edge(1.0)).manhattanLength() > 2.0;
        };
        {
            InsideUnderTest test;
            QVERIFY(depth_shows(test));
            QTest::keyClick(test.window.get(), Qt::Key_5);
            QTest::qWait(50);
            QVERIFY(!depth_shows(test));
            // The mouse turns, pans and zooms as before; a click tells about what is there.
            QSignalSpy clicks(&test.view(), &MeshView::element_clicked);
            QTest::mouseClick(&test.view(), Qt::LeftButton, {}, test.place_of({0.52, 0.0, 0.47}));
            auto element = clicks.takeLast().at(0).value<std::optional<Index>>();
            QVERIFY(element && test.extent(*element, 1)[0] < 1e-9);
            const double unit = test.view().units_per_pixel({0.5, 0.5, 0.5});
            QWheelEvent wheel(test.place_of({1.0, 0.0, 1.0}), test.view().mapToGlobal(test.place_of({1.0, 0.0, 1.0})),
                              {}, {0, 240}, Qt::NoButton, {}, Qt::NoScrollPhase, false);
            const QPointF corner = test.view().to_display({1.0, 0.0, 1.0});
            QApplication::sendEvent(&test.view(), &wheel);
            QTest::qWait(50);
            QVERIFY(test.view().units_per_pixel({0.5, 0.5, 0.5}) < 0.9 * unit);
            QVERIFY((test.view().to_display({1.0, 0.0, 1.0}) - corner).manhattanLength() < 3.0);
            // Before and now have the same camera.
            test.window->action(CommandId::compare)->trigger();
            QTest::qWait(100);
            auto& before = *test.find<MeshView>("before_view");
            const auto edge = [](const MeshView& view) {
                return view.to_display({1.0, 0.0, 1.0}) - view.to_display({0.0, 1.0, 0.0});
            };
            QVERIFY((edge(before) - edge(test.view())).manhattanLength() < 1.0);
            test.window->action(CommandId::compare)->trigger();
            test.window->close();
        }
        InsideUnderTest again;
        QVERIFY(again.window->action(CommandId::orthographic)->isChecked());
        QVERIFY(!depth_shows(again));
        QTest::keyClick(again.window.get(), Qt::Key_5);
        QTest::qWait(50);
        QVERIFY(depth_shows(again));
        again.open(again.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(!again.window->action(CommandId::orthographic)->isEnabled());
    }
};

QObject* make_test() {
    return new InsideTest;
}

#include "inside_test.moc"
