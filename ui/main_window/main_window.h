#pragma once

#include <functional>
#include <map>
#include <optional>

#include <QMainWindow>
#include <QTimer>

#include "ui/document/edit_state.h"
#include "ui/document/journal.h"
#include "ui/document/mesh_document.h"
#include "ui/document/message_log.h"
#include "ui/document/notice_board.h"
#include "ui/document/preferences.h"
#include "ui/document/recent_files.h"
#include "ui/document/sample_catalog.h"
#include "ui/document/view_bookmarks.h"
#include "ui/jobs/element_numbers.h"
#include "ui/jobs/global_check.h"
#include "ui/jobs/live_drag.h"
#include "ui/jobs/mesh_jobs.h"
#include "ui/jobs/step_player.h"
#include "ui/main_window/commands.h"
#include "ui/main_window/dialogs.h"
#include "ui/panels/theme.h"
#include "ui/scene/mesh_scene.h"

class QDockWidget;
class QLabel;
class QMenu;
class QSplitter;
class QStackedWidget;
class QTabWidget;

namespace curvewright {

class Banner;
class SampleNote;
class ClipBar;
class ColorBar;
class DeformPanel;
class EditPanel;
class ImprovePanel;
class LogPanel;
class MeshPanel;
class MeshView;
class Nudge;
class PointerTag;
class QualityPanel;
class SelectionPanel;
class StartPage;
class StepPanel;
class StepTool;
class TimelinePanel;
class Tool;
class UntanglePanel;
class WarpPanel;
class WorstTable;

/// The window: puts document, jobs, panels and view together, and nothing else.
class MainWindow : public QMainWindow {
    Q_OBJECT

  public:
    explicit MainWindow(Theme& theme, Dialogs dialogs = Dialogs::standard());
    ~MainWindow() override;

    MeshDocument& document() { return document_; }
    MeshJobs& jobs() { return jobs_; }
    EditState& edit() { return edit_; }
    GlobalCheck& global_check() { return global_check_; }
    LiveDrag& drag() { return drag_; }
    StepPlayer& player() { return player_; }
    MeshView& view() { return *view_; }
    NoticeBoard& notices() { return notices_; }
    MessageLog& log() { return log_; }
    QAction* action(CommandId id) const { return actions_[id]; }

    /// Opens a mesh, as File > Open does; asks first if the open one has unsaved changes. A .json or .csv file is
    /// loaded as a deformation of the open mesh, unless it is a session: that is done again. apply: also apply the
    /// deformation to the boundary.
    void open_file(const QString& path, const QString& deformation_path = {}, bool apply = false);
    void open_sample(const Sample& sample);
    const SampleCatalog& samples() const { return samples_; }
    /// Brings up a tab of the right panel: "edit", "inspect", "deform", "warp" or "untangle".
    void show_tab(const QString& name);

  protected:
    void closeEvent(QCloseEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dragLeaveEvent(QDragLeaveEvent* event) override;
    void dropEvent(QDropEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    // main_window_layout.cpp
    void build_menus();
    void build_tool_bar();
    void build_center();
    void build_docks();
    void build_status_bar();
    QDockWidget* add_dock(const QString& name, const QString& title, Qt::DockWidgetArea area, QWidget* content);
    void fill_recent_menu();
    void fill_samples_menu();
    /// Sets the method and its parameters as the thesis has them for a sample.
    void prepare_method(const Sample& sample);
    void restore_layout();
    void save_layout() const;
    void reset_layout();

    // main_window.cpp
    void connect_commands();
    void connect_document();
    void connect_panels();
    void show_opened();
    void show_state();
    void update_title();
    void update_commands();
    void update_options();
    void choose_theme(Theme::Choice choice);
    void select_elements(const std::vector<Index>& elements, bool fly);
    /// Moves the clip plane, or takes it away, if it keeps the element out of sight.
    void uncover(Index element);
    void tell_element(std::optional<Index> element);

    // main_window_editing.cpp
    void build_tools();
    void connect_editing();
    void connect_selection();
    void fit_selection();
    /// The tool that the view is to have now; null = the camera alone.
    Tool* current_tool() const;
    QString tool_setting() const;
    void choose_tool_for_mesh();
    void update_tool();
    void update_hint();
    void show_frame(const Coordinates& positions, const QualityReport* quality);
    void show_verdict(const QualitySummary& summary);
    /// The view of the state before the last step, if it is wanted.
    void show_before();
    /// Makes room for it, or takes the room back.
    void split_view(bool is_split);

    // main_window_colors.cpp
    void connect_colors();
    /// The user has chosen other colours.
    void update_coloring();
    /// The mesh is in another state.
    void follow_coloring();
    void show_coloring();
    /// The bars over the view, below each other.
    void place_bars();
    // main_window_keyboard.cpp
    void connect_keyboard();
    /// Moves the keyboard to the next (1) or the previous (-1) of the view and the panels.
    void go_to_area(int step);
    void show_found();
    void apply_preferences();

    // main_window_session.cpp
    /// If the preferences say so and nothing else is open or being opened.
    void open_last_mesh();
    void connect_session();
    void offer_lost_work();
    void recover(const LostWork& lost);
    void open_session(const QString& path);
    void ask_open_session();

    // main_window_timeline.cpp
    void connect_timeline();
    int step_to_record() const;
    void record_again();
    void ask_open_trace();
    void ask_save_trace();
    void open_timeline(const RecordedRun& run);
    void close_timeline();
    /// The step that the timeline has stopped at, as well as any mesh is drawn.
    void show_settled();
    /// The step that is shown, in words and pictures.
    void explain_step();
    /// The patch fills the view.
    void look_at_patch();
    /// The elements of the patch that the timeline is in stand out.
    void show_patch();

    // main_window_views.cpp
    void connect_views();
    void fill_bookmarks_menu();
    void add_bookmark();
    void go_to_bookmark(int number);
    void ask_export_film();
    void ask_export_quality();

    // main_window_notices.cpp
    void connect_notices();
    /// Shows a notice over the view until it is dismissed, and logs it.
    void receive(const Notice& notice);
    void show_notices();
    /// Whether the mesh is valid as a whole, in the panel and in the status bar.
    void show_global();
    /// The button of a notice was pressed.
    void act_on(int notice, int action);
    /// Selects what an entry of the log speaks of, if the mesh is still that one.
    void show_logged(const LogEntry& entry);
    /// What a job or a command has to say of its end: in the status bar for a while, and in the log.
    void tell(const QString& text, int milliseconds = 12000);
    /// What is told now belongs to this: the last step that was done, or the mesh as opened.
    QString present_step() const;

    // main_window_report.cpp
    void connect_report();
    void ask_report();

    // main_window_files.cpp
    void ask_open();
    void ask_load_deformation();
    void load_deformation(const QString& path);
    void save(bool ask_for_name);
    void ask_export();
    void ask_save_picture();
    bool is_busy();
    /// Runs next now, or after the user has saved the changes or given them up; not at all if the user cancels.
    void when_settled(std::function<void()> next);
    QString suggested_path(const QString& suffix) const;
    /// Where file dialogs begin.
    static QString last_folder();
    static void remember_folder(const QString& path);

    Theme& theme_;
    Dialogs dialogs_;
    MeshDocument document_;
    MeshJobs jobs_;
    NoticeBoard notices_;
    MessageLog log_;
    GlobalCheck global_check_;
    EditState edit_;
    LiveDrag drag_;
    StepPlayer player_;
    QTimer settled_;
    ElementNumbers element_numbers_;
    RecentFiles recent_;
    SampleCatalog samples_;
    ViewBookmarks bookmarks_;
    std::unique_ptr<Journal> journal_;
    Preferences preferences_;
    CommandActions actions_;

    QStackedWidget* center_ = nullptr;
    StartPage* start_page_ = nullptr;
    QWidget* view_page_ = nullptr;
    Banner* banner_ = nullptr;
    SampleNote* sample_note_ = nullptr;
    MeshView* view_ = nullptr;
    MeshView* before_view_ = nullptr;  ///< beside view_, if the user wants to compare
    ClipBar* clip_bar_ = nullptr;
    ColorBar* color_bar_ = nullptr;
    PointerTag* pointer_tag_ = nullptr;
    Nudge* nudge_ = nullptr;
    std::map<CommandId, Tool*> tools_;
    EditPanel* edit_panel_ = nullptr;
    SelectionPanel* selection_panel_ = nullptr;
    MeshPanel* mesh_panel_ = nullptr;
    QTabWidget* tabs_ = nullptr;
    QSplitter* right_splitter_ = nullptr;
    DeformPanel* deform_panel_ = nullptr;
    WarpPanel* warp_panel_ = nullptr;
    UntanglePanel* untangle_panel_ = nullptr;
    ImprovePanel* improve_panel_ = nullptr;  ///< below it
    WorstTable* worst_table_ = nullptr;
    QualityPanel* quality_panel_ = nullptr;
    TimelinePanel* timeline_panel_ = nullptr;
    StepPanel* step_panel_ = nullptr;
    StepTool* step_tool_ = nullptr;  ///< in place of the others while a timeline is open
    LogPanel* log_panel_ = nullptr;
    QDockWidget *left_dock_ = nullptr, *right_dock_ = nullptr, *bottom_dock_ = nullptr, *timeline_dock_ = nullptr,
                *log_dock_ = nullptr;
    QLabel *hint_ = nullptr, *verdict_ = nullptr;
    QMenu *recent_menu_ = nullptr, *samples_menu_ = nullptr, *panels_menu_ = nullptr, *bookmarks_menu_ = nullptr;
    QList<QAction*> bookmark_actions_;

    /// What the colours show of the elements, if it is computed; null = not yet.
    std::shared_ptr<const FieldArray> numbers_now_, numbers_before_;

    UntangleOptions options_of_run_;  ///< that the timeline shows
    int tab_before_timeline_ = 0;
    QList<int> sizes_before_timeline_;  ///< of the right splitter
    std::optional<std::size_t> followed_patch_;

    std::function<void()> after_save_;
    std::optional<MeshFormat> saved_format_;    ///< of the file that Save may overwrite; none = Save asks for a name
    std::optional<MeshFormat> pending_format_;  ///< of the file that is being saved
    QByteArray first_layout_;
    bool is_drag_unprepared_ = false;  ///< the weights of the open mesh wait until it is seen
    bool is_closing_ = false;
};

}  // namespace curvewright
