#include "ui/main_window/main_window.h"

#include <algorithm>
#include <utility>

#include <QAction>
#include <QDockWidget>
#include <QEvent>
#include <QLabel>
#include <QSettings>
#include <QStackedWidget>
#include <QStatusBar>
#include <QTabWidget>

#include "ui/document/core_words.h"
#include "ui/document/mesh_text.h"
#include "ui/document/number_format.h"
#include "ui/main_window/command_palette.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/clip_bar.h"
#include "ui/panels/improve_panel.h"
#include "ui/panels/mesh_panel.h"
#include "ui/panels/operation_panels.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/sample_note.h"
#include "ui/panels/start_page.h"
#include "ui/panels/untangle_panel.h"
#include "ui/panels/widgets.h"
#include "ui/panels/worst_table.h"
#include "ui/tools/tool.h"

namespace curvewright {
namespace {

Color to_color(const QColor& color) {
    return {color.redF(), color.greenF(), color.blueF()};
}

const struct {
    CommandId command;
    Theme::Choice choice;
    const char* name;
} theme_choices[] = {{CommandId::theme_system, Theme::Choice::follow_system, "system"},
                     {CommandId::theme_light, Theme::Choice::light, "light"},
                     {CommandId::theme_dark, Theme::Choice::dark, "dark"}};

const struct {
    CommandId command;
    ViewDirection direction;
} look_commands[] = {{CommandId::fit, ViewDirection::fit},
                     {CommandId::look_front, ViewDirection::minus_y},
                     {CommandId::look_back, ViewDirection::plus_y},
                     {CommandId::look_left, ViewDirection::minus_x},
                     {CommandId::look_right, ViewDirection::plus_x},
                     {CommandId::look_top, ViewDirection::plus_z},
                     {CommandId::look_bottom, ViewDirection::minus_z},
                     {CommandId::look_isometric, ViewDirection::isometric}};

}  // namespace

MainWindow::MainWindow(Theme& theme, Dialogs dialogs)
    : theme_(theme),
      dialogs_(std::move(dialogs)),
      jobs_(document_),
      notices_(document_),
      global_check_(document_),
      edit_(document_),
      drag_(document_),
      samples_(SampleCatalog::load()),
      actions_(theme, this) {
    setObjectName(QStringLiteral("main_window"));
    setWindowIcon(Theme::program_icon());
    theme.dress(this);
    build_menus();
    build_tool_bar();
    build_center();
    build_docks();
    build_status_bar();
    build_tools();
    restore_layout();
    connect_commands();
    connect_document();
    connect_notices();
    connect_panels();
    connect_editing();
    connect_colors();
    connect_session();
    connect_views();
    connect_report();
    connect_timeline();
    connect_keyboard();
    const QString saved_theme = QSettings().value(QStringLiteral("theme"), QStringLiteral("system")).toString();
    for (const auto& entry : theme_choices)
        if (saved_theme == QLatin1String(entry.name)) actions_[entry.command]->setChecked(true);
    show_opened();
    show_state();
    update_commands();
}

MainWindow::~MainWindow() {
    jobs_.runner().cancel_and_wait();
}

void MainWindow::connect_commands() {
    const auto on = [this](CommandId id, auto function) { connect(actions_[id], &QAction::triggered, this, function); };
    on(CommandId::open, &MainWindow::ask_open);
    on(CommandId::load_deformation, &MainWindow::ask_load_deformation);
    on(CommandId::save, [this] { save(false); });
    on(CommandId::save_as, [this] { save(true); });
    on(CommandId::export_mesh, &MainWindow::ask_export);
    on(CommandId::save_picture, &MainWindow::ask_save_picture);
    on(CommandId::close_mesh, [this] {
        if (!is_busy()) when_settled([this] { document_.close(); });
    });
    on(CommandId::quit, [this] { close(); });
    on(CommandId::undo, [this] { document_.history()->undo(); });
    on(CommandId::redo, [this] { document_.history()->redo(); });
    // With the panel whose parameters they take.
    on(CommandId::deform, [this] {
        show_tab(QStringLiteral("deform"));
        deform_panel_->run();
    });
    on(CommandId::warp, [this] {
        show_tab(QStringLiteral("warp"));
        warp_panel_->run();
    });
    on(CommandId::untangle, [this] {
        show_tab(QStringLiteral("untangle"));
        untangle_panel_->run();
    });
    on(CommandId::improve, [this] {
        show_tab(QStringLiteral("untangle"));
        improve_panel_->run();
    });
    on(CommandId::flip, [this] { jobs_.flip(); });
    on(CommandId::renumber, [this] { jobs_.renumber(); });
    on(CommandId::stop, [this] { jobs_.runner().cancel(); });
    on(CommandId::reset_layout, &MainWindow::reset_layout);
    on(CommandId::palette, [this] { (new CommandPalette(actions_, this))->open(); });
    on(CommandId::shortcuts, [this] { show_shortcuts(this, actions_, preferences_.mouse); });
    on(CommandId::about, [this] { show_about(this); });
    for (const auto& entry : look_commands)
        on(entry.command, [this, direction = entry.direction] { view_->look(direction); });
    for (const CommandId id : {CommandId::edges, CommandId::nodes, CommandId::legend, CommandId::clip,
                               CommandId::shrink, CommandId::worst_only})
        connect(actions_[id], &QAction::toggled, this, &MainWindow::update_options);
    for (const CommandId id : {CommandId::node_numbers, CommandId::element_numbers, CommandId::orthographic})
        connect(actions_[id], &QAction::toggled, this, &MainWindow::update_options);
    for (const auto& entry : theme_choices)
        connect(actions_[entry.command], &QAction::toggled, this, [this, entry](bool is_on) {
            if (is_on && theme_.choice() != entry.choice) theme_.set_choice(entry.choice);
        });
    for (const auto& entry : theme_choices)
        on(entry.command, [entry] { QSettings().setValue(QStringLiteral("theme"), QLatin1String(entry.name)); });
    connect(&theme_, &Theme::changed, this, [this] {
        for (const auto& entry : theme_choices)
            if (entry.choice == theme_.choice()) actions_[entry.command]->setChecked(true);
        update_options();
    });
}

void MainWindow::connect_document() {
    connect(&document_, &MeshDocument::opened, this, &MainWindow::show_opened);
    connect(&document_, &MeshDocument::state_changed, this, &MainWindow::show_state);
    connect(&document_, &MeshDocument::deformation_changed, this, [this] {
        update_commands();
        // Both of these take it; from another tab it would go unseen.
        const bool is_seen = tabs_->currentWidget()->objectName() == QLatin1String("warp_tab");
        if (document_.deformation() && !is_seen) show_tab(QStringLiteral("deform"));
    });
    connect(&document_, &MeshDocument::file_path_changed, this, &MainWindow::update_title);
    connect(&document_, &MeshDocument::dirty_changed, this, &MainWindow::update_title);

    JobRunner& runner = jobs_.runner();
    connect(&runner, &JobRunner::running_changed, this, &MainWindow::update_commands);
    connect(&runner, &JobRunner::running_changed, this, &MainWindow::update_tool);
    connect(&runner, &JobRunner::running_changed, &drag_,
            [this] { drag_.set_allowed(!jobs_.runner().is_running() && !player_.is_open()); });
    connect(&runner, &JobRunner::started, statusBar(), &QStatusBar::clearMessage);
    connect(&runner, &JobRunner::failed, this, [this](const QString& title, const QString& message) {
        after_save_ = nullptr;
        pending_format_.reset();
        dialogs_.show_error(this, tr("%1 failed").arg(title), message);
    });
    connect(&runner, &JobRunner::cancelled, this, [this](const QString& title) {
        after_save_ = nullptr;
        pending_format_.reset();
        tell(tr("%1 was stopped; the mesh is as it was.").arg(title), 6000);
    });
    connect(&runner, &JobRunner::finished, this, [this] {
        if (pending_format_) saved_format_ = std::exchange(pending_format_, std::nullopt);
        if (after_save_ && !document_.is_dirty()) std::exchange(after_save_, nullptr)();
    });
}

void MainWindow::connect_panels() {
    for (OperationPanel* panel :
         std::initializer_list<OperationPanel*>{deform_panel_, warp_panel_, untangle_panel_, improve_panel_})
        connect(panel, &OperationPanel::refreshed, this, &MainWindow::update_commands);
    connect(start_page_, &StartPage::open_requested, this, &MainWindow::ask_open);
    connect(start_page_, &StartPage::file_chosen, this, [this](const QString& path) { open_file(path); });
    connect(start_page_, &StartPage::sample_chosen, this, &MainWindow::open_sample);
    connect(deform_panel_, &DeformPanel::load_requested, this, &MainWindow::ask_load_deformation);
    connect(clip_bar_, &ClipBar::changed, this, &MainWindow::update_options);
    connect(worst_table_, &WorstTable::element_chosen, this,
            [this](Index element) { select_elements({element}, true); });
    connect(worst_table_, &WorstTable::count_changed, this, [this](int count) {
        if (count == preferences_.worst_count) return;
        preferences_ = Preferences::load();
        preferences_.worst_count = count;
        preferences_.store();
        if (actions_[CommandId::worst_only]->isChecked()) update_options();
    });
    connect(quality_panel_, &QualityPanel::elements_chosen, this,
            [this](const std::vector<Index>& elements) { select_elements(elements, false); });
    connect(quality_panel_, &QualityPanel::export_requested, actions_[CommandId::export_quality], &QAction::trigger);
    connect(actions_[CommandId::export_quality], &QAction::triggered, this, &MainWindow::ask_export_quality);
    connect(mesh_panel_, &MeshPanel::elements_chosen, this,
            [this](const std::vector<Index>& elements) { select_elements(elements, false); });
    connect(mesh_panel_, &MeshPanel::nodes_chosen, &edit_, &EditState::select_nodes);
    connect(view_, &MeshView::element_clicked, this, &MainWindow::tell_element);
}

void MainWindow::show_opened() {
    saved_format_.reset();
    sample_note_->hide();
    const bool has_mesh = document_.has_mesh();
    center_->setCurrentWidget(has_mesh ? view_page_ : static_cast<QWidget*>(start_page_));
    for (QDockWidget* dock : {left_dock_, right_dock_, bottom_dock_}) {
        // Without a mesh the panels have nothing to say; a panel that the user has closed stays closed.
        dock->setVisible(has_mesh && !dock->property("closed_by_user").toBool());
        dock->toggleViewAction()->setEnabled(has_mesh);
    }
    choose_tool_for_mesh();
    update_tool();
    statusBar()->clearMessage();
    if (has_mesh) view_->setFocus();
    update_title();
    update_options();
}

void MainWindow::show_state() {
    const MeshState& state = document_.state();
    view_->show_state(state);
    view_->set_highlighted_elements(edit_.elements());
    if (actions_[CommandId::worst_only]->isChecked()) update_options();
    show_before();
    verdict_->clear();
    if (state.mesh && !state.quality) {
        verdict_->setText(tr("quality unknown"));
        set_tone(verdict_, "warning");
    } else if (state.quality) {
        show_global();
    }
    if (Tool* tool = current_tool()) tool->refresh();
    update_commands();
}

void MainWindow::update_title() {
    setWindowTitle(document_.has_mesh() ? tr("%1[*] – Curvewright").arg(document_.file_name()) : tr("Curvewright"));
    setWindowModified(document_.is_dirty());
}

void MainWindow::update_commands() {
    const bool is_idle = !jobs_.runner().is_running() && !drag_.is_active(), has_mesh = document_.has_mesh();
    for (const CommandId id : {CommandId::open, CommandId::load_deformation, CommandId::open_session})
        actions_[id]->setEnabled(is_idle);
    actions_[CommandId::load_deformation]->setEnabled(is_idle && has_mesh);
    for (const CommandId id : {CommandId::save, CommandId::save_as, CommandId::export_mesh, CommandId::save_session,
                               CommandId::copy_command, CommandId::close_mesh})
        actions_[id]->setEnabled(is_idle && has_mesh);
    for (const CommandId id :
         {CommandId::save_picture, CommandId::fit, CommandId::edges, CommandId::nodes, CommandId::legend,
          CommandId::colors, CommandId::shrink, CommandId::compare, CommandId::zoom_in, CommandId::zoom_out,
          CommandId::panel_mesh, CommandId::panel_operations, CommandId::panel_quality, CommandId::find})
        actions_[id]->setEnabled(has_mesh);
    for (const CommandId id : {CommandId::node_numbers, CommandId::element_numbers}) actions_[id]->setEnabled(has_mesh);
    const bool is_3d = has_mesh && document_.state().mesh->topology().dimension() == 3;
    for (const auto& entry : look_commands)
        if (entry.command != CommandId::fit) actions_[entry.command]->setEnabled(is_3d);
    actions_[CommandId::clip]->setEnabled(is_3d);
    actions_[CommandId::orthographic]->setEnabled(is_3d);
    for (const CommandId id : {CommandId::worst_only, CommandId::export_quality})
        actions_[id]->setEnabled(has_mesh && document_.state().quality);
    actions_[CommandId::bookmark_add]->setEnabled(has_mesh);
    actions_[CommandId::export_film]->setEnabled(is_idle && has_mesh &&
                                                 (document_.history()->index() > 0 || player_.is_open()));
    actions_[CommandId::report]->setEnabled(is_idle && last_untangling(document_));
    actions_[CommandId::undo]->setEnabled(is_idle && document_.history()->canUndo());
    actions_[CommandId::redo]->setEnabled(is_idle && document_.history()->canRedo());
    actions_[CommandId::deform]->setEnabled(is_idle && deform_panel_->why_not().isEmpty());
    actions_[CommandId::warp]->setEnabled(is_idle && warp_panel_->why_not().isEmpty());
    actions_[CommandId::untangle]->setEnabled(is_idle && untangle_panel_->why_not().isEmpty());
    actions_[CommandId::improve]->setEnabled(is_idle && improve_panel_->why_not().isEmpty());
    for (const CommandId id : {CommandId::flip, CommandId::renumber})
        actions_[id]->setEnabled(is_idle && has_mesh && document_.state().quality);
    actions_[CommandId::timeline_show]->setEnabled(is_idle && step_to_record() >= 0);
    actions_[CommandId::timeline_open]->setEnabled(is_idle && has_mesh && document_.state().quality);
    actions_[CommandId::timeline_save]->setEnabled(is_idle && player_.is_open());
    actions_[CommandId::timeline_close]->setEnabled(player_.is_open());
    actions_[CommandId::stop]->setEnabled(jobs_.runner().is_running());
    for (const auto& [id, tool] : tools_) actions_[id]->setEnabled(has_mesh);
    actions_[CommandId::soft]->setEnabled(has_mesh);
    const bool has_nodes = has_mesh && !edit_.nodes().empty(), has_elements = has_mesh && !edit_.elements().empty();
    for (const CommandId id : {CommandId::select_all, CommandId::select_invert}) actions_[id]->setEnabled(has_mesh);
    for (const CommandId id :
         {CommandId::select_none, CommandId::select_grow, CommandId::select_shrink, CommandId::fit_selection})
        actions_[id]->setEnabled(has_nodes || has_elements);
    for (const CommandId id : {CommandId::select_side, CommandId::select_boundary, CommandId::pin_selection})
        actions_[id]->setEnabled(has_nodes);
    actions_[CommandId::select_feature]->setEnabled(has_nodes && is_3d);
    actions_[CommandId::select_tangled]->setEnabled(has_mesh && document_.state().quality);
    actions_[CommandId::unpin_all]->setEnabled(!edit_.pins().empty());
    mesh_panel_->set_history_enabled(is_idle);

    const auto step_tip = [this](CommandId id, const QString& step) {
        const auto found = std::find_if(commands().begin(), commands().end(),
                                        [&](const Command& command) { return command.id == id; });
        const QString name = plain_text(*found);
        actions_[id]->setToolTip(tool_tip(*found, actions_[id]->shortcut().toString(QKeySequence::NativeText),
                                          step.isEmpty() ? name : tr("%1: %2").arg(name, step)));
    };
    step_tip(CommandId::undo, document_.history()->undoText());
    step_tip(CommandId::redo, document_.history()->redoText());
}

void MainWindow::update_options() {
    const bool is_3d = document_.has_mesh() && document_.state().mesh->topology().dimension() == 3;
    const bool is_clipped = is_3d && actions_[CommandId::clip]->isChecked();
    SceneOptions options = view_->options();
    options.show_edges = actions_[CommandId::edges]->isChecked();
    options.show_nodes = actions_[CommandId::nodes]->isChecked();
    options.show_legend = actions_[CommandId::legend]->isChecked();
    options.show_node_numbers = actions_[CommandId::node_numbers]->isChecked();
    options.show_element_numbers = actions_[CommandId::element_numbers]->isChecked();
    options.is_orthographic = actions_[CommandId::orthographic]->isChecked();
    static const TextFont font = find_text_font();
    options.font = font;
    options.background = to_color(theme_.color(QStringLiteral("view")));
    options.foreground = to_color(theme_.color(QStringLiteral("text")));
    options.edge_color = to_color(theme_.color(QStringLiteral("view_edge")));
    options.element_size = actions_[CommandId::shrink]->isChecked() ? 0.8 : 1.0;
    options.only_elements.reset();
    const auto& quality = document_.state().quality;
    if (quality && actions_[CommandId::worst_only]->isChecked())
        options.only_elements = quality->worst(static_cast<std::size_t>(preferences_.worst_count));
    options.clip.reset();
    if (is_clipped) {
        const ClipSetting setting = clip_bar_->setting();
        ClipPlane plane;
        plane.normal = {0.0, 0.0, 0.0};
        plane.normal[static_cast<std::size_t>(setting.axis)] = setting.is_flipped ? -1.0 : 1.0;
        plane.position = setting.is_flipped ? 1.0 - setting.position : setting.position;
        plane.style = setting.is_through ? ClipStyle::cut : ClipStyle::whole_elements;
        options.clip = plane;
    }
    view_->set_options(options);
    SceneOptions before_options = options;
    before_options.show_legend = false;
    before_view_->set_options(before_options);
    clip_bar_->setVisible(is_clipped);
    place_bars();
}

void MainWindow::select_elements(const std::vector<Index>& elements, bool fly) {
    IndexSet set = elements;
    std::sort(set.begin(), set.end());
    edit_.select_elements(set);
    if (elements.size() == 1) {
        if (fly) {
            uncover(elements.front());
            view_->fly_to(elements.front());
        }
        tell_element(elements.front());
        return;
    }
    statusBar()->showMessage(elements.empty() ? tr("No elements there.")
                                              : tr("%1 elements are outlined; click into the empty view to clear.")
                                                    .arg(format_count(static_cast<long long>(elements.size()))),
                             8000);
}

void MainWindow::uncover(Index element) {
    if (!view_->options().clip || view_->draws_element(element)) return;
    const CurvedMesh& mesh = *document_.state().mesh;
    const auto box = bounding_box(mesh);
    const int axis = clip_bar_->setting().axis;
    const double extent = box(1, axis) - box(0, axis);
    if (extent > 0.0) clip_bar_->show_layer((mesh.element_center(element)[axis] - box(0, axis)) / extent);
    view_->finish_preparing();
    if (!view_->draws_element(element)) actions_[CommandId::clip]->setChecked(false);
}

void MainWindow::tell_element(std::optional<Index> element) {
    const MeshState& state = document_.state();
    if (!element || !state.mesh) {
        edit_.select({}, {});
        statusBar()->clearMessage();
        return;
    }
    edit_.select_elements({*element});
    const MeshTopology& topology = state.mesh->topology();
    const Eigen::RowVector3d center = state.mesh->element_center(*element);
    QString text = tr("Element %1, %2, centre (%3, %4, %5)")
                       .arg(topology.element_tag(*element).value)
                       .arg(type_name(topology.element_type(*element)), format_component(center.x(), center.norm()),
                            format_component(center.y(), center.norm()), format_component(center.z(), center.norm()));
    if (state.quality) {
        const ElementQuality& quality = state.quality->elements[static_cast<std::size_t>(*element)];
        const QString validity = quality.validity == Validity::valid     ? tr("proved valid")
                                 : quality.validity == Validity::invalid ? tr("tangled")
                                                                         : tr("undecided");
        if (quality.validity == Validity::not_assessed)
            text += tr(": a pyramid, not assessed");
        else
            text += tr(": scaled Jacobian %1, %2").arg(format_number(quality.scaled_jacobian), validity);
    }
    statusBar()->showMessage(text);
}

void MainWindow::show_tab(const QString& name) {
    for (int i = 0; i < tabs_->count(); ++i)
        if (tabs_->widget(i)->objectName() == name + QLatin1String("_tab")) tabs_->setCurrentIndex(i);
}

bool MainWindow::eventFilter(QObject* watched, QEvent* event) {
    if ((watched == view_ || watched == before_view_) && event->type() == QEvent::Resize) place_bars();
    return QMainWindow::eventFilter(watched, event);
}

}  // namespace curvewright
