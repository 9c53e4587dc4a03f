/// Ways of looking at a mesh: side by side, shrunk, only the worst.

#include <QDialog>
#include <QLineEdit>
#include <QListWidget>
#include <QSettings>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTreeWidget>

#include "tests/gui/drag_under_test.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

struct LookingUnderTest : DragUnderTest {
    using DragUnderTest::DragUnderTest;
    MeshView& before_view() { return *find<MeshView>("before_view"); }
    void toggle(CommandId id) {
        window->action(id)->trigger();
        QTest::qWait(60);
    }
    /// Pixels of the picture that are not of the ground.
    static int drawn(const QImage& picture) {
        const QRgb ground = picture.pixel(1, 1);
        int count = 0;
        for (int y = 0; y < picture.height(); ++y)
            for (int x = 0; x < picture.width(); ++x) count += picture.pixel(x, y) != ground;
        return count;
    }
};

int differing(const QImage& a, const QImage& b) {
    if (a.size() != b.size()) return a.width() * a.height();
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) count += a.pixel(x, y) != b.pixel(x, y);
    return count;
}

}  // namespace

class LookingTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void directions_are_what_they_are_called() {
        LookingUnderTest test("cube.msh");
        const struct {
            CommandId command;
            Eigen::Vector3d towards_the_eye;
        } directions[] = {{CommandId::look_front, {0, -1, 0}}, {CommandId::look_back, {0, 1, 0}},
                          {CommandId::look_left, {-1, 0, 0}},  {CommandId::look_right, {1, 0, 0}},
                          {CommandId::look_top, {0, 0, 1}},    {CommandId::look_bottom, {0, 0, -1}}};
        for (const auto& entry : directions) {
            test.window->action(entry.command)->trigger();
            QVERIFY2((test.view().view_axes().col(2) - entry.towards_the_eye).norm() < 1e-9,
                     qPrintable(test.window->action(entry.command)->objectName()));
        }
    }

    void before_and_now_stand_side_by_side() {
        LookingUnderTest test;
        QVERIFY(!test.before_view().isVisible());
        const Index node = test.node_at(0.5, 0.0);
        test.drag_node(node, {20, -30});
        const Coordinates now = test.positions(), before = test.document().before().mesh->coordinates();
        test.toggle(CommandId::compare);
        QVERIFY(test.before_view().isVisible());
        QVERIFY(std::abs(test.before_view().width() - test.view().width()) < 20);
        // The same camera: the same point shows at the same place, from the middle of each view.
        const auto from_middle = [](const MeshView& view, const Eigen::RowVector3d& point) {
            return view.to_display(point) - QPointF(view.width(), view.height()) / 2.0;
        };
        const auto is_linked = [&] {
            const QPointF a = from_middle(test.view(), Eigen::RowVector3d(1.0, 1.0, 0.0)) -
                              from_middle(test.view(), Eigen::RowVector3d(0.0, 0.0, 0.0));
            const QPointF b = from_middle(test.before_view(), Eigen::RowVector3d(1.0, 1.0, 0.0)) -
                              from_middle(test.before_view(), Eigen::RowVector3d(0.0, 0.0, 0.0));
            return (a - b).manhattanLength() < 1.0;
        };
        QVERIFY(is_linked());
        // Zooming in either zooms both.
        for (MeshView* view : {&test.view(), &test.before_view()}) {
            const double unit = test.unit();
            QWheelEvent event(view->rect().center(), view->mapToGlobal(view->rect().center()), {}, {0, 240},
                              Qt::NoButton, {}, Qt::NoScrollPhase, false);
            QApplication::sendEvent(view, &event);
            QTest::qWait(60);
            QVERIFY(test.unit() < 0.8 * unit);
            QVERIFY(is_linked());
        }
        // What is dragged now does not change what was before; undo shows the steps before that.
        const QImage left = test.before_view().picture(1);
        test.toggle(CommandId::fit);
        test.click("tool_undo");
        QCOMPARE(test.positions(), before);
        test.click("tool_redo");
        QCOMPARE(test.positions(), now);
        QVERIFY(!left.isNull());
        test.toggle(CommandId::compare);
        QVERIFY(!test.before_view().isVisible());
    }

    void what_was_seen_is_seen_in_half_the_width() {
        LookingUnderTest test;
        const auto from_middle = [&](double x, double y) {
            return test.view().to_display(Eigen::RowVector3d(x, y, 0.0)) - test.view().free_area().center();
        };
        const auto is_near = [](QPointF a, QPointF b) { return (a - b).manhattanLength() < 3.0; };
        // Fitted: fitted again.
        test.toggle(CommandId::compare);
        QTest::qWait(300);
        QVERIFY(test.view().keeps_fitted());
        test.toggle(CommandId::compare);
        QVERIFY(test.view().keeps_fitted());
        // Moved: what was seen stays where it was, smaller, and comes back.
        QTest::keyClick(&test.view(), Qt::Key_Right);
        QTest::keyClick(&test.view(), Qt::Key_Up);
        QTest::qWait(60);
        QVERIFY(!test.view().keeps_fitted());
        const QPointF whole = from_middle(1.0, 0.0);
        const double width = test.view().free_area().width();
        test.toggle(CommandId::compare);
        const double share = test.view().free_area().width() / width;
        QVERIFY(share < 0.5);
        QTRY_VERIFY(is_near(from_middle(1.0, 0.0), whole * share));
        const ViewPose there = test.view().pose();
        QTRY_COMPARE(test.before_view().pose().scale, there.scale);
        test.toggle(CommandId::compare);
        QTRY_VERIFY(is_near(from_middle(1.0, 0.0), whole));
    }

    void shrunk_elements_leave_gaps_and_still_move() {
        LookingUnderTest test;
        const int whole = LookingUnderTest::drawn(test.view().picture(1));
        test.toggle(CommandId::shrink);
        const int shrunk = LookingUnderTest::drawn(test.view().picture(1));
        QVERIFY2(shrunk < 0.8 * whole && shrunk > 0.4 * whole,
                 qPrintable(QStringLiteral("%1 %2").arg(whole).arg(shrunk)));
        test.drag_node(test.node_at(0.5, 0.0), {0, 40});
        QVERIFY(LookingUnderTest::drawn(test.view().picture(1)) > shrunk);
        test.toggle(CommandId::shrink);
        QVERIFY(LookingUnderTest::drawn(test.view().picture(1)) > 0.95 * whole);
    }

    void commands_are_found_by_name() {
        LookingUnderTest test;
        test.window->action(CommandId::palette)->trigger();
        auto* words = test.find<QLineEdit>("palette_words");
        auto* list = test.find<QListWidget>("palette_list");
        QVERIFY(list->count() > 20);
        // What cannot run is not offered.
        QTest::keyClicks(words, QStringLiteral("warp"));
        for (int row = 0; row < list->count(); ++row)
            QVERIFY(list->item(row)->data(Qt::UserRole).toInt() != static_cast<int>(CommandId::warp));
        words->clear();
        QTest::keyClicks(words, QStringLiteral("gaps"));  // by what it does
        QCOMPARE(list->count(), 1);
        QTest::keyClick(words, Qt::Key_Return);
        QVERIFY(QTest::qWaitFor([&] { return test.window->action(CommandId::shrink)->isChecked(); }));
        QVERIFY(!test.window->findChild<QDialog*>(QStringLiteral("command_palette")));
        // Escape runs nothing.
        test.window->action(CommandId::palette)->trigger();
        words = test.find<QLineEdit>("palette_words");
        QTest::keyClicks(words, QStringLiteral("shrink elem"));
        QTest::keyClick(words, Qt::Key_Escape);
        QTest::qWait(50);
        QVERIFY(test.window->action(CommandId::shrink)->isChecked());
    }

    void only_the_worst_are_shown() {
        LookingUnderTest test;
        test.drag_node(test.node_at(0.5, 0.0), {0, -40});
        const int all = LookingUnderTest::drawn(test.view().picture(1));
        test.toggle(CommandId::worst_only);
        QVERIFY(LookingUnderTest::drawn(test.view().picture(1)) < 0.7 * all);
        const auto worst = test.document().state().quality->worst(10);
        for (Index element = 0; element < test.topology().element_count(); ++element)
            QCOMPARE(test.view().draws_element(element), std::count(worst.begin(), worst.end(), element) == 1);
        // They follow the history.
        test.click("tool_undo");
        const auto first = test.document().state().quality->worst(10);
        for (const Index element : first) QVERIFY(test.view().draws_element(element));
        test.toggle(CommandId::worst_only);
        for (Index element = 0; element < test.topology().element_count(); ++element)
            QVERIFY(test.view().draws_element(element));
    }

    void as_many_of_the_worst_as_wanted() {
        {
            LookingUnderTest test;
            test.drag_node(test.node_at(0.5, 0.0), {0, -40});
            test.toggle(CommandId::worst_only);
            auto* count = test.find<QSpinBox>("worst_count");
            auto* table = test.find<QTreeWidget>("worst_elements");
            QCOMPARE(count->value(), 10);
            count->selectAll();
            // Half a number is none yet.
            QTest::keyClicks(count, QStringLiteral("17"));
            QCOMPARE(table->topLevelItemCount(), 10);
            QTest::keyClick(count, Qt::Key_Return);
            for (const int wanted : {17, 3}) {
                count->setValue(wanted);
                const auto worst = test.document().state().quality->worst(std::size_t(wanted));
                QCOMPARE(table->topLevelItemCount(), wanted);
                for (int row = 0; row < wanted; ++row)
                    QCOMPARE(table->topLevelItem(row)->text(0),
                             QString::number(test.topology().element_tag(worst[std::size_t(row)]).value));
                for (Index element = 0; element < test.topology().element_count(); ++element)
                    QCOMPARE(test.view().draws_element(element), std::count(worst.begin(), worst.end(), element) == 1);
            }
            // More than there are: all.
            count->setValue(1000);
            QCOMPARE(table->topLevelItemCount(), int(test.topology().element_count()));
            // A bookmark knows how many it showed.
            count->setValue(3);
            test.window->action(CommandId::bookmark_add)->trigger();
            count->setValue(5);
            test.find<QAction>("bookmark_1")->trigger();
            QCOMPARE(count->value(), 3);
            test.document().mark_unchanged();
        }
        LookingUnderTest later;
        QCOMPARE(later.find<QSpinBox>("worst_count")->value(), 3);
        QCOMPARE(later.find<QTreeWidget>("worst_elements")->topLevelItemCount(), 3);
        later.toggle(CommandId::worst_only);
        int drawn = 0;
        for (Index element = 0; element < later.topology().element_count(); ++element)
            drawn += later.view().draws_element(element);
        QCOMPARE(drawn, 3);
        later.toggle(CommandId::worst_only);
    }

    void other_sizes_are_drawn_once() {
        LookingUnderTest test;
        MeshView& view = test.view();
        QVERIFY(QTest::qWaitFor([&] { return !view.has_frame_under_way(); }));
        const QSize first = view.size();
        QSignalSpy drawn(&view, &MeshView::frame_drawn);
        for (const int step : {10, 20, 30}) view.resize(first + QSize(step, step));
        QCOMPARE(drawn.count(), 0);
        QTRY_COMPARE(drawn.count(), 1);
        QCOMPARE(view.grabFramebuffer().size(), view.device_size());
        QCOMPARE(view.picture(1).size(), view.device_size());
    }

    void until_another_size_is_drawn_the_middle_of_the_picture_stays() {
        LookingUnderTest test;
        MeshView& view = test.view();
        view.set_drawing_mode(DrawingMode::behind);
        const auto is_settled = [&] { return !view.has_frame_under_way(); };
        QVERIFY(QTest::qWaitFor(is_settled));
        const QSize first = view.size();
        const QImage picture = view.grabFramebuffer();
        view.resize(first - QSize(60, 40));
        const QImage smaller = view.grabFramebuffer();
        QCOMPARE(smaller.size(), picture.size() - QSize(60, 40));
        QCOMPARE(differing(smaller, picture.copy(30, 20, smaller.width(), smaller.height())), 0);
        QVERIFY(QTest::qWaitFor(is_settled));
        view.resize(first);
        QVERIFY(QTest::qWaitFor(is_settled));
        QCOMPARE(differing(view.grabFramebuffer(), picture), 0);
        // Narrower and higher at once.
        view.resize(first + QSize(-60, 40));
        const QImage other = view.grabFramebuffer();
        QCOMPARE(differing(other.copy(0, 20, other.width(), picture.height()),
                           picture.copy(30, 0, other.width(), picture.height())),
                 0);
        QCOMPARE(other.pixel(other.width() / 2, 5), picture.pixel(1, 1));
    }

    void the_first_picture_of_a_mesh_is_drawn_behind() {
        LookingUnderTest test;
        MeshView& view = test.view();
        view.set_drawing_mode(DrawingMode::automatic);
        QSignalSpy begun(&view, &MeshView::frame_begun);
        test.open(test.inputs.path(QStringLiteral("cube.msh")));
        QVERIFY(view.has_frame_under_way());
        QTRY_VERIFY(!view.has_frame_under_way());
        QVERIFY(begun.count() > 0);
        QVERIFY(LookingUnderTest::drawn(view.grabFramebuffer()) > 1000);
    }

    void what_is_prepared_behind_is_what_is_shown_in_the_end() {
        LookingUnderTest small;
        const QImage usual = small.view().picture(1);
        constexpr int few = 30;  // pixels: sides that were curved once stay cut finer
        const Index before = std::exchange(MeshView::least_nodes_prepared, 0);
        {
            LookingUnderTest test;
            MeshView& view = test.view();
            view.set_drawing_mode(DrawingMode::behind);
            const auto wait = [&view] { return QTest::qWaitFor([&] { return !view.has_frame_under_way(); }); };
            QVERIFY(wait());
            QVERIFY(differing(view.picture(1), usual) <= few);
            // Another mesh: nothing of the one before can be pointed at, and of several the last one is shown.
            const QString square = test.inputs.path(QStringLiteral("square.msh"));
            QSignalSpy shown(&view, &MeshView::content_shown);
            test.open(test.inputs.path(QStringLiteral("cube.msh")));
            QVERIFY(view.is_preparing());
            QVERIFY(!view.element_at(QPointF(0.4 * view.width(), 0.5 * view.height())));
            QCOMPARE(shown.count(), 0);
            test.open(square);
            QVERIFY(wait());
            QVERIFY(view.is_flat());
            QVERIFY(shown.count() <= 2);
            QVERIFY(differing(view.picture(1), usual) <= few);
            // A state and its colours come together, with all that was changed meanwhile.
            test.drag_node(test.node_at(0.5, 0.0), {0, -40});
            test.point_at({5, 5});  // away from what would show under the pointer
            const QImage bent = view.picture(1);
            QVERIFY(differing(bent, usual) > 20 * few);
            test.click("tool_undo");
            QVERIFY(view.is_preparing());
            test.window->action(CommandId::edges)->trigger();
            test.window->action(CommandId::shrink)->trigger();
            test.window->action(CommandId::select_all)->trigger();
            test.window->action(CommandId::select_none)->trigger();
            test.window->action(CommandId::edges)->trigger();
            test.window->action(CommandId::shrink)->trigger();
            QVERIFY(wait());
            QVERIFY(differing(view.picture(1), usual) <= few);
            test.click("tool_redo");
            QVERIFY(wait());
            QVERIFY(differing(view.picture(1), bent) <= few);
            // Stopped: what is shown stays, until something changes.
            QSignalSpy stopped(&view, &MeshView::not_drawn);
            test.click("tool_undo");
            view.stop_preparing();
            QCOMPARE(stopped.count(), 1);
            QVERIFY(wait());
            QVERIFY(differing(view.picture(1), bent) <= few);
            test.window->action(CommandId::shrink)->trigger();
            test.window->action(CommandId::shrink)->trigger();
            QVERIFY(wait());
            QVERIFY(differing(view.picture(1), usual) <= few);
            // In parts it is the same picture, and so if something changes between two of them.
            const QImage whole = view.grabFramebuffer();
            const long long points = std::exchange(MeshScene::most_points_of_part, 1);
            QAction* edges = test.window->action(CommandId::edges);
            bool is_in_parts = false;
            connect(
                &view, &MeshView::frame_begun, &view, [&] { is_in_parts = view.scene().has_more_parts(); },
                Qt::SingleShotConnection);
            edges->trigger();
            QVERIFY(wait());
            QVERIFY(is_in_parts);
            QVERIFY(view.grabFramebuffer() != whole);
            edges->trigger();
            QVERIFY(wait());
            QVERIFY(view.grabFramebuffer() == whole);
            connect(&view, &MeshView::frame_begun, edges, &QAction::trigger, Qt::SingleShotConnection);
            edges->trigger();
            QVERIFY(wait());
            QVERIFY(edges->isChecked());
            QVERIFY(view.grabFramebuffer() == whole);
            // The camera may go on meanwhile: the frame is finished as it was begun, and the next one follows.
            int frames_begun = 0;
            QImage finished;
            const auto zooming = connect(&view, &MeshView::frame_begun, &view, [&] {
                if (++frames_begun == 1) test.window->action(CommandId::zoom_in)->trigger();
            });
            const auto keeping = connect(&view, &QOpenGLWidget::frameSwapped, &view, [&] {
                if (frames_begun == 1 && finished.isNull()) finished = view.grabFramebuffer();
            });
            view.set_drawing_mode(DrawingMode::behind);  // another frame
            QVERIFY(wait());
            disconnect(zooming);
            disconnect(keeping);
            QCOMPARE(frames_begun, 2);
            QVERIFY(finished == whole);
            QVERIFY(view.grabFramebuffer() != whole);
            test.window->action(CommandId::zoom_out)->trigger();
            QVERIFY(wait());
            QVERIFY(differing(view.grabFramebuffer(), whole) <= few);
            // Another state while a frame of the one before is under way: that begins again, and in parts, too.
            QVERIFY(test.document().history()->canRedo());
            int frames_in_parts = 0;
            const auto counting = connect(&view, &MeshView::frame_begun, &view, [&] {
                frames_in_parts += view.scene().has_more_parts();
                if (frames_in_parts > 1) return;
                test.click("tool_redo");
                view.finish_preparing();
            });
            edges->trigger();
            QVERIFY(wait());
            disconnect(counting);
            QCOMPARE(frames_in_parts, 2);
            edges->trigger();
            QVERIFY(wait());
            QVERIFY(differing(view.picture(1), bent) <= few);
            test.click("tool_undo");
            QVERIFY(wait());
            QVERIFY(differing(view.picture(1), usual) <= few);
            // A solid, whose parts hide each other, with the axes in the corner.
            test.document().mark_unchanged();
            MeshScene::most_points_of_part = points;
            test.open(test.inputs.path(QStringLiteral("cube.msh")));
            QVERIFY(wait());
            for (const auto change :
                 {CommandId::shrink, CommandId::clip, CommandId::nodes, CommandId::element_numbers}) {
                test.window->action(change)->trigger();
                QVERIFY(wait());
                const QImage solid = view.grabFramebuffer();
                MeshScene::most_points_of_part = 1;
                is_in_parts = false;
                connect(
                    &view, &MeshView::frame_begun, &view, [&] { is_in_parts = view.scene().has_more_parts(); },
                    Qt::SingleShotConnection);
                view.set_drawing_mode(DrawingMode::behind);  // another frame
                QVERIFY(wait());
                QVERIFY(is_in_parts);
                QCOMPARE(differing(view.grabFramebuffer(), solid), 0);
                MeshScene::most_points_of_part = points;
            }
            test.window->action(CommandId::clip)->trigger();
            test.window->action(CommandId::shrink)->trigger();
            test.window->action(CommandId::nodes)->trigger();
            test.window->action(CommandId::element_numbers)->trigger();
            test.open(square);
            QVERIFY(wait());
            // Closed before it was ready.
            test.click("tool_redo");
            test.document().mark_unchanged();
            test.window->action(CommandId::close_mesh)->trigger();
            QVERIFY(!view.is_preparing());
            QTest::qWait(50);
            test.open(square);
            QVERIFY(wait());
            QVERIFY(differing(view.picture(1), usual) <= few);
        }
        MeshView::least_nodes_prepared = before;
    }
};

QObject* make_test() {
    return new LookingTest;
}

#include "looking_test.moc"
