/// What is told to people: how long notices hold, what their buttons do, what the log keeps.

#include <cmath>
#include <fstream>
#include <numbers>

#include <QClipboard>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QMouseEvent>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QTableWidget>
#include <QToolButton>
#include <QTreeWidget>

#include "core/io/mesh_io.h"
#include "core/mesh/renumbering.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/improve.h"
#include "tests/gui/drag_under_test.h"
#include "tests/support/mesh_factory.h"
#include "tests/support/region_meshes.h"
#include "ui/document/message_log.h"
#include "ui/document/notice_board.h"
#include "ui/jobs/global_check.h"
#include "ui/panels/banner.h"

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

/// A document with a mesh and no window.
struct DocumentUnderTest {
    DocumentUnderTest() { open(square_mesh(2, 2)); }

    void open(const CurvedMesh& mesh) {
        document.open({state_of(mesh), QStringLiteral("/folder/square.msh"), {}, nullptr});
    }
    void do_step(double distance) {
        document.apply(QStringLiteral("step"), state_of(moved(*document.state().mesh, distance)), FlipAction{});
    }
    void post(const char* text, NoticeLife life, NoticeSeverity severity = NoticeSeverity::warning,
              const char* topic = "") {
        board.post({severity, QLatin1String(text), {}, life, QLatin1String(topic)});
    }
    QString shown() const {
        QStringList texts;
        for (const NoticeBoard::Line& line : board.lines()) texts << line.notice.text;
        return texts.join(QLatin1Char(' '));
    }
    int id_of(const char* text) const {
        for (const NoticeBoard::Line& line : board.lines())
            if (line.notice.text == QLatin1String(text)) return line.id;
        return -1;
    }

    MeshDocument document;
    NoticeBoard board{document};
};

/// A window with linear triangles; the ends of the bottom have passed the corners above them, so that some elements
/// cannot be mended as long as the boundary stays.
struct UnmendableUnderTest : WindowUnderTest {
    UnmendableUnderTest() {
        const QString mesh = inputs.path(QStringLiteral("linear.msh"));
        const QString ends = inputs.path(QStringLiteral("ends.json"));
        write_mesh(mesh.toStdString(), square_mesh(4, 1));
        std::ofstream(ends.toStdString())
            << R"json({"operations": [{"group": "bottom", "type": "expression", "y": "y + 0.3 * (2 * x - 1)^8 + 0.27 * sin(pi * x)^8"}]})json";
        open(mesh, ends);
        if (!window->jobs().deform() || !wait_for_job()) qFatal("The boundary was not deformed.");
        tangled = window->document().state().mesh;
    }
    Banner* banner() { return find<Banner>("banner"); }

    std::shared_ptr<const CurvedMesh> tangled;
};

QString log_of(const MessageLog& log) {
    QStringList lines;
    for (const LogEntry& entry : log.entries()) lines << MessageLog::line(entry);
    return lines.join(QLatin1Char('\n'));
}

}  // namespace

class NoticesTest : public QObject {
    Q_OBJECT

  private slots:
    void init() { QSettings().clear(); }

    void notices_hold_as_long_as_what_they_are_about() {
        DocumentUnderTest test;
        test.post("file", NoticeLife::document);
        test.do_step(0.25);
        test.post("state", NoticeLife::state);
        test.post("step", NoticeLife::step);
        QCOMPARE(test.shown(), QStringLiteral("step state file"));
        test.do_step(0.5);
        QCOMPARE(test.shown(), QStringLiteral("step file"));
        test.document.history()->undo();
        QCOMPARE(test.shown(), QStringLiteral("step state file"));
        test.document.history()->undo();
        QCOMPARE(test.shown(), QStringLiteral("file"));
        test.document.history()->redo();
        QCOMPARE(test.shown(), QStringLiteral("step state file"));

        // What was dismissed stays so.
        test.board.dismiss(test.id_of("state"));
        QCOMPARE(test.shown(), QStringLiteral("step file"));
        test.document.history()->undo();
        test.document.history()->redo();
        QCOMPARE(test.shown(), QStringLiteral("step file"));

        // Another step instead of this one, and another mesh.
        test.document.history()->undo();
        test.do_step(0.75);
        QCOMPARE(test.shown(), QStringLiteral("file"));
        test.open(square_mesh(1, 1));
        QCOMPARE(test.shown(), QString());
        test.document.close();
        QCOMPARE(test.shown(), QString());
    }

    void the_most_severe_comes_first_and_a_topic_has_one_notice() {
        DocumentUnderTest test;
        test.post("first", NoticeLife::state, NoticeSeverity::information);
        test.post("second", NoticeLife::state, NoticeSeverity::information);
        test.post("wrong", NoticeLife::state, NoticeSeverity::error);
        test.post("less", NoticeLife::state, NoticeSeverity::warning);
        QCOMPARE(test.shown(), QStringLiteral("wrong less second first"));
        QSignalSpy changes(&test.board, &NoticeBoard::changed);
        test.post("written", NoticeLife::state, NoticeSeverity::error, "saving");
        test.post("again", NoticeLife::state, NoticeSeverity::error, "saving");
        QCOMPARE(test.shown(), QStringLiteral("again wrong less second first"));
        QCOMPARE(changes.count(), 2);
        test.board.dismiss(test.id_of("again"));
        QCOMPARE(test.shown(), QStringLiteral("wrong less second first"));
        QVERIFY(test.board.find(test.board.lines().front().id) != nullptr);
        QVERIFY(test.board.find(-1) == nullptr);
    }

    void what_a_state_tells_by_itself_comes_and_goes_with_it() {
        DocumentUnderTest test;
        QCOMPARE(test.shown(), QString());
        test.open(flip_orientation(square_mesh(2, 2)));
        QCOMPARE(test.board.lines().size(), std::size_t(1));
        QVERIFY(test.shown().contains(QStringLiteral("clockwise")));
        QCOMPARE(test.board.lines()[0].notice.actions.size(), std::size_t(1));
        QVERIFY(test.board.lines()[0].notice.actions[0].command == NoticeCommand::flip);
        const int id = test.board.lines()[0].id;
        // In another state that tells the same it is the same notice; dismissed once, it is not told again.
        test.do_step(0.5);
        QCOMPARE(test.board.lines().size(), std::size_t(1));
        QCOMPARE(test.board.lines()[0].id, id);
        test.board.dismiss(id);
        QCOMPARE(test.shown(), QString());
        test.document.history()->undo();
        QCOMPARE(test.shown(), QString());
        test.open(flip_orientation(square_mesh(2, 2)));
        QVERIFY(test.shown().contains(QStringLiteral("clockwise")));
    }

    void only_what_is_fixed_can_be_let_slide() {
        GuaranteedOptions options;
        options.target = 0.3;
        auto action = sliding_boundary(options, true);
        QVERIFY(action && action->undoes && action->options);
        QVERIFY(action->options->boundary.otherwise == BoundaryMode::slide);
        QCOMPARE(action->options->target, 0.3);
        QVERIFY(action_text(*action).startsWith(QStringLiteral("Undo and ")));
        action->undoes = false;
        QVERIFY(!action_text(*action).contains(QStringLiteral("Undo")));

        options.boundary.groups = {{"inner", BoundaryMode::free}, {"outer", BoundaryMode::fixed}};
        action = sliding_boundary(options, false);
        QVERIFY(action);
        QCOMPARE(action->options->boundary.groups.size(), std::size_t(1));
        QVERIFY(action->options->boundary.groups[0].mode == BoundaryMode::free);
        options.boundary.otherwise = BoundaryMode::slide;
        action = sliding_boundary(options, false);
        QVERIFY(action && action->options->boundary.otherwise == BoundaryMode::slide);
        options.boundary.groups.pop_back();
        QVERIFY(!sliding_boundary(options, false));
    }

    void interfaces_are_let_slide_by_name() {
        GuaranteedOptions options;
        QVERIFY(!sliding_interfaces(options, {}, true));
        options.boundary.groups = {{"outer", BoundaryMode::slide}, {"skin", BoundaryMode::fixed}};
        const auto action = sliding_interfaces(options, {"skin", "interfaces"}, true);
        QVERIFY(action);
        QCOMPARE(action_text(*action), QStringLiteral("Undo and let the interface slide"));
        std::map<std::string, BoundaryMode> modes;
        for (const BoundaryRules::Rule& rule : action->options->boundary.groups) modes[rule.group] = rule.mode;
        QCOMPARE(modes.size(), std::size_t(3));
        for (const auto& [name, mode] : modes) QVERIFY2(mode == BoundaryMode::slide, name.c_str());
        QVERIFY(action->options->boundary.otherwise == BoundaryMode::fixed);
    }

    void the_log_keeps_everything_once() {
        MessageLog log;
        QSignalSpy added(&log, &MessageLog::added), changed(&log, &MessageLog::last_changed);
        const QString step = QStringLiteral("Warp");
        log.add({{}, step, NoticeSeverity::information, QStringLiteral("Done. 3 elements are tangled.")});
        // The notice about a part of what the job has said already.
        Notice notice{
            NoticeSeverity::warning, QStringLiteral("3 elements are tangled."), {selecting_elements({2, 0, 1})}};
        const auto topology = square_mesh(1, 1).shared_topology();
        log.add(log_entry(notice, step, topology));
        QCOMPARE(added.count(), 1);
        QCOMPARE(changed.count(), 1);
        const LogEntry& entry = log.entries().front();
        QVERIFY(entry.severity == NoticeSeverity::warning);
        QCOMPARE(entry.elements, (std::vector<Index>{0, 1, 2}));
        QVERIFY(entry.topology.lock() == topology);
        QVERIFY(entry.time.isValid());
        // The same of another step, and the same said twice, are entries of their own.
        log.add(log_entry(notice, QStringLiteral("Untangle"), topology));
        QCOMPARE(log.entries().size(), std::size_t(2));
        for (int i = 0; i < 2; ++i) log.add({{}, step, NoticeSeverity::information, QStringLiteral("Wrote a.msh.")});
        QCOMPARE(log.entries().size(), std::size_t(4));
        const QStringList columns = MessageLog::line(log.entries()[1]).split(QLatin1Char('\t'));
        QCOMPARE(columns.mid(1), (QStringList{QStringLiteral("warning"), QStringLiteral("Untangle"),
                                              QStringLiteral("3 elements are tangled.")}));
        log.clear();
        QVERIFY(log.entries().empty());
    }

    void what_a_reader_passes_over_stays_told() {
        WindowUnderTest test;
        const QString path = test.inputs.path(QStringLiteral("noted.msh"));
        write_mesh(path.toStdString(), square_mesh(4, 3));
        std::ofstream(path.toStdString(), std::ios::app) << "$Unheard\n1\n$EndUnheard\n";
        test.open(path);
        auto* banner = test.find<Banner>("banner");
        QVERIFY(banner->isVisible());
        QVERIFY2(banner->text().contains(QStringLiteral("Section $Unheard was skipped.")), qPrintable(banner->text()));
        QVERIFY(log_of(test.window->log()).contains(QStringLiteral("noted.msh as opened\tSection $Unheard")));
        // It outlives steps, but not the mesh.
        QVERIFY(test.window->jobs().flip() && test.wait_for_job());
        QCOMPARE(test.window->document().history()->count(), 1);
        QVERIFY(banner->text().contains(QStringLiteral("$Unheard")));
        test.unsaved_answer = UnsavedAnswer::discard;
        test.open(test.inputs.path(QStringLiteral("cube.msh")));
        QVERIFY(!banner->isVisible());
        test.open(path);
        QVERIFY(banner->isVisible());
        test.click("banner_close");
        QVERIFY(!banner->isVisible());
        QVERIFY(log_of(test.window->log()).count(QStringLiteral("$Unheard")) == 2);
    }

    void unmended_elements_can_be_selected_and_the_boundary_let_slide() {
        UnmendableUnderTest test;
        const GuaranteedResult expected = untangle_guaranteed(*test.tangled);
        QVERIFY(!expected.unmended.empty());
        QVERIFY(!test.banner()->isVisible());
        QVERIFY(test.window->jobs().untangle(GuaranteedOptions()));
        QVERIFY(test.wait_for_job());
        QVERIFY(test.banner()->isVisible());
        // "Cannot" is said of those for which it is proved, and of no others.
        const bool has_proof = std::any_of(expected.unmended.begin(), expected.unmended.end(),
                                           [](const UnmendedElement& element) { return element.is_proved; });
        const bool has_other = std::any_of(expected.unmended.begin(), expected.unmended.end(),
                                           [](const UnmendedElement& element) { return !element.is_proved; });
        QCOMPARE(test.banner()->text().contains(QStringLiteral("cannot be mended")), has_proof);
        QCOMPARE(test.banner()->text().contains(QStringLiteral("No way was found to mend")), has_other);
        QCOMPARE(test.find<QPushButton>("banner_action")->text(), QStringLiteral("Select them"));
        test.click("banner_action");
        IndexSet elements;
        for (const UnmendedElement& element : expected.unmended) elements.push_back(element.element);
        std::sort(elements.begin(), elements.end());
        QCOMPARE(test.window->edit().elements(), elements);

        // Undone, it is not told any more.
        const int steps = test.window->document().history()->count();
        test.window->action(CommandId::undo)->trigger();
        QVERIFY(!test.banner()->isVisible());
        test.window->action(CommandId::redo)->trigger();
        QVERIFY(test.banner()->isVisible());

        auto* slide = test.find<QPushButton>("banner_action_2");
        QCOMPARE(slide->text(), QStringLiteral("Undo and let the boundary slide"));
        QTest::mouseClick(slide, Qt::LeftButton);
        QVERIFY(test.wait_for_job());
        GuaranteedOptions sliding;
        sliding.boundary.otherwise = BoundaryMode::slide;
        QCOMPARE(test.window->document().state().mesh->coordinates(),
                 untangle_guaranteed(*test.tangled, sliding).coordinates);
        QCOMPARE(test.window->document().history()->count(), steps);
        QCOMPARE(test.find<QComboBox>("boundary")->currentText(), QStringLiteral("Slides along itself"));
    }

    void an_interface_in_the_way_can_be_let_slide() {
        WindowUnderTest test;
        // The middle node of an edge of the interface folds it back at its end.
        const CurvedMesh plain = with_regions(square_mesh(4, 2), InterfaceCells::none);
        Coordinates x = plain.coordinates();
        x(node_at(plain, 0.5, 0.375), 1) = 0.27;
        const CurvedMesh folded = plain.with_coordinates(x);
        const QString path = test.inputs.path(QStringLiteral("regions.msh"));
        write_mesh(path.toStdString(), folded);
        test.open(path);
        QVERIFY(test.window->jobs().untangle(GuaranteedOptions()));
        QVERIFY(test.wait_for_job());
        auto* banner = test.find<Banner>("banner");
        QVERIFY2(banner->text().contains(QStringLiteral("“interfaces”")), qPrintable(banner->text()));
        auto* slide = test.find<QPushButton>("banner_action_2");
        QVERIFY2(slide->text().endsWith(QStringLiteral("et the interface slide")), qPrintable(slide->text()));
        QTest::mouseClick(slide, Qt::LeftButton);
        QVERIFY(test.wait_for_job());
        GuaranteedOptions options;
        options.boundary.groups = {{"interfaces", BoundaryMode::slide}};
        QCOMPARE(test.window->document().state().mesh->coordinates(), untangle_guaranteed(folded, options).coordinates);
        QCOMPARE(test.window->document().state().quality->summary.invalid, 0);
        QCOMPARE(test.window->document().history()->count(), 1);
        // The panel has the rule, and undoing takes the mesh back to the file.
        auto* groups = test.find<QTreeWidget>("boundary_groups");
        QVERIFY(groups->isVisible());
        for (int row = 0; row < groups->topLevelItemCount(); ++row) {
            const QTreeWidgetItem* item = groups->topLevelItem(row);
            QCOMPARE(item->text(1) == QStringLiteral("Slides"), item->text(0) == QStringLiteral("interfaces"));
        }
        QCOMPARE(groups->findItems(QStringLiteral("interfaces"), Qt::MatchExactly).size(), 1);
    }

    void interfaces_are_listed_and_can_be_selected() {
        WindowUnderTest test;
        for (const bool is_solid : {false, true})
            for (const InterfaceCells cells : {InterfaceCells::none, InterfaceCells::named}) {
                const CurvedMesh mesh = with_regions(is_solid ? cube_mesh(2, 2) : square_mesh(4, 2), cells);
                const QString path = test.inputs.path(QStringLiteral("regions.msh"));
                write_mesh(path.toStdString(), mesh);
                test.open(path);
                const QString name =
                    cells == InterfaceCells::none ? QStringLiteral("interfaces") : QStringLiteral("interface");
                auto* groups = test.find<QTreeWidget>("groups");
                const auto rows = groups->findItems(name, Qt::MatchExactly);
                QCOMPARE(rows.size(), 1);
                const MeshTopology& topology = test.window->document().state().mesh->topology();
                const GroupLine& line = test.window->document().groups()[groups->indexOfTopLevelItem(rows[0])];
                std::vector<Index> in_the_middle;
                for (Index node = 0; node < topology.node_count(); ++node)
                    if (std::abs(test.window->document().state().mesh->coordinates()(node, 0) - 0.5) < 1e-12)
                        in_the_middle.push_back(node);
                QCOMPARE(line.nodes, in_the_middle);
                // The elements on both sides.
                QCOMPARE(line.elements.size(), 2 * topology.interface_facets().size());
                emit groups->itemClicked(rows[0], 0);
                QCOMPARE(test.window->edit().nodes(), in_the_middle);
                QCOMPARE(test.find<QTreeWidget>("boundary_groups")->findItems(name, Qt::MatchExactly).size(), 1);
            }
    }

    void a_valid_mesh_is_not_untangled_but_can_be_improved() {
        WindowUnderTest test;
        const CurvedMesh mesh = bulged_square_mesh(3, 3, 0.04);
        const QualitySummary before = assess_quality(mesh).summary;
        QVERIFY(before.invalid + before.undecided == 0 && before.min < 0.85);
        const QString path = test.inputs.path(QStringLiteral("bulged.msh"));
        write_mesh(path.toStdString(), mesh);
        test.open(path);
        test.window->action(CommandId::untangle)->trigger();
        QVERIFY(test.wait_for_job());
        auto* banner = test.find<Banner>("banner");
        QVERIFY2(banner->text().contains(QStringLiteral("valid already")), qPrintable(banner->text()));
        QCOMPARE(test.window->document().history()->count(), 0);
        QVERIFY(!test.window->document().is_dirty());
        QCOMPARE(test.find<QPushButton>("banner_action")->text(), QStringLiteral("Improve it"));
        test.click("banner_action");
        QVERIFY(test.wait_for_job());
        const MeshState& state = test.window->document().state();
        QCOMPARE(state.mesh->coordinates(), improve(mesh, ImproveOptions()).coordinates);
        QVERIFY(state.quality->summary.min > before.min);
        QCOMPARE(test.window->document().history()->undoText(), QStringLiteral("Improve"));
        QCOMPARE(test.window->document().session().size(), std::size_t(2));

        // The panel's options reach the core, too.
        test.window->action(CommandId::undo)->trigger();
        test.find<QDoubleSpinBox>("improve_target")->setValue(0.95);
        test.find<QDoubleSpinBox>("improve_farthest")->setValue(0.5);
        test.find<QPushButton>("improve_button")->click();
        QVERIFY(test.wait_for_job());
        ImproveOptions options;
        options.target = 0.95;
        options.max_move = 0.005;
        QCOMPARE(state.mesh->coordinates(), improve(mesh, options).coordinates);
        const Coordinates moves = state.mesh->coordinates() - mesh.coordinates();
        QVERIFY(moves.rowwise().norm().maxCoeff() <= 0.005 * std::sqrt(2.0) * (1.0 + 1e-12));
        QCOMPARE(banner->text().contains(QStringLiteral("target of 0.95 is not reached")),
                 state.quality->summary.min < 0.95);
    }

    void reversed_elements_can_be_selected_and_renumbered() {
        WindowUnderTest test;
        for (const bool is_solid : {false, true}) {
            const CurvedMesh plain = is_solid ? cube_mesh(2, 2) : square_mesh(4, 2);
            const QString path = test.inputs.path(QStringLiteral("reversed.msh"));
            write_mesh(path.toStdString(),
                       renumbered(plain, [](Index element) { return element == 3 || element == 10; }));
            test.unsaved_answer = UnsavedAnswer::discard;
            test.open(path);
            auto* banner = test.find<Banner>("banner");
            QVERIFY2(banner->text().startsWith(QStringLiteral("2 elements are numbered against their neighbours.")),
                     qPrintable(banner->text()));
            QVERIFY(test.text("mesh_validity").contains(QStringLiteral("2 reversed")));
            QCOMPARE(test.window->document().state().quality->summary.invalid, 0);
            QCOMPARE(test.find<QPushButton>("banner_action_2")->text(), QStringLiteral("Select them"));
            test.click("banner_action_2");
            QCOMPARE(test.window->edit().elements(), (IndexSet{3, 10}));
            QCOMPARE(test.find<QPushButton>("banner_action")->text(), QStringLiteral("Renumber them"));
            test.click("banner_action");
            QVERIFY(test.wait_for_job());
            QVERIFY(!banner->isVisible());
            const MeshState& state = test.window->document().state();
            QCOMPARE(state.mesh->coordinates(), plain.coordinates());
            QCOMPARE(state.mesh->topology().reversed_count(), 0);
            QCOMPARE(state.quality->summary.valid, plain.topology().element_count());
            for (Index element = 0; element < plain.topology().element_count(); ++element)
                QCOMPARE(state.mesh->topology().element_tag(element).value,
                         plain.topology().element_tag(element).value);
            test.window->action(CommandId::undo)->trigger();
            QVERIFY(banner->isVisible());
            QCOMPARE(test.window->document().state().mesh->topology().reversed_count(), 2);
            test.window->action(CommandId::redo)->trigger();
        }
    }

    void overlaps_are_found_in_the_background() {
        WindowUnderTest test;
        // A strip that is bent more than once around: all of its elements are valid, its end lies on its beginning.
        const CurvedMesh strip = quad_mesh(12, 2);
        Coordinates x = strip.coordinates();
        for (Eigen::Index i = 0; i < x.rows(); ++i) {
            const double angle = 2.2 * std::numbers::pi * (1.0 - x(i, 0)), radius = 1.0 + x(i, 1) + 0.3 * x(i, 0);
            x.row(i) << radius * std::cos(angle), radius * std::sin(angle), 0.0;
        }
        const QString path = test.inputs.path(QStringLiteral("strip.msh"));
        write_mesh(path.toStdString(), strip.with_coordinates(x));
        test.open(path);
        QCOMPARE(test.window->document().state().quality->summary.invalid, 0);
        auto* banner = test.find<Banner>("banner");
        QTRY_VERIFY_WITH_TIMEOUT(banner->isVisible(), 20000);
        QVERIFY2(banner->text().startsWith(QStringLiteral("The boundary crosses itself")), qPrintable(banner->text()));
        QVERIFY(test.text("mesh_global").contains(QStringLiteral("crosses itself")));
        QVERIFY(test.text("verdict").contains(QStringLiteral("crosses itself")));
        const auto report = test.window->global_check().report();
        QVERIFY(report && report->answer == GlobalValidity::no);
        test.click("banner_action");
        QCOMPARE(test.window->edit().elements(), elements_of(report->boundary.crossings));
        QVERIFY(!test.window->edit().elements().empty());
        // Dismissed, it stays so when the state comes back.
        test.click("banner_close");
        QVERIFY(test.window->jobs().flip() && test.wait_for_job());
        test.window->action(CommandId::undo)->trigger();
        QCOMPARE(test.window->global_check().report(), report);
        QVERIFY(test.text("mesh_global").contains(QStringLiteral("crosses itself")));

        test.unsaved_answer = UnsavedAnswer::discard;
        for (const char* good : {"square.msh", "cube.msh"}) {
            test.open(test.inputs.path(QLatin1String(good)));
            QTRY_VERIFY_WITH_TIMEOUT(test.window->global_check().report(), 20000);
            QVERIFY(test.text("mesh_global").contains(QStringLiteral("valid as a mesh")));
            QVERIFY(!banner->isVisible());
            QCOMPARE(test.text("verdict"), QStringLiteral("✓ all proved valid"));
        }
    }

    void what_global_validity_says_is_about_what_decides() {
        GlobalValidityReport report;
        report.answer = report.elements = report.conformity = report.boundary.answer = GlobalValidity::yes;
        QVERIFY(!global_notice(report));
        report.answer = report.elements = GlobalValidity::no;
        QVERIFY(!global_notice(report));  // told as tangled
        report.conflict_count = 1;
        report.conflicts = {{{4, 0}, {2, 1}}};
        auto notice = global_notice(report);
        QVERIFY(notice && notice->text.contains(QStringLiteral("do not match (1 pair of facets)")));
        QCOMPARE(notice->actions[0].items, (std::vector<Index>{2, 4}));
        report.boundary.crossing_count = 1200;
        report.boundary.crossings = {{{7, 0}, {7, 0}}};
        notice = global_notice(report);
        QVERIFY(notice && notice->text.contains(QStringLiteral("1,200 pairs of facets")));
        QCOMPARE(notice->actions[0].items, (std::vector<Index>{7}));
        report = {};
        report.elements = GlobalValidity::yes;
        QVERIFY(!global_notice(report));
        report.boundary.unsettled_count = 1;
        QVERIFY(global_notice(report)->severity == NoticeSeverity::information);
    }

    void a_job_that_moves_nothing_is_no_step() {
        WindowUnderTest test;
        const QString still = test.inputs.path(QStringLiteral("still.json"));
        std::ofstream(still.toStdString())
            << R"json({"operations": [{"group": "bottom", "type": "expression", "y": "y + 0"}]})json";
        for (const char* mesh : {"square.msh", "cube.msh"}) {
            if (QLatin1String(mesh) == QLatin1String("cube.msh"))
                std::ofstream(still.toStdString())
                    << R"json({"operations": [{"group": "z0", "type": "expression", "z": "z + 0"}]})json";
            test.open(test.inputs.path(QLatin1String(mesh)), still);
            const auto opened = test.window->document().state().mesh;
            QSignalSpy states(&test.window->document(), &MeshDocument::state_changed);
            QVERIFY(test.window->jobs().warp(WarpOptions()));
            QVERIFY(test.wait_for_job());
            QVERIFY(test.find<Banner>("banner")->text().startsWith(QStringLiteral("Nothing moved")));
            QVERIFY(test.window->jobs().warp(WarpOptions(), IncrementOptions()));
            QVERIFY(test.wait_for_job());
            QVERIFY(test.window->jobs().deform());
            QVERIFY(test.wait_for_job());
            QVERIFY(test.errors.isEmpty());
            QCOMPARE(states.count(), 0);
            QCOMPARE(test.window->document().history()->count(), 0);
            QVERIFY(!test.window->document().is_dirty() && !test.window->isWindowModified());
            QCOMPARE(test.window->document().state().mesh, opened);
            QCOMPARE(test.window->document().session().size(), std::size_t(1));
            QCOMPARE(test.window->notices().lines().size(), std::size_t(1));
        }
    }

    void a_drag_of_nothing_is_no_step() {
        DragUnderTest test;
        const auto opened = test.document().state().mesh;
        const Index node = test.node_at(0.5, 0.0);
        DragRequest request;
        request.set.nodes = {node};
        request.name = QStringLiteral("Drag");
        for (const double distance : {1e-16, 1e-300}) {
            QSignalSpy still(&test.drag(), &LiveDrag::nothing_moved), ended(&test.drag(), &LiveDrag::ended);
            test.drag().begin(request);
            AffineMotion motion;
            motion.shift = {0.0, distance, 0.0};
            test.drag().move(motion);
            test.drag().finish();
            QTRY_COMPARE(ended.count(), 1);
            QCOMPARE(still.count(), 1);
        }
        // There and back again by hand.
        test.take(node);
        test.move_by({8, -8});
        test.move_by({-8, 8});
        test.let_go();
        QVERIFY(!test.document().is_dirty() && !test.window->isWindowModified());
        QCOMPARE(test.document().history()->count(), 0);
        QCOMPARE(test.document().state().mesh, opened);
        QVERIFY(log_of(test.window->log()).contains(QStringLiteral("Nothing moved")));
        // A hand that does move is a step.
        test.drag_node(node, {6, -6});
        QCOMPARE(test.document().history()->count(), 1);
    }

    void errors_of_dialogs_are_in_the_log() {
        WindowUnderTest test;
        test.window->open_file(test.inputs.path(QStringLiteral("malformed.msh")));
        QVERIFY(test.wait_for_job());
        QTRY_COMPARE(test.errors.size(), 1);
        const LogEntry& entry = test.window->log().entries().back();
        QVERIFY(entry.severity == NoticeSeverity::error);
        QVERIFY(entry.text.contains(test.errors.back()));
    }

    void the_log_is_a_panel() {
        UnmendableUnderTest test;
        QVERIFY(test.window->jobs().untangle(GuaranteedOptions()));
        QVERIFY(test.wait_for_job());
        auto* table = test.find<QTableWidget>("log_table");
        QVERIFY(!table->isVisible());
        test.window->action(CommandId::panel_log)->trigger();
        QVERIFY(table->isVisible() && table->height() > 40);
        const auto& entries = test.window->log().entries();
        QCOMPARE(table->rowCount(), static_cast<int>(entries.size()));
        const int last = table->rowCount() - 1;
        QVERIFY(table->item(last, 2)->text().contains(QStringLiteral("mend")));
        QCOMPARE(table->item(last, 1)->text(), test.window->document().history()->undoText());
        // Nothing of it is cut off.
        for (int row = 0; row <= last; ++row) {
            const QRect room(0, 0, table->columnWidth(2) - 40, 10000);
            const QRect wanted = table->fontMetrics().boundingRect(room, Qt::TextWordWrap, table->item(row, 2)->text());
            QVERIFY(table->rowHeight(row) >= wanted.height());
        }

        QVERIFY(!entries.back().elements.empty());
        emit table->cellDoubleClicked(last, 2);
        QCOMPARE(test.window->edit().elements(), entries.back().elements);
        test.click("log_copy");
        QCOMPARE(QGuiApplication::clipboard()->text(), log_of(test.window->log()));
        table->selectRow(last);
        test.click("log_copy");
        QCOMPARE(QGuiApplication::clipboard()->text(), MessageLog::line(entries.back()));

        // Of another mesh there is nothing to select.
        test.unsaved_answer = UnsavedAnswer::discard;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        emit table->cellDoubleClicked(last, 2);
        QVERIFY(test.window->edit().elements().empty());
        test.click("log_clear");
        QCOMPARE(table->rowCount(), 0);
        QVERIFY(test.window->log().entries().empty());
        test.window->action(CommandId::panel_log)->trigger();
        QVERIFY(!table->isVisible());
    }

    void the_banner_wraps_and_is_worked_with_the_keyboard() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        NoticeBoard& board = test.window->notices();
        auto* banner = test.find<Banner>("banner");
        QString long_text;
        for (int i = 0; i < 40; ++i) long_text += QStringLiteral("Word number %1. ").arg(i);
        board.post({NoticeSeverity::warning, long_text, {selecting_elements({1, 3})}});
        board.post({NoticeSeverity::error, QStringLiteral("Short."), {}});
        QTRY_VERIFY(banner->isVisible());
        const auto labels = banner->findChildren<QLabel*>(QStringLiteral("banner_text"));
        QCOMPARE(labels.size(), 2);
        for (const int width : {1280, 1000, 1440}) {
            test.window->resize(width, 800);
            for (const QLabel* label : labels)
                QTRY_VERIFY(label->height() >= label->heightForWidth(label->width()) && label->width() > 100);
        }
        for (const auto* button : banner->findChildren<QToolButton*>(QStringLiteral("banner_close")))
            QVERIFY(!button->toolTip().isEmpty() && !button->accessibleName().isEmpty());

        // From the view to the notes; the first is dismissed, then the button of the second is pressed.
        test.window->view().setFocus();
        test.window->action(CommandId::previous_area)->trigger();
        QVERIFY(banner->isAncestorOf(test.window->focusWidget()));
        QTest::keyClick(test.window->focusWidget(), Qt::Key_Space);
        QCOMPARE(board.lines().size(), std::size_t(1));
        QVERIFY(banner->isAncestorOf(test.window->focusWidget()));
        auto* select = test.find<QPushButton>("banner_action");
        select->setFocus();
        QTest::keyClick(select, Qt::Key_Space);
        QCOMPARE(test.window->edit().elements(), (IndexSet{1, 3}));
        // Escape belongs to tools and jobs.
        QTest::keyClick(select, Qt::Key_Escape);
        QVERIFY(banner->isVisible());
        test.find<QToolButton>("banner_close")->setFocus();
        QTest::keyClick(test.window->focusWidget(), Qt::Key_Space);
        QVERIFY(!banner->isVisible());
        QVERIFY(test.window->view().hasFocus());
    }

    void of_many_notes_some_are_folded_away() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        for (int i = 0; i < 5; ++i)
            test.window->notices().post({NoticeSeverity::information, QStringLiteral("Note %1.").arg(i), {}});
        auto* banner = test.find<Banner>("banner");
        QCOMPARE(banner->text(), QStringLiteral("Note 4.\nNote 3.\nNote 2."));
        QVERIFY(test.find<QPushButton>("banner_more")->text().contains(QStringLiteral("2 more")));
        test.click("banner_more");
        QCOMPARE(banner->text(), QStringLiteral("Note 4.\nNote 3.\nNote 2.\nNote 1.\nNote 0."));
        test.click("banner_close");
        test.click("banner_close");
        QCOMPARE(banner->text(), QStringLiteral("Note 2.\nNote 1.\nNote 0."));
        QVERIFY(!test.find<QPushButton>("banner_more")->isVisible());
    }
};

QObject* make_test() {
    return new NoticesTest;
}

#include "notices_test.moc"
