/// The session, its replay, the command line on the clipboard, and work that a crash leaves.

#include <QClipboard>
#include <QDir>
#include <QFile>
#include <QGuiApplication>
#include <QLabel>
#include <QListView>
#include <QProcess>
#include <QProcessEnvironment>
#include <QSettings>
#include <QStatusBar>
#include <cstdio>
#include <cstring>

#include "core/base/error.h"
#include "core/io/mesh_io.h"
#include "core/session/journal_file.h"
#include "core/session/replay.h"
#include "core/session/session_file.h"
#include "tests/gui/drag_under_test.h"
#include "ui/document/journal.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

/// The journal of the living window; "" if there is none.
QString living_journal() {
    const QDir folder(Journal::standard_folder());
    QStringList names = folder.entryList({QStringLiteral("*.journal")}, QDir::Files);
    names.removeIf([](const QString& name) { return name.startsWith(QStringLiteral("crashed")); });
    return names.isEmpty() ? QString() : folder.filePath(names.front());
}

std::optional<JournalContent> read_living() {
    const QString file = living_journal();
    if (file.isEmpty()) return {};
    try {
        return read_journal(file.toStdString());
    } catch (const Error&) {
        return {};  // its head is being written
    }
}

std::string text_of(const std::vector<Action>& session) {
    std::string text;
    for (const Action& action : session) text += to_json_line(action) + '\n';
    return text;
}

/// Waits until the journal has everything that was done.
bool is_kept(const MeshDocument& document) {
    return QTest::qWaitFor(
        [&] {
            const auto content = read_living();
            return content && content->damage.empty() && text_of(content->session) == text_of(document.session()) &&
                   content->head.clean == document.history()->cleanIndex();
        },
        20000);
}

/// What a program that crashed would have left: the journal of a living one under another name.
QString copy_of_journal() {
    const QString file = living_journal();
    if (file.isEmpty()) qFatal("There is no journal.");
    const QString copy = QDir(Journal::standard_folder()).filePath(QStringLiteral("crashed.journal"));
    QFile::remove(copy);
    if (!QFile::copy(file, copy)) qFatal("The journal cannot be copied.");
    return copy;
}

void cut(const QString& file, qint64 size) {
    QFile journal(file);
    if (!journal.open(QIODevice::ReadWrite) || !journal.resize(size)) qFatal("The journal cannot be cut.");
}

bool is_same(const Coordinates& a, const Coordinates& b) {
    return a.rows() == b.rows() &&
           std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

void compare_states(const MeshState& a, const MeshState& b) {
    QVERIFY(is_same(a.mesh->coordinates(), b.mesh->coordinates()));
    QCOMPARE(fingerprint(a.mesh->topology()), fingerprint(b.mesh->topology()));
    QCOMPARE(a.applied_deformations, b.applied_deformations);
    QVERIFY(a.quality && b.quality);
    QCOMPARE(a.quality->orientation_sign, b.quality->orientation_sign);
    for (std::size_t i = 0; i < a.quality->elements.size(); ++i) {
        QCOMPARE(a.quality->elements[i].scaled_jacobian, b.quality->elements[i].scaled_jacobian);
        QVERIFY(a.quality->elements[i].validity == b.quality->elements[i].validity);
    }
}

/// Both documents are the same, with all of their histories. Goes through these, and back.
void compare_documents(MeshDocument& a, MeshDocument& b) {
    QCOMPARE(text_of(a.session()), text_of(b.session()));
    QCOMPARE(a.file_path(), b.file_path());
    QCOMPARE(a.history()->count(), b.history()->count());
    QCOMPARE(a.history()->index(), b.history()->index());
    QCOMPARE(a.history()->cleanIndex(), b.history()->cleanIndex());
    compare_states(a.original(), b.original());
    for (int step = 0; step < a.history()->count(); ++step) {
        QCOMPARE(a.history()->text(step), b.history()->text(step));
        QCOMPARE(a.step_details(step), b.step_details(step));
        QCOMPARE(to_json_line(a.step_action(step)), to_json_line(b.step_action(step)));
    }
    for (int index = 0; index <= a.history()->count(); ++index) compare_states(a.state_at(index), b.state_at(index));
    compare_states(a.before(), b.before());
    compare_states(a.state(), b.state());
}

/// A window in which much has been done: drags, a loaded deformation, a warp, a flip, steps back and another way.
struct BusyWindow : DragUnderTest {
    BusyWindow() : DragUnderTest("square.msh", true) {
        drag_node(node_at(0.5, 0.0), {9, -20});
        drag_node(node_at(1.0, 0.5), {-14, 5});
        click("tool_undo");
        drag_node(node_at(0.5, 1.0), {3, -8});
        run([&] { window->jobs().load_deformation(inputs.path(QStringLiteral("gentle.json"))); });
        run([&] { window->action(CommandId::warp)->trigger(); });
        run([&] { window->action(CommandId::flip)->trigger(); });
        run([&] { window->action(CommandId::flip)->trigger(); });
        click("tool_undo");
        if (!errors.isEmpty()) qFatal("%s", qPrintable(errors.front()));
    }
    template <class Function>
    void run(Function function) {
        function();
        if (!wait_for_job()) qFatal("The job did not end.");
    }
};

}  // namespace

class SessionTest : public QObject {
    Q_OBJECT

  private slots:
    void init() {
        QSettings().clear();
        if (!qEnvironmentVariableIsEmpty("CURVEWRIGHT_VICTIM_MESH")) return;
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
        const auto is_dirty = [] {
            const QString file = living_journal();
            if (file.isEmpty()) return false;
            try {
                return summarize_journal(file.toStdString()).is_dirty();
            } catch (const Error&) {
                return false;
            }
        };
        {
            DragUnderTest test("square.msh");
            QVERIFY(living_journal().isEmpty());
            test.drag_node(test.node_at(0.5, 0.0), {9, -20});
            QTRY_VERIFY(is_dirty());
            test.click("tool_undo");
            QTRY_VERIFY(!is_dirty());
            test.click("tool_redo");
            QTRY_VERIFY(is_dirty());
            test.file_answer = test.inputs.path(QStringLiteral("saved.msh"));
            test.window->action(CommandId::save)->trigger();
            QVERIFY(test.wait_for_job());
            QTRY_VERIFY(!is_dirty());
            // What would be saved is not offered when the program ends in this moment.
            copy_of_journal();
            WindowUnderTest other;
            QTest::qWait(50);
            QVERIFY(other.recover_questions.isEmpty());
            QVERIFY(!QFile::exists(QDir(Journal::standard_folder()).filePath(QStringLiteral("crashed.journal"))));
            // Another step, and another mesh: that one's journal begins anew.
            test.drag_node(test.node_at(1.0, 0.5), {-9, 2});
            QTRY_VERIFY(is_dirty());
            test.unsaved_answer = UnsavedAnswer::discard;
            test.open(test.inputs.path(QStringLiteral("square.msh")));
            QTRY_VERIFY(living_journal().isEmpty());
        }
        QVERIFY(living_journal().isEmpty());
    }

    void every_step_is_written_once() {
        DragUnderTest test("square.msh");
        qint64 last = 0;
        for (int i = 0; i < 4; ++i) {
            test.drag_node(test.node_at(i < 2 ? 0.5 : 0.25, i % 2 ? 1.0 : 0.0), {4, i % 2 ? -5 : 5});
            QVERIFY(is_kept(test.document()));
            const qint64 size = QFileInfo(living_journal()).size();
            // The nodes with index and position, the action, the name: nothing of the steps before.
            const qint64 all = static_cast<qint64>(test.positions().rows()) * 28;
            if (last > 0) QVERIFY2(size - last < all + 1500, qPrintable(QString::number(size - last)));
            QVERIFY(size > last);
            last = size;
        }
        const auto content = read_living();
        QCOMPARE(content->records, 5u);
    }

    void lost_work_comes_back_with_its_history() {
        {
            BusyWindow test;
            QVERIFY(is_kept(test.document()));
            copy_of_journal();
            // The work of a living program is not offered to another.
            WindowUnderTest beside;
            QTest::qWait(50);
            QCOMPARE(beside.recover_questions.size(), 1);  // of the crashed one alone
            QVERIFY(beside.recover_questions[0].contains(QStringLiteral("square.msh")));
            QVERIFY2(beside.recover_questions[0].contains(QStringLiteral("4 steps, the last one “Flip numbering”")),
                     qPrintable(beside.recover_questions[0]));

            // Later: it is still there.
            beside.window.reset();
            WindowUnderTest::recover_answer = UnsavedAnswer::save;
            WindowUnderTest recovering;
            QVERIFY(QTest::qWaitFor([&] { return recovering.window->document().has_mesh(); }, 20000));
            QVERIFY(recovering.wait_for_job());
            MeshDocument& document = recovering.window->document();
            QVERIFY(recovering.errors.isEmpty());
            compare_documents(document, test.document());
            QVERIFY(recovering.window->isWindowModified());
            QCOMPARE(document.deformation()->file_path, test.document().deformation()->file_path);
            auto* history = recovering.find<QListView>("history");
            QCOMPARE(history->model()->rowCount(), document.history()->count() + 1);
            QCOMPARE(history->currentIndex().row(), document.history()->index());

            // It goes on as if nothing had happened, and so does its journal.
            test.run([&] { test.window->action(CommandId::warp)->trigger(); });
            recovering.window->action(CommandId::warp)->trigger();
            QVERIFY(recovering.wait_for_job());
            for (MeshDocument* its : {&document, &test.document()}) {
                its->history()->undo();
                its->history()->undo();
                its->history()->redo();
            }
            compare_documents(document, test.document());
            test.document().mark_unchanged();
            test.window.reset();
            QVERIFY(is_kept(document));
            // Crashes again.
            copy_of_journal();
            WindowUnderTest again;
            QVERIFY(QTest::qWaitFor([&] { return again.window->document().has_mesh(); }, 20000));
            QVERIFY(again.wait_for_job());
            compare_documents(again.window->document(), document);
            again.window->document().mark_unchanged();
            document.mark_unchanged();
        }
        WindowUnderTest later;
        QTest::qWait(50);
        QVERIFY(later.recover_questions.isEmpty());
        QVERIFY(living_journal().isEmpty());
    }

    void a_program_that_is_killed_leaves_its_work() {
        // Another process with this program's folders: it drags, tells that it is kept, and is killed.
        QProcess victim;
        QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
        const Inputs inputs;
        environment.insert(QStringLiteral("CURVEWRIGHT_VICTIM_MESH"), inputs.path(QStringLiteral("square.msh")));
        environment.insert(QStringLiteral("CURVEWRIGHT_VICTIM_DATA"), QString::fromLocal8Bit(qgetenv("XDG_DATA_HOME")));
        victim.setProcessEnvironment(environment);
        victim.setProcessChannelMode(QProcess::MergedChannels);
        victim.start(QCoreApplication::applicationFilePath(), {QStringLiteral("victim")});
        QByteArray said;
        QVERIFY(QTest::qWaitFor(
            [&] {
                said += victim.readAll();
                return said.contains("KEPT") || victim.state() == QProcess::NotRunning;
            },
            60000));
        QVERIFY2(said.contains("KEPT"), said.constData());
        // It lives: nothing is offered.
        {
            WindowUnderTest early;
            QTest::qWait(50);
            QVERIFY(early.recover_questions.isEmpty());
        }
        victim.kill();
        QVERIFY(victim.waitForFinished(20000));
        WindowUnderTest::recover_answer = UnsavedAnswer::save;
        WindowUnderTest recovering;
        QVERIFY(QTest::qWaitFor([&] { return recovering.window->document().has_mesh(); }, 20000));
        QVERIFY(recovering.wait_for_job());
        QCOMPARE(recovering.recover_questions.size(), 1);
        MeshDocument& document = recovering.window->document();
        QCOMPARE(document.history()->count(), 2);
        QCOMPARE(document.history()->index(), 1);
        const qsizetype at = said.indexOf("SUM ");
        QCOMPARE(QByteArray::number(document.state_at(2).mesh->coordinates().sum(), 'g', 17),
                 said.mid(at + 4, said.indexOf('\n', at) - at - 4).trimmed());
        document.mark_unchanged();
    }

    void damaged_work_comes_back_up_to_the_damage() {
        DragUnderTest test("square.msh");
        test.drag_node(test.node_at(0.5, 0.0), {9, -20});
        test.drag_node(test.node_at(0.5, 1.0), {3, 8});
        QVERIFY(is_kept(test.document()));
        const QString file = copy_of_journal();
        cut(file, QFileInfo(file).size() - 1);
        WindowUnderTest::recover_answer = UnsavedAnswer::save;
        WindowUnderTest recovering;
        QVERIFY(QTest::qWaitFor([&] { return recovering.window->document().has_mesh(); }, 20000));
        QVERIFY(recovering.wait_for_job());
        MeshDocument& document = recovering.window->document();
        QVERIFY(recovering.errors.isEmpty());
        QVERIFY(recovering.recover_questions[0].contains(QStringLiteral("1 step, ")));
        QCOMPARE(document.history()->count(), 1);
        compare_states(document.state(), test.document().state_at(1));
        QVERIFY(recovering.window->statusBar()->currentMessage().contains(QStringLiteral("damaged")));
        // It is whole from here on.
        document.history()->undo();
        test.document().mark_unchanged();
        test.window.reset();
        QVERIFY(is_kept(document));
    }

    void lost_work_of_a_mesh_that_has_changed_is_an_error_and_stays() {
        DragUnderTest test("square.msh");
        test.drag_node(test.node_at(0.5, 0.0), {9, -20});
        QVERIFY(is_kept(test.document()));
        const QString mesh = test.inputs.path(QStringLiteral("square.msh"));
        const struct {
            const char* other;
            const char* expected;
        } cases[] = {{"quad.msh", "it has changed since"}, {"missing.msh", "there is no such file"}};
        for (const auto& entry : cases) {
            const QString file = copy_of_journal();
            QFile::remove(mesh);
            QFile::copy(test.inputs.path(QLatin1String(entry.other)), mesh);
            WindowUnderTest::recover_answer = UnsavedAnswer::save;
            WindowUnderTest other;
            QVERIFY(QTest::qWaitFor([&] { return !other.errors.isEmpty(); }, 20000));
            QVERIFY2(other.errors[0].contains(QLatin1String(entry.expected)), qPrintable(other.errors[0]));
            QVERIFY(other.errors[0].contains(QStringLiteral("square.msh")));
            QVERIFY(!other.window->document().has_mesh());
            QVERIFY(QFile::exists(file));
        }
        // Saved over the opened file: the work before that comes back all the same.
        test.file_answer = mesh;
        test.window->action(CommandId::save)->trigger();
        QVERIFY(test.wait_for_job());
        test.drag_node(test.node_at(0.5, 1.0), {3, 8});
        QVERIFY(is_kept(test.document()));
        copy_of_journal();
        {
            WindowUnderTest other;
            QVERIFY(QTest::qWaitFor([&] { return other.window->document().has_mesh(); }, 20000));
            QVERIFY(other.wait_for_job());
            compare_documents(other.window->document(), test.document());
            other.window->document().mark_unchanged();
        }
        // A journal without a beginning is nothing to offer; one that is thrown away is gone.
        cut(copy_of_journal(), 100);
        WindowUnderTest::recover_answer = UnsavedAnswer::discard;
        {
            WindowUnderTest other;
            QTest::qWait(50);
            QVERIFY(other.recover_questions.isEmpty());
        }
        const QString file = copy_of_journal();
        WindowUnderTest other;
        QTRY_VERIFY(!QFile::exists(file));
        QCOMPARE(other.recover_questions.size(), 1);
        test.document().mark_unchanged();
    }

    void recovering_can_be_stopped() {
        DragUnderTest test("square.msh");
        test.drag_node(test.node_at(0.5, 0.0), {9, -20});
        QVERIFY(is_kept(test.document()));
        const QString file = copy_of_journal();
        WindowUnderTest::recover_answer = UnsavedAnswer::save;
        WindowUnderTest other;
        bool was_stopped = false;
        connect(&other.window->jobs().runner(), &JobRunner::started, this, [&] {
            QMetaObject::invokeMethod(other.window.get(), [&] { other.window->jobs().runner().cancel(); });
        });
        connect(&other.window->jobs().runner(), &JobRunner::cancelled, this, [&] { was_stopped = true; });
        QTRY_VERIFY_WITH_TIMEOUT(was_stopped || other.window->document().has_mesh(), 20000);
        QCOMPARE(other.window->document().has_mesh(), !was_stopped);
        QCOMPARE(QFile::exists(file), was_stopped);
        other.window->document().mark_unchanged();
        test.document().mark_unchanged();
    }

    void a_session_is_opened_with_its_history() {
        BusyWindow test;
        test.file_answer = test.inputs.path(QStringLiteral("work.json"));
        test.window->action(CommandId::save_session)->trigger();
        WindowUnderTest other;
        other.file_answer = test.file_answer;
        other.window->action(CommandId::open_session)->trigger();
        QVERIFY(other.wait_for_job());
        QVERIFY(other.errors.isEmpty());
        MeshDocument& document = other.window->document();
        QCOMPARE(document.history()->count(), test.document().history()->count());
        QCOMPARE(document.history()->index(), test.document().history()->index());
        QCOMPARE(document.history()->cleanIndex(), 0);
        for (int step = 0; step <= document.history()->count(); ++step)
            compare_states(document.state_at(step), test.document().state_at(step));
        for (int step = 0; step < document.history()->count(); ++step)
            QCOMPARE(to_json_line(document.step_action(step)), to_json_line(test.document().step_action(step)));
        QCOMPARE(document.history()->text(2), test.document().history()->text(2));
        QCOMPARE(document.step_details(2), test.document().step_details(2));
        QCOMPARE(text_of(document.way_here()), text_of(test.document().way_here()));
        test.document().mark_unchanged();
        test.window.reset();
        // It is unsaved work like any other.
        QVERIFY(is_kept(document));

        // Dropped, relative to its folder, and doing what cannot be done.
        QFile session(test.inputs.path(QStringLiteral("short.json")));
        QVERIFY(session.open(QIODevice::WriteOnly));
        session.write(
            "{\"action\":\"open\",\"mesh\":\"square.msh\"}\n"
            "{\"action\":\"deform\",\"deformation\":\"gentle.json\"}\n");
        session.close();
        other.unsaved_answer = UnsavedAnswer::discard;
        other.window->open_file(session.fileName());
        QVERIFY(other.wait_for_job());
        QVERIFY(other.errors.isEmpty());
        QCOMPARE(document.history()->count(), 1);
        QCOMPARE(document.file_path(), test.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(document.is_deformation_applied());
        const char* bad[] = {"{\"action\":\"flip\"}\n",
                             "{\"action\":\"open\",\"mesh\":\"square.msh\"}\n{\"action\":\"history\",\"step\":1}\n",
                             "{\"action\":\"open\",\"mesh\":\"no.msh\"}\n",
                             "{\"action\":\"open\",\"mesh\":\"square.msh\"}\n{\"action\":\"undo\"}\n"};
        for (const char* text : bad) {
            QVERIFY(session.open(QIODevice::WriteOnly | QIODevice::Truncate));
            session.write(text);
            session.close();
            other.errors.clear();
            other.window->open_file(session.fileName());
            QVERIFY(other.wait_for_job());
            QCOMPARE(other.errors.size(), 1);
            QCOMPARE(document.history()->count(), 1);
        }
        document.mark_unchanged();
    }

    /// Only on request, by a_program_that_is_killed_leaves_its_work: the program that is killed.
    void victim() {
        if (qEnvironmentVariableIsEmpty("CURVEWRIGHT_VICTIM_MESH")) return;
        qputenv("XDG_DATA_HOME", qgetenv("CURVEWRIGHT_VICTIM_DATA"));
        DragUnderTest test("square.msh");
        test.open(qEnvironmentVariable("CURVEWRIGHT_VICTIM_MESH"));
        test.drag_node(test.node_at(0.5, 0.0), {9, -20});
        test.drag_node(test.node_at(0.5, 1.0), {3, 8});
        QVERIFY(is_kept(test.document()));
        std::printf("SUM %s\n", QByteArray::number(test.positions().sum(), 'g', 17).constData());
        test.click("tool_undo");
        QVERIFY(is_kept(test.document()));
        std::printf("KEPT\n");
        std::fflush(stdout);
        QTest::qWait(60000);
    }
};

QObject* make_test() {
    return new SessionTest;
}

#include "session_test.moc"
