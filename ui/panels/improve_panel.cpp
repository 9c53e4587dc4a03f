#include "ui/panels/improve_panel.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/panels/boundary_field.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/widgets.h"

namespace curvewright {

ImprovePanel::ImprovePanel(MeshJobs& jobs, QWidget* parent)
    : OperationPanel(jobs, tr("Improve"), QStringLiteral("improve_button"), parent) {
    const ImproveOptions defaults;
    goal_ = make_choice("improve_goal", tr("What is raised."),
                        {{tr("Scaled Jacobian"), int(ImproveGoal::jacobian),
                          tr("the least one, so that J varies less within the elements.")},
                         {tr("Shape"), int(ImproveGoal::shape),
                          tr("the worst mean ratio against the straight-sided elements, so that slivers open.")}});
    target_ = make_number("improve_target", 0.05, 1.0, 0.05, 2, defaults.target);
    target_->setToolTip(tr("Elements below this are improved, together with those around them."));
    farthest_ = make_number("improve_farthest", 0.0, 100.0, 0.1, 3, 0.0);
    farthest_->setSuffix(tr(" %"));
    farthest_->setSpecialValueText(tr("no limit"));
    farthest_->setToolTip(
        tr("How far a node may go from where it is, in per cent of the diagonal of the mesh’s box. 0: as far as it "
           "likes."));
    boundary_ = new BoundaryField(
        QStringLiteral("improve_boundary"),
        {tr("What the nodes of the boundary may do."), tr("not one of them moves."),
         tr("they move along the boundary as it is; corners and feature edges are kept."), QString(),
         tr("what each named part of the boundary may do, and what lies between regions inside the domain, which stays "
            "otherwise."),
         true},
        this);
    auto* form = make_form();
    form->addRow(tr("Raise"), goal_);
    form->addRow(tr("Target"), target_);
    form->addRow(tr("Farthest"), farthest_);
    boundary_->add_to(form, tr("Boundary"));
    align_labels(form);
    QVBoxLayout* layout = make_panel_layout(this);
    layout->addWidget(make_label(tr("Improve a valid mesh"), "section"));
    layout->addLayout(form);
    finish_layout();
    button_->setProperty("primary", false);
    connect(&jobs_.document(), &MeshDocument::state_changed, boundary_, [this] {
        const auto& mesh = jobs_.document().state().mesh;
        boundary_->list_groups(mesh ? &mesh->topology() : nullptr);
    });
}

void ImprovePanel::run() {
    jobs_.improve(options());
}

ImproveOptions ImprovePanel::options() const {
    ImproveOptions options;
    options.goal = chosen<ImproveGoal>(goal_);
    options.target = target_->value();
    if (farthest_->value() > 0.0) options.max_move = 0.01 * farthest_->value();
    options.boundary = boundary_->rules();
    return options;
}

void ImprovePanel::show_options(const ImproveOptions& options) {
    goal_->setCurrentIndex(goal_->findData(int(options.goal)));
    target_->setValue(options.target);
    farthest_->setValue(100.0 * options.max_move.value_or(0.0));
    boundary_->set_rules(options.boundary);
}

}  // namespace curvewright
