/// The untangle panel: which fields it shows, and that what they say reaches the core and the history.

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <QSignalSpy>
#include <QSpinBox>
#include <QToolButton>
#include <QTreeWidget>
#include <algorithm>
#include <fstream>

#include "core/io/mesh_io.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/unsigned_angles.h"
#include "tests/gui/gui_test_support.h"
#include "tests/support/mesh_factory.h"
#include "ui/panels/banner.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace {

/// A window at the untangle panel, with a mesh whose boundary was deformed.
struct UntangleUnderTest : WindowUnderTest {
    void open_deformed(const QString& mesh, const QString& deformation) {
        open(mesh, deformation);
        if (!window->jobs().deform() || !wait_for_job()) qFatal("The boundary was not deformed.");
        window->show_tab(QStringLiteral("untangle"));
        QObject::connect(&window->jobs(), &MeshJobs::note, window.get(), [this](const QString& text) { note = text; });
    }
    void open_annulus() {
        const QString folder = QStringLiteral(CURVEWRIGHT_SAMPLES "/annulus/");
        open_deformed(folder + QStringLiteral("annulus.msh"), folder + QStringLiteral("deformation.json"));
    }
    QString file(const char* name, const CurvedMesh& mesh) {
        const QString path = inputs.path(QLatin1String(name));
        write_mesh(path.toStdString(), mesh);
        return path;
    }
    QString file(const char* name, const char* text) {
        const QString path = inputs.path(QLatin1String(name));
        std::ofstream(path.toStdString()) << text;
        return path;
    }
    void choose(const char* method) {
        auto* box = find<QComboBox>("method");
        box->setCurrentIndex(box->findText(QLatin1String(method)));
    }
    bool shows(const char* name) { return find<QWidget>(name)->isVisible(); }
    bool untangle_and_wait() {
        click("untangle_button");
        return wait_for_job();
    }
    MeshDocument& document() { return window->document(); }
    const MeshState& state() { return document().state(); }
    QString details() { return document().step_details(document().history()->index() - 1); }

    QString note;
};

/// What stands over the view.
QString told(UntangleUnderTest& test) {
    return test.find<Banner>("banner")->text();
}

constexpr const char* guaranteed_fields[] = {"boundary", "improves", "target"};
constexpr const char* signed_angle_fields[] = {"beta", "max_passes", "reject_worse_pass"};

}  // namespace

class UntangleTest : public QObject {
    Q_OBJECT

  private slots:
    void shows_the_fields_of_the_method() {
        UntangleUnderTest test;
        test.open_annulus();
        auto* method = test.find<QComboBox>("method");
        QCOMPARE(method->currentText(), QStringLiteral("Guaranteed"));
        QVERIFY(method->toolTip().contains(QStringLiteral("proved valid")));
        for (const char* name : guaranteed_fields) QVERIFY2(test.shows(name), name);
        for (const char* name : signed_angle_fields) QVERIFY2(!test.shows(name), name);
        auto* target = test.find<QDoubleSpinBox>("target");
        QCOMPARE(target->value(), GuaranteedOptions().target);
        QCOMPARE(target->minimum(), 0.05);
        QCOMPARE(target->maximum(), 1.0);
        QVERIFY(test.find<QCheckBox>("improves")->isChecked() && target->isEnabled());
        test.find<QCheckBox>("improves")->setChecked(false);
        QVERIFY(!target->isEnabled());

        test.choose("Signed angles");
        for (const char* name : guaranteed_fields) QVERIFY2(!test.shows(name), name);
        QVERIFY(test.shows("chooses_beta") && test.shows("max_passes") && !test.shows("beta"));
        test.find<QCheckBox>("chooses_beta")->setChecked(false);
        for (const char* name : signed_angle_fields) QVERIFY2(test.shows(name), name);
        QVERIFY(method->toolTip().contains(QStringLiteral("order 2 and up")));
        const QWidget* panel = test.find<QPushButton>("untangle_button")->parentWidget();
        for (const char* name : {"Guaranteed", "Signed angles", "Unsigned angles"}) {
            test.choose(name);
            QTest::qWait(20);
            QVERIFY2(panel->width() <= panel->parentWidget()->width(), name);
        }
    }

    void guaranteed_is_the_core_s() {
        UntangleUnderTest test;
        test.open_annulus();
        const CurvedMesh tangled = *test.state().mesh;
        QCOMPARE(test.state().quality->summary.invalid, 2);
        QVERIFY(test.untangle_and_wait());
        QVERIFY(test.errors.isEmpty());
        const Coordinates& result = test.state().mesh->coordinates();
        QCOMPARE(test.state().quality->summary.valid, 30);
        QVERIFY(test.state().quality->summary.min > 0.9);
        QCOMPARE(result, untangle_guaranteed(tangled).coordinates);
        for (const Index node : tangled.topology().boundary_nodes())
            QCOMPARE(result.row(node), tangled.coordinates().row(node));
        QCOMPARE(test.document().history()->count(), 2);
        QCOMPARE(test.document().history()->undoText(), QStringLiteral("Untangle, guaranteed"));
        const QRegularExpression times(QStringLiteral("^Valid after (less than )?[0-9.]+ s; improved in [^ ].* s\\.$"));
        QVERIFY2(times.match(test.note).hasMatch(), qPrintable(test.note));
        QVERIFY(test.details().contains(QStringLiteral("Elements below 0.9 improved afterwards")));
        QVERIFY(test.details().contains(test.note));
        test.click("tool_undo");
        QCOMPARE(test.state().mesh->coordinates(), tangled.coordinates());

        // The options reach the core.
        test.find<QDoubleSpinBox>("target")->setValue(0.3);
        QVERIFY(test.untangle_and_wait());
        GuaranteedOptions options;
        options.target = 0.3;
        QCOMPARE(test.state().mesh->coordinates(), untangle_guaranteed(tangled, options).coordinates);
        test.click("tool_undo");
        test.find<QCheckBox>("improves")->setChecked(false);
        QVERIFY(test.untangle_and_wait());
        options.improves = false;
        QCOMPARE(test.state().mesh->coordinates(), untangle_guaranteed(tangled, options).coordinates);
        QVERIFY(test.state().quality->summary.min < 0.9);
        QVERIFY(test.details().contains(QStringLiteral("nothing improved")));
        QVERIFY(!test.note.contains(QStringLiteral("improved")));
    }

    void signed_angles_are_the_core_s() {
        UntangleUnderTest test;
        test.open_annulus();
        const CurvedMesh tangled = *test.state().mesh;
        test.choose("Signed angles");
        QVERIFY(test.untangle_and_wait());
        SignedAngleOptions automatic;
        automatic.beta_choice = BetaChoice::automatic;
        QCOMPARE(test.state().mesh->coordinates(), untangle_signed_angles(tangled, automatic).coordinates);
        QCOMPARE(test.document().history()->undoText(), QStringLiteral("Untangle, signed angles, β chosen"));
        test.click("tool_undo");

        test.find<QCheckBox>("chooses_beta")->setChecked(false);
        test.find<QDoubleSpinBox>("beta")->setValue(0.7);
        test.find<QSpinBox>("max_passes")->setValue(4);
        QVERIFY(test.untangle_and_wait());
        SignedAngleOptions options;
        options.beta = 0.7;
        options.max_passes = 4;
        options.reject_worse_pass = true;
        QCOMPARE(test.state().mesh->coordinates(), untangle_signed_angles(tangled, options).coordinates);
        QCOMPARE(test.document().history()->undoText(), QStringLiteral("Untangle, signed angles, β 0.7"));
    }

    void unsigned_angles_are_the_core_s() {
        UntangleUnderTest test;
        test.open_annulus();
        const CurvedMesh tangled = *test.state().mesh;
        test.choose("Unsigned angles");
        QVERIFY(test.shows("literal") && test.shows("max_passes"));
        for (const char* name : {"improves", "target", "beta", "reject_worse_pass"}) QVERIFY2(!test.shows(name), name);
        QVERIFY(test.untangle_and_wait());
        QCOMPARE(test.state().quality->summary.valid, 30);
        UnsignedAngleOptions options;
        options.max_passes = test.find<QSpinBox>("max_passes")->value();
        QCOMPARE(test.state().mesh->coordinates(), untangle_unsigned_angles(tangled, options).coordinates);
        QCOMPARE(test.document().history()->undoText(), QStringLiteral("Untangle, unsigned angles"));
        QVERIFY2(test.note.startsWith(QStringLiteral("All elements are valid after ")), qPrintable(test.note));

        // To the letter, the method is at a loss here, and says what to do.
        test.click("tool_undo");
        test.find<QCheckBox>("literal")->setChecked(true);
        QVERIFY(test.untangle_and_wait());
        QCOMPARE(test.state().quality->summary.invalid, 2);
        QVERIFY2(told(test).contains(QStringLiteral("the guaranteed method")), qPrintable(told(test)));
    }

    void says_which_elements_cannot_be_mended() {
        UntangleUnderTest test;
        // Linear triangles; the bottom's ends pass the corners above them.
        test.open_deformed(
            test.file("linear.msh", square_mesh(4, 1)),
            test.file(
                "ends.json",
                R"json({"operations": [{"group": "bottom", "type": "expression", "y": "y + 0.3 * (2 * x - 1)^8 + 0.27 * sin(pi * x)^8"}]})json"));
        const CurvedMesh tangled = *test.state().mesh;
        const GuaranteedResult expected = untangle_guaranteed(tangled);
        QVERIFY(expected.unmended.size() > 1);
        for (const UnmendedElement& its : expected.unmended) QVERIFY(!its.is_proved);
        QVERIFY(test.untangle_and_wait());
        QVERIFY(test.errors.isEmpty());
        const UnmendedElement& first = expected.unmended.front();
        QVERIFY2(
            test.note.contains(
                QStringLiteral(
                    "No way was found to mend %1 elements with the boundary as it is; the first is element %2: %3.")
                    .arg(expected.unmended.size())
                    .arg(tangled.topology().element_tag(first.element).value)
                    .arg(QString::fromStdString(first.reason))),
            qPrintable(test.note));
        QVERIFY(test.note.startsWith(QStringLiteral("Stopped after ")));
        QVERIFY(test.note.endsWith(QStringLiteral("Let the boundary slide, move it less, or refine the mesh there.")));
        QVERIFY(test.details().contains(QStringLiteral("No way was found")));
        QCOMPARE(test.state().quality->summary.invalid, static_cast<Index>(expected.unmended.size()));
    }

    void the_reason_follows_the_method() {
        UntangleUnderTest test;
        const auto reason = [&] { return test.text("untangle_button_reason"); };
        const auto* button = test.find<QPushButton>("untangle_button");
        test.open(test.file("p1.msh", square_mesh(2, 1)));
        test.window->show_tab(QStringLiteral("untangle"));
        QVERIFY(button->isEnabled() && reason().isEmpty());
        for (const char* name : {"Signed angles", "Unsigned angles"}) {
            test.choose(name);
            QVERIFY(!button->isEnabled() && reason().contains(QStringLiteral("order 2 and up")));
            QVERIFY(reason().contains(QStringLiteral("P1 triangle")));
            QVERIFY(!test.find<QToolButton>("tool_untangle")->isEnabled());
        }
        test.choose("Guaranteed");
        QVERIFY(button->isEnabled() && reason().isEmpty());
        QVERIFY(test.find<QToolButton>("tool_untangle")->isEnabled());

        test.open(test.inputs.path(QStringLiteral("quad.msh")));
        QVERIFY(button->isEnabled() && reason().isEmpty());
        test.choose("Signed angles");
        QVERIFY(!button->isEnabled() && reason().contains(QStringLiteral("quadrilateral")));
        test.choose("Guaranteed");

        // Pyramids are not assessed, and stay where they are.
        test.open(test.file("pyramids.msh", pyramid_mesh(1)));
        QVERIFY(button->isEnabled() && reason().isEmpty());
        QCOMPARE(test.state().quality->summary.not_assessed, 6);
        QVERIFY(test.untangle_and_wait());
        QCOMPARE(test.document().history()->count(), 0);
        QVERIFY2(told(test).contains(QStringLiteral("not assessed")) && !told(test).contains(QStringLiteral("valid")),
                 qPrintable(told(test)));
    }

    void the_boundary_slides_where_it_is_told_to() {
        UntangleUnderTest test;
        test.open_annulus();
        const CurvedMesh tangled = *test.state().mesh;
        auto* boundary = test.find<QComboBox>("boundary");
        QCOMPARE(boundary->currentText(), QStringLiteral("Stays"));
        QVERIFY(!test.shows("boundary_groups"));
        boundary->setCurrentIndex(boundary->findText(QStringLiteral("Slides along itself")));
        QVERIFY(test.untangle_and_wait());
        GuaranteedOptions slide;
        slide.boundary.otherwise = BoundaryMode::slide;
        QCOMPARE(test.state().mesh->coordinates(), untangle_guaranteed(tangled, slide).coordinates);
        QVERIFY2(test.note.contains(QStringLiteral("from where it was")), qPrintable(test.note));
        QCOMPARE(test.document().history()->undoText(), QStringLiteral("Untangle, guaranteed, boundary moves"));

        test.click("tool_undo");
        boundary->setCurrentIndex(boundary->findText(QStringLiteral("By group")));
        auto* groups = test.find<QTreeWidget>("boundary_groups");
        QVERIFY(groups->isVisible());
        QCOMPARE(groups->topLevelItemCount(), 2);
        GuaranteedOptions by_group;
        for (int i = 0; i < 2; ++i) {
            QTreeWidgetItem* item = groups->topLevelItem(i);
            if (item->text(0) != QStringLiteral("inner")) continue;
            QCOMPARE(item->text(1), QStringLiteral("Stays"));
            choose_in_row(groups, item, QStringLiteral("Slides"));
            QCOMPARE(item->text(1), QStringLiteral("Slides"));
            by_group.boundary.groups.push_back({"inner", BoundaryMode::slide});
        }
        QCOMPARE(by_group.boundary.groups.size(), std::size_t(1));
        QVERIFY(test.untangle_and_wait());
        QCOMPARE(test.state().mesh->coordinates(), untangle_guaranteed(tangled, by_group).coordinates);
        const std::vector<Index> outer = tangled.topology().find_group_nodes("outer").value();
        for (const Index node : outer)
            QCOMPARE(test.state().mesh->coordinates().row(node), tangled.coordinates().row(node));
    }

    void tetrahedra_are_untangled_and_can_be_cancelled() {
        UntangleUnderTest test;
        test.open_deformed(
            test.file("tetrahedra.msh", cube_mesh(6, 2)),
            test.file(
                "dent.json",
                R"json({"operations": [{"group": "z0", "type": "expression", "z": "z + 0.15 * (sin(4 * pi * x) * sin(4 * pi * y))^2"}]})json"));
        const CurvedMesh tangled = *test.state().mesh;
        QVERIFY(test.state().quality->summary.invalid > 0);
        QSignalSpy cancelled(&test.window->jobs().runner(), &JobRunner::cancelled);
        QSignalSpy progress(&test.window->jobs().runner(), &JobRunner::progress);
        test.click("untangle_button");
        QTRY_VERIFY(progress.count() > 0);
        QTest::keyClick(test.window.get(), Qt::Key_Escape);
        QTRY_COMPARE(cancelled.count(), 1);
        QCOMPARE(test.document().history()->count(), 1);
        QCOMPARE(test.state().mesh->coordinates(), tangled.coordinates());

        // Stop and keep: a step of the history, not worse than what was there.
        QSignalSpy finished(&test.window->jobs().runner(), &JobRunner::finished);
        progress.clear();
        test.click("untangle_button");
        QTRY_VERIFY(progress.count() > 0);
        QVERIFY(test.window->jobs().runner().can_keep());
        QTRY_VERIFY(test.shows("job_keep"));
        test.click("job_keep");
        QTRY_COMPARE(finished.count(), 1);
        QCOMPARE(cancelled.count(), 1);
        QCOMPARE(test.document().history()->count(), 2);
        QVERIFY2(test.note.contains(QStringLiteral("best mesh so far is kept")), qPrintable(test.note));
        QVERIFY(test.state().quality->summary.invalid <= assess_quality(tangled).summary.invalid);
        test.click("tool_undo");
        QCOMPARE(test.state().mesh->coordinates(), tangled.coordinates());

        test.find<QCheckBox>("improves")->setChecked(false);
        QVERIFY(test.untangle_and_wait());
        QCOMPARE(test.state().quality->summary.valid, tangled.topology().element_count());
        for (const Index node : tangled.topology().boundary_nodes())
            QCOMPARE(test.state().mesh->coordinates().row(node), tangled.coordinates().row(node));
    }
};

QObject* make_test() {
    return new UntangleTest;
}

#include "untangle_test.moc"
