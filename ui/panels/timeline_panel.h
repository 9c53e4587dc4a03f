#pragma once

#include <functional>

#include <QWidget>

#include "ui/document/edit_state.h"
#include "ui/jobs/step_player.h"
#include "ui/panels/theme.h"

class QAction;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QMenu;
class QToolButton;

namespace curvewright {

class TimelineTrack;

/// The player's buttons, what is seen, and the track.
class TimelinePanel : public QWidget {
    Q_OBJECT

  public:
    TimelinePanel(StepPlayer& player, EditState& edit, const Theme& theme, QWidget* parent = nullptr);

    /// Who asks for an element's tag; "" = given up.
    void set_question(std::function<QString(const QString& title, const QString& label)> ask) { ask_ = std::move(ask); }
    TimelineTrack& track() { return *track_; }
    /// "pass 2/3 · patch 14/61 · step 9/120".
    static QString place_text(const Recording& recording, StepNumber step);

  signals:
    void close_requested();
    /// Something to tell in a line.
    void told(const QString& text);

  protected:
    void keyPressEvent(QKeyEvent* event) override;

  private:
    QToolButton* add_button(const char* name, const QString& tip, const std::function<void()>& press);
    void make_transport();
    QMenu* make_jump_menu();
    QMenu* make_break_menu();
    void add_breakpoints(const IndexSet& elements, const IndexSet& nodes);
    void ask_element();
    void jump_to_validity(Index element);
    void show_icons();
    void show_step();
    void show_breakpoints();

    StepPlayer& player_;
    EditState& edit_;
    const Theme& theme_;
    TimelineTrack* track_ = nullptr;
    QList<QToolButton*> buttons_;
    QToolButton *play_ = nullptr, *breaks_ = nullptr, *jump_ = nullptr;
    QComboBox* level_ = nullptr;
    QDoubleSpinBox* speed_ = nullptr;
    QLabel *place_ = nullptr, *quality_ = nullptr;
    QAction* crossing_ = nullptr;
    std::function<QString(const QString&, const QString&)> ask_;
};

}  // namespace curvewright
