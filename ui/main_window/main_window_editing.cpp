#include <cmath>
#include <utility>

#include <QAction>
#include <QActionGroup>
#include <QLabel>
#include <QSettings>
#include <QSplitter>
#include <QStatusBar>

#include "core/base/stopwatch.h"
#include "ui/document/mesh_text.h"
#include "ui/document/number_format.h"
#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/mesh_panel.h"
#include "ui/panels/operation_panels.h"
#include "ui/panels/pointer_tag.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/selection_panel.h"
#include "ui/panels/widgets.h"
#include "ui/panels/worst_table.h"
#include "ui/tools/drag_tool.h"
#include "ui/tools/look_tool.h"
#include "ui/tools/pin_tool.h"
#include "ui/tools/select_tool.h"
#include "ui/tools/step_tool.h"
#include "ui/tools/transform_tool.h"

namespace curvewright {

void MainWindow::build_tools() {
    pointer_tag_ = new PointerTag(view_);
    const ToolContext context{*view_, edit_, drag_};
    tools_[CommandId::tool_look] = new LookTool(context, this);
    step_tool_ = new StepTool(context, this);
    tools_[CommandId::tool_select] = new SelectTool(context, this);
    tools_[CommandId::tool_drag] = new DragTool(context, this);
    tools_[CommandId::tool_transform] = new TransformTool(context, this);
    tools_[CommandId::tool_pin] = new PinTool(context, this);
    auto* group = new QActionGroup(this);
    for (const auto& [id, tool] : tools_) {
        group->addAction(actions_[id]);
        connect(actions_[id], &QAction::toggled, this, &MainWindow::update_tool);
        connect(tool, &Tool::hint_changed, this, &MainWindow::update_hint);
    }
    // Chosen by the user, each for meshes of its kind.
    for (const auto& [id, tool] : tools_)
        connect(actions_[id], &QAction::triggered, this, [this, id = id] {
            QSettings().setValue(tool_setting(), QLatin1String(actions_[id]->objectName().toLatin1()));
        });
    actions_[CommandId::tool_look]->setChecked(true);
}

QString MainWindow::tool_setting() const {
    const bool is_flat = !document_.has_mesh() || document_.state().mesh->topology().dimension() < 3;
    return is_flat ? QStringLiteral("tool/flat") : QStringLiteral("tool/solid");
}

void MainWindow::connect_editing() {
    connect(&drag_, &LiveDrag::active_changed, this, [this](bool is_active) {
        update_commands();
        // What is told about a click before would hide what the hand does now.
        if (is_active) statusBar()->clearMessage();
        if (!is_active) pointer_tag_->hide();
    });
    connect(&drag_, &LiveDrag::frame, this, &MainWindow::show_frame);
    connect(&drag_, &LiveDrag::ended, this, [this](bool is_kept) {
        if (is_kept) return;  // the document has another state
        view_->show_state(document_.state());
        quality_panel_->show_state();
        mesh_panel_->show_state();
        worst_table_->show_state();
        if (document_.state().quality) show_verdict(document_.state().quality->summary);
    });
    connect(&drag_, &LiveDrag::nothing_moved, this,
            [this] { tell(tr("Nothing moved, so there is no new step."), 6000); });
    connect(&drag_, &LiveDrag::failed, this,
            [this](const QString& message) { dialogs_.show_error(this, tr("Dragging failed"), message); });
    connect(&drag_, &LiveDrag::working, this, [this](const QString& phase, double fraction) {
        if (phase.isEmpty())
            update_hint();
        else
            hint_->setText(tr("%1, %2 %. Esc: put back").arg(phase).arg(static_cast<int>(100.0 * fraction)));
    });
    connect(before_view_, &MeshView::content_shown, this, [this] { before_view_->follow_camera(*view_); });
    connect(view_, &MeshView::preparing_changed, this, [this](bool takes_long) {
        if (takes_long)
            hint_->setText(tr("preparing the picture… Esc: leave it as it is"));
        else
            update_hint();
    });
    connect(view_, &MeshView::not_drawn, this, [this] {
        statusBar()->showMessage(tr("The picture is not that of the present state: View > Fit draws it."), 12000);
    });
    connect(view_, &MeshView::frame_begun, &drag_, [this] { drag_.hold_frames(true); });
    connect(view_, &MeshView::frame_drawn, &drag_, [this] {
        drag_.hold_frames(false);
        // Not before the mesh is seen: the weights would take the processors from what draws it.
        if (view_->is_preparing() || !std::exchange(is_drag_unprepared_, false)) return;
        drag_.prepare();
    });
    connect(&document_, &MeshDocument::opened, &drag_, [this] { is_drag_unprepared_ = true; });
    connect(view_, &MeshView::pointer_moved, pointer_tag_, &PointerTag::follow);
    const auto refresh = [this] {
        if (Tool* tool = current_tool()) tool->refresh();
        update_hint();
    };
    connect(&edit_, &EditState::selection_changed, this, refresh);
    connect(&edit_, &EditState::pins_changed, this, refresh);
    connect(&edit_, &EditState::spokes_changed, this, refresh);
    connect(&edit_, &EditState::settings_changed, this, [this, refresh] {
        actions_[CommandId::soft]->setChecked(edit_.settings().is_soft);
        drag_.set_rules(edit_.settings().rules);
        refresh();
    });
    connect(&edit_, &EditState::pins_changed, this, [this] { drag_.set_pinned(edit_.pins()); });
    connect(actions_[CommandId::soft], &QAction::toggled, this, [this](bool is_on) {
        EditSettings settings = edit_.settings();
        if (settings.is_soft == is_on) return;
        settings.is_soft = is_on;
        edit_.set_settings(settings);
    });
    actions_[CommandId::soft]->setChecked(edit_.settings().is_soft);
    const auto use_weights = [this] {
        drag_.set_weights(warp_panel_->options());
        selection_panel_->set_weights(warp_panel_->options());
    };
    connect(warp_panel_, &OperationPanel::refreshed, this, use_weights);
    use_weights();
    connect(actions_[CommandId::compare], &QAction::toggled, this, &MainWindow::split_view);
    connect(view_, &MeshView::camera_moved, this, [this] {
        if (before_view_->isVisible()) before_view_->follow_camera(*view_);
    });
    connect(before_view_, &MeshView::camera_moved, this, [this] {
        if (before_view_->isVisible()) view_->follow_camera(*before_view_);
    });
    connect_selection();
    update_tool();
}

Tool* MainWindow::current_tool() const {
    if (jobs_.runner().is_running() || !document_.has_mesh()) return nullptr;
    // What a recording shows is looked at, and not the document's to edit.
    if (player_.is_open()) return step_tool_;
    for (const auto& [id, tool] : tools_)
        if (actions_[id]->isChecked()) return tool;
    return nullptr;
}

void MainWindow::choose_tool_for_mesh() {
    if (!document_.has_mesh()) return;
    const bool is_flat = document_.state().mesh->topology().dimension() < 3;
    // On a flat mesh there is room beside the boundary for the camera; the surface of a solid is all boundary.
    const QString usual = is_flat ? QStringLiteral("tool_drag") : QStringLiteral("tool_look");
    const QString chosen = preferences_.remembers_tool ? QSettings().value(tool_setting(), usual).toString() : usual;
    for (const auto& [id, tool] : tools_)
        if (actions_[id]->objectName() == chosen) actions_[id]->setChecked(true);
}

void MainWindow::update_tool() {
    view_->set_tool(current_tool());
    update_hint();
}

void MainWindow::update_hint() {
    if (const Tool* tool = current_tool())
        hint_->setText(tool->hint());
    else if (document_.has_mesh())
        hint_->setText(tr("wait, or look around: drag and wheel move the view"));
    else
        hint_->setText(tr("Open a mesh, drop one here, or choose a sample."));
}

void MainWindow::show_frame(const Coordinates& positions, const QualityReport* quality) {
    view_->show_frame(positions, quality);
    if (!quality) return;
    const QualitySummary& summary = quality->summary;
    show_verdict(summary);
    mesh_panel_->show_quality(summary);
    worst_table_->show_live(*quality);
    if (player_.is_open())
        quality_panel_->show_live(quality->elements, player_.recording()->start_quality().elements);
    else
        quality_panel_->show_live(*quality);
    if (!drag_.is_active()) return;
    QString validity = describe_validity(summary);
    if (summary.invalid > 0)
        validity += tr(", worst: element %1")
                        .arg(document_.state().mesh->topology().element_tag(quality->worst(1).front()).value);
    pointer_tag_->set_room(view_->free_area().toRect());
    pointer_tag_->show_quality(tr("min %1").arg(format_number(summary.min)), validity,
                               summary.invalid > 0     ? "alarm"
                               : summary.undecided > 0 ? "warning"
                                                       : "good");
}

void MainWindow::show_before() {
    const bool is_wanted = actions_[CommandId::compare]->isChecked() && document_.has_mesh();
    if (!is_wanted) place_bars();  // with the keyboard, if that is there
    before_view_->setVisible(is_wanted);
    for (QLabel* name : view_page_->findChildren<QLabel*>(QStringLiteral("view_name"))) name->setVisible(is_wanted);
    place_bars();
    if (!is_wanted) {
        before_view_->show_state({});
        return;
    }
    before_view_->show_state(document_.before());
    before_view_->follow_camera(*view_);
}

void MainWindow::split_view(bool is_split) {
    const double width = view_->free_area().width();
    show_before();
    auto* views = static_cast<QSplitter*>(view_->parentWidget());
    // Two halves, for the first time and whenever the window has changed in between.
    if (is_split) views->setSizes({1000, 1000});
    views->refresh();
    // A view that is fitted is so again; of another one all that was seen from left to right is seen again.
    const double factor = width / view_->free_area().width();
    if (view_->keeps_fitted() || !document_.has_mesh() || !std::isfinite(factor)) return;
    view_->widen(factor);
}

void MainWindow::show_verdict(const QualitySummary& summary) {
    verdict_->setText(validity_sentence(summary));
    set_tone(verdict_, summary.invalid > 0 ? "alarm" : summary.undecided > 0 ? "warning" : "good");
}

}  // namespace curvewright
