#include <QAction>
#include <QActionGroup>
#include <QDockWidget>
#include <QFileInfo>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QScreen>
#include <QScrollArea>
#include <QSettings>
#include <QSplitter>
#include <QStackedWidget>
#include <QStatusBar>
#include <QTabBar>
#include <QTabWidget>
#include <QToolBar>
#include <QToolButton>
#include <QVBoxLayout>

#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/panels/banner.h"
#include "ui/panels/clip_bar.h"
#include "ui/panels/color_bar.h"
#include "ui/panels/edit_panel.h"
#include "ui/panels/improve_panel.h"
#include "ui/panels/job_bar.h"
#include "ui/panels/log_panel.h"
#include "ui/panels/mesh_panel.h"
#include "ui/panels/operation_panels.h"
#include "ui/panels/quality_panel.h"
#include "ui/panels/sample_note.h"
#include "ui/panels/selection_panel.h"
#include "ui/panels/start_page.h"
#include "ui/panels/step_panel.h"
#include "ui/panels/timeline_panel.h"
#include "ui/panels/untangle_panel.h"
#include "ui/panels/widgets.h"
#include "ui/panels/worst_table.h"

namespace curvewright {
namespace {

constexpr int layout_version = 1;
const QList<int> right_sizes{420, 236};  ///< tabs, worst elements

/// A panel that scrolls when it is higher than its dock.
QScrollArea* scrolling(QWidget* panel) {
    auto* area = new QScrollArea;
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setFocusPolicy(Qt::NoFocus);  // Tab goes to the fields
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setWidget(panel);
    return area;
}

}  // namespace

void MainWindow::build_menus() {
    std::map<CommandMenu, QMenu*> menus;
    menus[CommandMenu::file] = menuBar()->addMenu(tr("&File"));
    menus[CommandMenu::edit] = menuBar()->addMenu(tr("&Edit"));
    menus[CommandMenu::view] = menuBar()->addMenu(tr("&View"));
    menus[CommandMenu::select] = menuBar()->addMenu(tr("&Select"));
    menus[CommandMenu::mesh] = menuBar()->addMenu(tr("&Mesh"));
    menus[CommandMenu::help] = menuBar()->addMenu(tr("&Help"));
    menus[CommandMenu::look] = new QMenu(tr("Look &from"), this);
    menus[CommandMenu::bookmarks] = bookmarks_menu_ = new QMenu(tr("&Bookmarks"), this);
    menus[CommandMenu::theme] = new QMenu(tr("&Theme"), this);
    recent_menu_ = new QMenu(tr("Open &recent"), this);
    samples_menu_ = new QMenu(tr("Sa&mples"), this);
    panels_menu_ = new QMenu(tr("&Panels"), this);
    menus[CommandMenu::panels] = panels_menu_;

    for (const Command& command : commands()) {
        QMenu* menu = menus.at(command.menu);
        if (command.starts_section) menu->addSeparator();
        if (command.id == CommandId::reset_layout) {
            menu->addMenu(menus.at(CommandMenu::theme));
            menu->addMenu(panels_menu_);
        }
        menu->addAction(actions_[command.id]);
        if (command.id == CommandId::open) {
            menu->addMenu(recent_menu_);
            menu->addMenu(samples_menu_);
        }
        if (command.id == CommandId::fit) menu->addMenu(menus.at(CommandMenu::look));
        if (command.id == CommandId::fit_selection) menu->addMenu(bookmarks_menu_);
    }
    bookmarks_menu_->addSeparator();
    auto* themes = new QActionGroup(this);
    for (const CommandId id : {CommandId::theme_system, CommandId::theme_light, CommandId::theme_dark})
        themes->addAction(actions_[id]);
    connect(recent_menu_, &QMenu::aboutToShow, this, &MainWindow::fill_recent_menu);
    fill_samples_menu();
}

void MainWindow::fill_recent_menu() {
    recent_menu_->clear();
    for (const QString& path : recent_.paths())
        recent_menu_->addAction(QFileInfo(path).fileName(), this, [this, path] { open_file(path); })->setToolTip(path);
    recent_menu_->setToolTipsVisible(true);
    if (recent_menu_->isEmpty()) {
        recent_menu_->addAction(tr("No files yet"))->setEnabled(false);
        return;
    }
    recent_menu_->addSeparator();
    recent_menu_->addAction(tr("Clear the list"), &recent_, &RecentFiles::clear);
}

void MainWindow::fill_samples_menu() {
    for (const int chapter : samples_.chapters()) {
        QMenu* menu = samples_menu_->addMenu(chapter_title(chapter));
        for (const Sample& sample : samples_.of_chapter(chapter)) {
            QString text = sample.title;
            text.replace(QLatin1Char('&'), QStringLiteral("&&"));
            // Where shortcuts stand in other menus.
            if (!sample.figures.isEmpty()) text += QLatin1Char('\t') + sample.figures_text();
            QAction* action = menu->addAction(text, this, [this, sample] { open_sample(sample); });
            action->setObjectName(QStringLiteral("sample_") + sample.name);
            action->setStatusTip(sample.description);
        }
    }
    if (samples_menu_->isEmpty()) samples_menu_->addAction(samples_.error())->setEnabled(false);
}

void MainWindow::build_tool_bar() {
    QToolBar* bar = addToolBar(tr("Tools"));
    bar->setObjectName(QStringLiteral("tool_bar"));
    bar->setMovable(false);
    bar->setIconSize({20, 20});
    bar->setContextMenuPolicy(Qt::PreventContextMenu);
    for (int group = 1; group <= 5; ++group) {
        if (group > 1) bar->addSeparator();
        for (const Command& command : commands()) {
            if (command.tool_group != group) continue;
            bar->addAction(actions_[command.id]);
            auto* button = static_cast<QToolButton*>(bar->widgetForAction(actions_[command.id]));
            button->setObjectName(QStringLiteral("tool_") + QLatin1String(command.name));
            if (command.has_tool_text) button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        }
    }
}

void MainWindow::build_center() {
    start_page_ = new StartPage(samples_, recent_, theme_);
    view_ = new MeshView;
    banner_ = new Banner(theme_);
    sample_note_ = new SampleNote(theme_);
    view_page_ = new QWidget;
    auto* layout = new QVBoxLayout(view_page_);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(0);
    layout->addWidget(banner_);
    layout->addWidget(sample_note_);
    before_view_ = new MeshView(nullptr, QStringLiteral("before_view"));
    auto* views = new QSplitter(Qt::Horizontal);
    views->setObjectName(QStringLiteral("views"));
    views->setChildrenCollapsible(false);
    views->addWidget(before_view_);
    views->addWidget(view_);
    before_view_->hide();
    layout->addWidget(views, 1);
    for (const auto& [view, text] : {std::pair(before_view_, tr("Before")), std::pair(view_, tr("Now"))}) {
        QLabel* name = make_label(text, "title");
        name->setParent(view);
        name->setObjectName(QStringLiteral("view_name"));
        name->setAttribute(Qt::WA_TransparentForMouseEvents);
        name->move(12, 12);
        name->hide();
    }
    clip_bar_ = new ClipBar(theme_, view_);
    clip_bar_->hide();
    color_bar_ = new ColorBar(document_, theme_, view_);
    color_bar_->hide();
    for (MeshView* view : {view_, before_view_}) view->installEventFilter(this);

    center_ = new QStackedWidget;
    center_->addWidget(start_page_);
    center_->addWidget(view_page_);
    setCentralWidget(center_);
    setAcceptDrops(true);
}

QDockWidget* MainWindow::add_dock(const QString& name, const QString& title, Qt::DockWidgetArea area,
                                  QWidget* content) {
    auto* dock = new QDockWidget(title, this);
    dock->setObjectName(name);
    dock->setWidget(content);
    dock->setFeatures(QDockWidget::DockWidgetClosable | QDockWidget::DockWidgetMovable);
    addDockWidget(area, dock);
    dock->setProperty("closed_by_user", QSettings().value(QStringLiteral("window/closed_") + name, false));
    connect(dock->toggleViewAction(), &QAction::triggered, dock,
            [dock](bool is_shown) { dock->setProperty("closed_by_user", !is_shown); });
    return dock;
}

void MainWindow::build_docks() {
    mesh_panel_ = new MeshPanel(document_);
    edit_panel_ = new EditPanel(edit_, drag_);
    selection_panel_ = new SelectionPanel(edit_, theme_);
    deform_panel_ = new DeformPanel(jobs_);
    warp_panel_ = new WarpPanel(jobs_);
    untangle_panel_ = new UntanglePanel(jobs_);
    improve_panel_ = new ImprovePanel(jobs_);
    auto* untangle_tab = new QWidget;
    auto* of_tab = new QVBoxLayout(untangle_tab);
    of_tab->setContentsMargins(0, 0, 0, 0);
    of_tab->setSpacing(0);
    of_tab->addWidget(untangle_panel_);
    of_tab->addWidget(improve_panel_, 1);
    worst_table_ = new WorstTable(document_, theme_);
    quality_panel_ = new QualityPanel(document_, theme_);
    timeline_panel_ = new TimelinePanel(player_, edit_, theme_);
    step_panel_ = new StepPanel(theme_);
    log_panel_ = new LogPanel(log_, theme_);

    tabs_ = new QTabWidget;
    tabs_->setObjectName(QStringLiteral("operations_tabs"));
    tabs_->setDocumentMode(true);
    tabs_->tabBar()->setExpanding(true);
    tabs_->tabBar()->setDrawBase(false);
    const struct {
        QWidget* panel;
        const char* name;
        QString title;
    } tabs[] = {{edit_panel_, "edit_tab", tr("Edit")},          {selection_panel_, "inspect_tab", tr("Inspect")},
                {deform_panel_, "deform_tab", tr("Deform")},    {warp_panel_, "warp_tab", tr("Warp")},
                {untangle_tab, "untangle_tab", tr("Untangle")}, {step_panel_, "step_tab", tr("Step")}};
    for (const auto& tab : tabs) {
        QScrollArea* area = scrolling(tab.panel);
        area->setObjectName(QLatin1String(tab.name));
        tabs_->addTab(area, tab.title);
    }
    tabs_->setTabVisible(tabs_->count() - 1, false);  // until there is a timeline
    auto* right = new QSplitter(Qt::Vertical);
    right->setObjectName(QStringLiteral("right_splitter"));
    right->addWidget(tabs_);
    right->addWidget(worst_table_);
    right->setStretchFactor(0, 0);
    right->setStretchFactor(1, 1);
    right->setSizes(right_sizes);
    right->setChildrenCollapsible(false);
    right_splitter_ = right;

    left_dock_ = add_dock(QStringLiteral("mesh_dock"), tr("Mesh"), Qt::LeftDockWidgetArea, mesh_panel_);
    right_dock_ = add_dock(QStringLiteral("operations_dock"), tr("Operations"), Qt::RightDockWidgetArea, right);
    bottom_dock_ =
        add_dock(QStringLiteral("quality_dock"), tr("Scaled Jacobian"), Qt::BottomDockWidgetArea, quality_panel_);
    timeline_dock_ =
        add_dock(QStringLiteral("timeline_dock"), tr("Timeline"), Qt::BottomDockWidgetArea, timeline_panel_);
    log_dock_ = add_dock(QStringLiteral("log_dock"), tr("Messages"), Qt::BottomDockWidgetArea, log_panel_);
    setTabPosition(Qt::BottomDockWidgetArea, QTabWidget::North);
    tabifyDockWidget(bottom_dock_, timeline_dock_);
    tabifyDockWidget(bottom_dock_, log_dock_);
    setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
    // The tabs and the headings say what these two are.
    right_dock_->setTitleBarWidget(new QWidget);
    bottom_dock_->setTitleBarWidget(new QWidget);
    timeline_dock_->setTitleBarWidget(new QWidget);
    left_dock_->setTitleBarWidget(new QWidget);
    log_dock_->setTitleBarWidget(new QWidget);
    resizeDocks({left_dock_, right_dock_}, {240, 288}, Qt::Horizontal);
    resizeDocks({bottom_dock_}, {176}, Qt::Vertical);
    // Until there is a recording.
    timeline_dock_->hide();
    timeline_dock_->toggleViewAction()->setEnabled(false);
    // Until somebody asks for it.
    log_dock_->hide();
}

void MainWindow::build_status_bar() {
    hint_ = make_label(QString(), "");
    hint_->setObjectName(QStringLiteral("hint"));
    hint_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    hint_->setContentsMargins(8, 0, 0, 0);
    verdict_ = make_label(QString(), "");
    verdict_->setObjectName(QStringLiteral("verdict"));
    verdict_->setContentsMargins(8, 0, 8, 0);
    statusBar()->addWidget(hint_, 1);
    statusBar()->addPermanentWidget(new JobBar(jobs_.runner()));
    statusBar()->addPermanentWidget(verdict_);
    statusBar()->setSizeGripEnabled(false);
}

void MainWindow::restore_layout() {
    first_layout_ = saveState(layout_version);
    const QSettings settings;
    const Preferences preferences = Preferences::load();
    // No larger than the screen, with room for the frame that the window manager will add.
    const QRect available = screen()->availableGeometry();
    constexpr int frame_width = 8, frame_height = 40;
    resize(qMin(1280, available.width() - frame_width), qMin(800, available.height() - frame_height));
    restoreGeometry(settings.value(QStringLiteral("window/geometry")).toByteArray());
    restoreState(settings.value(QStringLiteral("window/state")).toByteArray(), layout_version);
    timeline_dock_->hide();
    const struct {
        CommandId id;
        bool is_on;
    } defaults[] = {{CommandId::edges, preferences.starts_with_edges},
                    {CommandId::nodes, preferences.starts_with_nodes},
                    {CommandId::legend, preferences.starts_with_legend},
                    {CommandId::orthographic, false}};
    for (const auto& entry : defaults) {
        const QVariant left = settings.value(QStringLiteral("view/") + actions_[entry.id]->objectName());
        actions_[entry.id]->setChecked(preferences.remembers_drawing && left.isValid() ? left.toBool() : entry.is_on);
    }
    right_splitter_->restoreState(settings.value(QStringLiteral("window/right_splitter")).toByteArray());
    show_tab(settings.value(QStringLiteral("window/tab")).toString());
}

void MainWindow::save_layout() const {
    QSettings settings;
    settings.setValue(QStringLiteral("window/geometry"), saveGeometry());
    settings.setValue(QStringLiteral("window/state"), saveState(layout_version));
    for (const QDockWidget* dock : {left_dock_, right_dock_, bottom_dock_})
        settings.setValue(QStringLiteral("window/closed_") + dock->objectName(), dock->property("closed_by_user"));
    settings.setValue(QStringLiteral("window/right_splitter"), right_splitter_->saveState());
    settings.setValue(QStringLiteral("window/tab"), tabs_->currentWidget()->objectName().chopped(4));
    for (const CommandId id : {CommandId::edges, CommandId::nodes, CommandId::legend, CommandId::orthographic})
        settings.setValue(QStringLiteral("view/") + actions_[id]->objectName(), actions_[id]->isChecked());
}

void MainWindow::reset_layout() {
    restoreState(first_layout_, layout_version);
    log_dock_->hide();
    timeline_dock_->setVisible(player_.is_open());
    for (QDockWidget* dock : {left_dock_, right_dock_, bottom_dock_}) {
        dock->setProperty("closed_by_user", false);
        dock->setVisible(document_.has_mesh());
    }
    resizeDocks({left_dock_, right_dock_}, {240, 288}, Qt::Horizontal);
    resizeDocks({bottom_dock_}, {176}, Qt::Vertical);
    right_splitter_->setSizes(right_sizes);
    static_cast<QSplitter*>(view_->parentWidget())->setSizes({1000, 1000});
    tabs_->setCurrentIndex(0);
}

}  // namespace curvewright
