/// What a user does with an open mesh: by mouse and keyboard, on the real window.

#include <QAction>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHelpEvent>
#include <QLabel>
#include <QMenuBar>
#include <QPushButton>
#include <QSignalSpy>
#include <QSlider>
#include <QToolButton>
#include <QToolTip>
#include <QTreeWidget>
#include <QUndoView>
#include <set>

#include "core/deform/deformation.h"
#include "core/warp/warp.h"
#include "tests/gui/gui_test_support.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/histogram_widget.h"
#include "ui/panels/start_page.h"

using namespace curvewright;
using namespace curvewright::testing;

class WindowTest : public QObject {
    Q_OBJECT

  private slots:
    void commands_are_declared_once() {
        WindowUnderTest test;
        std::set<std::string> names, keys;
        for (const Command& command : commands()) {
            QVERIFY2(names.insert(command.name).second, command.name);
            const QAction* action = test.window->action(command.id);
            QCOMPARE(action->objectName(), QLatin1String(command.name));
            QVERIFY2(!action->toolTip().isEmpty(), command.name);
            QCOMPARE(action->icon().isNull(), *command.icon == 0);
            for (const QKeySequence& key : action->shortcuts()) {
                QVERIFY2(!key.isEmpty(), command.name);
                QVERIFY2(keys.insert(key.toString().toStdString()).second, qPrintable(key.toString()));
            }
        }
    }

    void starts_with_the_start_page() {
        WindowUnderTest test;
        QVERIFY(test.window->findChild<StartPage*>()->isVisible());
        QVERIFY(!test.find<QToolButton>("tool_warp")->isEnabled());
        QVERIFY(!test.find<QPushButton>("untangle_button")->isVisible());
        QVERIFY(!test.window->isWindowModified());
    }

    void opening_shows_what_it_is() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        QCOMPARE(test.text("file_name"), QStringLiteral("square.msh"));
        QCOMPARE(test.text("mesh_elements"), QStringLiteral("P3 · 32 triangles"));
        QCOMPARE(test.text("mesh_validity"), QStringLiteral("✓ all proved valid"));
        QCOMPARE(test.text("verdict"), QStringLiteral("✓ all proved valid"));
        QVERIFY(test.text("after_figures").startsWith(QStringLiteral("min 1.00   mean 1.00   max 1.00")));
        QVERIFY(test.window->windowTitle().startsWith(QStringLiteral("square.msh")));
        QCOMPARE(test.find<QTreeWidget>("groups")->topLevelItemCount(), 5);
        QVERIFY(test.window->view().isVisible());
        QVERIFY(test.errors.isEmpty());
    }

    void operations_say_why_they_cannot_run() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("cube.msh")));

        test.window->show_tab(QStringLiteral("warp"));
        QVERIFY(!test.find<QPushButton>("warp_button")->isEnabled());
        QCOMPARE(test.text("warp_button_reason"), QStringLiteral("Load a deformation first."));
        test.window->show_tab(QStringLiteral("untangle"));
        QVERIFY(test.find<QPushButton>("untangle_button")->isEnabled());
        QVERIFY(test.find<QToolButton>("tool_untangle")->isEnabled());
        auto* method = test.find<QComboBox>("method");
        method->setCurrentIndex(method->findText(QStringLiteral("Signed angles")));
        QVERIFY(!test.find<QPushButton>("untangle_button")->isEnabled());
        QVERIFY(!test.find<QToolButton>("tool_untangle")->isEnabled());
        QVERIFY(test.text("untangle_button_reason").contains(QStringLiteral("P2 tetrahedron")));
    }

    void deform_untangle_undo_redo() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")), test.inputs.path(QStringLiteral("bump.json")));
        MeshDocument& document = test.window->document();
        const Coordinates opened = document.state().mesh->coordinates();

        // The tab is there by itself once a deformation is.
        test.click("deform_button");
        QVERIFY(test.wait_for_job());
        const Coordinates deformed = document.state().mesh->coordinates();
        const QualitySummary tangled = document.state().quality->summary;
        QVERIFY(tangled.invalid > 0);
        QVERIFY(test.text("verdict").contains(QStringLiteral("tangled (scaled Jacobian ≤ 0)")));
        QCOMPARE(test.find<HistogramWidget>("after_histogram")->bars().tangled.count(), tangled.invalid);
        QCOMPARE(test.find<HistogramWidget>("before_histogram")->bars().tangled.count(), 0);
        QCOMPARE(test.find<HistogramWidget>("after_histogram")->limit(),
                 test.find<HistogramWidget>("before_histogram")->limit());
        QVERIFY(test.window->isWindowModified());
        QCOMPARE(test.find<QTreeWidget>("worst_elements")->topLevelItem(0)->text(2), QStringLiteral("tangled"));

        test.window->show_tab(QStringLiteral("untangle"));
        test.click("untangle_button");
        QVERIFY(test.wait_for_job());
        const Coordinates untangled = document.state().mesh->coordinates();
        QCOMPARE(document.state().quality->summary.invalid, 0);
        QCOMPARE(test.text("verdict"), QStringLiteral("✓ all proved valid"));
        QVERIFY(test.text("before_validity").contains(QStringLiteral("tangled")));
        QCOMPARE(test.text("after_validity"), QStringLiteral("✓ all proved valid"));
        for (const Index node : document.state().mesh->topology().boundary_nodes())
            QCOMPARE(untangled.row(node), deformed.row(node));

        test.click("tool_undo");
        QCOMPARE(document.state().mesh->coordinates(), deformed);
        QCOMPARE(test.find<HistogramWidget>("after_histogram")->bars().tangled.count(), tangled.invalid);
        test.click("tool_undo");
        QCOMPARE(document.state().mesh->coordinates(), opened);
        QVERIFY(!test.find<QToolButton>("tool_undo")->isEnabled());
        QVERIFY(!test.window->isWindowModified());
        test.click("tool_redo");
        QCOMPARE(document.state().mesh->coordinates(), deformed);
        test.click("tool_redo");
        QCOMPARE(document.state().mesh->coordinates(), untangled);

        // The list of the history jumps.
        auto* history = test.find<QUndoView>("history");
        const QRect first = history->visualRect(history->model()->index(0, 0));
        QTest::mouseClick(history->viewport(), Qt::LeftButton, {}, first.center());
        QCOMPARE(document.state().mesh->coordinates(), opened);
    }

    void warp_follows_the_boundary() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")), test.inputs.path(QStringLiteral("bump.json")));
        test.window->show_tab(QStringLiteral("warp"));
        auto* weights = test.find<QComboBox>("weights");
        auto* power = test.find<QDoubleSpinBox>("distance_power");
        QCOMPARE(power->value(), WarpOptions().distance_power);
        MeshDocument& document = test.window->document();
        for (const int choice : {0, 1}) {
            weights->setCurrentIndex(choice);
            test.click("warp_button");
            QVERIFY(test.wait_for_job());
            QCOMPARE(document.history()->index(), 1);
            QCOMPARE(document.history()->undoText(),
                     choice == 0 ? QStringLiteral("Warp, convex weights") : QStringLiteral("Warp, affine weights"));
            QCOMPARE(document.state().quality->summary.invalid, 0);
            QVERIFY(document.is_deformation_applied());
            QVERIFY(document.state().mesh->coordinates() != document.original().mesh->coordinates());
            test.click("tool_undo");
            QCOMPARE(document.state().mesh->coordinates(), document.original().mesh->coordinates());
            QVERIFY(!document.is_deformation_applied());
        }

        // The distance power reaches the job, and the history says so.
        const CurvedMesh& opened = *document.state().mesh;
        const Coordinates moved = apply_deformation(opened, *document.deformation()->deformation);
        WarpOptions thesis;
        thesis.weighting = Weighting::affine;
        thesis.distance_power = 0.0;
        const Coordinates expected = warp(opened, moved, thesis).coordinates;
        power->setValue(0.0);
        test.click("warp_button");
        QVERIFY(test.wait_for_job());
        QCOMPARE(document.history()->undoText(), QStringLiteral("Warp, affine weights, power 0"));
        QVERIFY((document.state().mesh->coordinates() - expected).cwiseAbs().maxCoeff() < 1e-9);
        test.click("tool_undo");
        power->setValue(2.0);
        test.click("warp_button");
        QVERIFY(test.wait_for_job());
        QVERIFY((document.state().mesh->coordinates() - expected).cwiseAbs().maxCoeff() > 1e-4);
    }

    void history_tells_about_its_steps() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")), test.inputs.path(QStringLiteral("bump.json")));
        QTest::keyClick(test.window.get(), Qt::Key_D, Qt::ControlModifier);
        QVERIFY(test.wait_for_job());
        auto* history = test.find<QUndoView>("history");
        const QPoint steps[] = {history->visualRect(history->model()->index(0, 0)).center(),
                                history->visualRect(history->model()->index(1, 0)).center()};
        QCOMPARE(history->model()->index(1, 0).data().toString(), QStringLiteral("Deform boundary"));
        const auto tip_at = [&](QPoint position) {
            QHelpEvent help(QEvent::ToolTip, position, history->viewport()->mapToGlobal(position));
            QCoreApplication::sendEvent(history->viewport(), &help);
            return QToolTip::text();
        };
        QVERIFY(tip_at(steps[0]).contains(QStringLiteral("square.msh")));
        QVERIFY(tip_at(steps[1]).contains(QStringLiteral("bump.json")));
        QVERIFY(tip_at(steps[1]).contains(QStringLiteral("boundary nodes")));
        QToolTip::hideText();

        // A click below the last step changes nothing, not even the mark.
        QTest::mouseClick(history->viewport(), Qt::LeftButton, {}, steps[1] + QPoint(0, 60));
        QCOMPARE(test.window->document().history()->index(), 1);
        QCOMPARE(history->currentIndex().row(), 1);
        QVERIFY(history->selectionModel()->isSelected(history->currentIndex()));
    }

    void flying_to_a_hidden_element_uncovers_it() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("cube.msh")));
        const MeshView& view = test.window->view();
        test.click("tool_clip");
        auto* table = test.find<QTreeWidget>("worst_elements");
        auto* slider = test.find<QSlider>("clip_position");
        for (const char* side : {"", "clip_flip"}) {
            if (*side) test.click(side);
            for (int row = 0; row < table->topLevelItemCount(); ++row) {
                slider->setValue(*side ? slider->maximum() : slider->minimum());  // hides all
                const Index element = test.window->document().state().quality->worst(row + 1).back();
                QVERIFY(!view.draws_element(element));
                QTest::mouseClick(table->viewport(), Qt::LeftButton, {},
                                  table->visualItemRect(table->topLevelItem(row)).center());
                QVERIFY(view.draws_element(element));
                QVERIFY(view.options().clip.has_value());
            }
        }
    }

    void narrow_windows_keep_everything_in_view() {
        WindowUnderTest test;
        test.window->resize(1024, 700);
        for (const char* file : {"square.msh", "quad.msh", "clockwise.msh"}) {
            test.open(test.inputs.path(QLatin1String(file)));
            QTest::qWait(20);
            QCOMPARE(test.window->width(), 1024);
        }
    }

    void stopping_leaves_the_mesh_as_it_was() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")), test.inputs.path(QStringLiteral("bump.json")));
        MeshDocument& document = test.window->document();
        const auto mesh = document.state().mesh;
        QSignalSpy cancelled(&test.window->jobs().runner(), &JobRunner::cancelled);

        // A job that ends only when it is asked to stop, then the result of a real one asked to stop at once.
        QVERIFY(test.window->jobs().runner().start(QStringLiteral("Waiting"), [](const TaskContext& context) {
            for (double fraction = 0.0;; fraction = fraction < 1.0 ? fraction + 0.01 : 0.0) {
                context.report("waiting", fraction);
                std::this_thread::sleep_for(std::chrono::milliseconds(2));
            }
            return JobRunner::Finish([] {});
        }));
        QVERIFY(test.find<QToolButton>("tool_stop")->isEnabled());
        QVERIFY(!test.find<QToolButton>("tool_warp")->isEnabled());
        auto* cancel = test.find<QPushButton>("job_cancel");
        QTRY_VERIFY(cancel->isVisible());
        QTRY_VERIFY(test.text("job_text").contains(QStringLiteral("waiting")));
        QTest::mouseClick(cancel, Qt::LeftButton);
        QTRY_COMPARE(cancelled.count(), 1);
        QVERIFY(test.find<QToolButton>("tool_warp")->isEnabled());

        QTest::keyClick(test.window.get(), Qt::Key_R, Qt::ControlModifier);
        QVERIFY(test.window->jobs().runner().is_running());
        QTest::keyClick(test.window.get(), Qt::Key_Escape);
        QTRY_COMPARE(cancelled.count(), 2);
        QCOMPARE(document.state().mesh, mesh);
        QCOMPARE(document.history()->count(), 0);
    }

    void clockwise_meshes_can_be_flipped() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("clockwise.msh")));
        QVERIFY(test.find<QLabel>("banner_text")->isVisible());
        QVERIFY(test.text("banner_text").startsWith(QStringLiteral("All elements are numbered clockwise")));
        QCOMPARE(test.text("verdict"), QStringLiteral("✓ all proved valid"));
        test.click("banner_action");
        QVERIFY(test.wait_for_job());
        QVERIFY(!test.find<QLabel>("banner_text")->isVisible());
        QVERIFY(test.window->document().state().quality->orientation == Orientation::positive);
        test.click("tool_undo");
        QVERIFY(test.window->document().state().quality->orientation == Orientation::negative);
    }

    void view_options_reach_the_scene() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        const MeshView& view = test.window->view();
        QVERIFY(view.options().show_edges && !view.options().show_nodes);
        test.click("tool_nodes");
        QVERIFY(view.options().show_nodes);
        QTest::keyClick(test.window.get(), Qt::Key_E);
        QVERIFY(!view.options().show_edges);
        QVERIFY(!test.find<QToolButton>("tool_clip")->isEnabled());  // nothing to cut in 2D
        QTest::keyClick(test.window.get(), Qt::Key_E);

        test.open(test.inputs.path(QStringLiteral("cube.msh")));
        test.click("tool_clip");
        QVERIFY(view.options().clip.has_value());
        QVERIFY(test.find<QWidget>("clip_bar")->isVisible());
        test.click("clip_z");
        test.click("clip_flip");
        QCOMPARE(view.options().clip->normal[2], -1.0);
    }

    void clicking_an_element_tells_about_it() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        MeshView& view = test.window->view();
        QSignalSpy clicks(&view, &MeshView::element_clicked);
        QTest::qWait(50);  // a frame, so that the camera has been fitted to the window
        QTest::mouseClick(&view, Qt::LeftButton, {}, view.rect().center());
        QCOMPARE(clicks.count(), 1);
        QVERIFY(clicks.front().at(0).value<std::optional<Index>>().has_value());
        QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(3, view.height() - 3));
        QVERIFY(!clicks.back().at(0).value<std::optional<Index>>().has_value());
    }

    void the_view_draws_the_mesh() {
        WindowUnderTest test;
        test.open(test.inputs.path(QStringLiteral("square.msh")));
        test.window->action(CommandId::theme_light)->trigger();
        const QImage once = test.window->view().picture(1), twice = test.window->view().picture(2);
        QVERIFY(!once.isNull());
        QCOMPARE(twice.size(), once.size() * 2);
        // The middle shows the mesh, the corner the ground.
        QCOMPARE(once.pixelColor(2, 2), theme().color(QStringLiteral("view")));
        int colored = 0;
        for (int x = 0; x < once.width(); ++x)
            colored += once.pixelColor(x, once.height() / 2) != once.pixelColor(2, 2);
        QVERIFY(colored > once.height() / 2);
        const QImage grabbed = test.window->view().grabFramebuffer();
        QCOMPARE(grabbed.pixelColor(2, 2), theme().color(QStringLiteral("view")));
        test.window->action(CommandId::theme_dark)->trigger();
        QTest::qWait(50);
        QCOMPARE(test.window->view().grabFramebuffer().pixelColor(2, 2), theme().color(QStringLiteral("view")));
        QVERIFY(theme().color(QStringLiteral("view")).lightness() < 64);
        // The ground of the legend, which reaches the right border, follows as well.
        const QImage dark = test.window->view().grabFramebuffer();
        QVERIFY(once.pixelColor(once.width() - 2, once.height() / 2).lightness() > 192);
        QVERIFY(dark.pixelColor(dark.width() - 2, dark.height() / 2).lightness() < 64);
        test.window->action(CommandId::theme_light)->trigger();
    }
};

QObject* make_test() {
    return new WindowTest;
}

#include "window_test.moc"
