/// The warp panel: which fields it shows, and that what they say reaches the core and the history.

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>
#include <QSpinBox>
#include <fstream>

#include "core/deform/deformation.h"
#include "core/warp/incremental.h"
#include "tests/gui/gui_test_support.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/banner.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

/// A window with the square and a deformation, at the warp panel.
struct WarpUnderTest : WindowUnderTest {
    explicit WarpUnderTest(const char* deformation, const char* mesh = "square.msh") {
        open(inputs.path(QLatin1String(mesh)), inputs.path(QLatin1String(deformation)));
        window->show_tab(QStringLiteral("warp"));
    }
    void choose(const char* box, const char* text) {
        const int index = find<QComboBox>(box)->findText(QLatin1String(text));
        if (index < 0) qFatal("%s has no entry %s.", box, text);
        find<QComboBox>(box)->setCurrentIndex(index);
    }
    bool shows(const char* name) { return find<QWidget>(name)->isVisible(); }
    bool warp_and_wait() {
        click("warp_button");
        return wait_for_job();
    }
    MeshDocument& document() { return window->document(); }
    const CurvedMesh& opened() { return *document().original().mesh; }
    Coordinates moved(double fraction = 1.0) {
        return apply_deformation(opened(), *document().deformation()->deformation, fraction);
    }
    double distance_to(const Coordinates& expected) {
        return (document().state().mesh->coordinates() - expected).cwiseAbs().maxCoeff();
    }
    QString details() { return document().step_details(document().history()->index() - 1); }
};

/// Moves the bottom so far that it passes the top.
QString too_far(WarpUnderTest& test) {
    const QString path = test.inputs.path(QStringLiteral("too_far.json"));
    std::ofstream(path.toStdString())
        << R"json({"operations": [{"group": "bottom", "type": "expression", "y": "y + 3 * sin(pi * x)"}]})json";
    return path;
}

}  // namespace

class WarpTest : public QObject {
    Q_OBJECT

  private slots:
    void a_job_gives_the_focus_back() {
        WarpUnderTest test("gentle.json");
        auto* button = test.find<QPushButton>("warp_button");
        button->setFocus();
        QTest::keyClick(button, Qt::Key_Space);
        QVERIFY(!button->isEnabled() && !button->hasFocus());
        QVERIFY(test.wait_for_job());
        QVERIFY(button->isEnabled() && button->hasFocus());
        // Who has gone elsewhere meanwhile stays there.
        QTest::keyClick(button, Qt::Key_Space);
        test.window->view().setFocus();
        QVERIFY(test.wait_for_job());
        QVERIFY(!button->hasFocus());
    }

    void elements_that_a_warp_turns_over_are_not_called_numbered_so() {
        WarpUnderTest test("gentle.json");
        test.open(test.inputs.path(QStringLiteral("square.msh")), too_far(test));
        test.window->show_tab(QStringLiteral("warp"));
        QVERIFY(test.warp_and_wait());
        QCOMPARE(test.document().state().quality->summary.reversed, 0);
        // What is told is that they are tangled.
        const QString told = test.find<Banner>("banner")->text();
        QVERIFY2(told.contains(QStringLiteral("tangled")) && !told.contains(QStringLiteral("numbered")),
                 qPrintable(told));
    }

    void shows_the_fields_of_the_choices() {
        WarpUnderTest test("gentle.json");
        const auto more = {"neighbours", "poisson_ratio", "stiffening", "solver"};
        for (const char* name : more) QVERIFY2(!test.shows(name), name);
        QVERIFY(test.shows("distance_power"));
        QVERIFY(!test.shows("step_count") && !test.shows("new_weights"));
        test.click("more_warp_options");
        QVERIFY(test.shows("neighbours") && test.shows("solver"));
        QVERIFY(!test.shows("poisson_ratio") && !test.shows("stiffening"));
        test.choose("weights", "Elastic body");
        QVERIFY(!test.shows("distance_power") && !test.shows("neighbours"));
        QVERIFY(test.shows("poisson_ratio") && test.shows("stiffening") && test.shows("solver"));
        test.choose("steps", "Automatic");
        QVERIFY(!test.shows("step_count") && test.shows("new_weights"));
        test.choose("steps", "Number");
        QVERIFY(test.shows("step_count") && test.shows("new_weights"));
        test.click("more_warp_options");
        for (const char* name : more) QVERIFY2(!test.shows(name), name);
        QVERIFY(test.find<QComboBox>("weights")->toolTip().contains(QStringLiteral("Elastic body: ")));
    }

    void fits_beside_a_scroll_bar() {
        WarpUnderTest test("gentle.json");
        const QWidget* panel = test.find<QPushButton>("warp_button")->parentWidget();
        test.choose("steps", "Number");
        test.click("more_warp_options");
        for (const char* weights : {"Convex weights", "Affine weights", "Elastic body"}) {
            test.choose("weights", weights);
            QTest::qWait(20);
            QVERIFY2(panel->width() <= panel->parentWidget()->width(), weights);
        }
    }

    void elastic_body_is_the_core_s() {
        WarpUnderTest test("bump.json");
        test.choose("weights", "Elastic body");
        QVERIFY(test.warp_and_wait());
        WarpOptions options;
        options.weighting = Weighting::elastic;
        QVERIFY(test.distance_to(warp(test.opened(), test.moved(), options).coordinates) < 1e-12);
        QCOMPARE(test.document().history()->undoText(), QStringLiteral("Warp, elastic body"));
        QVERIFY(test.details().contains(QStringLiteral("Poisson’s ratio 0.33, stiffening 0")));
        test.click("tool_undo");

        test.click("more_warp_options");
        test.find<QDoubleSpinBox>("poisson_ratio")->setValue(-0.5);
        test.find<QDoubleSpinBox>("stiffening")->setValue(1.5);
        test.choose("solver", "Direct");
        QVERIFY(test.warp_and_wait());
        options.poisson_ratio = -0.5;
        options.stiffening = 1.5;
        options.solver = SolverChoice::direct;
        QVERIFY(test.distance_to(warp(test.opened(), test.moved(), options).coordinates) < 1e-12);
        QVERIFY(test.details().contains(QStringLiteral("Poisson’s ratio −0.5, stiffening 1.5")));
        QVERIFY(test.details().contains(QStringLiteral("direct solver")));
    }

    void neighbours_reach_the_core() {
        WarpUnderTest test("bump.json");
        test.click("more_warp_options");
        test.choose("neighbours", "One edge away");
        QVERIFY(test.warp_and_wait());
        WarpOptions options;
        options.neighbours = NeighbourKind::edge_connected;
        QVERIFY(test.distance_to(warp(test.opened(), test.moved(), options).coordinates) < 1e-12);
        QVERIFY(test.details().contains(QStringLiteral("neighbours one edge away")));
    }

    void steps_are_the_core_s() {
        WarpUnderTest test("bump.json");
        const BoundaryPath path = [&](double fraction) { return test.moved(fraction); };
        test.choose("steps", "Number");
        test.find<QSpinBox>("step_count")->setValue(3);
        for (const bool new_weights : {true, false}) {
            test.find<QCheckBox>("new_weights")->setChecked(new_weights);
            QVERIFY(test.warp_and_wait());
            IncrementOptions increments;
            increments.steps = 3;
            increments.recomputes_weights = new_weights;
            QVERIFY(test.distance_to(warp_in_increments(test.opened(), path, {}, increments).coordinates) < 1e-12);
            QCOMPARE(test.document().history()->undoText(), QStringLiteral("Warp, convex weights, 3 steps"));
            QVERIFY(test.details().contains(QStringLiteral("The whole motion in 3 steps.")));
            QCOMPARE(test.details().contains(QStringLiteral("new weights at every step")), new_weights);
            test.click("tool_undo");
        }
        test.choose("steps", "Automatic");
        QVERIFY(test.warp_and_wait());
        QCOMPARE(test.document().history()->undoText(), QStringLiteral("Warp, convex weights, automatic steps"));
        QCOMPARE(test.document().history()->index(), 1);
        QVERIFY(test.document().is_deformation_applied());
        QCOMPARE(test.document().state().quality->summary.invalid, 0);
    }

    void stops_at_the_last_valid_state() {
        WarpUnderTest test("gentle.json");
        QVERIFY(test.window->jobs().load_deformation(too_far(test)));
        QVERIFY(test.wait_for_job());
        test.choose("steps", "Automatic");
        QString note;
        connect(&test.window->jobs(), &MeshJobs::note, &test.window->jobs(),
                [&note](const QString& text) { note = text; });
        QVERIFY(test.warp_and_wait());
        QVERIFY(test.errors.isEmpty());
        const BoundaryPath path = [&](double fraction) { return test.moved(fraction); };
        const IncrementalResult expected = warp_in_increments(test.opened(), path, {}, {});
        QVERIFY(!expected.increments.is_complete() && expected.increments.fraction > 0.0);
        QVERIFY(test.distance_to(expected.coordinates) < 1e-12);
        QCOMPARE(test.document().state().quality->summary.invalid, 0);
        QCOMPARE(test.document().history()->index(), 1);
        QVERIFY(test.document().history()->undoText().startsWith(QStringLiteral("Warp to ")));
        QString sentence = QString::fromStdString(describe(expected.increments, test.opened().topology()));
        QCOMPARE(note, sentence.replace(QStringLiteral("Jacobian -"), QStringLiteral("Jacobian −")));
        QVERIFY(test.details().contains(sentence));
        test.click("tool_undo");
        QCOMPARE(test.document().state().mesh->coordinates(), test.opened().coordinates());

        // Where not even one step goes, nothing changes, and the message says why.
        test.choose("steps", "Number");
        test.find<QSpinBox>("step_count")->setValue(1);
        QVERIFY(test.warp_and_wait());
        QCOMPARE(test.errors.size(), 1);
        QVERIFY(test.errors[0].startsWith(QStringLiteral("Stopped at 0 % of the motion")));
        QCOMPARE(test.document().history()->index(), 0);
    }

    void steps_can_be_cancelled() {
        WarpUnderTest test("gentle.json");
        test.choose("steps", "Number");
        test.find<QSpinBox>("step_count")->setValue(1000);
        QSignalSpy cancelled(&test.window->jobs().runner(), &JobRunner::cancelled);
        QSignalSpy progress(&test.window->jobs().runner(), &JobRunner::progress);
        test.click("warp_button");
        QTRY_VERIFY(progress.count() > 2);
        QTest::keyClick(test.window.get(), Qt::Key_Escape);
        QTRY_COMPARE(cancelled.count(), 1);
        QCOMPARE(test.document().history()->count(), 0);
        QVERIFY(test.find<QPushButton>("warp_button")->isEnabled());
    }

    void steps_need_a_mesh_that_is_proved_valid() {
        WarpUnderTest test("bump.json");
        QVERIFY(test.window->jobs().deform());
        QVERIFY(test.wait_for_job());
        QVERIFY(test.find<QPushButton>("warp_button")->isEnabled());
        test.choose("steps", "Automatic");
        QVERIFY(!test.find<QPushButton>("warp_button")->isEnabled());
        QVERIFY(test.text("warp_button_reason").contains(QStringLiteral("untangle it first")));
        test.choose("steps", "At once");
        QVERIFY(test.find<QPushButton>("warp_button")->isEnabled());
    }

    void elements_without_quality_are_warped() {
        WarpUnderTest test("gentle.json");
        const QString path = test.inputs.path(QStringLiteral("turn.json"));
        std::ofstream(path.toStdString())
            << R"({"operations": [{"group": "boundary", "type": "rotate", "center": [0, 0, 0], "angle_deg": 30}]})";
        test.open(test.inputs.path(QStringLiteral("quad.msh")), path);
        test.window->show_tab(QStringLiteral("warp"));
        test.choose("weights", "Elastic body");
        QVERIFY(test.warp_and_wait());
        QVERIFY2(test.errors.isEmpty(), qPrintable(test.errors.join(QLatin1Char(' '))));
        QCOMPARE(test.document().history()->index(), 1);
        QVERIFY(test.distance_to(test.moved()) < 1e-12);  // all of its nodes are on the boundary
        test.click("tool_undo");
        if (test.document().state().quality) return;
        test.choose("steps", "Automatic");
        QVERIFY(!test.find<QPushButton>("warp_button")->isEnabled());
        QVERIFY(test.text("warp_button_reason").contains(QStringLiteral("quadrilateral")));
    }
};

QObject* make_test() {
    return new WarpTest;
}

#include "warp_test.moc"
