/// The Step tab: what it says of the steps of every method, its plot and what if, with a real mouse; and what a step
/// draws over the mesh.

#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Geometry>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QSettings>
#include <QSlider>
#include <QStyleOptionSlider>
#include <QTabWidget>
#include <QToolButton>

#include "core/io/mesh_io.h"
#include "core/timeline/cursor.h"
#include "tests/gui/gui_test_support.h"
#include "tests/support/mesh_factory.h"
#include "ui/document/number_format.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/convergence_plot.h"
#include "ui/panels/landscape_view.h"
#include "ui/panels/step_panel.h"
#include "ui/tools/step_marks.h"

using namespace curvewright;
using namespace curvewright::testing;

namespace event = untangle_event;

namespace {

/// A run of a method with a name.
struct Run {
    CurvedMesh mesh;
    UntangleOptions options;
};

Run run_of(const QByteArray& name) {
    const CurvedMesh cubic = bulged_square_mesh(4, 3, 0.12);
    if (name == "signed") return {cubic, SignedAngleOptions{.beta = 0.3, .max_passes = 2}};
    if (name == "automatic")
        return {bulged_square_mesh(3, 4, 0.15),
                SignedAngleOptions{.beta_choice = BetaChoice::automatic, .max_passes = 2}};
    if (name == "unsigned") {
        UnsignedAngleOptions options;
        options.first_steps = {0.01};
        options.tries_straight_edge = options.moves_face_nodes = options.is_guarded = false;
        options.max_passes = 2;
        return {cubic, options};
    }
    if (name == "guaranteed") return {cubic, GuaranteedOptions{}};
    std::mt19937 random(3);
    return {shaken(cube_mesh(2, 2), 0.09, random), GuaranteedOptions{}};
}

constexpr const char* run_names[] = {"signed", "automatic", "unsigned", "guaranteed", "solid"};

/// A window with the timeline of a run.
struct StepUnderTest : WindowUnderTest {
    explicit StepUnderTest(const QByteArray& name) {
        const Run run = run_of(name);
        const QString file = inputs.path(QStringLiteral("run.msh"));
        write_mesh(file.toStdString(), run.mesh);
        open(file);
        window->show_tab(QStringLiteral("untangle"));
        if (!window->jobs().untangle_recorded(run.options) || !wait_for_job()) qFatal("Nothing was recorded.");
        if (!errors.isEmpty()) qFatal("%s", qPrintable(errors.front()));
        QTest::qWait(30);
    }
    StepPlayer& player() { return window->player(); }
    const Recording& recording() { return *player().recording(); }
    StepPanel& panel() { return *find<StepPanel>("step_panel"); }
    ConvergencePlot& plot() { return *find<ConvergencePlot>("convergence_plot"); }
    QTabWidget& tabs() { return *find<QTabWidget>("operations_tabs"); }
    QSlider& slider() { return *find<QSlider>("trial_slider"); }
    double number() { return find<QDoubleSpinBox>("trial_number")->value(); }
    const StepExplanation& step() { return *player().shown().explanation; }

    bool arrive() {
        return QTest::qWaitFor([this] { return !player().is_seeking() && player().shown().step == player().step(); });
    }
    bool go_to(StepNumber step) {
        player().go_to(step);
        return arrive() && player().shown().explanation;
    }
    /// What is tried of the step shown is there, with the value that the fields show.
    bool is_tried() {
        return QTest::qWaitFor([this] {
            const auto& trial = panel().trial();
            return trial && trial->step == player().step() && parameter(*trial) == number();
        });
    }
    double parameter(const TrialResult& trial) {
        if (*step().method == UntangleMethod::signed_angles) return trial.parameters.beta;
        return *step().method == UntangleMethod::unsigned_angles ? trial.parameters.first_step : trial.parameters.eps;
    }
    /// Moves the handle of the slider by the mouse to a place between 0 and 1.
    void drag_slider(double to) {
        QSlider& its = slider();
        QStyleOptionSlider option;
        option.initFrom(&its);
        option.minimum = its.minimum();
        option.maximum = its.maximum();
        option.sliderPosition = option.sliderValue = its.value();
        option.orientation = Qt::Horizontal;
        const QPoint from =
            its.style()->subControlRect(QStyle::CC_Slider, &option, QStyle::SC_SliderHandle, &its).center();
        const QPoint there(static_cast<int>(8 + to * (its.width() - 16)), from.y());
        QTest::mousePress(&its, Qt::LeftButton, {}, from);
        QTest::mouseMove(&its, (from + there) / 2);
        QTest::mouseMove(&its, there);
        QTest::mouseRelease(&its, Qt::LeftButton, {}, there);
    }
    QString element_tag(Index element) {
        return QString::number(recording().mesh().topology().element_tag(element).value);
    }
    /// The first step of a kind that is followed by another one of its patch, if there is one.
    std::optional<StepNumber> first_of(StepKind kind, StepNumber from = 0) {
        for (StepNumber step = from; step < recording().step_count(); ++step)
            if (recording().kind(step) == kind) return step;
        return std::nullopt;
    }
    /// The patch with the most steps.
    const RecordedPatch& busy_patch() {
        const auto patches = recording().patches();
        return *std::max_element(patches.begin(), patches.end(), [](const RecordedPatch& a, const RecordedPatch& b) {
            return a.last - a.first < b.last - b.first;
        });
    }
    /// What the tab has to say of a step: a part of its title, its text and numbers.
    void expect(const StepEvent& read, QString& title, QStringList& said);
};

QString degrees(double radians) {
    return format_number(radians * 180.0 / std::numbers::pi) + QStringLiteral("°");
}

void StepUnderTest::expect(const StepEvent& read, QString& title, QStringList& said) {
    if (std::holds_alternative<event::Started>(read)) title = QStringLiteral("The mesh as it is");
    if (const auto* pass = std::get_if<event::PassBegan>(&read))
        title = QStringLiteral("Pass %1 begins").arg(pass->pass);
    if (const auto* patch = std::get_if<event::PatchBegan>(&read)) {
        title = QStringLiteral("A patch comes into focus");
        if (patch->elements.size() == 2)
            said << QStringLiteral("elements %1 and %2")
                        .arg(element_tag(patch->elements[0]), element_tag(patch->elements[1]));
        else
            said << QStringLiteral("%1 elements").arg(format_count(static_cast<long long>(patch->elements.size())))
                 << QStringLiteral("%1 free nodes").arg(format_count(static_cast<long long>(patch->nodes.size())));
    }
    if (const auto* simplex = std::get_if<event::SimplexStep>(&read)) {
        title = QStringLiteral("Simplex step %1, node %2")
                    .arg(simplex->iteration)
                    .arg(recording().mesh().topology().node_tag(simplex->node).value);
        said << format_number(simplex->objective[0]) << format_number(simplex->displacement_term)
             << format_number(simplex->angle_term);
        for (const double angle : simplex->angles) said << degrees(angle);
    }
    if (const auto* bfgs = std::get_if<event::BfgsStep>(&read)) {
        title =
            bfgs->iteration == 0 ? QStringLiteral("BFGS begins") : QStringLiteral("BFGS step %1").arg(bfgs->iteration);
        said << degrees(bfgs->objective) << format_number(bfgs->gradient_norm) << format_number(bfgs->step);
        for (const double angle : bfgs->angles) said << degrees(angle);
    }
    if (const auto* energy = std::get_if<event::EnergyStep>(&read)) {
        title = QStringLiteral("Round %1, L-BFGS step %2").arg(energy->round).arg(energy->iteration);
        said << format_number(energy->objective) << format_number(energy->least_determinant)
             << (energy->sharpness > 0.0 ? QStringLiteral("sharpness ") + format_number(energy->sharpness)
                                         : QStringLiteral("ε ") + format_number(energy->eps));
    }
    if (const auto* certified = std::get_if<event::PatchCertified>(&read)) {
        title = QStringLiteral("The patch is certified");
        said << (certified->not_valid == 0 ? QStringLiteral("proved valid")
                                           : QStringLiteral("%1 elements").arg(certified->not_valid));
    }
    if (const auto* end = std::get_if<event::PatchEnded>(&read)) {
        title = QStringLiteral("The patch is done");
        said << format_number(end->min_scaled_jacobian_before) + QStringLiteral(" → ") +
                    format_number(end->min_scaled_jacobian_after)
             << format_number(end->objective_before) << format_number(end->objective_after);
        if (end->beta > 0.0) said << QStringLiteral("β ") + format_number(end->beta);
    }
    if (std::holds_alternative<event::FaceNodesMoved>(read))
        title = QStringLiteral("Nodes inside the triangles follow");
    if (const auto* placed = std::get_if<event::NodesPlaced>(&read))
        title = placed->placement == event::Placement::straightened ? QStringLiteral("The edge is made straight")
                                                                    : QStringLiteral("An earlier state is put back");
    if (const auto* pass = std::get_if<event::PassEnded>(&read)) {
        title = QStringLiteral("Pass %1 is done").arg(pass->pass);
        said << format_number(pass->relative_change);
    }
    if (const auto* end = std::get_if<event::Finished>(&read)) {
        title = QStringLiteral("The end");
        said << QString::fromLatin1(to_string(end->reason));
    }
}

/// A view of 100 pixels per unit that keeps what it is given.
class FakeCanvas : public Canvas {
  public:
    bool is_flat() const override { return true; }
    QRectF free_area() const override { return {0, 0, 100, 100}; }
    QPointF to_display(const Eigen::RowVector3d& point) const override { return {point[0], point[1]}; }
    Eigen::RowVector3d to_mesh(QPointF position, const Eigen::RowVector3d&) const override {
        return {position.x(), position.y(), 0.0};
    }
    double units_per_pixel(const Eigen::RowVector3d&) const override { return unit; }
    Eigen::Matrix3d view_axes() const override { return Eigen::Matrix3d::Identity(); }
    std::optional<Index> node_at(QPointF, double, const std::function<bool(Index)>&) const override { return {}; }
    std::optional<Index> element_at(QPointF) const override { return {}; }
    std::vector<Index> nodes_inside(const std::vector<QPointF>&, bool) const override { return {}; }
    std::vector<Index> elements_inside(const std::vector<QPointF>&, bool) const override { return {}; }
    void show_marks(Marks, const std::vector<QPointF>&) override {}
    void show_cursor(const QCursor&) override {}

    double unit = 0.01;
};

std::vector<MarkLine> lines_of(const Marks& marks, MarkRole role) {
    std::vector<MarkLine> lines;
    std::copy_if(marks.lines.begin(), marks.lines.end(), std::back_inserter(lines),
                 [role](const MarkLine& line) { return line.role == role; });
    return lines;
}

std::vector<MarkPoint> points_of(const Marks& marks, MarkRole role) {
    std::vector<MarkPoint> points;
    std::copy_if(marks.points.begin(), marks.points.end(), std::back_inserter(points),
                 [role](const MarkPoint& point) { return point.role == role; });
    return points;
}

/// An edge along x with its node 0 in focus, between corners at (0, 0) and (1, 0): angles of 60°, −30°, 45° and 90°.
StepExplanation made_up_step() {
    StepExplanation step;
    step.step = 7;
    step.method = UntangleMethod::signed_angles;
    step.nodes = {0};
    step.elements = {0, 1};
    step.focus = 0;
    step.focus_start = {0.5, 0.1, 2.0};
    step.edge_length = 10.0;
    const double turns[] = {60.0, -30.0, 45.0, 90.0};
    for (int i = 0; i < 4; ++i) {
        AngleMark mark;
        mark.triangle = static_cast<Index>(i / 2);
        mark.corner = {i % 2 == 0 ? 0.0 : 1.0, 0.0, 2.0};
        mark.edge_tangent = {i % 2 == 0 ? 1.0 : -1.0, 0.0};
        mark.signed_angle = turns[i] * std::numbers::pi / 180.0;
        // The first triangle lies above the edge, the second one below.
        const double turn = (i / 2 == 0) == (i % 2 == 0) ? mark.signed_angle : -mark.signed_angle;
        mark.other_tangent = Eigen::Rotation2D<double>(turn) * mark.edge_tangent;
        step.angles.push_back(mark);
    }
    step.path = {{0.5, 0.1, 2.0}, {0.5, 0.15, 2.0}, {0.5, 0.2, 2.0}};
    step.simplex.emplace();
    step.simplex->simplex = {{{0.5, 0.2}, {0.6, 0.2}, {0.5, 0.3}}};
    return step;
}

double turn_of(const MarkLine& arc, const Eigen::Vector2d& corner) {
    const auto at = [&](const std::array<double, 3>& p) {
        return Eigen::Vector2d(Eigen::Vector2d(p[0], p[1]) - corner);
    };
    const Eigen::Vector2d first = at(arc.points.front()), last = at(arc.points.back());
    return std::abs(std::atan2(first[0] * last[1] - first[1] * last[0], first.dot(last))) * 180.0 / std::numbers::pi;
}

}  // namespace

class StepPanelTest : public QObject {
    Q_OBJECT

    void add_runs(std::initializer_list<const char*> names) {
        QTest::addColumn<QByteArray>("name");
        for (const char* name : names) QTest::newRow(name) << QByteArray(name);
    }

  private slots:
    void init() { QSettings().clear(); }

    void says_what_the_step_is_data() { add_runs({"signed", "automatic", "unsigned", "guaranteed", "solid"}); }
    void says_what_the_step_is() {
        QFETCH(QByteArray, name);
        StepUnderTest test(name);
        QCOMPARE(test.tabs().currentWidget()->objectName(), QStringLiteral("step_tab"));
        QCOMPARE(test.text("step_title"), QStringLiteral("The mesh as it is"));
        int kinds = 0;
        for (int kind = 0; kind < 12; ++kind) {
            const auto first = test.first_of(static_cast<StepKind>(kind));
            if (!first) continue;
            ++kinds;
            // The first of the kind, and one somewhere in the middle of the run.
            for (const auto step :
                 {first, test.first_of(static_cast<StepKind>(kind), test.recording().step_count() / 2)}) {
                if (!step) continue;
                QVERIFY(test.go_to(*step));
                QString title;
                QStringList said;
                test.expect(test.recording().read(*step), title, said);
                QCOMPARE(test.text("step_title"), title);
                const QString all = test.text("step_text") + QLatin1Char('\n') + test.text("step_numbers");
                // The mesh as it is shown, wherever the patch's nodes are.
                const QualitySummary& summary = test.player().shown().quality.summary;
                said << QStringLiteral("%1, %2 not valid")
                            .arg(format_number(summary.min), format_count(summary.invalid + summary.undecided));
                const bool is_in_patch = test.recording().patch_of(*step).has_value();
                if (is_in_patch) said << QStringLiteral("element %1").arg(test.element_tag(test.step().worst_element));
                for (const QString& part : said)
                    QVERIFY2(all.contains(part),
                             qPrintable(title + QStringLiteral(": no ") + part + QStringLiteral(" in ") + all));
                QVERIFY(!test.text("step_text").isEmpty());
                // There is something to be tried in a patch only.
                QCOMPARE(test.step().method.has_value(), is_in_patch);
                QCOMPARE(test.slider().isVisible(), is_in_patch);
                QCOMPARE(test.find<LandscapeView>("landscape_view")->isVisible(), is_in_patch);
                QCOMPARE(test.plot().isVisible(), is_in_patch && !test.step().convergence.empty());
            }
        }
        QVERIFY(kinds >= 6);
        QVERIFY(test.errors.isEmpty());
    }

    void a_click_into_the_plot_goes_there_data() {
        add_runs({"signed", "automatic", "unsigned", "guaranteed", "solid"});
    }
    void a_click_into_the_plot_goes_there() {
        QFETCH(QByteArray, name);
        StepUnderTest test(name);
        QVERIFY(test.go_to(test.busy_patch().first + 2));
        ConvergencePlot& plot = test.plot();
        QVERIFY(plot.isVisible());
        const auto course = test.step().convergence;
        QVERIFY(course.size() > 1);
        for (const std::size_t i : {course.size() / 4, course.size() / 2, course.size() - 1, std::size_t{0}}) {
            const int x = static_cast<int>(std::lround(plot.x_of(course[i].step)));
            QVERIFY(x > 0 && x < plot.width());
            // More steps than pixels: the nearest one.
            double nearest = 1e9;
            std::map<StepNumber, double> distances;
            for (const ConvergencePoint& point : course) {
                distances[point.step] = std::abs(plot.x_of(point.step) - x);
                nearest = std::min(nearest, distances[point.step]);
            }
            QTest::mouseClick(&plot, Qt::LeftButton, {}, QPoint(x, plot.height() / 2));
            QVERIFY(test.arrive());
            QCOMPARE(distances[test.player().step()], nearest);
            if (static_cast<int>(course.size()) < plot.width() / 4) QCOMPARE(test.player().step(), course[i].step);
        }
        // A press that moves on takes the steps along.
        QTest::mousePress(&plot, Qt::LeftButton, {}, QPoint(static_cast<int>(plot.x_of(course[0].step)), 60));
        QTest::mouseMove(&plot, QPoint(plot.width() - 1, 60));
        QTest::mouseRelease(&plot, Qt::LeftButton, {}, QPoint(plot.width() - 1, 60));
        QVERIFY(test.arrive());
        QCOMPARE(test.player().step(), course.back().step);
        QCOMPARE(plot.x_of(test.recording().step_count() - 1), -1.0);
    }

    void the_methods_own_parameter_leads_where_the_method_went_data() { add_runs({"signed", "automatic", "unsigned"}); }
    void the_methods_own_parameter_leads_where_the_method_went() {
        QFETCH(QByteArray, name);
        StepUnderTest test(name);
        int tried = 0;
        for (const RecordedPatch& patch : test.recording().patches()) {
            if (patch.last - patch.first < 3) continue;
            // Of an edge whose nodes move one after the other, the last one, when the others have gone.
            const StepNumber step = name == "automatic" ? patch.last : patch.first;
            QVERIFY(test.go_to(step) && test.is_tried());
            const auto end = std::get<event::PatchEnded>(test.recording().read(patch.last));
            if (end.beta > 0.0) QVERIFY(std::abs(test.number() / end.beta - 1.0) < 1e-9);
            const Index focus = *test.step().focus;
            const auto place = std::find(end.nodes.begin(), end.nodes.end(), focus) - end.nodes.begin();
            const event::Position& went = end.positions[static_cast<std::size_t>(place)];
            const auto& outcome = test.panel().trial()->outcome;
            QVERIFY((outcome.position - Eigen::RowVector3d(went[0], went[1], went[2])).norm() < 1e-9);
            QVERIFY(std::abs(outcome.min_scaled_jacobian - end.min_scaled_jacobian_after) < 1e-9);
            QVERIFY2(test.text("trial_outcome").contains(format_number(end.min_scaled_jacobian_after)),
                     qPrintable(test.text("trial_outcome")));
            if (++tried == 6) break;
        }
        QVERIFY(tried > 1);
    }

    void an_automatic_weight_is_that_of_the_patch_from_its_beginning() {
        StepUnderTest test("automatic");
        const RecordedPatch& patch = test.busy_patch();
        const double beta = std::get<event::PatchEnded>(test.recording().read(patch.last)).beta;
        QVERIFY(beta > 0.0);
        QVERIFY(test.go_to(patch.first + 1) && test.is_tried());
        QVERIFY(std::abs(test.number() / beta - 1.0) < 1e-9);
        // A trace does not tell how the run was made, but it leads to the same.
        test.file_answer = test.inputs.path(QStringLiteral("run.jsonl"));
        test.window->action(CommandId::timeline_save)->trigger();
        QVERIFY(test.wait_for_job());
        const StepNumber last = patch.last;
        test.window->action(CommandId::timeline_open)->trigger();
        QVERIFY(test.wait_for_job() && test.errors.isEmpty());
        QVERIFY(test.go_to(last) && test.is_tried());
        const auto end = std::get<event::PatchEnded>(test.recording().read(last));
        QVERIFY(std::abs(test.panel().trial()->outcome.min_scaled_jacobian - end.min_scaled_jacobian_after) < 1e-9);
    }

    void the_slider_tries_another_parameter_data() {
        add_runs({"signed", "automatic", "unsigned", "guaranteed", "solid"});
    }
    void the_slider_tries_another_parameter() {
        QFETCH(QByteArray, name);
        StepUnderTest test(name);
        const RecordedPatch patch = test.busy_patch();
        QVERIFY(test.go_to(patch.first + 2) && test.is_tried());
        const double own = test.number();
        const Coordinates positions = test.player().shown().coordinates;
        std::vector<double> numbers;
        for (const double to : {0.1, 0.9}) {
            test.drag_slider(to);
            QVERIFY(test.is_tried());
            numbers.push_back(test.number());
            const auto& trial = *test.panel().trial();
            QVERIFY(!trial.contours.empty());
            QVERIFY2(test.text("trial_outcome").contains(format_number(trial.outcome.min_scaled_jacobian)),
                     qPrintable(test.text("trial_outcome")));
            QCOMPARE(test.text("trial_outcome").contains(QStringLiteral("tangled")), trial.outcome.not_valid > 0);
        }
        QVERIFY(numbers[0] < 0.1 * numbers[1]);
        QVERIFY(own != numbers[1]);
        // The number does the same, and the slider follows.
        auto* box = test.find<QDoubleSpinBox>("trial_number");
        box->selectAll();
        QTest::keyClicks(box, QStringLiteral("0.002"));
        QTest::keyClick(box, Qt::Key_Return);
        QVERIFY(test.is_tried());
        QCOMPARE(test.number(), 0.002);
        const double place = double(test.slider().value()) / test.slider().maximum();
        QVERIFY(place > 0.2 && place < 0.6);
        // It stays within its patch, and the timeline is as it was.
        QVERIFY(test.go_to(patch.first + 3) && test.is_tried());
        QCOMPARE(test.number(), 0.002);
        QVERIFY(test.go_to(patch.first + 2));
        QCOMPARE(test.player().shown().coordinates, positions);
    }

    void contours_are_drawn_on_request_data() { add_runs({"signed", "unsigned", "guaranteed", "solid"}); }
    void contours_are_drawn_on_request() {
        QFETCH(QByteArray, name);
        StepUnderTest test(name);
        QVERIFY(test.go_to(test.busy_patch().first + 2) && test.is_tried());
        QTest::qWait(250);  // the step has settled
        const auto picture = [&] { return test.window->view().grabFramebuffer(); };
        const QImage with = picture();
        auto* box = test.find<QCheckBox>("trial_contours");
        QVERIFY(box->isChecked());
        const auto press = [&] { QTest::mouseClick(box, Qt::LeftButton, {}, QPoint(8, box->height() / 2)); };
        press();
        QVERIFY(!box->isChecked() && !test.panel().shows_contours());
        QTest::qWait(50);
        const QImage without = picture();
        QVERIFY(without != with);
        press();
        QTest::qWait(50);
        QCOMPARE(picture(), with);
    }

    void there_is_nothing_to_be_tried_between_patches() {
        StepUnderTest test("signed");
        QVERIFY(test.go_to(test.busy_patch().first + 2) && test.is_tried());
        QVERIFY(test.go_to(*test.first_of(StepKind::pass_ended)));
        for (const char* name :
             {"trial_slider", "trial_number", "trial_outcome", "trial_contours", "landscape_view", "convergence_plot"})
            QVERIFY2(!test.find<QWidget>(name)->isVisible(), name);
        QVERIFY(!test.panel().trial());
        QTest::qWait(100);
        QVERIFY(!test.panel().trial());
        QVERIFY(test.go_to(test.busy_patch().first + 2) && test.is_tried());
        QVERIFY(test.slider().isVisible());
    }

    void closing_gives_the_tab_back() {
        StepUnderTest test("guaranteed");
        QTabWidget& tabs = test.tabs();
        const int step_tab = tabs.count() - 1;
        QVERIFY(tabs.isTabVisible(step_tab) && test.panel().isVisible());
        QVERIFY(test.go_to(test.busy_patch().first + 2) && test.is_tried());
        test.click("timeline_close");
        QVERIFY(!tabs.isTabVisible(step_tab) && !test.panel().isVisible());
        QCOMPARE(tabs.currentWidget()->objectName(), QStringLiteral("untangle_tab"));
        QCOMPARE(test.text("step_title"), QStringLiteral("No timeline"));
        QVERIFY(test.text("step_numbers").isEmpty() && !test.panel().trial());
        // Somebody who has gone to another tab stays there.
        test.window->action(CommandId::timeline_show)->trigger();
        QVERIFY(test.wait_for_job() && test.player().is_open());
        QCOMPARE(tabs.currentIndex(), step_tab);
        test.window->show_tab(QStringLiteral("deform"));
        test.click("timeline_close");
        QCOMPARE(tabs.currentWidget()->objectName(), QStringLiteral("deform_tab"));
    }

    void the_view_follows_the_patch_on_request() {
        StepUnderTest test("signed");
        MeshView& view = test.window->view();
        const auto unit = [&] { return view.units_per_pixel(Eigen::RowVector3d(0.5, 0.5, 0.0)); };
        QTest::qWait(300);  // until notices have their place
        const double before = unit();
        QVERIFY(test.go_to(test.busy_patch().first + 2));
        QTest::qWait(300);
        QCOMPARE(unit(), before);
        auto* box = test.find<QCheckBox>("step_follows");
        QTest::mouseClick(box, Qt::LeftButton, {}, QPoint(8, box->height() / 2));
        QVERIFY(box->isChecked());
        QTRY_VERIFY(unit() < 0.99 * before);
        QTest::qWait(300);
        // Another patch: the middle of its elements is in the middle of the view.
        const Recording& recording = test.recording();
        const RecordedPatch& last = recording.patches().back();
        QVERIFY(test.go_to(last.first));
        QTest::qWait(1000);
        const auto& elements = test.player().shown().patch->elements;
        for (const Index element : elements)
            for (const Index node : recording.mesh().topology().element_nodes(element)) {
                const QPointF at = view.to_display(test.player().shown().coordinates.row(node));
                QVERIFY(QRectF(view.rect()).contains(at));
            }
    }

    void the_marks_of_an_edge() {
        const StepExplanation step = made_up_step();
        Coordinates x(1, 3);
        x << 0.5, 0.2, 2.0;
        FakeCanvas canvas;
        const Marks marks = step_marks(step, x, canvas, nullptr, true);
        // Four arcs, three of good and one of a tangled angle, each of its degrees, around its corner.
        QCOMPARE(lines_of(marks, MarkRole::angle).size(), 3u);
        QCOMPARE(lines_of(marks, MarkRole::tangled_angle).size(), 1u);
        QVERIFY(std::abs(turn_of(lines_of(marks, MarkRole::tangled_angle)[0], {1.0, 0.0}) - 30.0) < 1e-9);
        QVERIFY(std::abs(turn_of(lines_of(marks, MarkRole::angle)[0], {0.0, 0.0}) - 60.0) < 1e-9);
        QVERIFY(std::abs(turn_of(lines_of(marks, MarkRole::angle)[2], {1.0, 0.0}) - 90.0) < 1e-9);
        for (const MarkLine& line : marks.lines)
            for (const auto& point : line.points) QCOMPARE(point[2], 2.0);
        std::vector<std::string> texts;
        for (const MarkText& text : marks.texts) {
            texts.push_back(text.text);
            QCOMPARE(text.role, text.text == "−30°" ? MarkRole::tangled_angle : MarkRole::angle);
        }
        QCOMPARE(texts, (std::vector<std::string>{"60°", "−30°", "45°", "90°"}));
        // Tangents: of the other edges, and once per end that of the edge.
        QCOMPARE(lines_of(marks, MarkRole::tangent).size(), 6u);
        // The simplex is a triangle, the path goes from the start to where the node is.
        const auto simplex = lines_of(marks, MarkRole::simplex);
        QCOMPARE(simplex.size(), 1u);
        QCOMPARE(simplex[0].points.size(), 4u);
        QCOMPARE(simplex[0].points.front(), simplex[0].points.back());
        QCOMPARE(simplex[0].points[1], (std::array<double, 3>{0.6, 0.2, 2.0}));
        QCOMPARE(lines_of(marks, MarkRole::path).size(), 1u);
        QCOMPARE(lines_of(marks, MarkRole::path)[0].points, step.path);
        QCOMPARE(points_of(marks, MarkRole::selected)[0].at, (std::array<double, 3>{0.5, 0.2, 2.0}));
        QCOMPARE(points_of(marks, MarkRole::soft)[0].at, step.focus_start);
        QVERIFY(lines_of(marks, MarkRole::contour).empty() && points_of(marks, MarkRole::outcome).empty());
    }

    void marks_keep_their_size_but_within_the_edge() {
        StepExplanation step = made_up_step();
        Coordinates x(1, 3);
        x << 0.5, 0.2, 2.0;
        FakeCanvas canvas;
        const auto radius = [&] {
            const auto p = lines_of(step_marks(step, x, canvas, nullptr, false), MarkRole::angle)[0].points[0];
            return std::hypot(p[0], p[1]);
        };
        const double first = radius();
        canvas.unit = 0.005;
        QVERIFY(std::abs(radius() / first - 0.5) < 1e-9);
        canvas.unit = 100.0;  // from far away
        QVERIFY(radius() < 0.5 * step.edge_length);
    }

    void the_marks_of_a_trial_and_of_other_methods() {
        StepExplanation step = made_up_step();
        Coordinates x(3, 3);
        x << 0.5, 0.2, 2.0, 0.7, 0.2, 2.0, 0.0, 0.0, 2.0;
        TrialResult trial;
        trial.landscape = {{0.5, 0.1, 2.0}, {0.4, 0.0, 0.0}, {0.0, 0.4, 0.0}, Eigen::MatrixXd(3, 3)};
        trial.levels = {1.0, 2.0, 3.0};
        trial.contours = {{{{0.0, 0.0}, {1.0, 1.0}}}, {{{2.0, 2.0}, {1.0, 1.0}}, {{0.0, 2.0}, {1.0, 1.0}}}, {}};
        trial.outcome.position = {0.5, 0.4, 2.0};
        trial.outcome.path = {{0.5, 0.1, 2.0}, {0.5, 0.4, 2.0}};
        FakeCanvas canvas;
        const Marks with = step_marks(step, x, canvas, &trial, true),
                    without = step_marks(step, x, canvas, &trial, false);
        const auto contours = lines_of(with, MarkRole::contour);
        QCOMPARE(contours.size(), 3u);
        QCOMPARE(contours[0].points[0], (std::array<double, 3>{0.5 - 0.4, 0.1 - 0.4, 2.0}));
        QCOMPARE(contours[0].points[1], (std::array<double, 3>{0.5, 0.1, 2.0}));
        QVERIFY(contours[0].share > contours[1].share);
        QCOMPARE(contours[1].share, contours[2].share);
        QVERIFY(lines_of(without, MarkRole::contour).empty());
        QCOMPARE(without.lines.size() + 3, with.lines.size());
        QCOMPARE(points_of(with, MarkRole::outcome)[0].at, (std::array<double, 3>{0.5, 0.4, 2.0}));
        QCOMPARE(lines_of(with, MarkRole::ghost)[0].points.size(), 2u);

        // At the end of the patch the simplex is gone.
        step.end.emplace();
        QVERIFY(lines_of(step_marks(step, x, canvas, nullptr, true), MarkRole::simplex).empty());
        // Unsigned angles move all nodes of the edge.
        step.method = UntangleMethod::unsigned_angles;
        step.nodes = {0, 1};
        QCOMPARE(points_of(step_marks(step, x, canvas, nullptr, true), MarkRole::soft).size(), 2u);
        // The guaranteed method: the worst place.
        step.method = UntangleMethod::guaranteed;
        step.worst_point = {0.1, 0.2, 2.0};
        QCOMPARE(points_of(step_marks(step, x, canvas, nullptr, true), MarkRole::worst)[0].at, step.worst_point);
        // Between patches there is nothing.
        QVERIFY(step_marks(StepExplanation{}, x, canvas, nullptr, true).is_empty());
    }

    void marks_of_every_run() {
        for (const char* name : run_names) {
            StepUnderTest test(name);
            QVERIFY(test.go_to(test.busy_patch().first + 2) && test.is_tried());
            const Marks marks = step_marks(test.step(), test.player().shown().coordinates, test.window->view(),
                                           test.panel().trial().get(), true);
            const bool has_angles = *test.step().method != UntangleMethod::guaranteed;
            QCOMPARE(marks.texts.size(), has_angles ? 4u : 0u);
            QCOMPARE(points_of(marks, MarkRole::worst).size(), has_angles ? 0u : 1u);
            QCOMPARE(points_of(marks, MarkRole::selected).size(), 1u);
            QCOMPARE(points_of(marks, MarkRole::outcome).size(), 1u);
            QVERIFY(!lines_of(marks, MarkRole::contour).empty());
            for (const MarkText& text : marks.texts) QVERIFY(text.text.ends_with("°"));
        }
    }
};

QObject* make_test() {
    return new StepPanelTest;
}

#include "step_panel_test.moc"
