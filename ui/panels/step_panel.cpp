#include "ui/panels/step_panel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <QCheckBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSlider>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
#include "ui/panels/convergence_plot.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/landscape_view.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

namespace event = untangle_event;

constexpr int slider_steps = 400;

/// The parameter of a method that can be tried, from lower to upper in even factors.
struct TriedParameter {
    double lower, upper, usual;
};
TriedParameter tried_parameter(UntangleMethod method) {
    switch (method) {
        case UntangleMethod::signed_angles:
            return {1e-6, 1.0, 0.5};  // the automatic choice goes down to 3e-6
        case UntangleMethod::unsigned_angles:
            return {1e-4, 1.0, 0.01};
        case UntangleMethod::guaranteed:
            return {1e-4, 10.0, 1e-2};
    }
    return {1e-6, 1.0, 0.5};
}

QString angle_text(double radians) {
    return QStringLiteral("%1°").arg(format_number(radians * 180.0 / std::numbers::pi));
}

template <class Angles>
QString angles_text(const Angles& angles) {
    QStringList texts;
    for (const double angle : angles) texts << angle_text(angle);
    return texts.join(QStringLiteral(", "));
}

}  // namespace

StepPanel::StepPanel(const Theme& theme, QWidget* parent) : QWidget(parent) {
    setObjectName(QStringLiteral("step_panel"));
    auto* layout = make_panel_layout(this);
    title_ = make_label({}, "title");
    title_->setObjectName(QStringLiteral("step_title"));
    title_->setWordWrap(true);
    text_ = make_paragraph({}, "");
    text_->setObjectName(QStringLiteral("step_text"));
    numbers_ = make_paragraph({}, "muted");
    numbers_->setObjectName(QStringLiteral("step_numbers"));
    numbers_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    plot_ = new ConvergencePlot(theme);
    follows_ = new QCheckBox(tr("Keep the patch in view"));
    follows_->setObjectName(QStringLiteral("step_follows"));
    follows_->setToolTip(tr("Fly to every patch that comes into focus, unless the timeline plays."));
    layout->setSpacing(6);
    layout->addWidget(title_);
    layout->addWidget(text_);
    layout->addWidget(numbers_);
    layout->addWidget(plot_);

    trial_box_ = new QWidget;
    auto* box = new QVBoxLayout(trial_box_);
    box->setContentsMargins(0, 0, 0, 0);
    box->setSpacing(6);
    auto* row = new QHBoxLayout;
    parameter_name_ = new QLabel;
    slider_ = new QSlider(Qt::Horizontal);
    slider_->setObjectName(QStringLiteral("trial_slider"));
    slider_->setRange(0, slider_steps);
    slider_->setToolTip(
        tr("Another value of the parameter for this patch alone: the landscape changes at once, and the "
           "diamond shows where the method would take the node. The timeline stays as it is."));
    number_ = new LogSpinBox;
    number_->setObjectName(QStringLiteral("trial_number"));
    number_->setDecimals(16);  // four digits are shown, but a weight that was found has all of them
    number_->setMinimumWidth(92);
    number_->setToolTip(slider_->toolTip());
    number_->setKeyboardTracking(false);
    row->addWidget(parameter_name_);
    row->addWidget(slider_, 1);
    row->addWidget(number_);
    box->addLayout(row);
    outcome_ = make_paragraph({}, "muted");
    outcome_->setObjectName(QStringLiteral("trial_outcome"));
    box->addWidget(outcome_);
    landscape_ = new LandscapeView(theme);
    box->addWidget(landscape_);
    contours_ = new QCheckBox(tr("Contour lines in the view"));
    contours_->setObjectName(QStringLiteral("trial_contours"));
    contours_->setToolTip(tr("Draw the landscape's lines of equal height around the node, over the mesh."));
    contours_->setChecked(true);
    box->addWidget(contours_);
    layout->addWidget(trial_box_);
    layout->addWidget(follows_);
    // A click leaves the keyboard with the track.
    for (QCheckBox* check : {contours_, follows_}) check->setFocusPolicy(Qt::TabFocus);
    layout->addStretch(1);

    connect(plot_, &ConvergencePlot::step_chosen, this, &StepPanel::step_chosen);
    connect(slider_, &QSlider::valueChanged, this, [this](int position) {
        if (!shown_method_) return;
        const auto [lower, upper, usual] = tried_parameter(*shown_method_);
        const QSignalBlocker blocker(number_);
        // As many digits as there is room for.
        const double value = lower * std::pow(upper / lower, static_cast<double>(position) / slider_steps);
        number_->setValue(QString::number(value, 'g', 3).toDouble());
        ask();
    });
    connect(number_, &QDoubleSpinBox::valueChanged, this, [this](double value) {
        if (!shown_method_) return;
        const auto [lower, upper, usual] = tried_parameter(*shown_method_);
        const QSignalBlocker blocker(slider_);
        slider_->setValue(static_cast<int>(
            std::lround(slider_steps * std::log(std::max(value, lower) / lower) / std::log(upper / lower))));
        ask();
    });
    connect(follows_, &QCheckBox::toggled, this, [this](bool is_on) {
        if (is_on) emit follow_wanted();
    });
    connect(contours_, &QCheckBox::toggled, this, &StepPanel::trial_changed);
    connect(&trials_, &PatchTrials::answered, this, [this](const std::shared_ptr<const TrialResult>& result) {
        trial_ = result;
        if (result) {
            landscape_->show_result(result, request_.step);
            QString text = tr("diamond: scaled J %1").arg(format_number(result->outcome.min_scaled_jacobian));
            if (result->outcome.not_valid > 0) text += tr(", %1 tangled").arg(result->outcome.not_valid);
            outcome_->setText(text);
        } else {
            landscape_->clear();
            outcome_->setText(tr("There is nothing to be tried in this step."));
        }
        emit trial_changed();
    });
    clear();
}

StepPanel::~StepPanel() = default;

bool StepPanel::shows_contours() const {
    return contours_->isChecked();
}

bool StepPanel::follows_patches() const {
    return follows_->isChecked();
}

void StepPanel::clear() {
    trials_.cancel();
    request_ = {};
    trial_.reset();
    shown_method_.reset();
    shown_patch_.reset();
    title_->setText(tr("No timeline"));
    text_->setText(tr("Untangle step by step, or open a trace, to see what the method does."));
    numbers_->clear();
    plot_->clear();
    plot_->hide();
    landscape_->clear();
    trial_box_->hide();
}

double StepPanel::parameter_value() const {
    return number_->value();
}

void StepPanel::show_parameter(const Recording& recording, const UntangleOptions& options) {
    const UntangleMethod method = *request_.step->method;
    const auto [lower, upper, usual] = tried_parameter(method);
    double value = usual;
    if (method == UntangleMethod::signed_angles) {
        // What the patch was done with, which its end tells; else what was given.
        if (const auto* given = std::get_if<SignedAngleOptions>(&options)) value = given->beta;
        const StepEvent last = recording.read(recording.patches()[*shown_patch_].last);
        if (const auto* end = std::get_if<event::PatchEnded>(&last); end && end->beta > 0.0) value = end->beta;
        parameter_name_->setText(tr("What if β ="));
    } else if (method == UntangleMethod::unsigned_angles) {
        if (const auto* given = std::get_if<UnsignedAngleOptions>(&options))
            if (!given->first_steps.empty()) value = given->first_steps.front();
        parameter_name_->setText(tr("What if step ="));
    } else {
        if (request_.step->energy) value = request_.step->energy->eps;
        parameter_name_->setText(tr("What if ε ="));
    }
    const QSignalBlocker slider_blocker(slider_), number_blocker(number_);
    number_->setRange(lower, upper);
    number_->setValue(std::clamp(value, lower, upper));
    slider_->setValue(
        static_cast<int>(std::lround(slider_steps * std::log(number_->value() / lower) / std::log(upper / lower))));
}

void StepPanel::show_step(const Recording& recording, std::shared_ptr<const StepExplanation> step,
                          std::shared_ptr<const CurvedMesh> mesh, std::shared_ptr<const CurvedMesh> start,
                          const QualitySummary& quality, const OrientationSigns& orientation_sign,
                          const UntangleOptions& options, const Eigen::RowVector3d& across,
                          const Eigen::RowVector3d& up) {
    quality_ = quality;
    const auto patch = recording.patch_of(step->step);
    request_.step = std::move(step);
    request_.mesh = std::move(mesh);
    request_.start = std::move(start);
    request_.orientation_sign = orientation_sign;
    request_.options = options;
    request_.across = across;
    request_.up = up;
    describe(recording);
    plot_->setVisible(!request_.step->convergence.empty());
    plot_->show_course(*request_.step);
    const bool can_try = request_.step->method && request_.step->focus;
    trial_box_->setVisible(can_try);
    if (!can_try) {
        trials_.cancel();
        trial_.reset();
        shown_method_.reset();
        shown_patch_.reset();
        emit trial_changed();
        return;
    }
    // A value that the user has set stays within its patch.
    if (patch != shown_patch_ || request_.step->method != shown_method_) {
        shown_method_ = request_.step->method;
        shown_patch_ = patch;
        show_parameter(recording, options);
    }
    if (trial_ && trial_->focus != *request_.step->focus) trial_.reset();
    ask();
}

void StepPanel::ask() {
    if (!request_.step || !request_.step->method) return;
    TrialParameters parameters;
    if (*request_.step->method == UntangleMethod::signed_angles) parameters.beta = parameter_value();
    if (*request_.step->method == UntangleMethod::unsigned_angles) parameters.first_step = parameter_value();
    if (*request_.step->method == UntangleMethod::guaranteed) parameters.eps = parameter_value();
    request_.parameters = parameters;
    trials_.ask(request_);
}

void StepPanel::describe(const Recording& recording) {
    const StepExplanation& step = *request_.step;
    const MeshTopology& topology = recording.mesh().topology();
    const StepEvent read = recording.read(step.step);
    const auto node_tag = [&](Index node) { return QString::number(topology.node_tag(node).value); };
    const auto element_tag = [&](Index element) { return QString::number(topology.element_tag(element).value); };
    QString title, text;
    QStringList numbers;
    switch (recording.kind(step.step)) {
        case StepKind::started:
            title = tr("The mesh as it is");
            text = tr("Nothing has moved yet.");
            break;
        case StepKind::pass_began:
            title = tr("Pass %1 begins").arg(std::get<event::PassBegan>(read).pass);
            text = tr("The method goes over the mesh, patch by patch.");
            break;
        case StepKind::patch_began:
            title = tr("A patch comes into focus");
            text = step.elements.size() == 2
                       ? tr("The curved edge between elements %1 and %2: its nodes may move, everything else stays.")
                             .arg(element_tag(step.elements[0]), element_tag(step.elements[1]))
                       : tr("%1 elements around the damage; their %2 free nodes move together.")
                             .arg(format_count(static_cast<long long>(step.elements.size())),
                                  format_count(static_cast<long long>(step.nodes.size())));
            break;
        case StepKind::simplex_step: {
            const auto& simplex = std::get<event::SimplexStep>(read);
            title = tr("Simplex step %1, node %2").arg(simplex.iteration).arg(node_tag(simplex.node));
            text =
                tr("Nelder-Mead: a triangle of trial positions walks downhill on "
                   "(1 − β) displacement + β Σ exp(−10 angle).");
            numbers << tr("objective %1 = %2 + %3")
                           .arg(format_number(simplex.objective[0]), format_number(simplex.displacement_term),
                                format_number(simplex.angle_term))
                    << tr("angles %1").arg(angles_text(simplex.angles));
            break;
        }
        case StepKind::bfgs_step: {
            const auto& bfgs = std::get<event::BfgsStep>(read);
            title = bfgs.iteration == 0 ? tr("BFGS begins") : tr("BFGS step %1").arg(bfgs.iteration);
            text =
                tr("The edge's nodes go downhill on the sum of its four angles (quasi-Newton), which is level where "
                   "nothing is tangled.");
            numbers << tr("sum of the angles %1").arg(angle_text(bfgs.objective))
                    << tr("angles %1").arg(angles_text(bfgs.angles))
                    << tr("gradient %1, step %2").arg(format_number(bfgs.gradient_norm), format_number(bfgs.step));
            break;
        }
        case StepKind::energy_step: {
            const auto& energy = std::get<event::EnergyStep>(read);
            title = tr("Round %1, L-BFGS step %2").arg(energy.round).arg(energy.iteration);
            text = energy.sharpness > 0.0
                       ? tr("All elements are valid: a soft minimum of their scaled Jacobians is raised.")
                       : tr("ε > 0 keeps the foldover energy finite while elements are tangled; it falls as the least "
                            "determinant rises.");
            numbers << (energy.sharpness > 0.0
                            ? tr("energy %1, sharpness %2")
                                  .arg(format_number(energy.objective), format_number(energy.sharpness))
                            : tr("energy %1, ε %2").arg(format_number(energy.objective), format_number(energy.eps)))
                    << tr("least determinant %1").arg(format_number(energy.least_determinant));
            break;
        }
        case StepKind::patch_certified: {
            const auto& certified = std::get<event::PatchCertified>(read);
            title = tr("The patch is certified");
            text = certified.not_valid == 0
                       ? tr("Every element of the patch is proved valid.")
                       : tr("%1 elements are not proved valid; the worst points become samples of the energy.")
                             .arg(format_count(certified.not_valid));
            break;
        }
        case StepKind::patch_ended: {
            const auto& end = std::get<event::PatchEnded>(read);
            title = tr("The patch is done");
            text = tr("Least scaled Jacobian of the patch: %1 → %2, after %3 iterations.")
                       .arg(format_number(end.min_scaled_jacobian_before), format_number(end.min_scaled_jacobian_after),
                            format_count(end.iterations));
            if (end.beta > 0.0) numbers << tr("β %1").arg(format_number(end.beta));
            numbers
                << tr("objective %1 → %2").arg(format_number(end.objective_before), format_number(end.objective_after));
            break;
        }
        case StepKind::face_nodes_moved:
            title = tr("Nodes inside the triangles follow");
            text = tr("They are put where the curved edges around them ask for.");
            break;
        case StepKind::nodes_placed:
            if (std::get<event::NodesPlaced>(read).placement == event::Placement::straightened) {
                title = tr("The edge is made straight");
                text = tr("Of the attempts on this edge, one that begins with the edge straight was the best.");
            } else {
                title = tr("An earlier state is put back");
                text = tr("It was better than what came after it.");
            }
            break;
        case StepKind::pass_ended: {
            const auto& pass = std::get<event::PassEnded>(read);
            title = tr("Pass %1 is done").arg(pass.pass);
            text = pass.invalid + pass.undecided == 0
                       ? tr("Every element is proved valid.")
                       : tr("%1 elements are not proved valid yet.").arg(format_count(pass.invalid + pass.undecided));
            numbers << tr("relative change of the positions %1").arg(format_number(pass.relative_change));
            break;
        }
        case StepKind::finished:
            title = tr("The end");
            text = tr("The method stopped: %1.")
                       .arg(QString::fromLatin1(to_string(std::get<event::Finished>(read).reason)));
            break;
        case StepKind::increment: {
            const auto& increment = std::get<WarpIncrement>(read);
            title = tr("%1 % of the motion").arg(format_number(100.0 * increment.fraction));
            text = increment.is_accepted ? tr("Every element is valid: the next increment starts here.")
                                         : tr("Elements are tangled here: this increment is taken back.");
            break;
        }
    }
    const QualityPoint point{step.step, static_cast<float>(quality_.min), quality_.invalid + quality_.undecided};
    if (step.method) {
        numbers << tr("patch: scaled J %1 in element %2")
                       .arg(format_number(step.worst_scaled_jacobian), element_tag(step.worst_element));
        if (step.certificate && *step.method == UntangleMethod::guaranteed)
            numbers << tr("last certificate: round %1, %2 not valid")
                           .arg(step.certificate->round)
                           .arg(format_count(step.certificate->not_valid));
    }
    numbers << tr("mesh: min scaled J %1, %2 not valid")
                   .arg(format_number(point.min_scaled_jacobian), format_count(point.not_valid));
    title_->setText(title);
    text_->setText(text);
    numbers_->setText(numbers.join(QLatin1Char('\n')));
}

}  // namespace curvewright
