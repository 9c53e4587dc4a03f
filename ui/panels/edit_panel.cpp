#include "ui/panels/edit_panel.h"

#include <numbers>

#include <QCheckBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui/panels/boundary_field.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

/// A length of any size.
LogSpinBox* make_length(const char* object_name) {
    auto* box = new LogSpinBox;
    box->setObjectName(QLatin1String(object_name));
    box->setLocale(QLocale::c());
    box->setDecimals(12);
    box->setRange(1e-12, 1e12);
    return box;
}

}  // namespace

EditPanel::EditPanel(EditState& edit, LiveDrag& drag, QWidget* parent) : QWidget(parent), edit_(edit), drag_(drag) {
    make_fields();
    make_numbers();
    QVBoxLayout* column = make_panel_layout(this);
    column->addLayout(form_);
    column->addSpacing(8);
    column->addWidget(make_label(tr("Selection by numbers"), "section"));
    column->addLayout(numbers_form_);
    column->addWidget(apply_);
    layout()->addItem(new QSpacerItem(0, 0, QSizePolicy::Minimum, QSizePolicy::Expanding));
    connect(&edit, &EditState::settings_changed, this, &EditPanel::show_settings);
    connect(&edit, &EditState::selection_changed, this, &EditPanel::show_numbers);
    connect(&drag, &LiveDrag::active_changed, this, &EditPanel::show_numbers);
    connect(&drag, &LiveDrag::allowed_changed, this, &EditPanel::show_numbers);
    connect(&edit.document(), &MeshDocument::opened, this, &EditPanel::show_numbers);
    show_settings();
    show_numbers();
}

void EditPanel::make_numbers() {
    motion_ = make_choice("motion", tr("What becomes of the selected nodes; the interior follows."),
                          {{tr("Move by"), 0, tr("along a vector.")},
                           {tr("Rotate by"), 1, tr("about the middle of the selection.")},
                           {tr("Scale by"), 2, tr("about the middle of the selection.")}});
    numbers_row_ = new QWidget;
    auto* row = new QHBoxLayout(numbers_row_);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    const char* names[] = {"motion_x", "motion_y", "motion_z"};
    for (int d = 0; d < 3; ++d) {
        numbers_[d] = make_number(names[d], -1e12, 1e12, 0.1, 6, 0.0);
        numbers_[d]->setButtonSymbols(QAbstractSpinBox::NoButtons);
        numbers_[d]->setMinimumWidth(40);
        row->addWidget(numbers_[d], 1);
    }
    angle_ = make_number("motion_angle", -3600.0, 3600.0, 5.0, 4, 0.0);
    angle_->setSuffix(QStringLiteral("°"));
    angle_->setToolTip(tr("Counter-clockwise, seen from the tip of the axis"));
    for (int d = 0; d < 3; ++d)
        numbers_[d]->setToolTip(tr("Along %1: how far, in the unit of the mesh, or how many times as large")
                                    .arg(QStringLiteral("xyz").mid(d, 1)));
    axis_ = make_choice("motion_axis", tr("The direction that the selection turns about."),
                        {{tr("x"), 0, tr("x")}, {tr("y"), 1, tr("y")}, {tr("z"), 2, tr("z")}});
    axis_->setCurrentIndex(2);
    apply_ = new QPushButton(tr("Apply"));
    apply_->setObjectName(QStringLiteral("apply_motion"));
    numbers_form_ = make_form();
    numbers_form_->addRow(tr("Motion"), motion_);
    numbers_form_->addRow(tr("x, y, z"), numbers_row_);
    numbers_form_->addRow(tr("Angle"), angle_);
    numbers_form_->addRow(tr("About"), axis_);
    align_labels(numbers_form_);
    connect(motion_, &QComboBox::currentIndexChanged, this, [this](int motion) {
        for (QDoubleSpinBox* number : numbers_) number->setValue(motion == 2 ? 1.0 : 0.0);
        show_numbers();
    });
    connect(apply_, &QPushButton::clicked, this, &EditPanel::apply_numbers);
}

void EditPanel::show_numbers() {
    const MeshState& state = edit_.document().state();
    const bool is_solid = state.mesh && state.mesh->topology().dimension() == 3;
    const bool turns = motion_->currentData().toInt() == 1;
    numbers_form_->setRowVisible(numbers_row_, !turns);
    numbers_form_->setRowVisible(angle_, turns);
    numbers_form_->setRowVisible(axis_, turns && is_solid);
    numbers_[2]->setVisible(is_solid);
    static_cast<QLabel*>(numbers_form_->labelForField(numbers_row_))->setText(is_solid ? tr("x, y, z") : tr("x, y"));
    const bool can_apply = state.mesh && !without(edit_.nodes(), edit_.pins()).empty() && drag_.can_begin();
    apply_->setEnabled(can_apply);
    apply_->setToolTip(edit_.nodes().empty() ? tr("Select nodes first, with the select tool or by a group")
                                             : QString());
}

void EditPanel::apply_numbers() {
    const CurvedMesh& mesh = *edit_.document().state().mesh;
    const IndexSet nodes = without(edit_.nodes(), edit_.pins());
    if (nodes.empty() || !drag_.can_begin()) return;
    Eigen::RowVector3d low = mesh.coordinates().row(nodes.front()), high = low;
    for (const Index node : nodes) {
        low = low.cwiseMin(mesh.coordinates().row(node));
        high = high.cwiseMax(mesh.coordinates().row(node));
    }
    const bool is_solid = mesh.topology().dimension() == 3;
    Eigen::Vector3d numbers(numbers_[0]->value(), numbers_[1]->value(), numbers_[2]->value());
    const QString count = tr("%1 nodes").arg(nodes.size());
    DragRequest request{edit_.dragged(nodes), ResponseKind::affine, 0.5 * (low + high).transpose(), {}};
    AffineMotion motion;
    switch (motion_->currentData().toInt()) {
        case 0:
            if (!is_solid) numbers[2] = 0.0;
            motion = AffineMotion::translation(numbers);
            request.kind = ResponseKind::translation;
            request.name = tr("Move %1").arg(count);
            break;
        case 1:
            motion = AffineMotion::rotation(Eigen::Vector3d::Unit(is_solid ? axis_->currentData().toInt() : 2),
                                            angle_->value() * std::numbers::pi / 180.0);
            request.name = tr("Rotate %1 by %2°").arg(count).arg(angle_->value());
            break;
        default:
            if (!is_solid) numbers[2] = 1.0;
            motion = AffineMotion::scaling(numbers);
            request.name = tr("Scale %1").arg(count);
            break;
    }
    drag_.begin(request);
    drag_.move(motion);
    drag_.finish();
}

void EditPanel::make_fields() {
    unit_ = make_choice("grab_unit", tr("What a press on the boundary takes hold of, unless it is selected."),
                        {{tr("A node"), int(GrabUnit::node), tr("the node under the mouse.")},
                         {tr("A side"), int(GrabUnit::side),
                          tr("the smooth part of the boundary, up to the next corners or feature edges.")},
                         {tr("A whole boundary"), int(GrabUnit::boundary), tr("all that hangs together.")}});
    soft_ = new QCheckBox(tr("Take neighbours along"));
    soft_->setObjectName(QStringLiteral("soft"));
    soft_->setToolTip(
        tr("Boundary nodes within the radius follow, the less the farther away they are "
           "(proportional editing)."));
    radius_ = make_length("soft_radius");
    radius_->setToolTip(tr("How far the drag reaches, in the unit of the mesh. While dragging, the wheel changes it."));
    falloff_ = make_choice("falloff", tr("How the share falls from the node in hand to the radius."),
                           {{tr("Smooth"), int(Falloff::smooth), tr("level at both ends.")},
                            {tr("Sphere"), int(Falloff::sphere), tr("like a ball pressed from below.")},
                            {tr("Root"), int(Falloff::root), tr("full and blunt.")},
                            {tr("Linear"), int(Falloff::linear), tr("a tent.")},
                            {tr("Sharp"), int(Falloff::sharp), tr("a thin peak.")}});
    along_ = new QCheckBox(tr("Measured along the boundary"));
    along_->setObjectName(QStringLiteral("along_boundary"));
    along_->setToolTip(tr("Otherwise as the crow flies: the far side of a thin part moves too"));
    direction_ =
        make_choice("drag_direction", tr("Where what is dragged may go. While dragging: X, Y, Z, N, or Shift."),
                    {{tr("With the mouse"), int(DragDirection::view_plane), tr("in the plane of the view.")},
                     {tr("Along x"), int(DragDirection::along_x), tr("along the x axis only.")},
                     {tr("Along y"), int(DragDirection::along_y), tr("along the y axis only.")},
                     {tr("Along z"), int(DragDirection::along_z), tr("along the z axis only.")},
                     {tr("Along the normal"), int(DragDirection::along_normal),
                      tr("along the boundary's normal at the node in hand.")}});
    snap_ = make_choice("snap", tr("Where the node in hand comes to rest. Ctrl: as free as ever."),
                        {{tr("Nothing"), int(SnapTarget::nothing), tr("where the mouse is.")},
                         {tr("Grid"), int(SnapTarget::grid), tr("on multiples of the spacing.")},
                         {tr("Circle"), int(SnapTarget::circle), tr("on a circle in the xy plane.")},
                         {tr("Sphere"), int(SnapTarget::sphere), tr("on a sphere.")},
                         {tr("NACA profile"), int(SnapTarget::naca), tr("on a symmetric four-digit profile.")}});
    spacing_ = make_length("grid_spacing");
    spacing_->setToolTip(
        tr("From one grid point to the next, in the unit of the mesh; also the step of a nudge by keys"));
    center_row_ = new QWidget;
    auto* row = new QHBoxLayout(center_row_);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    const char* names[] = {"snap_x", "snap_y", "snap_z"};
    for (int d = 0; d < 3; ++d) {
        center_[d] = make_number(names[d], -1e12, 1e12, 0.1, 6, 0.0);
        center_[d]->setButtonSymbols(QAbstractSpinBox::NoButtons);
        center_[d]->setMinimumWidth(40);
        row->addWidget(center_[d], 1);
    }
    size_ = make_length("snap_radius");
    size_->setToolTip(tr("In the unit of the mesh"));
    for (int d = 0; d < 3; ++d) center_[d]->setToolTip(tr("Its place along %1").arg(QStringLiteral("xyz").mid(d, 1)));
    thickness_ = make_number("snap_thickness", 0.01, 0.6, 0.01, 3, 0.12);
    thickness_->setToolTip(tr("Thickness of the profile as a fraction of its chord: 0.12 is NACA 0012"));
    center_label_ = make_label(tr("Centre"), "");
    size_label_ = make_label(tr("Radius"), "");

    others_ = new BoundaryField(
        QStringLiteral("other_boundary"),
        {tr("What the boundary that is not in hand does."), tr("not one of its nodes moves."),
         tr("its nodes follow along the boundary as it was when the drag began; corners and feature edges are kept."),
         tr("its nodes follow like those inside, and the boundary changes its shape."),
         tr("what each named part of the boundary does.")},
        this);
    anew_ = new QCheckBox(tr("New weights when let go"));
    anew_->setObjectName(QStringLiteral("solves_anew"));
    anew_->setToolTip(tr(
        "At the end of a drag the interior is solved for once more, with weights of the mesh as it was before it.\n"
        "Better after large motions; otherwise what is seen in hand is kept, with the weights of the mesh as opened."));

    form_ = make_form();
    form_->addRow(tr("Takes"), unit_);
    form_->addRow(soft_);
    form_->addRow(tr("Radius"), radius_);
    form_->addRow(tr("Falloff"), falloff_);
    form_->addRow(along_);
    form_->addRow(tr("Moves"), direction_);
    form_->addRow(tr("Snaps to"), snap_);
    form_->addRow(tr("Spacing"), spacing_);
    form_->addRow(center_label_, center_row_);
    form_->addRow(size_label_, size_);
    form_->addRow(tr("Thickness"), thickness_);
    others_->add_to(form_, tr("The rest"));
    form_->addRow(anew_);
    align_labels(form_);
    connect(others_, &BoundaryField::changed, this, &EditPanel::read_settings);
    connect(&edit_.document(), &MeshDocument::state_changed, others_, [this] {
        const auto& mesh = edit_.document().state().mesh;
        others_->list_groups(mesh ? &mesh->topology() : nullptr);
    });

    for (QComboBox* box : {unit_, falloff_, direction_, snap_})
        connect(box, &QComboBox::currentIndexChanged, this, &EditPanel::read_settings);
    for (QCheckBox* box : {soft_, along_, anew_}) connect(box, &QCheckBox::toggled, this, &EditPanel::read_settings);
    for (QDoubleSpinBox* box : {radius_, spacing_, size_, thickness_, center_[0], center_[1], center_[2]})
        connect(box, &QDoubleSpinBox::valueChanged, this, &EditPanel::read_settings);
}

void EditPanel::show_settings() {
    is_showing_ = true;
    const EditSettings& settings = edit_.settings();
    const auto choose = [](QComboBox* box, int value) { box->setCurrentIndex(box->findData(value)); };
    choose(unit_, int(settings.unit));
    soft_->setChecked(settings.is_soft);
    radius_->setValue(settings.soft.radius);
    choose(falloff_, int(settings.soft.falloff));
    along_->setChecked(settings.soft.follows_boundary);
    choose(direction_, int(settings.direction));
    choose(snap_, int(settings.snap.target));
    spacing_->setValue(settings.snap.grid_spacing);
    for (int d = 0; d < 3; ++d) center_[d]->setValue(settings.snap.center[static_cast<std::size_t>(d)]);
    size_->setValue(settings.snap.radius);
    thickness_->setValue(settings.snap.thickness);
    anew_->setChecked(settings.rules.solves_anew);
    is_showing_ = false;
    show_rows();
}

void EditPanel::read_settings() {
    if (is_showing_) return;
    EditSettings settings = edit_.settings();
    settings.unit = chosen<GrabUnit>(unit_);
    settings.is_soft = soft_->isChecked();
    settings.soft.radius = radius_->value();
    settings.soft.falloff = chosen<Falloff>(falloff_);
    settings.soft.follows_boundary = along_->isChecked();
    settings.direction = chosen<DragDirection>(direction_);
    settings.snap.target = chosen<SnapTarget>(snap_);
    settings.snap.grid_spacing = spacing_->value();
    for (int d = 0; d < 3; ++d) settings.snap.center[static_cast<std::size_t>(d)] = center_[d]->value();
    settings.snap.radius = size_->value();
    settings.snap.thickness = thickness_->value();
    settings.rules = {others_->rules(), anew_->isChecked()};
    edit_.set_settings(settings);
}

void EditPanel::show_rows() {
    const EditSettings& settings = edit_.settings();
    const bool can_be_soft = settings.unit != GrabUnit::boundary, is_soft = can_be_soft && settings.is_soft;
    form_->setRowVisible(soft_, can_be_soft);
    for (QWidget* field : std::initializer_list<QWidget*>{radius_, falloff_, along_})
        form_->setRowVisible(field, is_soft);
    const SnapTarget target = settings.snap.target;
    const bool has_shape = target == SnapTarget::circle || target == SnapTarget::sphere || target == SnapTarget::naca;
    form_->setRowVisible(spacing_, target == SnapTarget::grid);
    form_->setRowVisible(center_row_, has_shape);
    form_->setRowVisible(size_, has_shape);
    form_->setRowVisible(thickness_, target == SnapTarget::naca);
    center_label_->setText(target == SnapTarget::naca ? tr("Leading edge") : tr("Centre"));
    size_label_->setText(target == SnapTarget::naca ? tr("Chord") : tr("Radius"));
}

}  // namespace curvewright
