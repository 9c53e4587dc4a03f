#include "ui/panels/selection_panel.h"

#include <algorithm>

#include <QCheckBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "core/base/error.h"
#include "ui/document/core_words.h"
#include "ui/document/number_format.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/jacobian_map.h"
#include "ui/panels/widgets.h"

namespace curvewright {
namespace {

enum ItemRole { is_element_role = Qt::UserRole, index_role };

QTreeWidget* make_table(const char* object_name) {
    auto* table = new QTreeWidget;
    table->setObjectName(QLatin1String(object_name));
    table->setColumnCount(2);
    table->setHeaderHidden(true);
    table->setRootIsDecorated(false);
    table->setUniformRowHeights(true);
    table->header()->setStretchLastSection(true);
    table->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    table->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    table->setTextElideMode(Qt::ElideRight);
    return table;
}

QToolButton* make_button(const QString& text, const QString& tip, const char* object_name) {
    auto* button = new QToolButton;
    button->setText(text);
    button->setToolTip(tip);
    button->setObjectName(QLatin1String(object_name));
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    return button;
}

QString validity_word(Validity validity) {
    return validity == Validity::valid          ? SelectionPanel::tr("proved valid")
           : validity == Validity::invalid      ? SelectionPanel::tr("tangled")
           : validity == Validity::not_assessed ? SelectionPanel::tr("not assessed")
                                                : SelectionPanel::tr("undecided");
}

}  // namespace

SelectionPanel::SelectionPanel(EditState& edit, const Theme& theme, QWidget* parent) : QWidget(parent), edit_(edit) {
    make_selecting();
    list_ = make_table("selection_list");
    list_->setMinimumHeight(72);
    details_ = make_table("selection_details");
    details_->setSelectionMode(QAbstractItemView::NoSelection);
    details_->setMinimumHeight(120);
    layout()->addWidget(list_);
    layout()->addWidget(details_);
    map_ = new JacobianMap(theme);
    map_->hide();
    layout()->addWidget(map_);
    static_cast<QVBoxLayout*>(layout())->setStretchFactor(list_, 2);
    static_cast<QVBoxLayout*>(layout())->setStretchFactor(details_, 3);
    connect(list_, &QTreeWidget::currentItemChanged, this, &SelectionPanel::show_details);
    connect(list_, &QTreeWidget::itemActivated, this, [this](QTreeWidgetItem* item) {
        if (item->data(0, index_role).isNull()) return;
        const Index index = item->data(0, index_role).toInt();
        if (item->data(0, is_element_role).toBool())
            emit element_shown(index);
        else
            emit node_shown(index);
    });
    connect(&edit, &EditState::selection_changed, this, &SelectionPanel::show_selection);
    connect(&edit, &EditState::settings_changed, this, &SelectionPanel::show_settings);
    connect(&edit.document(), &MeshDocument::state_changed, this, &SelectionPanel::show_selection);
    show_settings();
    show_selection();
}

void SelectionPanel::make_selecting() {
    what_ = make_choice("select_what", tr("What a click, a box or a lasso selects."),
                        {{tr("Boundary nodes"), int(SelectWhat::boundary_nodes),
                          tr("nodes of the boundary; a click beside them takes the element there.")},
                         {tr("All nodes"), int(SelectWhat::nodes), tr("interior nodes too.")},
                         {tr("Elements"), int(SelectWhat::elements), tr("whole elements.")}});
    shape_ = make_choice("select_shape", tr("What a drag with the select tool draws."),
                         {{tr("Box"), 0, tr("a rectangle.")}, {tr("Lasso"), 1, tr("any outline.")}});
    sees_through_ = new QCheckBox(tr("Through the surface"));
    sees_through_->setObjectName(QStringLiteral("select_through"));
    sees_through_->setToolTip(tr("Takes what the surface of a solid hides as well"));
    lower_ = make_number("range_lower", -1e3, 1.0, 0.05, 2, 0.0);
    upper_ = make_number("range_upper", -1e3, 1.0, 0.05, 2, 0.3);
    lower_->setButtonSymbols(QAbstractSpinBox::NoButtons);
    upper_->setButtonSymbols(QAbstractSpinBox::NoButtons);
    lower_->setToolTip(tr("The lowest scaled Jacobian to take; negative: tangled elements too"));
    upper_->setToolTip(tr("The highest scaled Jacobian to take"));
    lower_->setMinimumWidth(48);
    upper_->setMinimumWidth(48);
    auto* select_range = new QPushButton(tr("Take"));
    select_range->setObjectName(QStringLiteral("select_range"));
    select_range->setToolTip(tr("Selects the elements whose scaled Jacobian is in this range"));
    range_ = new QWidget;
    auto* row = new QHBoxLayout(range_);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    row->addWidget(lower_, 1);
    row->addWidget(make_label(tr("to"), "muted"));
    row->addWidget(upper_, 1);
    row->addWidget(select_range);

    QFormLayout* form = make_form();
    form->addRow(tr("Selects"), what_);
    form->addRow(tr("By"), shape_);
    form->addRow(sees_through_);
    form->addRow(tr("Scaled J"), range_);
    align_labels(form);

    count_ = make_label(QString(), "title");
    count_->setObjectName(QStringLiteral("selection_count"));
    grow_ = make_button(tr("Grow"), tr("One layer more: neighbours of what is selected"), "selection_grow");
    shrink_ = make_button(tr("Shrink"), tr("One layer less: the rim of what is selected goes"), "selection_shrink");
    invert_ = make_button(tr("Invert"), tr("What is not selected instead of what is"), "selection_invert");
    clear_ = make_button(tr("Clear"), tr("Select nothing"), "selection_clear");
    auto* buttons = new QHBoxLayout;
    buttons->setSpacing(4);
    for (QToolButton* button : {grow_, shrink_, invert_, clear_}) buttons->addWidget(button);

    QVBoxLayout* column = make_panel_layout(this);
    column->addLayout(form);
    column->addSpacing(4);
    column->addWidget(count_);
    column->addLayout(buttons);

    for (QComboBox* box : {what_, shape_})
        connect(box, &QComboBox::currentIndexChanged, this, &SelectionPanel::read_settings);
    connect(sees_through_, &QCheckBox::toggled, this, &SelectionPanel::read_settings);
    connect(select_range, &QPushButton::clicked, this, [this] {
        const MeshState& state = edit_.document().state();
        if (!state.quality) return;
        edit_.select_elements(elements_in_range(*state.quality, std::min(lower_->value(), upper_->value()),
                                                std::max(lower_->value(), upper_->value())));
    });
    connect(grow_, &QToolButton::clicked, &edit_, &EditState::grow);
    connect(shrink_, &QToolButton::clicked, &edit_, &EditState::shrink);
    connect(invert_, &QToolButton::clicked, &edit_, &EditState::invert);
    connect(clear_, &QToolButton::clicked, &edit_, [this] { edit_.select({}, {}); });
}

void SelectionPanel::set_scale(const ColorScale& scale) {
    map_->set_scale(scale);
}

void SelectionPanel::show_settings() {
    is_showing_ = true;
    const SelectSettings& settings = edit_.settings().select;
    what_->setCurrentIndex(what_->findData(int(settings.what)));
    shape_->setCurrentIndex(shape_->findData(settings.is_lasso ? 1 : 0));
    sees_through_->setChecked(settings.sees_through);
    is_showing_ = false;
}

void SelectionPanel::read_settings() {
    if (is_showing_) return;
    EditSettings settings = edit_.settings();
    settings.select.what = chosen<SelectWhat>(what_);
    settings.select.is_lasso = shape_->currentData().toInt() == 1;
    settings.select.sees_through = sees_through_->isChecked();
    edit_.set_settings(settings);
}

void SelectionPanel::show_selection() {
    const MeshState& state = edit_.document().state();
    const bool is_solid = state.mesh && state.mesh->topology().dimension() == 3;
    sees_through_->setVisible(is_solid);
    range_->setEnabled(state.quality != nullptr);
    const auto nodes = static_cast<long long>(edit_.nodes().size()),
               elements = static_cast<long long>(edit_.elements().size());
    QStringList parts;
    if (nodes > 0) parts << (nodes == 1 ? tr("1 node") : tr("%1 nodes").arg(format_count(nodes)));
    if (elements > 0) parts << (elements == 1 ? tr("1 element") : tr("%1 elements").arg(format_count(elements)));
    count_->setText(parts.isEmpty() ? tr("Nothing is selected") : parts.join(QStringLiteral(", ")));
    for (QToolButton* button : {grow_, shrink_, clear_}) button->setEnabled(!parts.isEmpty());
    invert_->setEnabled(state.mesh != nullptr);

    const QSignalBlocker blocker(list_);
    list_->clear();
    if (!state.mesh) {
        show_details();
        return;
    }
    const MeshTopology& topology = state.mesh->topology();
    const auto add = [this](const QString& name, const QString& value, bool is_element, Index index) {
        auto* item = new QTreeWidgetItem(list_, {name, value});
        item->setData(0, is_element_role, is_element);
        item->setData(0, index_role, index);
        item->setTextAlignment(1, Qt::AlignRight | Qt::AlignVCenter);
    };
    // Elements from the worst on: one looks for what is wrong.
    IndexSet by_quality = edit_.elements();
    if (state.quality) {
        const auto value = [&](Index element) {
            return state.quality->elements[static_cast<std::size_t>(element)].scaled_jacobian;
        };
        const auto rows = std::min<std::ptrdiff_t>(max_rows, static_cast<std::ptrdiff_t>(by_quality.size()));
        std::partial_sort(by_quality.begin(), by_quality.begin() + rows, by_quality.end(),
                          [&](Index a, Index b) { return std::pair(value(a), a) < std::pair(value(b), b); });
    }
    int rows = 0;
    for (const Index element : by_quality) {
        if (rows++ == max_rows) break;
        add(tr("Element %1").arg(topology.element_tag(element).value),
            state.quality ? format_number(state.quality->elements[static_cast<std::size_t>(element)].scaled_jacobian)
                          : QString(),
            true, element);
    }
    for (const Index node : edit_.nodes()) {
        if (rows++ >= max_rows) break;
        const auto at = state.mesh->coordinates().row(node);
        add(tr("Node %1").arg(topology.node_tag(node).value),
            QStringLiteral("%1, %2").arg(format_number(at[0]), format_number(at[1])) +
                (is_solid ? QStringLiteral(", ") + format_number(at[2]) : QString()),
            false, node);
    }
    if (nodes + elements > max_rows)
        new QTreeWidgetItem(list_, {tr("and %1 more").arg(format_count(nodes + elements - max_rows)), QString()});
    if (list_->topLevelItemCount() > 0) list_->setCurrentItem(list_->topLevelItem(0));
    show_details();
}

void SelectionPanel::add_detail(const QString& name, const QString& value, const QString& tip) {
    auto* item = new QTreeWidgetItem(details_, {name, value});
    item->setToolTip(0, tip);
    item->setToolTip(1, tip.isEmpty() ? value : tip);
}

void SelectionPanel::show_details() {
    details_->clear();
    map_->clear();
    const QTreeWidgetItem* item = list_->currentItem();
    const bool is_any = item && !item->data(0, index_role).isNull() && edit_.document().has_mesh();
    const bool is_node = is_any && !item->data(0, is_element_role).toBool();
    edit_.set_spokes(is_node ? find_spokes(item->data(0, index_role).toInt()) : Spokes{});
    if (!is_any) return;
    const Index index = item->data(0, index_role).toInt();
    if (item->data(0, is_element_role).toBool())
        show_element(index);
    else
        show_node(index);
}

void SelectionPanel::show_element(Index element) {
    const MeshState& state = edit_.document().state();
    const MeshTopology& topology = state.mesh->topology();
    add_detail(tr("Element"), QString::number(topology.element_tag(element).value));
    add_detail(tr("Type"), type_name(topology.element_type(element)));
    const auto center = state.mesh->element_center(element);
    add_detail(tr("Centre"),
               QStringLiteral("%1, %2, %3")
                   .arg(format_component(center[0], center.norm()), format_component(center[1], center.norm()),
                        format_component(center[2], center.norm())));
    if (state.quality) {
        const ElementQuality& quality = state.quality->elements[static_cast<std::size_t>(element)];
        add_detail(tr("Scaled J"), format_number(quality.scaled_jacobian), exact_number(quality.scaled_jacobian));
        add_detail(tr("Validity"), validity_word(quality.validity));
        const QString range = QStringLiteral("%1 … %2");
        add_detail(tr("min J"), range.arg(format_number(quality.min_lower), format_number(quality.min_upper)),
                   tr("The least Jacobian lies between %1 and %2: that is proved.")
                       .arg(exact_number(quality.min_lower), exact_number(quality.min_upper)));
        add_detail(tr("max J"), range.arg(format_number(quality.max_lower), format_number(quality.max_upper)),
                   tr("The largest Jacobian lies between %1 and %2: that is proved.")
                       .arg(exact_number(quality.max_lower), exact_number(quality.max_upper)));
    }
    if (state.quality) map_->show_element(*state.mesh, element, *state.quality);
    QStringList tags;
    for (const Index node : topology.element_nodes(element)) tags << QString::number(topology.node_tag(node).value);
    add_detail(tr("Nodes"), tags.join(QStringLiteral(", ")));
}

void SelectionPanel::show_node(Index node) {
    const MeshState& state = edit_.document().state();
    const MeshTopology& topology = state.mesh->topology();
    add_detail(tr("Node"), QString::number(topology.node_tag(node).value));
    const auto at = state.mesh->coordinates().row(node);
    const QString names[] = {tr("x"), tr("y"), tr("z")};
    for (int d = 0; d < 3; ++d) add_detail(names[d], exact_number(at[d]));
    const auto was = edit_.document().original().mesh->coordinates().row(node);
    add_detail(tr("Moved by"), format_number((at - was).norm()), tr("Distance from where the file had it"));
    QStringList places{topology.is_boundary_node(node) ? tr("boundary") : tr("interior")};
    if (std::binary_search(edit_.pins().begin(), edit_.pins().end(), node)) places << tr("pinned");
    add_detail(tr("Lies"), places.join(QStringLiteral(", ")));
    QStringList groups;
    for (const PhysicalGroup& group : topology.groups()) {
        const std::string group_name = MeshTopology::display_name(group);
        const auto members = topology.find_group_nodes(group_name);
        if (members && std::binary_search(members->begin(), members->end(), node))
            groups << QString::fromStdString(group_name);
    }
    if (!groups.isEmpty()) add_detail(tr("Groups"), groups.join(QStringLiteral(", ")));
    QStringList tags;
    for (const Index element : elements_with_any(topology, {node}))
        tags << QString::number(topology.element_tag(element).value);
    add_detail(tr("Elements"), tags.join(QStringLiteral(", ")));
    const Spokes& spokes = edit_.spokes();
    for (std::size_t i = 0; i < spokes.neighbours.size(); ++i)
        add_detail(
            tr("Weight of %1").arg(topology.node_tag(spokes.neighbours[i]).value), format_number(spokes.weights[i]),
            tr("The node moves by this part of what its neighbour moves: %1").arg(exact_number(spokes.weights[i])));
}

void SelectionPanel::set_weights(const WarpOptions& options) {
    weights_ = options;
    show_details();
}

Spokes SelectionPanel::find_spokes(Index node) const {
    const CurvedMesh& mesh = *edit_.document().state().mesh;
    if (!mesh.topology().is_interior_node(node) || weights_.weighting == Weighting::elastic) return {};
    try {
        // Those that a drag uses: of the mesh as opened, as long as it is the same mesh.
        const CurvedMesh& opened = *edit_.document().original().mesh;
        const CurvedMesh& base = opened.shared_topology() == mesh.shared_topology() ? opened : mesh;
        const NeighbourSets sets = find_neighbours(base.topology(), {node}, weights_.neighbours);
        const WeightTable table =
            compute_weights(base, sets,
                            weights_.weighting == Weighting::affine
                                ? affine_weighting(weights_.distance_power, weights_.sharing_power)
                                : convex_weighting(weights_.distance_power, weights_.sharing_power));
        return {node, sets.nodes, table.weights};
    } catch (const Error&) {
        return {};  // a mesh that cannot be warped this way has no weights to show
    }
}

}  // namespace curvewright
