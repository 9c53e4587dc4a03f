/// Opening, dropping, saving, exporting and closing, as a user does them.

#include <QAction>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QLabel>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QTimer>
#include <QTreeWidget>

#include "core/io/mesh_io.h"
#include "tests/gui/gui_test_support.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/start_page.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

void drop(QWidget* widget, const QString& path) {
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(path)});
    const QPoint at(100, 100);
    QDragEnterEvent enter(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(widget, &enter);
    QVERIFY(enter.isAccepted());
    QDropEvent event(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(widget, &event);
    QVERIFY(event.isAccepted());
}

/// The sentence that reading a file gives without the window.
QString sentence_of(const QString& path) {
    try {
        read_mesh(path.toStdString());
    } catch (const std::exception& problem) {
        return QString::fromUtf8(problem.what());
    }
    return {};
}

void make_dirty(WindowUnderTest& test) {
    test.open(test.inputs.path(QStringLiteral("square.msh")), test.inputs.path(QStringLiteral("gentle.json")));
    QVERIFY(test.window->jobs().deform());
    QVERIFY(test.wait_for_job());
    QVERIFY(test.window->document().is_dirty());
}

}  // namespace

class FilesTest : public QObject {
    Q_OBJECT

  private slots:
    void dialog_opens_a_mesh_and_remembers_it() {
        WindowUnderTest test;
        test.file_answer = test.inputs.path(QStringLiteral("square.msh"));
        test.click("tool_open");
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.text("file_name"), QStringLiteral("square.msh"));
        test.window->action(CommandId::close_mesh)->trigger();
        QVERIFY(!test.window->document().has_mesh());
        const auto recent = test.window->findChildren<QPushButton*>(QStringLiteral("recent_file"));
        QVERIFY(!recent.isEmpty());
        QCOMPARE(recent.front()->toolTip(), test.file_answer);
        QTest::mouseClick(recent.front(), Qt::LeftButton);
        QVERIFY(test.wait_for_job());
        QVERIFY(test.window->document().has_mesh());
    }

    void dropping_opens_meshes_and_deformations() {
        WindowUnderTest test;
        drop(test.window.get(), test.inputs.path(QStringLiteral("bump.json")));
        QTRY_COMPARE(test.errors.size(), 1);
        QVERIFY(test.errors[0].contains(QStringLiteral("open the mesh that it deforms first")));
        drop(test.window.get(), test.inputs.path(QStringLiteral("square.msh")));
        QTRY_VERIFY(test.window->document().has_mesh());
        QVERIFY(test.wait_for_job());
        drop(test.window.get(), test.inputs.path(QStringLiteral("bump.json")));
        QTRY_VERIFY(test.window->document().deformation().has_value());
        QCOMPARE(test.text("deformation_name"), QStringLiteral("bump.json"));
        QCOMPARE(test.find<QTreeWidget>("operations")->topLevelItem(0)->text(0), QStringLiteral("bottom"));
    }

    void malformed_file_keeps_the_open_mesh() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        const auto mesh = test.window->document().state().mesh;
        const QString bad = test.inputs.path(QStringLiteral("malformed.msh"));
        test.window->open_file(bad);
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.errors.size(), 1);
        QVERIFY(!sentence_of(bad).isEmpty());
        QCOMPARE(test.errors[0], sentence_of(bad));
        QCOMPARE(test.window->document().state().mesh, mesh);
        QCOMPARE(test.text("file_name"), QStringLiteral("square.msh"));
        test.window->open_file(test.inputs.path(QStringLiteral("missing.msh")));
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.errors.size(), 2);
        QVERIFY(test.errors[1].contains(QStringLiteral("missing.msh")));
        QCOMPARE(test.window->document().state().mesh, mesh);
    }

    void real_error_box_shows_the_sentence() {
        const Inputs inputs;
        MainWindow window(theme());
        window.show();
        window.open_file(inputs.path(QStringLiteral("malformed.msh")));
        QTRY_VERIFY(window.findChild<QMessageBox*>(QStringLiteral("error_box")));
        auto* box = window.findChild<QMessageBox*>(QStringLiteral("error_box"));
        QTRY_VERIFY(box->isVisible());
        QCOMPARE(box->text(), sentence_of(inputs.path(QStringLiteral("malformed.msh"))));
        QTest::mouseClick(box->button(QMessageBox::Ok), Qt::LeftButton);
        QTRY_VERIFY(!window.findChild<QMessageBox*>(QStringLiteral("error_box")));
    }

    void failed_deformation_changes_nothing() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("cube.msh")), test.inputs.path(QStringLiteral("bump.json")));
        QVERIFY(test.window->jobs().warp({}));
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.errors.size(), 1);
        QVERIFY(test.errors[0].contains(QStringLiteral("bottom")));
        QCOMPARE(test.window->document().history()->count(), 0);
    }

    void export_writes_what_is_shown() {
        WindowUnderTest test;
        make_dirty(test);
        const CurvedMesh& shown = *test.window->document().state().mesh;
        const struct {
            const char *name, *filter;
            MeshFormat format;
        } cases[] = {{"out.vtu", "VTU", MeshFormat::vtu},
                     {"out4.msh", "MSH 4.1", MeshFormat::msh4},
                     {"out2.msh", "MSH 2.2", MeshFormat::msh2},
                     {"bare", "MSH 2.2", MeshFormat::msh2}};
        for (const auto& entry : cases) {
            test.file_answer = test.inputs.path(QLatin1String(entry.name));
            test.filter_answer = QLatin1String(entry.filter);
            test.click("tool_export");
            QVERIFY(test.wait_for_job());
            QVERIFY2(test.errors.isEmpty(), qPrintable(test.errors.join(QLatin1Char('\n'))));
            QString path = test.file_answer;
            if (!path.contains(QLatin1String("out"))) path += QStringLiteral(".msh");
            const ReadResult back = read_mesh(path.toStdString());
            QVERIFY(back.format == entry.format);
            QCOMPARE(back.mesh.topology().element_count(), shown.topology().element_count());
            QCOMPARE(back.mesh.coordinates(), shown.coordinates());
        }
        QFile vtu(test.inputs.path(QStringLiteral("out.vtu")));
        QVERIFY(vtu.open(QIODevice::ReadOnly));
        const QByteArray text = vtu.readAll();
        for (const char* array : {"ScaledJacobian", "Validity", "Displacement"}) QVERIFY2(text.contains(array), array);
        QVERIFY(test.window->document().is_dirty());  // a copy is not a save
    }

    void save_asks_for_a_name_once() {
        WindowUnderTest test;
        make_dirty(test);
        const QByteArray input = [&] {
            QFile file(test.inputs.path(QStringLiteral("square.msh")));
            return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
        }();
        test.file_answer = test.inputs.path(QStringLiteral("saved.msh"));
        test.filter_answer = QStringLiteral("MSH 4.1");
        test.click("tool_save");
        QVERIFY(test.wait_for_job());
        QVERIFY(!test.window->document().is_dirty());
        QCOMPARE(test.text("file_name"), QStringLiteral("saved.msh"));
        QVERIFY(test.window->jobs().deform());
        QVERIFY(test.wait_for_job());
        test.file_answer = QStringLiteral("/nowhere/never-asked.msh");
        test.click("tool_save");
        QVERIFY(test.wait_for_job());
        QVERIFY(test.errors.isEmpty() && !test.window->document().is_dirty());
        const ReadResult back = read_mesh(test.inputs.path(QStringLiteral("saved.msh")).toStdString());
        QCOMPARE(back.mesh.coordinates(), test.window->document().state().mesh->coordinates());
        QFile opened(test.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(opened.open(QIODevice::ReadOnly) && opened.readAll() == input);
    }

    void export_that_fails_is_told() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        test.file_answer = test.inputs.path(QStringLiteral("no/such/folder/out.vtu"));
        test.click("tool_export");
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.errors.size(), 1);
        QVERIFY(test.errors[0].contains(QStringLiteral("out.vtu")));
    }

    void closing_with_changes_asks() {
        WindowUnderTest test;
        make_dirty(test);
        test.unsaved_answer = UnsavedAnswer::cancel;
        test.window->close();
        QCoreApplication::processEvents();
        QCOMPARE(test.unsaved_questions, 1);
        QVERIFY(test.window->isVisible());
        test.unsaved_answer = UnsavedAnswer::save;
        test.file_answer = test.inputs.path(QStringLiteral("kept.vtu"));
        test.window->close();
        QTRY_VERIFY(!test.window->isVisible());
        QCOMPARE(test.unsaved_questions, 2);
        const ReadResult back = read_mesh(test.file_answer.toStdString());
        QCOMPARE(back.mesh.coordinates(), test.window->document().state().mesh->coordinates());
    }

    void discarding_closes_at_once() {
        WindowUnderTest test;
        make_dirty(test);
        test.unsaved_answer = UnsavedAnswer::discard;
        test.window->close();
        QTRY_VERIFY(!test.window->isVisible());
        QCOMPARE(test.unsaved_questions, 1);
    }

    void opening_over_changes_asks() {
        WindowUnderTest test;
        make_dirty(test);
        test.window->open_file(test.inputs.path(QStringLiteral("cube.msh")));
        QCOMPARE(test.unsaved_questions, 1);
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.text("file_name"), QStringLiteral("square.msh"));
        test.unsaved_answer = UnsavedAnswer::discard;
        test.window->open_file(test.inputs.path(QStringLiteral("cube.msh")));
        QVERIFY(test.wait_for_job());
        QCOMPARE(test.text("file_name"), QStringLiteral("cube.msh"));
    }

    void real_question_about_changes() {
        MainWindow window(theme());
        const Inputs inputs;
        window.show();
        window.open_file(inputs.path(QStringLiteral("square.msh")), inputs.path(QStringLiteral("gentle.json")), true);
        QTRY_VERIFY(window.document().is_dirty());
        QString asked;
        QTimer::singleShot(300, &window, [&asked] {
            auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
            if (!box) return;
            asked = box->text();
            QTest::mouseClick(box->button(QMessageBox::Discard), Qt::LeftButton);
        });
        window.close();
        QTRY_VERIFY(!window.isVisible());
        QVERIFY(asked.contains(QStringLiteral("square.msh")));
    }

    void closing_stops_a_running_job() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        QVERIFY(test.window->jobs().runner().start(QStringLiteral("Waiting"), [](const TaskContext& context) {
            while (!context.stop.stop_requested()) std::this_thread::yield();
            return [] {};
        }));
        test.window->close();
        QVERIFY(!test.window->jobs().runner().is_running());
        QVERIFY(!test.window->isVisible());
    }

    void sample_is_ready_to_work_on() {
        const Inputs inputs;
        Sample sample;
        sample.mesh_path = inputs.path(QStringLiteral("square.msh"));
        sample.deformation_path = inputs.path(QStringLiteral("bump.json"));
        sample.task = Sample::Task::untangle;
        sample.beta = 0.25;
        WindowUnderTest test;
        test.window->open_sample(sample);
        QVERIFY(test.wait_for_job());
        QVERIFY(test.window->document().state().quality->summary.invalid > 0);
        QVERIFY(test.find<QPushButton>("untangle_button")->isVisible());
        QCOMPARE(test.find<QComboBox>("method")->currentText(), QStringLiteral("Signed angles"));
        QCOMPARE(test.find<QDoubleSpinBox>("beta")->value(), 0.25);
        // It is where the user starts: leaving it loses nothing.
        QCOMPARE(test.window->document().history()->count(), 1);
        QVERIFY(!test.window->isWindowModified());
        test.click("untangle_button");
        QVERIFY(test.wait_for_job());
        QVERIFY(test.window->isWindowModified());
    }
};

QObject* make_test() {
    return new FilesTest;
}

#include "files_test.moc"
