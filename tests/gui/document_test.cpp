/// The document, the jobs and the texts, without the window.

#include <QFile>
#include <QSemaphore>
#include <QSignalSpy>
#include <QTextStream>
#include <QUndoStack>

#include "app/desktop/start_up.h"
#include "core/io/deformation_file.h"
#include "tests/gui/gui_test_support.h"
#include "tests/support/mesh_factory.h"
#include "ui/document/deformation_text.h"
#include "ui/document/mesh_text.h"
#include "ui/document/number_format.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/histogram_widget.h"
#include "ui/panels/operation_panels.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

MeshState state_of(const CurvedMesh& mesh) {
    MeshState state;
    state.mesh = std::make_shared<const CurvedMesh>(mesh);
    state.quality = std::make_shared<const QualityReport>(assess_quality(mesh));
    return state;
}

CurvedMesh moved(const CurvedMesh& mesh, double distance) {
    Coordinates x = mesh.coordinates();
    x.array() += distance;
    return mesh.with_coordinates(x);
}

void write_manifest(const Inputs& inputs, const QByteArray& text) {
    QFile manifest(inputs.path(QStringLiteral("MANIFEST")));
    QVERIFY(manifest.open(QIODevice::WriteOnly));
    manifest.write(text);
}

}  // namespace

class DocumentTest : public QObject {
    Q_OBJECT

  private slots:
    void history_walks_states() {
        MeshDocument document;
        const CurvedMesh square = square_mesh(2, 2);
        document.open({state_of(square), QStringLiteral("/folder/square.msh"), {}, nullptr});
        QVERIFY(!document.is_dirty());
        QCOMPARE(document.file_name(), QStringLiteral("square.msh"));

        const MeshState first = state_of(moved(square, 0.5)), second = state_of(moved(square, 0.75));
        QSignalSpy changes(&document, &MeshDocument::state_changed);
        document.apply(QStringLiteral("first"), first, FlipAction{});
        document.apply(QStringLiteral("second"), second, FlipAction{});
        QCOMPARE(changes.count(), 2);
        QVERIFY(document.is_dirty());
        QCOMPARE(document.state().mesh, second.mesh);
        QCOMPARE(document.before().mesh, first.mesh);
        QCOMPARE(document.original().mesh->coordinates(), square.coordinates());

        document.history()->undo();
        QCOMPARE(document.state().mesh, first.mesh);
        QCOMPARE(document.before().mesh, document.original().mesh);
        changes.clear();
        document.history()->setIndex(0);
        document.history()->setIndex(2);
        QCOMPARE(changes.count(), 2);  // a jump over two steps is one change
        QCOMPARE(document.state().mesh, second.mesh);
        QCOMPARE(document.state().quality, second.quality);
    }

    void saving_and_opening_settle_the_dirty_mark() {
        MeshDocument document;
        const CurvedMesh square = square_mesh(2, 2);
        document.open({state_of(square), QStringLiteral("a.msh"), {}, nullptr});
        document.apply(QStringLiteral("step"), state_of(moved(square, 1.0)), FlipAction{});
        QSignalSpy dirty(&document, &MeshDocument::dirty_changed);
        document.mark_saved(QStringLiteral("b.msh"));
        QVERIFY(!document.is_dirty());
        QCOMPARE(document.file_path(), QStringLiteral("b.msh"));
        document.history()->undo();
        QVERIFY(document.is_dirty());
        QCOMPARE(dirty.count(), 2);
        document.open({state_of(square), QStringLiteral("c.msh"), {}, nullptr});
        QVERIFY(!document.is_dirty());
        QCOMPARE(document.history()->count(), 0);
        QVERIFY(!document.history()->canUndo());
        document.close();
        QVERIFY(!document.has_mesh());
    }

    void what_a_window_could_not_hear_in_time_is_told_once() {
        JobRunner runner;
        QList<double> told;
        QObject later;
        connect(&runner, &JobRunner::progress, [&](const QString&, double fraction) {
            told << fraction;
            // The end comes in a turn of its own: what else is due is not kept waiting by both.
            QMetaObject::invokeMethod(
                &later, [&] { told << (runner.is_running() ? 2.0 : 3.0); }, Qt::QueuedConnection);
        });
        QSemaphore said;
        QVERIFY(runner.start(QStringLiteral("job"), [&said](const TaskContext& context) {
            for (const char* phase : {"a", "b", "c"}) context.report(phase, 0.25 * (phase[0] - 'a' + 1));
            said.release();
            return [] {};
        }));
        said.acquire();
        QTRY_VERIFY(!runner.is_running());
        QCOMPARE(told, QList<double>({0.75, 2.0}));
    }

    void job_runs_one_at_a_time_and_reports() {
        JobRunner runner;
        QSignalSpy finished(&runner, &JobRunner::finished), failed(&runner, &JobRunner::failed);
        bool is_done = false;
        QVERIFY(runner.start(QStringLiteral("job"), [&is_done](const TaskContext& context) {
            context.report("phase", 0.5);
            return [&is_done] { is_done = true; };
        }));
        QVERIFY(!runner.start(QStringLiteral("second"), [](const TaskContext&) { return [] {}; }));
        QTRY_COMPARE(finished.count(), 1);
        QVERIFY(is_done);
        QVERIFY(runner.start(QStringLiteral("bad"), [](const TaskContext&) -> JobRunner::Finish {
            throw InvalidInput("file.msh", 7, "expected a number.");
        }));
        QTRY_COMPARE(failed.count(), 1);
        QCOMPARE(failed.front().at(1).toString(), QStringLiteral("file.msh:7: expected a number."));
        QCOMPARE(finished.count(), 1);
    }

    void cancelled_job_drops_its_result() {
        JobRunner runner;
        QSignalSpy cancelled(&runner, &JobRunner::cancelled), finished(&runner, &JobRunner::finished);
        bool is_done = false;
        const auto wait_for_stop = [&is_done](const TaskContext& context) {
            while (!context.stop.stop_requested()) std::this_thread::yield();
            return [&is_done] { is_done = true; };  // complete, but asked to stop before
        };
        QVERIFY(runner.start(QStringLiteral("job"), wait_for_stop));
        runner.cancel();
        QTRY_COMPARE(cancelled.count(), 1);
        QVERIFY(!is_done && finished.isEmpty());

        QVERIFY(runner.start(QStringLiteral("job"), wait_for_stop));
        runner.cancel_and_wait();
        QVERIFY(!runner.is_running());
        QCOMPARE(cancelled.count(), 2);
        QCoreApplication::processEvents();
        QVERIFY(!is_done && finished.isEmpty());
        QCOMPARE(cancelled.count(), 2);
    }

    void numbers_have_three_digits() {
        QCOMPARE(format_number(-0.12249), QStringLiteral("−0.122"));
        QCOMPARE(format_number(0.9996), QStringLiteral("1.00"));
        QCOMPARE(format_number(0.00314159), QStringLiteral("0.00314"));
        QCOMPARE(format_number(1234.6), QStringLiteral("1235"));
        QCOMPARE(format_number(2.5e-7), QStringLiteral("2.5e−07"));
        QCOMPARE(format_number(0.0), QStringLiteral("0"));
        QCOMPARE(format_number(std::nan("")), QStringLiteral("–"));
        QCOMPARE(format_component(5.55e-17, 0.046), QStringLiteral("0"));
        QCOMPARE(format_component(-5.55e-7, 0.046), QStringLiteral("−5.55e−07"));
        QCOMPARE(format_component(0.0, 0.0), QStringLiteral("0"));
        QCOMPARE(format_count(1234567), QStringLiteral("1,234,567"));
        QCOMPARE(exact_number(0.1).toDouble(), 0.1);
    }

    void sentences_count_what_is_wrong() {
        QualitySummary summary;
        summary.valid = 10;
        QCOMPARE(validity_sentence(summary), QStringLiteral("✓ all proved valid"));
        summary.invalid = 1;
        QCOMPARE(validity_sentence(summary), QStringLiteral("✕ 1 element is tangled (scaled Jacobian ≤ 0)"));
        summary.invalid = 1200;
        summary.undecided = 2;
        QCOMPARE(validity_sentence(summary),
                 QStringLiteral("✕ 1,200 elements are tangled (scaled Jacobian ≤ 0), 2 undecided"));
        QCOMPARE(describe_validity(summary), QStringLiteral("✕ 1,200 tangled · ? 2 undecided"));
    }

    void groups_know_their_elements() {
        const CurvedMesh square = square_mesh(4, 3);
        QCOMPARE(describe_elements(square.topology()), QStringLiteral("P3 · 32 triangles"));
        const auto groups = list_groups(square.topology());
        QCOMPARE(groups.size(), 5);
        QCOMPARE(groups[0].name, QStringLiteral("domain"));
        QCOMPARE(groups[0].elements.size(), std::size_t(32));
        QCOMPARE(groups[1].name, QStringLiteral("bottom"));
        QCOMPARE(groups[1].nodes.size(), std::size_t{13});
        QCOMPARE(groups[1].elements.size(), std::size_t(4));
    }

    void deformations_are_described() {
        const Inputs inputs;
        const auto lines = describe(read_deformation(inputs.path(QStringLiteral("gentle.json")).toStdString()));
        QCOMPARE(lines.size(), 1);
        QCOMPARE(lines[0].group, QStringLiteral("bottom"));
        QCOMPARE(lines[0].action, QStringLiteral("y = y + 0.02 * sin(pi * x)"));
        Deformation table;
        table.content = NodeTable{{{NodeTag{1}, {}}, {NodeTag{2}, {}}}, false};
        QCOMPARE(describe(table)[0].action, QStringLiteral("final positions of 2 nodes"));
    }

    void histogram_keeps_tangled_apart() {
        QualityReport report;
        report.elements.resize(4);
        report.elements[0].scaled_jacobian = -0.5;
        report.elements[0].validity = Validity::invalid;
        report.elements[1].scaled_jacobian = 0.01;
        report.elements[1].validity = Validity::valid;
        report.elements[2].scaled_jacobian = 1.0;
        report.elements[2].validity = Validity::valid;
        report.elements[3].scaled_jacobian = 0.99;
        report.elements[3].validity = Validity::undecided;
        HistogramBars bars = make_bars(report.elements);
        QCOMPARE(bars.tangled.decided, 1);
        QCOMPARE(bars.bars.front().decided, 1);
        QCOMPARE(bars.bars.back().decided, 1);
        QCOMPARE(bars.bars.back().undecided, 1);
        QCOMPARE(bars.highest(), 2);
        const int last = HistogramBars::bins - 1;
        QCOMPARE(bars.elements_in(-1, -1), IndexSet{0});
        QCOMPARE(bars.elements_in(-1, 0), (IndexSet{0, 1}));
        QCOMPARE(bars.elements_in(last, last), (IndexSet{2, 3}));
        QCOMPARE(bars.elements_in(1, last - 1), IndexSet());
        bars.mark({0, 3, 17});
        QCOMPARE(bars.tangled.selected, 1);
        QCOMPARE(bars.bars.front().selected, 0);
        QCOMPARE(bars.bars.back().selected, 1);
        bars.mark({});
        QCOMPARE(bars.tangled.selected, 0);
        const QualitySummary some = summary_of(report.elements, IndexSet{1, 2, 17});
        QCOMPARE(some.elements(), 2);
        QCOMPARE(some.min, 0.01);
        QCOMPARE(some.mean, 0.505);
        QCOMPARE(some.max, 1.0);
        QCOMPARE(summary_of(report.elements).invalid, 1);
        QCOMPARE(summary_of(report.elements, {}).elements(), 0);
    }

    void beta_steps_by_its_leading_digit() {
        LogSpinBox box;
        box.setDecimals(7);
        box.setRange(1e-5, 1.0);
        const auto step = [&box](double from, int steps) {
            box.setValue(from);
            box.stepBy(steps);
            return box.value();
        };
        QCOMPARE(step(0.5, 1), 0.6);
        QCOMPARE(step(0.1, -1), 0.09);
        QCOMPARE(step(0.009, 2), 0.02);
        QCOMPARE(step(1e-5, -1), 1e-5);
        QCOMPARE(step(1.0, 1), 1.0);
    }

    void samples_come_from_their_manifest() {
        const Inputs inputs;
        write_manifest(
            inputs, R"({"samples": [{"name": "s", "title": "Square", "mesh": "square.msh", "deformation": "bump.json",
            "dimension": 2, "order": 3, "elements": 32, "task": "untangle", "start": "straight", "beta": 0.25},
            {"name": "gone", "mesh": "gone.msh"}]})");
        const SampleCatalog catalog = SampleCatalog::load(inputs.path(QString()));
        QCOMPARE(catalog.samples().size(), 1);
        const Sample* sample = catalog.find(QStringLiteral("s"));
        QVERIFY(sample && !catalog.find(QStringLiteral("gone")));
        QCOMPARE(sample->mesh_path, inputs.path(QStringLiteral("square.msh")));
        QVERIFY(sample->task == Sample::Task::untangle && !sample->is_deformed);
        QCOMPARE(sample->beta, std::optional(0.25));
        QVERIFY(
            SampleCatalog::load(inputs.path(QStringLiteral("nowhere"))).error().contains(QStringLiteral("MANIFEST")));
    }

    void samples_know_their_place_in_the_thesis() {
        const Inputs inputs;
        write_manifest(inputs, R"({"samples": [
            {"name": "w", "title": "W", "mesh": "square.msh", "chapter": 2, "figures": ["2.5"], "tables": ["2.3", "2.4"],
             "method": "affine", "as_published": true, "look_for": "The gap."},
            {"name": "u", "mesh": "square.msh", "chapter": 3, "task": "untangle", "method": "unsigned-angle"},
            {"name": "s", "mesh": "square.msh", "chapter": 4, "method": "signed-angle", "beta": 1e-5, "result_min": -0.25},
            {"name": "large", "mesh": "large.msh", "made_on_demand": true}]})");
        const SampleCatalog catalog = SampleCatalog::load(inputs.path(QString()));
        QCOMPARE(catalog.samples().size(), 4);
        QCOMPARE(catalog.chapters(), (QVector<int>{2, 3, 4, 0}));
        const Sample* warp = catalog.find(QStringLiteral("w"));
        QCOMPARE(warp->reference(), QStringLiteral("Figure 2.5 · Tables 2.3, 2.4"));
        QCOMPARE(warp->look_for, QStringLiteral("The gap."));
        QVERIFY(warp->weighting == Weighting::affine && warp->is_as_published && warp->is_there());
        const Sample* untangle = catalog.find(QStringLiteral("u"));
        QVERIFY(untangle->method == UntangleMethod::unsigned_angles && !untangle->is_as_published);
        QCOMPARE(untangle->title, QStringLiteral("u"));
        QVERIFY(untangle->reference().isEmpty());
        QVERIFY(catalog.find(QStringLiteral("s"))->method == UntangleMethod::signed_angles);
        QCOMPARE(catalog.find(QStringLiteral("s"))->beta, std::optional(1e-5));
        QCOMPARE(catalog.find(QStringLiteral("s"))->result_minimum, std::optional(-0.25));
        const Sample* large = catalog.find(QStringLiteral("large"));
        QVERIFY(!large->is_there());
        QVERIFY(large->how_to_make().contains(QStringLiteral("generate.py large")));
        QCOMPARE(catalog.of_chapter(0).size(), 1);
    }

    void malformed_manifests_do_no_harm() {
        const Inputs inputs;
        QTemporaryDir elsewhere;
        QVERIFY(QFile::copy(inputs.path(QStringLiteral("square.msh")), elsewhere.filePath(QStringLiteral("x.msh"))));
        // What is wrong in one value leaves the rest.
        const QString endless(5000, QLatin1Char('x'));
        write_manifest(inputs, QStringLiteral(R"({"samples": [7, null, [], {}, "s",
            {"name": "a", "title": ["no"], "mesh": "square.msh", "chapter": 99, "figures": "2.5",
             "tables": [2.3, "<b>", "2.3.4", "2.3", "2.3\n"], "method": 5, "as_published": "yes", "beta": 7, "result_min": "x",
             "look_for": "one\ntwo%1", "thumbnail": "../../secret.png", "deformation": "%2/x.msh"},
            {"name": "a", "mesh": "square.msh", "title": "Again"},
            {"name": "b", "mesh": "square.msh", "chapter": -2, "beta": "0.5", "method": "magic", "figures": {"a": 1}},
            {"name": "up", "mesh": "../%3/x.msh"}, {"name": "there", "mesh": "%2/x.msh"},
            {"name": "far", "mesh": "../far.msh", "made_on_demand": true},
            {"name": "c", "mesh": 3}, {"mesh": "square.msh"}]})")
                                   .arg(endless, elsewhere.path(), QDir(elsewhere.path()).dirName())
                                   .toUtf8());
        const SampleCatalog catalog = SampleCatalog::load(inputs.path(QString()));
        QCOMPARE(catalog.samples().size(), 2);
        QCOMPARE(catalog.chapters(), QVector<int>{0});
        const Sample& a = catalog.samples().front();
        QCOMPARE(a.title, QStringLiteral("a"));
        QVERIFY(a.figures.isEmpty() && !a.beta && !a.result_minimum && !a.is_as_published);
        QCOMPARE(a.tables, QStringList{QStringLiteral("2.3")});
        QVERIFY(a.weighting == Weighting::convex && a.method == UntangleMethod::guaranteed);
        QVERIFY(a.look_for.startsWith(QStringLiteral("one two")) && a.look_for.size() <= 400);
        QVERIFY(a.thumbnail_path.isEmpty() && a.deformation_path.isEmpty());
        QVERIFY(!catalog.samples().back().beta);

        for (const QByteArray& text : {QByteArray(), QByteArray("{"), QByteArray("[]"), QByteArray("{\"samples\": 3}"),
                                       QByteArray("{\"samples\": ["), QByteArray("\0\xff\xfe", 3),
                                       QByteArray(100000, '['), QByteArray(2 << 20, ' ')}) {
            write_manifest(inputs, text);
            const SampleCatalog none = SampleCatalog::load(inputs.path(QString()));
            QVERIFY(none.samples().isEmpty() && none.chapters().isEmpty());
            QVERIFY(none.error().contains(QStringLiteral("MANIFEST")));
        }
    }

    void platforms_without_opengl_are_refused() {
        char program[] = "curvewright", option[] = "-platform", offscreen[] = "offscreen";
        char* arguments[] = {program, option, offscreen, nullptr};
        QVERIFY(prepare_display(3, arguments).find("'offscreen'") != std::string::npos);
        QVERIFY(prepare_display(1, arguments).empty());
    }
};

QObject* make_test() {
    return new DocumentTest;
}

#include "document_test.moc"
