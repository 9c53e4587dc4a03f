// The window without a mouse: areas, finding by tags, nudging; and what the preferences change.

#include <algorithm>

#include <QAction>
#include <QDockWidget>
#include <QMenu>
#include <QMenuBar>
#include <QStackedWidget>
#include <QStatusBar>
#include <QTabBar>
#include <QTabWidget>

#include "ui/main_window/find_dialog.h"
#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/main_window/preferences_dialog.h"
#include "ui/main_window/shortcuts.h"
#include "ui/panels/banner.h"
#include "ui/panels/focus_frame.h"
#include "ui/panels/log_panel.h"
#include "ui/panels/mesh_panel.h"
#include "ui/panels/pointer_tag.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/start_page.h"
#include "ui/panels/timeline_panel.h"
#include "ui/panels/worst_table.h"
#include "ui/tools/nudge.h"

namespace curvewright {
namespace {

constexpr double zoom_step = 1.25;

MouseMap mouse_map(const Preferences& preferences) {
    constexpr auto turn = CameraMotion::turn, pan = CameraMotion::pan, zoom = CameraMotion::zoom;
    MouseMap map;
    switch (preferences.mouse) {
        case MouseHabits::curvewright:
            break;
        case MouseHabits::paraview:
            map.middle = {pan, turn, turn};
            map.right = {zoom, pan, zoom};
            break;
        case MouseHabits::gmsh:
            map.middle = {zoom, zoom, zoom};
            map.right = {pan, pan, pan};
            break;
        case MouseHabits::blender:
            map.middle = {turn, pan, zoom};
            break;
    }
    map.wheel_is_reversed = preferences.wheel_is_reversed;
    return map;
}

/// The first widget inside another one that takes the keyboard, in the order of Tab; null if there is none.
QWidget* first_field(QWidget* area) {
    QWidget* widget = area;
    do {
        const bool takes_keys = (widget->focusPolicy() & Qt::TabFocus) && widget->isVisible() && widget->isEnabled();
        if (takes_keys && (widget == area || area->isAncestorOf(widget))) return widget;
        widget = widget->nextInFocusChain();
    } while (widget != area);
    return nullptr;
}

}  // namespace

void MainWindow::connect_keyboard() {
    const auto on = [this](CommandId id, auto function) { connect(actions_[id], &QAction::triggered, this, function); };
    on(CommandId::zoom_in, [this] { view_->zoom(zoom_step); });
    on(CommandId::zoom_out, [this] { view_->zoom(1.0 / zoom_step); });
    on(CommandId::next_area, [this] { go_to_area(1); });
    on(CommandId::previous_area, [this] { go_to_area(-1); });
    on(CommandId::find, [this] {
        auto* dialog = new FindDialog(edit_, this);
        connect(dialog, &FindDialog::found, this, &MainWindow::show_found);
        dialog->open();
    });
    on(CommandId::preferences, [this] {
        auto* dialog = new PreferencesDialog(actions_, edit_, recent_, this);
        connect(dialog, &PreferencesDialog::changed, this, &MainWindow::apply_preferences);
        dialog->open();
    });
    const struct {
        CommandId id;
        QDockWidget* dock;
    } panels[] = {{CommandId::panel_mesh, left_dock_},
                  {CommandId::panel_operations, right_dock_},
                  {CommandId::panel_quality, bottom_dock_},
                  {CommandId::panel_log, log_dock_}};
    for (const auto& panel : panels) {
        QAction *command = actions_[panel.id], *toggle = panel.dock->toggleViewAction();
        command->setChecked(toggle->isChecked());
        connect(toggle, &QAction::toggled, command, &QAction::setChecked);
        on(panel.id, [toggle](bool is_shown) {
            if (toggle->isChecked() != is_shown) toggle->trigger();
        });
    }

    // Beside other docks it would come up behind them.
    on(CommandId::panel_log, [this](bool is_shown) {
        if (!is_shown) return;
        log_dock_->raise();
        for (QTabBar* bar : findChildren<QTabBar*>(QString(), Qt::FindDirectChildrenOnly)) bar->setDrawBase(false);
    });

    nudge_ = new Nudge({*view_, edit_, drag_}, view_, this);
    connect(nudge_, &Nudge::refused, this, [this](const QString& why) { statusBar()->showMessage(why, 6000); });
    connect(nudge_, &Nudge::moved_to, pointer_tag_, &PointerTag::follow);
    for (MeshView* view : {view_, before_view_}) new FocusFrame(view, theme_);

    connect(&actions_.shortcuts(), &Shortcuts::changed, this, &MainWindow::update_commands);
    QHash<QKeySequence, QString> menu_keys;
    for (const QAction* menu : menuBar()->actions()) {
        const QKeySequence key = QKeySequence::mnemonic(menu->text());
        if (!key.isEmpty()) menu_keys.insert(key, menu->text().remove(QLatin1Char('&')));
    }
    actions_.shortcuts().set_menu_keys(menu_keys);
    apply_preferences();
}

void MainWindow::go_to_area(int step) {
    std::vector<QWidget*> areas;
    QWidget* center = center_->currentWidget() == start_page_ ? static_cast<QWidget*>(start_page_) : view_;
    for (QWidget* area : std::initializer_list<QWidget*>{banner_, center, mesh_panel_, tabs_, worst_table_,
                                                         quality_panel_, timeline_panel_, log_panel_})
        if (area->isVisible()) areas.push_back(area);
    const QWidget* now = focusWidget();
    const auto here = std::find_if(areas.begin(), areas.end(), [&](const QWidget* area) {
        return now && (area == now || area->isAncestorOf(now));
    });
    const auto count = static_cast<std::ptrdiff_t>(areas.size());
    std::ptrdiff_t at = here == areas.end() ? (step > 0 ? -1 : 0) : here - areas.begin();
    for (std::ptrdiff_t tries = 0; tries < count; ++tries) {
        at = (at + step + count) % count;
        QWidget* area = areas[static_cast<std::size_t>(at)];
        QWidget* field = area == tabs_ ? static_cast<QWidget*>(tabs_->tabBar()) : first_field(area);
        if (!field) continue;
        field->setFocus(Qt::ShortcutFocusReason);
        return;
    }
}

void MainWindow::show_found() {
    show_tab(QStringLiteral("inspect"));
    const IndexSet &nodes = edit_.nodes(), &elements = edit_.elements();
    if (nodes.empty() && elements.size() == 1) {
        uncover(elements.front());
        view_->fly_to(elements.front());
    } else if (elements.empty() && nodes.size() == 1) {
        view_->fit_to(document_.state().mesh->coordinates().row(nodes.front()), 0.0);
    } else {
        fit_selection();
    }
    view_->setFocus();
}

void MainWindow::apply_preferences() {
    preferences_ = Preferences::load();
    const MouseMap map = mouse_map(preferences_);
    view_->set_mouse_map(map);
    before_view_->set_mouse_map(map);
    journal_->set_keeping(preferences_.keeps_work);
    worst_table_->set_count(preferences_.worst_count);
}

}  // namespace curvewright
