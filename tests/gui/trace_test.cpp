/// Traces of every method on samples: they open, play, can be scrubbed, and every place explains itself.

#include <QLabel>
#include <QSettings>
#include <QSignalSpy>
#include <fstream>

#include "core/base/error.h"
#include "core/io/deformation_file.h"
#include "core/io/mesh_io.h"
#include "core/timeline/cursor.h"
#include "core/untangle/trace.h"
#include "tests/gui/gui_test_support.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/step_panel.h"
#include "ui/panels/timeline_panel.h"
#include "ui/panels/timeline_track.h"
#include "ui/tools/step_marks.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

constexpr int most_events = 1000;  ///< of a trace; the method is stopped then

/// Writes a trace and stops the method when it is long enough.
class LimitedTrace : public UntangleObserver {
  public:
    LimitedTrace(std::ostream& stream, std::stop_source stop) : writer_(stream), stop_(std::move(stop)) {}
    void on_event(const UntangleEvent& event) override {
        if (written_ == most_events) return;
        writer_.on_event(event);
        if (++written_ == most_events) stop_.request_stop();
    }

  private:
    TraceWriter writer_;
    std::stop_source stop_;
    int written_ = 0;
};

void write_trace(const QString& file, const CurvedMesh& mesh, const UntangleOptions& options) {
    std::ofstream stream(file.toStdString());
    std::stop_source stop;
    LimitedTrace trace(stream, stop);
    const TaskContext context{stop.get_token(), {}};
    try {
        if (const auto* its = std::get_if<GuaranteedOptions>(&options))
            untangle_guaranteed(mesh, *its, &trace, context);
        else if (const auto* of_signed = std::get_if<SignedAngleOptions>(&options))
            untangle_signed_angles(mesh, *of_signed, &trace, context);
        else
            untangle_unsigned_angles(mesh, std::get<UnsignedAngleOptions>(options), &trace, context);
    } catch (const Cancelled&) {
        // Long enough.
    }
}

}  // namespace

class TraceTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void explains_itself_data() {
        QTest::addColumn<QString>("sample");
        QTest::addColumn<QString>("file");
        QTest::newRow("annulus") << QStringLiteral("annulus") << QStringLiteral("annulus.msh");
        for (const char* name : {"bike_gear", "gear", "bl_airfoil"})
            QTest::newRow(name) << QString::fromLatin1(name) << QString::fromLatin1(name) + QStringLiteral(".msh.gz");
    }
    void explains_itself() {
        QFETCH(QString, sample);
        QFETCH(QString, file);
        const QString folder = QStringLiteral(CURVEWRIGHT_SAMPLES "/") + sample + QLatin1Char('/');
        const CurvedMesh mesh = read_mesh((folder + file).toStdString()).mesh;
        const Deformation deformation = read_deformation((folder + QStringLiteral("deformation.json")).toStdString());
        const CurvedMesh tangled = mesh.with_coordinates(apply_deformation(mesh, deformation));
        SignedAngleOptions given{.beta = 0.01, .max_passes = 2},
            automatic{.beta_choice = BetaChoice::automatic, .max_passes = 2};
        UnsignedAngleOptions unsigned_angles;
        unsigned_angles.max_passes = 2;
        const std::pair<const char*, UntangleOptions> methods[] = {{"signed", given},
                                                                   {"automatic", automatic},
                                                                   {"unsigned", unsigned_angles},
                                                                   {"guaranteed", GuaranteedOptions{}}};

        WindowUnderTest test;
        test.open(folder + file);
        MeshDocument& document = test.window->document();
        StepPlayer& player = test.window->player();
        const auto arrives = [&] {
            return QTest::qWaitFor([&] { return !player.is_seeking() && player.shown().step == player.step(); }, 20000);
        };
        const auto present = document.state().mesh;
        const Coordinates positions = present->coordinates();
        for (const auto& [name, options] : methods) {
            test.file_answer = test.inputs.path(QLatin1String(name) + QStringLiteral(".jsonl"));
            write_trace(test.file_answer, tangled, options);
            test.window->action(CommandId::timeline_open)->trigger();
            QVERIFY(test.wait_for_job());
            QVERIFY2(test.errors.isEmpty(), qPrintable(test.errors.join(QLatin1Char('\n'))));
            QVERIFY(player.is_open());
            const auto recording = player.recording();
            QCOMPARE(player.shown().coordinates, tangled.coordinates());
            QVERIFY2(recording->step_count() > 10, name);
            QVERIFY2(!recording->patches().empty(), name);

            // Scrubbed by the mouse.
            TimelineTrack& track = test.find<TimelinePanel>("timeline_panel")->track();
            TimelineCursor cursor(recording);
            int explained = 0;
            const auto at = [&](int place) { return QPoint(track.width() * place / 10, 8); };
            QTest::mousePress(&track, Qt::LeftButton, {}, at(1));
            for (const int place : {1, 3, 5, 7, 9}) {
                QTest::mouseMove(&track, at(place));
                QVERIFY(arrives());
                const StepNumber step = track.step_at(at(place).x());
                QCOMPARE(player.step(), step);
                cursor.seek(step);
                QCOMPARE(player.shown().coordinates, cursor.coordinates());
                QVERIFY(!test.text("step_title").isEmpty() && test.text("step_title") != QStringLiteral("No timeline"));
                QVERIFY(!test.text("step_text").isEmpty());
                const auto& explanation = player.shown().explanation;
                QVERIFY(explanation);
                const bool is_in_patch = recording->patch_of(step).has_value();
                QCOMPARE(explanation->method.has_value(), is_in_patch);
                const Marks marks =
                    step_marks(*explanation, player.shown().coordinates, test.window->view(), nullptr, false);
                QCOMPARE(marks.is_empty(), !is_in_patch);
                if (!is_in_patch) continue;
                ++explained;
                QCOMPARE(marks.texts.size(), *explanation->method == UntangleMethod::guaranteed ? 0u : 4u);
                StepPanel* panel = test.find<StepPanel>("step_panel");
                QTRY_VERIFY(panel->trial() && panel->trial()->step == step);
                QVERIFY(!test.text("trial_outcome").isEmpty());
            }
            QTest::mouseRelease(&track, Qt::LeftButton, {}, at(9));
            QVERIFY2(explained >= 2, name);

            // Played: a moment by iterations, then to the end.
            player.go_to(0);
            QVERIFY(arrives());
            player.set_level(StepLevel::iteration);
            player.set_speed(StepPlayer::max_speed);
            test.click("timeline_play");
            QTest::qWait(500);
            QVERIFY(player.step() > std::min<StepNumber>(10, recording->step_count() / 2));
            QSignalSpy at_end(&player, &StepPlayer::at_end);
            player.set_level(StepLevel::patch);
            if (!player.is_playing()) test.click("timeline_play");
            QVERIFY(QTest::qWaitFor([&] { return at_end.count() == 1; }, 20000));
            QVERIFY(arrives());
            QCOMPARE(player.step(), recording->step_count() - 1);
            cursor.seek(player.step());
            QCOMPARE(player.shown().coordinates, cursor.coordinates());
        }
        QCOMPARE(document.state().mesh, present);
        QCOMPARE(document.state().mesh->coordinates(), positions);
        QCOMPARE(document.history()->count(), 0);
        test.click("timeline_close");
        QVERIFY(test.errors.isEmpty());
    }
};

QObject* make_test() {
    return new TraceTest;
}

#include "trace_test.moc"
