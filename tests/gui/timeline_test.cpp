/// The timeline: recordings in the window, with a real mouse.

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QToolButton>
#include <QWheelEvent>
#include <fstream>

#include "core/timeline/cursor.h"
#include "core/untangle/trace.h"
#include "tests/gui/gui_test_support.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/timeline_panel.h"
#include "ui/panels/timeline_track.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

/// A window with the deformed annulus, at the untangle panel.
struct TimelineUnderTest : WindowUnderTest {
    TimelineUnderTest() {
        const QString folder = QStringLiteral(CURVEWRIGHT_SAMPLES "/annulus/");
        open(folder + QStringLiteral("annulus.msh"), folder + QStringLiteral("deformation.json"));
        if (!window->jobs().deform() || !wait_for_job()) qFatal("The boundary was not deformed.");
        window->show_tab(QStringLiteral("untangle"));
        QTest::qWait(50);
    }
    void choose(const char* method) {
        auto* box = find<QComboBox>("method");
        box->setCurrentIndex(box->findText(QLatin1String(method)));
    }
    void press(const char* button) {
        auto* widget = find<QWidget>(button);
        if (!widget->isVisible()) qFatal("%s is not seen.", button);
        QTest::mouseClick(widget, Qt::LeftButton);
    }
    void record(const char* method = "Guaranteed") {
        choose(method);
        press("step_by_step_button");
        if (!wait_for_job()) qFatal("The job did not end.");
        QTest::qWait(30);
    }
    StepPlayer& player() { return window->player(); }
    const Recording& recording() { return *player().recording(); }
    MeshDocument& document() { return window->document(); }
    TimelineTrack& track() { return find<TimelinePanel>("timeline_panel")->track(); }
    QDockWidget* dock() { return find<QDockWidget>("timeline_dock"); }
    bool arrive() {
        return QTest::qWaitFor([this] { return !player().is_seeking() && player().shown().step == player().step(); });
    }
    void menu(const char* action) { find<QAction>(action)->trigger(); }
    /// What is shown is the recording's step.
    bool is_right() {
        TimelineCursor cursor(player().recording());
        cursor.seek(player().step());
        const auto& shown = player().shown();
        return shown.step == player().step() && shown.coordinates == cursor.coordinates() &&
               shown.quality.summary.min == cursor.quality().summary.min &&
               shown.quality.summary.valid == cursor.quality().summary.valid;
    }
    QImage picture() { return window->view().picture(1); }
};

}  // namespace

class TimelineTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void is_hidden_until_there_is_a_recording() {
        TimelineUnderTest test;
        QVERIFY(!test.dock()->isVisible());
        QVERIFY(!test.window->action(CommandId::timeline_close)->isEnabled());
        QVERIFY(!test.window->action(CommandId::timeline_show)->isEnabled());
        QVERIFY(!test.window->action(CommandId::timeline_save)->isEnabled());
        test.window->action(CommandId::timeline_close)->trigger();
        QVERIFY(test.errors.isEmpty());
    }

    void step_by_step_is_the_same_untangling_data() {
        QTest::addColumn<QString>("method");
        for (const char* method : {"Guaranteed", "Signed angles", "Unsigned angles"})
            QTest::newRow(method) << QString::fromLatin1(method);
    }
    void step_by_step_is_the_same_untangling() {
        QFETCH(QString, method);
        TimelineUnderTest test;
        const Coordinates tangled = test.document().state().mesh->coordinates();
        const QByteArray name = method.toLatin1();
        test.record(name.constData());
        QVERIFY(test.errors.isEmpty());
        QVERIFY(test.player().is_open() && test.dock()->isVisible() && test.track().isVisible());
        QCOMPARE(test.document().history()->count(), 2);
        const Coordinates result = test.document().state().mesh->coordinates();
        QCOMPARE(test.dock()->windowTitle(), QStringLiteral("Timeline: ") + test.document().history()->undoText());

        // At the start; at the end it is the document's mesh.
        QCOMPARE(test.player().step(), 0u);
        QCOMPARE(test.player().shown().coordinates, tangled);
        QVERIFY(test.text("verdict").contains(QStringLiteral("2")));
        test.press("timeline_to_end");
        QVERIFY(test.arrive() && test.is_right());
        QCOMPARE(test.player().step(), test.recording().step_count() - 1);
        QCOMPARE(test.player().shown().coordinates, result);
        QVERIFY(test.text("timeline_quality").contains(QStringLiteral("all valid")));

        // The same again, without the timeline.
        test.press("timeline_close");
        test.click("tool_undo");
        test.press("untangle_button");
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.document().state().mesh->coordinates(), result);
        QVERIFY(!test.player().is_open());
    }

    void steps_at_every_level() {
        TimelineUnderTest test;
        test.record("Signed angles");
        auto* level = test.find<QComboBox>("timeline_level");
        for (const StepLevel its : {StepLevel::pass, StepLevel::patch, StepLevel::iteration}) {
            test.press("timeline_to_start");
            QVERIFY(test.arrive());
            level->setCurrentIndex(level->findData(static_cast<int>(its)));
            QCOMPARE(test.player().level(), its);
            StepNumber expected = 0;
            for (int i = 0; i < 3; ++i) {
                test.press("timeline_step_forward");
                expected = step_after(test.recording(), expected, its);
                QVERIFY(test.arrive() && test.is_right());
                QCOMPARE(test.player().step(), expected);
            }
            test.press("timeline_step_back");
            QVERIFY(test.arrive() && test.is_right());
            QCOMPARE(test.player().step(), step_before(test.recording(), expected, its));
        }
        // Into: from passes to patches to iterations, and out again.
        test.press("timeline_to_start");
        level->setCurrentIndex(0);
        test.press("timeline_step_into");
        QCOMPARE(test.player().level(), StepLevel::patch);
        QCOMPARE(level->currentData().toInt(), static_cast<int>(StepLevel::patch));
        const StepNumber patch_end = test.player().step();
        QCOMPARE(test.recording().kind(patch_end), StepKind::patch_ended);
        test.press("timeline_step_into");
        QCOMPARE(test.player().step(), patch_end + 1);
        test.press("timeline_step_into");
        const auto patch = test.recording().patch_of(test.player().step());
        QVERIFY(patch.has_value());
        QVERIFY(test.arrive());
        const QString place = test.text("timeline_place");
        QVERIFY2(place.contains(QStringLiteral("pass 1/")) && place.contains(QStringLiteral(" · patch 2/")),
                 qPrintable(place));
        test.press("timeline_step_out");
        QCOMPARE(test.player().step(), test.recording().patches()[*patch].last);
    }

    void bars_compare_the_step_with_the_start_however_they_are_drawn() {
        TimelineUnderTest test;
        test.record("Signed angles");
        QVERIFY(test.arrive());
        const QString start = test.text("before_figures"), end = [&] {
            test.press("timeline_to_end");
            return test.arrive() ? test.text("after_figures") : QString();
        }();
        QVERIFY(start != end && test.text("before_figures") == start);
        test.press("timeline_to_start");
        QVERIFY(test.arrive());
        for (const char* name : {"log_counts", "overlay_bars", "show_group_figures"}) {
            test.find<QCheckBox>(name)->toggle();
            QCOMPARE(test.text("before_figures"), start);
            QCOMPARE(test.text("after_figures"), start);
        }
        test.press("timeline_close");
        QCOMPARE(test.text("before_figures"), start);
        QCOMPARE(test.text("after_figures"), end);
    }

    void long_places_are_read_in_a_small_window() {
        TimelineUnderTest test;
        test.window->resize(1280, 800);
        test.record("Signed angles");
        test.player().set_level(StepLevel::iteration);
        test.player().go_to(test.recording().patches().back().first + 10);
        QVERIFY(test.arrive());
        for (const char* name : {"timeline_place", "timeline_quality"}) {
            const auto* label = test.find<QLabel>(name);
            QVERIFY2(label->fontMetrics().horizontalAdvance(label->text()) <= label->width(),
                     qPrintable(label->text()));
            QVERIFY(label->fontMetrics().height() <= label->height());
        }
    }

    void keys_step_and_play_while_the_track_has_the_keyboard() {
        TimelineUnderTest test;
        test.record("Signed angles");
        QVERIFY(test.track().hasFocus());
        test.player().set_level(StepLevel::iteration);
        QTest::keyClick(&test.track(), Qt::Key_Right);
        QTest::keyClick(&test.track(), Qt::Key_Right);
        QCOMPARE(test.player().step(), 2u);
        QTest::keyClick(&test.track(), Qt::Key_Left);
        QCOMPARE(test.player().step(), 1u);
        QTest::keyClick(&test.track(), Qt::Key_End);
        QCOMPARE(test.player().step(), test.recording().step_count() - 1);
        QTest::keyClick(&test.track(), Qt::Key_Home);
        QCOMPARE(test.player().step(), 0u);
        QVERIFY(test.arrive());
        test.player().set_speed(StepPlayer::min_speed);
        QTest::keyClick(&test.track(), Qt::Key_Space);
        QVERIFY(test.player().is_playing());
        QTest::keyClick(&test.track(), Qt::Key_Space);
        QVERIFY(!test.player().is_playing());
    }

    void plays_to_the_end_and_again_from_the_start() {
        TimelineUnderTest test;
        test.record("Signed angles");
        test.player().set_level(StepLevel::pass);
        test.find<QDoubleSpinBox>("timeline_speed")->setValue(50.0);
        QCOMPARE(test.player().speed(), 50.0);
        QSignalSpy at_end(&test.player(), &StepPlayer::at_end), steps(&test.player(), &StepPlayer::step_changed);
        QSignalSpy playing(&test.player(), &StepPlayer::playing_changed);
        const int history = test.document().history()->count();
        test.press("timeline_play");
        QVERIFY(test.player().is_playing());
        QTRY_COMPARE(at_end.count(), 1);
        QVERIFY(test.arrive() && test.is_right());
        QVERIFY(!test.player().is_playing());
        QCOMPARE(playing.count(), 2);
        QVERIFY(steps.count() >= 2);
        QCOMPARE(test.player().step(), test.recording().step_count() - 1);
        // Again, and pause on the way.
        test.player().set_level(StepLevel::iteration);
        test.player().set_speed(20.0);
        test.press("timeline_play");
        QTRY_VERIFY(test.player().step() > 1 && test.player().step() < test.recording().step_count() / 2);
        test.press("timeline_play");
        QVERIFY(!test.player().is_playing() && test.arrive());
        const StepNumber paused = test.player().step();
        QTest::qWait(200);
        QCOMPARE(test.player().step(), paused);
        QVERIFY(test.is_right());
        QCOMPARE(test.document().history()->count(), history);
        QCOMPARE(test.document().history()->index(), history);
    }

    void the_mouse_scrubs_zooms_and_pans() {
        TimelineUnderTest test;
        test.record();
        TimelineTrack& track = test.track();
        const StepNumber count = test.recording().step_count();
        QVERIFY(count > 50);
        const auto at = [&](StepNumber step, int y = 8) { return QPoint(static_cast<int>(track.x_of(step)), y); };
        QTest::mousePress(&track, Qt::LeftButton, {}, at(count / 4));
        QVERIFY(test.arrive());
        QCOMPARE(test.player().step(), track.step_at(at(count / 4).x()));
        QTest::mouseMove(&track, at(count / 2));
        QTest::mouseMove(&track, at(count / 2) + QPoint(1, 0));
        QVERIFY(test.arrive() && test.is_right());
        QCOMPARE(test.player().step(), track.step_at(at(count / 2).x() + 1));
        QTest::mouseRelease(&track, Qt::LeftButton, {}, at(count / 2) + QPoint(1, 0));
        QTest::mouseMove(&track, at(count / 3));
        QTest::qWait(20);
        QCOMPARE(test.player().step(), track.step_at(at(count / 2).x() + 1));

        // The wheel: what is under the pointer stays there.
        const auto wheel = [&](int notches, Qt::KeyboardModifiers modifiers = {}) {
            QWheelEvent event(QPointF(at(count / 2)), track.mapToGlobal(at(count / 2)), {}, {0, 120 * notches},
                              Qt::NoButton, modifiers, Qt::NoScrollPhase, false);
            QApplication::sendEvent(&track, &event);
        };
        QCOMPARE(track.length(), double(count));
        const double x = track.x_of(count / 2);
        wheel(4);
        QVERIFY(track.length() < 0.5 * count);
        QVERIFY(std::abs(track.x_of(count / 2) - x) < 4.0);
        const double first = track.first();
        wheel(1, Qt::ShiftModifier);
        QVERIFY(track.first() < first);
        const double panned = track.first();
        QTest::mousePress(&track, Qt::MiddleButton, {}, QPoint(300, 60));
        QMouseEvent move(QEvent::MouseMove, QPointF(350, 60), track.mapToGlobal(QPointF(350, 60)), Qt::NoButton,
                         Qt::MiddleButton, {});
        QApplication::sendEvent(&track, &move);
        QTest::mouseRelease(&track, Qt::MiddleButton, {}, QPoint(350, 60));
        QVERIFY(track.first() < panned);
        wheel(-20);
        QCOMPARE(track.length(), double(count));

        // A double click zooms to a patch, once more to everything.
        const auto patches = test.recording().patches();
        const RecordedPatch& longest = *std::max_element(
            patches.begin(), patches.end(),
            [](const RecordedPatch& a, const RecordedPatch& b) { return a.last - a.first < b.last - b.first; });
        const QPoint patch_row = at((longest.first + longest.last) / 2, 38);
        QTest::mouseDClick(&track, Qt::LeftButton, {}, patch_row);
        QVERIFY(track.length() < 1.2 * (longest.last - longest.first + 1) + 8.0);
        QVERIFY(track.first() <= longest.first && track.first() + track.length() >= longest.last);
        const QString tip = track.describe(QPointF(at((longest.first + longest.last) / 2, 38)));
        QVERIFY2(tip.contains(QStringLiteral("patch %1").arg(longest.number)), qPrintable(tip));
    }

    void jumps() {
        TimelineUnderTest test;
        test.record("Unsigned angles");
        test.menu("jump_worst");
        QVERIFY(test.arrive() && test.is_right());
        QCOMPARE(test.player().step(), worst_step(test.recording()));
        const auto& start = test.recording().start_quality().elements;
        const auto tangled = static_cast<Index>(
            std::find_if(start.begin(), start.end(), [](const auto& q) { return q.validity == Validity::invalid; }) -
            start.begin());
        test.window->edit().select_elements({tangled});
        test.menu("jump_selected");
        const auto validity = step_of_validity(test.recording(), tangled);
        QVERIFY(validity && *validity > 0);
        QCOMPARE(test.player().step(), *validity);
        QVERIFY(test.arrive());
        QCOMPARE(test.player().shown().quality.elements[tangled].validity, Validity::valid);
        test.menu("jump_start");
        QCOMPARE(test.player().step(), 0u);
        test.text_answer = QString::number(test.recording().mesh().topology().element_tag(tangled).value);
        test.menu("jump_element");
        QCOMPARE(test.player().step(), *validity);
        test.text_answer = QStringLiteral("no number");
        test.menu("jump_element");
        QCOMPARE(test.player().step(), *validity);
        test.menu("jump_end");
        QCOMPARE(test.player().step(), test.recording().step_count() - 1);
    }

    void stops_at_breakpoints() {
        TimelineUnderTest test;
        test.record();
        QSignalSpy at_break(&test.player(), &StepPlayer::at_break), at_end(&test.player(), &StepPlayer::at_end);
        test.player().set_speed(StepPlayer::max_speed);
        test.player().set_level(StepLevel::patch);
        test.find<QAction>("break_crossing")->trigger();
        Breakpoints crossing;
        crossing.min_crosses_zero = true;
        const auto expected = next_break(test.recording(), 0, crossing);
        QVERIFY(expected.has_value());
        test.press("timeline_play");
        QTRY_COMPARE(at_break.count(), 1);
        QVERIFY(test.arrive() && test.is_right());
        QCOMPARE(test.player().step(), *expected);
        QVERIFY(!test.player().is_playing());
        QVERIFY(test.text("timeline_quality").contains(QStringLiteral("all valid")));

        // A selected node: where its patches begin.
        test.menu("break_clear");
        QVERIFY(test.player().breakpoints().is_empty());
        QVERIFY(!test.find<QAction>("break_crossing")->isChecked());
        const auto began =
            std::get<untangle_event::PatchBegan>(test.recording().read(test.recording().patches().back().first));
        test.window->edit().select_nodes({began.nodes.front()});
        test.menu("break_nodes");
        Breakpoints node;
        node.nodes = {began.nodes.front()};
        QTRY_COMPARE(test.player().break_steps(), break_steps(test.recording(), node));
        test.press("timeline_to_start");
        for (const StepNumber step : test.player().break_steps()) {
            at_break.clear();
            test.press("timeline_play");
            QTRY_COMPARE(at_break.count(), 1);
            QCOMPARE(test.player().step(), step);
            QCOMPARE(next_break(test.recording(), step - 1, node), step);
        }
        test.press("timeline_play");
        QTRY_COMPARE(at_end.count(), 1);
    }

    void closing_shows_the_document_again() {
        TimelineUnderTest test;
        test.record();
        const MeshState state = test.document().state();
        QVERIFY(test.window->action(CommandId::tool_drag)->isChecked());
        QVERIFY(!test.window->drag().can_begin());
        test.press("timeline_to_start");
        QVERIFY(test.arrive());
        QTest::qWait(30);
        const QImage tangled = test.picture();
        const QString verdict = test.text("verdict");
        test.press("timeline_close");
        QVERIFY(!test.player().is_open() && !test.dock()->isVisible());
        QCOMPARE(test.document().state().mesh, state.mesh);
        QVERIFY(test.text("verdict") != verdict);
        QVERIFY(test.picture() != tangled);
        QVERIFY(test.window->drag().can_begin());
        QCOMPARE(test.document().history()->index(), 2);

        // Once more what is in the history, from whatever state.
        test.window->action(CommandId::timeline_show)->trigger();
        QVERIFY(test.wait_for_job());
        QVERIFY(test.player().is_open());
        QCOMPARE(test.document().state().mesh, state.mesh);
        QCOMPARE(test.picture(), tangled);
        test.press("timeline_to_end");
        QVERIFY(test.arrive());
        QCOMPARE(test.player().shown().coordinates, state.mesh->coordinates());

        // Undo goes to another state: the timeline gives way.
        test.click("tool_undo");
        QVERIFY(!test.player().is_open() && !test.dock()->isVisible());
        QCOMPARE(test.document().history()->index(), 1);
        QVERIFY(!test.window->action(CommandId::timeline_show)->isEnabled());
    }

    void a_saved_trace_comes_back() {
        TimelineUnderTest test;
        test.record("Signed angles");
        const auto recording = test.player().recording();
        test.file_answer = test.inputs.path(QStringLiteral("run.jsonl"));
        test.window->action(CommandId::timeline_save)->trigger();
        QVERIFY(test.wait_for_job() && test.errors.isEmpty());
        QVERIFY(test.player().is_open());
        test.press("timeline_close");
        test.window->action(CommandId::timeline_open)->trigger();
        QVERIFY(test.wait_for_job());
        QVERIFY(test.errors.isEmpty() && test.player().is_open());
        QCOMPARE(test.dock()->windowTitle(), QStringLiteral("Timeline: run.jsonl"));
        QCOMPARE(test.recording().step_count(), recording->step_count());
        QCOMPARE(test.recording().patches().size(), recording->patches().size());
        for (const StepNumber step : {recording->step_count() / 3, recording->step_count() - 1}) {
            TimelineCursor cursor(recording);
            cursor.seek(step);
            test.player().go_to(step);
            QVERIFY(test.arrive());
            QVERIFY((test.player().shown().coordinates - cursor.coordinates()).cwiseAbs().maxCoeff() < 1e-12);
        }
        QCOMPARE(test.document().history()->count(), 2);
    }

    void a_hostile_trace_leaves_everything_as_it_was() {
        TimelineUnderTest test;
        test.record("Signed angles");
        test.press("timeline_step_forward");
        QVERIFY(test.arrive());
        const auto recording = test.player().recording();
        const StepNumber step = test.player().step();
        test.file_answer = test.inputs.path(QStringLiteral("hostile.jsonl"));
        for (const char* text : {"", "{", "[1, 2]\n", "{\"event\": \"started\"}\n", "{\"event\": \"finished\"}\n",
                                 "{\"event\": \"started\", \"nodes\": [1e999], \"positions\": \"x\"}\n"}) {
            std::ofstream(test.file_answer.toStdString()) << text;
            test.errors.clear();
            test.window->action(CommandId::timeline_open)->trigger();
            QVERIFY(test.wait_for_job());
            QVERIFY2(test.errors.size() == 1, text);
            QVERIFY2(test.errors.front().contains(QStringLiteral("hostile.jsonl")), qPrintable(test.errors.front()));
            QCOMPARE(test.player().recording(), recording);
            QCOMPARE(test.player().step(), step);
            QVERIFY(test.is_right());
        }
        QCOMPARE(test.document().history()->count(), 2);
    }

    void a_warp_in_increments_can_be_gone_through() {
        WindowUnderTest test;
        const QString folder = QStringLiteral(CURVEWRIGHT_SAMPLES "/annulus/");
        test.open(folder + QStringLiteral("annulus.msh"), folder + QStringLiteral("deformation.json"));
        IncrementOptions increments;
        increments.steps = 3;
        QVERIFY(test.window->jobs().warp({}, increments) && test.wait_for_job());
        QVERIFY(!test.window->player().is_open());
        const auto result = test.window->document().state().mesh;
        test.window->action(CommandId::timeline_show)->trigger();
        QVERIFY(test.wait_for_job());
        QVERIFY2(test.errors.isEmpty(), qPrintable(test.errors.join(QLatin1Char(' '))));
        StepPlayer& player = test.window->player();
        QVERIFY(player.is_open());
        player.set_level(StepLevel::patch);
        for (const char* percent : {"33.3 %", "66.7 %", "100 %"}) {
            player.step_by(1);
            QTRY_VERIFY(!player.is_seeking() && player.shown().step == player.step());
            QCOMPARE(player.recording()->kind(player.step()), StepKind::increment);
            QVERIFY2(test.text("timeline_place").contains(QString::fromUtf8(percent)),
                     qPrintable(test.text("timeline_place")));
        }
        QCOMPARE(player.shown().coordinates, result->coordinates());
        QCOMPARE(test.window->document().state().mesh, result);
        QCOMPARE(test.window->document().history()->count(), 1);
    }

    void another_mesh_closes_it() {
        TimelineUnderTest test;
        test.record();
        test.player().set_speed(StepPlayer::max_speed);
        test.press("timeline_play");
        test.unsaved_answer = UnsavedAnswer::discard;
        test.open(test.inputs.path(QStringLiteral("cube.msh")));
        QVERIFY(!test.player().is_open() && !test.dock()->isVisible());
        QTest::qWait(50);
        QVERIFY(test.errors.isEmpty());
    }

    void nothing_is_clipped_at_1280_by_800() {
        TimelineUnderTest test;
        test.window->resize(1280, 800);
        test.record();
        QTest::qWait(50);
        auto* panel = test.find<TimelinePanel>("timeline_panel");
        QVERIFY(panel->height() >= panel->minimumSizeHint().height());
        QVERIFY2(panel->width() >= panel->minimumSizeHint().width(),
                 qPrintable(QString::number(panel->minimumSizeHint().width())));
        QVERIFY(test.window->height() <= 800 && test.window->width() <= 1280);
        for (const QWidget* child : panel->findChildren<QWidget*>())
            if (child->isVisible() && child->parentWidget() == panel)
                QVERIFY(panel->rect().contains(child->geometry()));
        auto* button = test.find<QPushButton>("step_by_step_button");
        QVERIFY(button->width() >= button->minimumSizeHint().width());
    }
};

QObject* make_test() {
    return new TimelineTest;
}

#include "timeline_test.moc"
