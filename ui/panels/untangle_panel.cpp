#include "ui/panels/untangle_panel.h"

#include <algorithm>

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QHeaderView>
#include <QSpinBox>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "ui/panels/form_fields.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

constexpr int group_row_height = 36;

enum class BoundaryChoice { fixed, slide, by_group };

}  // namespace

UntanglePanel::UntanglePanel(MeshJobs& jobs, QWidget* parent)
    : OperationPanel(jobs, tr("Untangle"), QStringLiteral("untangle_button"), parent) {
    make_fields();
    make_panel_layout(this)->addLayout(form_);
    finish_layout();
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
    boundary_ = make_choice(
        "boundary", tr("What the nodes of the boundary may do."),
        {{tr("Stays"), int(BoundaryChoice::fixed), tr("not one of them moves.")},
         {tr("Slides along itself"), int(BoundaryChoice::slide),
          tr("they move along the boundary as it is; corners and feature edges are kept. Mends elements that nothing "
             "else "
             "can, and the shape changes a little.")},
         {tr("By group"), int(BoundaryChoice::by_group), tr("what each named part of the boundary may do.")}});
    groups_ = new QTreeWidget;
    groups_->setObjectName(QStringLiteral("boundary_groups"));
    groups_->setColumnCount(2);
    groups_->setHeaderHidden(true);
    groups_->setRootIsDecorated(false);
    groups_->setUniformRowHeights(true);
    groups_->setSelectionMode(QAbstractItemView::NoSelection);
    groups_->header()->setStretchLastSection(false);
    groups_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
    groups_->header()->setSectionResizeMode(1, QHeaderView::Fixed);
    groups_->header()->resizeSection(1, 110);
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
    form_->addRow(tr("Boundary"), boundary_);
    form_->addRow(groups_);
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
    connect(boundary_, &QComboBox::currentIndexChanged, this, [this] { show_fields(); });
    connect(&jobs_.document(), &MeshDocument::state_changed, this, [this] { list_groups(); });
    connect(method_, &QComboBox::currentIndexChanged, this, [this] {
        show_fields();
        refresh();
    });
    list_groups();
    show_fields();
}

void UntanglePanel::show_fields() {
    const auto method = chosen<UntangleMethod>(method_);
    const bool is_guaranteed = method == UntangleMethod::guaranteed;
    for (QWidget* field : std::initializer_list<QWidget*>{boundary_, improves_, target_})
        form_->setRowVisible(field, is_guaranteed);
    form_->setRowVisible(groups_, is_guaranteed && chosen<BoundaryChoice>(boundary_) == BoundaryChoice::by_group);
    const bool is_signed = method == UntangleMethod::signed_angles;
    form_->setRowVisible(chooses_beta_, is_signed);
    for (QWidget* field : std::initializer_list<QWidget*>{beta_, reject_})
        form_->setRowVisible(field, is_signed && !chooses_beta_->isChecked());
    form_->setRowVisible(literal_, method == UntangleMethod::unsigned_angles);
    form_->setRowVisible(passes_, method != UntangleMethod::guaranteed);
}

void UntanglePanel::list_groups() {
    const MeshDocument& document = jobs_.document();
    QStringList names;
    if (document.has_mesh()) {
        const MeshTopology& topology = document.state().mesh->topology();
        for (const PhysicalGroup& group : topology.groups())
            if (group.dimension == topology.dimension() - 1 && !group.name.empty())
                names << QString::fromStdString(group.name);
    }
    names.removeDuplicates();
    if (names == group_names_) return;
    group_names_ = names;
    groups_->clear();
    group_modes_.clear();
    for (const QString& name : names) {
        auto* item = new QTreeWidgetItem(groups_, {name});
        item->setToolTip(0, name);
        item->setSizeHint(1, {110, group_row_height});
        auto* mode = new QComboBox;
        mode->addItem(tr("Stays"), int(BoundaryMode::fixed));
        mode->addItem(tr("Slides"), int(BoundaryMode::slide));
        mode->addItem(tr("Free"), int(BoundaryMode::free));
        mode->setAccessibleName(tr("Boundary %1").arg(name));
        groups_->setItemWidget(item, 1, mode);
        group_modes_.push_back(mode);
    }
    constexpr qsizetype rows_shown = 4;  // more can be scrolled to
    groups_->setFixedHeight(static_cast<int>(std::clamp<qsizetype>(names.size(), 1, rows_shown)) * group_row_height +
                            4);
}

BoundaryRules UntanglePanel::boundary_rules() const {
    BoundaryRules rules;
    const auto choice = chosen<BoundaryChoice>(boundary_);
    if (choice == BoundaryChoice::slide) rules.otherwise = BoundaryMode::slide;
    if (choice == BoundaryChoice::by_group)
        for (qsizetype i = 0; i < group_names_.size(); ++i) {
            const auto mode = chosen<BoundaryMode>(group_modes_[static_cast<std::size_t>(i)]);
            if (mode != BoundaryMode::fixed) rules.groups.push_back({group_names_[i].toStdString(), mode});
        }
    return rules;
}

void UntanglePanel::run() {
    jobs_.untangle(options());
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
            options.boundary = boundary_rules();
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

void UntanglePanel::choose_guaranteed() {
    method_->setCurrentIndex(method_->findData(int(UntangleMethod::guaranteed)));
}

}  // namespace curvewright
