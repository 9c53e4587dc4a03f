/// The session, its replay, the command line on the clipboard, and work that a crash leaves.

#include <QClipboard>
#include <QDir>
#include <QFile>
#include <QGuiApplication>
#include <QLabel>
#include <QProcess>
#include <QSettings>
#include <fstream>

#include "core/io/mesh_io.h"
#include "core/session/replay.h"
#include "core/session/session_file.h"
#include "tests/gui/drag_under_test.h"
#include "ui/document/journal.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

QString kept_file(const QString& suffix) {
    const QDir folder(Journal::standard_folder());
    QStringList names = folder.entryList({QStringLiteral("*.") + suffix}, QDir::Files);
    names.removeIf([](const QString& name) { return name.startsWith(QStringLiteral("crashed")); });
    return names.isEmpty() ? QString() : folder.filePath(names.front());
}

/// What a program that crashed would have left: the files of a living journal under another name.
QString copy_of_journal() {
    const QString card = kept_file(QStringLiteral("json"));
    if (card.isEmpty()) qFatal("There is no journal.");
    const QString stem = QDir(Journal::standard_folder()).filePath(QStringLiteral("crashed"));
    for (const char* suffix : {"json", "positions", "session"})
        QFile::copy(card.chopped(4) + QLatin1String(suffix), stem + QLatin1Char('.') + QLatin1String(suffix));
    return stem;
}

}  // namespace

class SessionTest : public QObject {
    Q_OBJECT

  private slots:
    void init() {
        QSettings().clear();
        QDir(Journal::standard_folder()).removeRecursively();
        WindowUnderTest::recover_answer = UnsavedAnswer::cancel;
    }

    void a_session_replays_to_the_same_coordinates() {
        DragUnderTest test("square.msh", true);
        MeshDocument& document = test.document();
        test.drag_node(test.node_at(0.5, 0.0), {9, -20});
        test.drag_node(test.node_at(1.0, 0.5), {-14, 5});
        test.click("tool_undo");
        test.window->edit().select_nodes(test.topology().find_group_nodes("top").value());
        test.window->show_tab(QStringLiteral("edit"));
        EditSettings settings = test.window->edit().settings();
        settings.is_soft = false;
        test.window->edit().set_settings(settings);
        test.drag_node(test.node_at(0.5, 1.0), {3, -8});
        test.window->jobs().load_deformation(test.inputs.path(QStringLiteral("gentle.json")));
        QVERIFY(test.wait_for_job());
        test.window->action(CommandId::warp)->trigger();
        QVERIFY(test.wait_for_job());
        test.window->action(CommandId::flip)->trigger();
        QVERIFY(test.wait_for_job());
        test.click("tool_undo");
        test.window->action(CommandId::untangle)->trigger();
        QVERIFY(test.wait_for_job());
        QVERIFY(test.errors.isEmpty());

        test.file_answer = test.inputs.path(QStringLiteral("work.json"));
        test.window->action(CommandId::save_session)->trigger();
        const auto actions = read_session(test.file_answer.toStdString());
        QCOMPARE(actions.size(), document.session().size());
        Replay replay;
        for (const Action& action : actions) replay.perform(action);
        QCOMPARE(replay.mesh().coordinates(), document.state().mesh->coordinates());

        // The way without the detours leads to the same.
        Replay direct;
        const auto way = document.way_here();
        QVERIFY(way.size() < actions.size());
        for (const Action& action : way) direct.perform(action);
        QCOMPARE(direct.mesh().coordinates(), document.state().mesh->coordinates());
    }

    void the_command_line_is_on_the_clipboard_and_works() {
        DragUnderTest test("square.msh");
        const Index node = test.node_at(0.5, 0.0);
        test.drag_node(node, {9, -20});
        test.window->action(CommandId::copy_command)->trigger();
        QString command = QGuiApplication::clipboard()->text();
        QVERIFY2(command.startsWith(QStringLiteral("curvewright-cli replay - -o ")), qPrintable(command));
        // As pasted into a shell, but for where the program and the output are.
        const QString output = test.inputs.path(QStringLiteral("again.msh"));
        const qsizetype end_of_output = command.indexOf(QStringLiteral(" <<"));
        command = QStringLiteral("'%1' replay - -o '%2'").arg(QStringLiteral(CURVEWRIGHT_CLI), output) +
                  command.mid(end_of_output);
        QProcess shell;
        shell.start(QStringLiteral("/bin/sh"), {QStringLiteral("-c"), command});
        QVERIFY(shell.waitForFinished(60000));
        QCOMPARE(shell.exitCode(), 0);
        QCOMPARE(read_mesh(output.toStdString()).mesh.coordinates(), test.positions());

        test.click("tool_undo");
        test.window->jobs().load_deformation(test.inputs.path(QStringLiteral("gentle.json")));
        QVERIFY(test.wait_for_job());
        test.window->action(CommandId::warp)->trigger();
        QVERIFY(test.wait_for_job());
        test.window->action(CommandId::copy_command)->trigger();
        command = QGuiApplication::clipboard()->text();
        QVERIFY2(command.contains(QStringLiteral(" warp ")) && command.contains(QStringLiteral("gentle.json")),
                 qPrintable(command));
    }

    void work_that_is_not_saved_is_kept_until_it_is() {
        DragUnderTest test("square.msh");
        QVERIFY(kept_file(QStringLiteral("positions")).isEmpty());
        test.drag_node(test.node_at(0.5, 0.0), {9, -20});
        QVERIFY(QTest::qWaitFor([] { return !kept_file(QStringLiteral("json")).isEmpty(); }));
        test.click("tool_undo");
        QVERIFY(QTest::qWaitFor([] { return kept_file(QStringLiteral("json")).isEmpty(); }));
        test.click("tool_redo");
        QVERIFY(QTest::qWaitFor([] { return !kept_file(QStringLiteral("json")).isEmpty(); }));
        test.file_answer = test.inputs.path(QStringLiteral("saved.msh"));
        test.window->action(CommandId::save)->trigger();
        QVERIFY(test.wait_for_job());
        QVERIFY(QTest::qWaitFor([] { return kept_file(QStringLiteral("json")).isEmpty(); }));
    }

    void lost_work_is_offered_and_recovered() {
        Coordinates lost;
        {
            DragUnderTest test("square.msh");
            test.drag_node(test.node_at(0.5, 0.0), {9, -20});
            lost = test.positions();
            QVERIFY(QTest::qWaitFor([] { return !kept_file(QStringLiteral("json")).isEmpty(); }));
            copy_of_journal();
            // The work of a living program is not offered to another.
            WindowUnderTest beside;
            QTest::qWait(50);
            QCOMPARE(beside.recover_questions.size(), 1);  // of the crashed one alone
            QVERIFY(beside.recover_questions[0].contains(QStringLiteral("square.msh")));
            QVERIFY(beside.recover_questions[0].contains(QStringLiteral("1 step, the last one “Drag node")));

            // Later: it is still there. Then recovered, in the folder that the mesh is still in.
            beside.window.reset();
            WindowUnderTest::recover_answer = UnsavedAnswer::save;
            WindowUnderTest recovering;
            QVERIFY(QTest::qWaitFor([&] { return recovering.window->document().has_mesh(); }, 20000));
            QVERIFY(recovering.wait_for_job());
            QCOMPARE(recovering.window->document().state().mesh->coordinates(), lost);
            QVERIFY(recovering.window->isWindowModified());
            QCOMPARE(recovering.window->document().history()->text(0), QStringLiteral("Recovered work"));
            recovering.click("tool_undo");
            QCOMPARE(recovering.window->document().state().mesh->coordinates(),
                     *&test.document().original().mesh->coordinates());
            QVERIFY(recovering.errors.isEmpty());
            recovering.window->document().mark_unchanged();
        }
        WindowUnderTest later;
        QTest::qWait(50);
        QVERIFY(later.recover_questions.isEmpty());
    }

    void lost_work_of_a_mesh_that_has_changed_is_an_error_and_stays() {
        DragUnderTest test("square.msh");
        test.drag_node(test.node_at(0.5, 0.0), {9, -20});
        QVERIFY(QTest::qWaitFor([] { return !kept_file(QStringLiteral("json")).isEmpty(); }));
        const QString stem = copy_of_journal();
        const struct {
            qsizetype keep;
            const char* expected;
        } damages[] = {{0, "no kept positions"}, {12, "no kept positions"}, {100, "it has changed since"}};
        for (const auto& damage : damages) {
            QFile file(stem + QStringLiteral(".positions"));
            QVERIFY(file.open(QIODevice::ReadWrite));
            file.resize(damage.keep);
            file.close();
            WindowUnderTest::recover_answer = UnsavedAnswer::save;
            WindowUnderTest other;
            QVERIFY(QTest::qWaitFor([&] { return !other.errors.isEmpty(); }, 20000));
            QVERIFY2(other.errors[0].contains(QLatin1String(damage.expected)), qPrintable(other.errors[0]));
            QVERIFY(!other.window->document().has_mesh());
            QVERIFY(QFile::exists(stem + QStringLiteral(".json")));
            other.window.reset();
            QFile::remove(stem + QStringLiteral(".positions"));
            copy_of_journal();
        }
        // Thrown away: gone.
        WindowUnderTest::recover_answer = UnsavedAnswer::discard;
        WindowUnderTest other;
        QVERIFY(QTest::qWaitFor([&] { return !QFile::exists(stem + QStringLiteral(".json")); }));
        test.document().mark_unchanged();
    }
};

QObject* make_test() {
    return new SessionTest;
}

#include "session_test.moc"
