#include "ui/panels/untangle_panel.h"

#include <algorithm>

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

#include "ui/panels/boundary_field.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/widgets.h"

namespace curvewright {
UntanglePanel::UntanglePanel(MeshJobs& jobs, QWidget* parent)
    : OperationPanel(jobs, tr("Untangle"), QStringLiteral("untangle_button"), parent) {
    make_fields();
    QVBoxLayout* layout = make_panel_layout(this);
    layout->addLayout(form_);
    recorded_ = new QPushButton(tr("Step by step"));
    recorded_->setObjectName(QStringLiteral("step_by_step_button"));
    recorded_->setToolTip(tr("Untangles the same way, and opens a timeline of everything that the method did"));
    connect(recorded_, &QPushButton::clicked, this, [this] { jobs_.untangle_recorded(options()); });
    finish_layout();
    auto* buttons = new QHBoxLayout;
    buttons->setSpacing(8);
    layout->insertLayout(layout->indexOf(button_), buttons);
    buttons->addWidget(button_, 1);
    buttons->addWidget(recorded_);
}

void UntanglePanel::make_fields() {
    const GuaranteedOptions guaranteed;
    const SignedAngleOptions signed_angles;
    method_ =
        make_choice("method", tr("How interior nodes move until no element is tangled; the boundary stays."),
                    {{tr("Guaranteed"), int(UntangleMethod::guaranteed),
                      tr("all elements but pyramids, any order. Goes on until every element is proved valid.")},
                     {tr("Signed angles"), int(UntangleMethod::signed_angles),
                      tr("triangles of order 2 and up, edge by edge. Corners stay; not every mesh becomes valid.")},
                     {tr("Unsigned angles"), int(UntangleMethod::unsigned_angles),
                      tr("triangles of order 2 and up, only edges of tangled elements. The simplest method; quick, and "
                         "at a loss where tangling is deep.")}});
    boundary_ = new BoundaryField(
        QStringLiteral("boundary"),
        {tr("What the nodes of the boundary may do."), tr("not one of them moves."),
         tr("they move along the boundary as it is; corners and feature edges are kept. Mends elements that nothing "
            "else can, and the shape changes a little."),
         QString(),
         tr("what each named part of the boundary may do, and what lies between regions inside the domain, which stays "
            "otherwise."),
         true},
        this);
    improves_ = new QCheckBox(tr("Improve the worst elements afterwards"));
    improves_->setObjectName(QStringLiteral("improves"));
    improves_->setChecked(guaranteed.improves);
    improves_->setToolTip(
        tr("Raises the least scaled Jacobian once all elements are valid; takes longer.\n"
           "Otherwise elements may stay close to tangled."));
    target_ = make_number("target", 0.05, 1.0, 0.05, 2, guaranteed.target);
    target_->setToolTip(
        tr("Elements below this scaled Jacobian are improved, together with those around them.\n"
           "1: straight-sided. Lower: fewer nodes move and it ends sooner."));
    beta_ = new LogSpinBox;
    beta_->setObjectName(QStringLiteral("beta"));
    beta_->setDecimals(7);
    beta_->setRange(1e-5, 1.0);
    beta_->setLocale(QLocale::c());
    beta_->setValue(signed_angles.beta);
    beta_->setToolTip(
        tr("Weight of the angles against the displacement. It depends on the unit of length: thin, "
           "stretched layers want small values."));
    chooses_beta_ = new QCheckBox(tr("Choose β for every edge"));
    chooses_beta_->setObjectName(QStringLiteral("chooses_beta"));
    chooses_beta_->setChecked(true);
    chooses_beta_->setToolTip(
        tr("Tries weights for every edge and keeps the one with the best certified quality.\n"
           "Otherwise one weight for all edges, as the method was published."));
    passes_ = new QSpinBox;
    passes_->setObjectName(QStringLiteral("max_passes"));
    passes_->setRange(1, 1000);
    passes_->setValue(signed_angles.max_passes);
    passes_->setToolTip(tr("Every pass visits all interior edges once"));
    reject_ = new QCheckBox(tr("Stop when a pass makes things worse"));
    reject_->setObjectName(QStringLiteral("reject_worse_pass"));
    reject_->setChecked(true);
    reject_->setToolTip(tr("Takes back a pass that leaves more tangled elements or a lower minimum"));
    literal_ = new QCheckBox(tr("As published"));
    literal_->setObjectName(QStringLiteral("literal"));
    literal_->setToolTip(tr(
        "The method to the letter: gradients by differences, one start and one first step per edge, face nodes stay.\n"
        "Otherwise several starts and steps are tried, and the best is kept."));

    form_ = make_form();
    form_->addRow(tr("Method"), method_);
    boundary_->add_to(form_, tr("Boundary"));
    form_->addRow(improves_);
    form_->addRow(tr("Target"), target_);
    form_->addRow(chooses_beta_);
    form_->addRow(tr("Weight β"), beta_);
    form_->addRow(tr("Passes at most"), passes_);
    form_->addRow(reject_);
    form_->addRow(literal_);
    align_labels(form_);
    connect(improves_, &QCheckBox::toggled, target_, &QWidget::setEnabled);
    connect(chooses_beta_, &QCheckBox::toggled, this, [this] { show_fields(); });
    connect(&jobs_.document(), &MeshDocument::state_changed, boundary_, [this] {
        const auto& mesh = jobs_.document().state().mesh;
        boundary_->list_groups(mesh ? &mesh->topology() : nullptr);
    });
    connect(method_, &QComboBox::currentIndexChanged, this, [this] {
        show_fields();
        refresh();
    });
    show_fields();
}

void UntanglePanel::show_fields() {
    const auto method = chosen<UntangleMethod>(method_);
    const bool is_guaranteed = method == UntangleMethod::guaranteed;
    boundary_->set_visible(is_guaranteed);
    for (QWidget* field : std::initializer_list<QWidget*>{improves_, target_})
        form_->setRowVisible(field, is_guaranteed);
    const bool is_signed = method == UntangleMethod::signed_angles;
    form_->setRowVisible(chooses_beta_, is_signed);
    for (QWidget* field : std::initializer_list<QWidget*>{beta_, reject_})
        form_->setRowVisible(field, is_signed && !chooses_beta_->isChecked());
    form_->setRowVisible(literal_, method == UntangleMethod::unsigned_angles);
    form_->setRowVisible(passes_, method != UntangleMethod::guaranteed);
}

void UntanglePanel::run() {
    jobs_.untangle(options());
}

void UntanglePanel::refresh() {
    OperationPanel::refresh();
    set_usable(*recorded_, button_->isEnabled());
}

QString UntanglePanel::why_not() const {
    return jobs_.why_not_untangle(chosen<UntangleMethod>(method_));
}

UntangleOptions UntanglePanel::options() const {
    switch (chosen<UntangleMethod>(method_)) {
        case UntangleMethod::guaranteed: {
            GuaranteedOptions options;
            options.improves = improves_->isChecked();
            options.target = target_->value();
            options.boundary = boundary_->rules();
            return options;
        }
        case UntangleMethod::signed_angles: {
            SignedAngleOptions options;
            options.beta_choice = chooses_beta_->isChecked() ? BetaChoice::automatic : BetaChoice::given;
            options.beta = beta_->value();
            options.max_passes = passes_->value();
            options.reject_worse_pass = reject_->isChecked();
            return options;
        }
        case UntangleMethod::unsigned_angles:
            break;
    }
    UnsignedAngleOptions options = literal_->isChecked() ? UnsignedAngleOptions::literal() : UnsignedAngleOptions();
    options.max_passes = passes_->value();
    return options;
}

void UntanglePanel::set_beta(double beta) {
    method_->setCurrentIndex(method_->findData(int(UntangleMethod::signed_angles)));
    chooses_beta_->setChecked(false);
    beta_->setValue(beta);
}

void UntanglePanel::choose_unsigned_angles(bool is_literal) {
    method_->setCurrentIndex(method_->findData(int(UntangleMethod::unsigned_angles)));
    literal_->setChecked(is_literal);
}

void UntanglePanel::choose_guaranteed() {
    method_->setCurrentIndex(method_->findData(int(UntangleMethod::guaranteed)));
}

void UntanglePanel::show_options(const GuaranteedOptions& options) {
    choose_guaranteed();
    improves_->setChecked(options.improves);
    target_->setValue(options.target);
    boundary_->set_rules(options.boundary);
}

}  // namespace curvewright
