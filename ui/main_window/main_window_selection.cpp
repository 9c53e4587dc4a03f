#include <algorithm>

#include <QAction>
#include <QStatusBar>

#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/selection_panel.h"

namespace curvewright {

void MainWindow::connect_selection() {
    const auto on = [this](CommandId id, auto function) { connect(actions_[id], &QAction::triggered, this, function); };
    on(CommandId::select_all,
       [this] { edit_.select_elements(inverted_elements(document_.state().mesh->topology(), {})); });
    on(CommandId::select_none, [this] { edit_.select({}, {}); });
    on(CommandId::select_invert, [this] { edit_.invert(); });
    on(CommandId::select_grow, [this] { edit_.grow(); });
    on(CommandId::select_shrink, [this] { edit_.shrink(); });
    on(CommandId::select_side, [this] {
        // Sides that a selected node is inside of; a corner alone means the sides that meet in it.
        const BoundaryParts& boundary = edit_.boundary();
        std::vector<int> parts;
        for (const bool takes_corners : {false, true}) {
            if (!parts.empty()) break;
            for (const Index node : edit_.nodes()) {
                std::vector<int> its;
                for (const Index facet : boundary.facets_of_node(node))
                    its.push_back(boundary.smooth_part_of_facet()[static_cast<std::size_t>(facet)]);
                std::sort(its.begin(), its.end());
                its.erase(std::unique(its.begin(), its.end()), its.end());
                if (its.size() == 1 || takes_corners) parts.insert(parts.end(), its.begin(), its.end());
            }
        }
        std::sort(parts.begin(), parts.end());
        parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
        IndexSet nodes = edit_.nodes();
        for (const int part : parts) nodes = united(nodes, boundary.smooth_part_nodes(part));
        edit_.select_nodes(std::move(nodes));
    });
    on(CommandId::select_feature, [this] {
        IndexSet nodes;
        for (const Index node : edit_.nodes()) nodes = united(nodes, edit_.boundary().feature_line_nodes_around(node));
        if (nodes.empty())
            statusBar()->showMessage(tr("None of the selected nodes is on a feature line."), 6000);
        else
            edit_.select_nodes(std::move(nodes));
    });
    on(CommandId::select_boundary, [this] {
        IndexSet nodes;
        for (const Index node : edit_.nodes())
            if (!std::binary_search(nodes.begin(), nodes.end(), node))
                nodes = united(united(nodes, {node}), edit_.boundary().component_nodes_around(node));
        edit_.select_nodes(std::move(nodes));
    });
    on(CommandId::select_tangled, [this] {
        IndexSet elements;
        const auto& quality = document_.state().quality->elements;
        for (std::size_t i = 0; i < quality.size(); ++i)
            if (quality[i].validity == Validity::invalid || quality[i].validity == Validity::undecided)
                elements.push_back(static_cast<Index>(i));
        select_elements(elements, false);
    });
    on(CommandId::pin_selection, [this] { edit_.set_pins(united(edit_.pins(), edit_.nodes())); });
    on(CommandId::unpin_all, [this] { edit_.set_pins({}); });
    on(CommandId::fit_selection, &MainWindow::fit_selection);

    connect(&edit_, &EditState::selection_changed, this, [this] {
        view_->set_highlighted_elements(edit_.elements());
        quality_panel_->set_selected(edit_.elements());
        update_commands();
    });
    connect(&edit_, &EditState::pins_changed, this, &MainWindow::update_commands);
    connect(selection_panel_, &SelectionPanel::element_shown, this, [this](Index element) {
        uncover(element);
        view_->fly_to(element);
    });
    connect(selection_panel_, &SelectionPanel::node_shown, this,
            [this](Index node) { view_->fit_to(document_.state().mesh->coordinates().row(node), 0.0); });
}

void MainWindow::fit_selection() {
    const CurvedMesh& mesh = *document_.state().mesh;
    const IndexSet nodes = united(edit_.nodes(), nodes_of_elements(mesh.topology(), edit_.elements()));
    if (nodes.empty()) return;
    Eigen::RowVector3d low = mesh.coordinates().row(nodes.front()), high = low;
    for (const Index node : nodes) {
        low = low.cwiseMin(mesh.coordinates().row(node));
        high = high.cwiseMax(mesh.coordinates().row(node));
    }
    view_->fit_to(0.5 * (low + high), 0.5 * (high - low).norm());
}

}  // namespace curvewright
