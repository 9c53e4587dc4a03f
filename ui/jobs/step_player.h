#pragma once

#include <memory>
#include <optional>

#include <QElapsedTimer>
#include <QObject>
#include <QString>
#include <QTimer>

#include "core/timeline/recording.h"
#include "core/timeline/search.h"

namespace curvewright {

/// Walks through a recording: goes to steps on a thread of its own (of many requests the latest counts), and plays at
/// a speed. All members are for the window's thread; none of them takes long.
class StepPlayer : public QObject {
    Q_OBJECT

  public:
    /// A step as it was shown.
    struct Shown {
        StepNumber step = 0;
        Coordinates coordinates;
        QualityReport quality;
        bool has_quality = false;                         ///< false: the quality is that of an earlier step
        std::optional<untangle_event::PatchBegan> patch;  ///< that the step is in
    };

    static constexpr double min_speed = 0.5, max_speed = 200.0;

    explicit StepPlayer(QObject* parent = nullptr);
    ~StepPlayer() override;

    /// At its first step, without breakpoints. In place of the one that was open.
    void open(std::shared_ptr<const Recording> recording);
    void close();
    bool is_open() const { return recording_ != nullptr; }
    /// Null: none is open.
    const std::shared_ptr<const Recording>& recording() const { return recording_; }

    /// What was shown last; pre: is_open().
    const Shown& shown() const { return *shown_; }
    /// Where it is, or is about to be. pre: is_open().
    StepNumber step() const { return target_; }
    /// Whether a step is still on its way.
    bool is_seeking() const { return is_seeking_ || waiting_ != nullptr; }

    /// Pauses, and goes there; beyond the last step: to the last.
    void go_to(StepNumber step);
    /// By one step of the level, forward (1) or back (-1).
    void step_by(int direction);
    /// A level finer, and one step there; a level coarser, and to the end of it.
    void step_into();
    void step_out();

    StepLevel level() const { return level_; }
    void set_level(StepLevel level);
    /// Steps of the level per second.
    double speed() const { return speed_; }
    void set_speed(double speed);
    /// From the start again if it is at the end.
    void play();
    void pause();
    bool is_playing() const { return timer_.isActive(); }
    /// While true no frames are made: whoever shows them is still busy with the last one.
    void hold_frames(bool is_held);

    void set_breakpoints(const Breakpoints& breakpoints);
    const Breakpoints& breakpoints() const { return breakpoints_; }
    /// The steps where it stops, ascending; empty until they are found.
    const std::vector<StepNumber>& break_steps() const { return break_steps_; }

  signals:
    void opened_changed(bool is_open);
    /// What to show: positions, and the quality unless a later step is already asked for. Both live during the call.
    void frame(const Coordinates& positions, const QualityReport* quality);
    /// After the frame.
    void step_changed(StepNumber step);
    void level_changed(StepLevel level);
    void speed_changed(double speed);
    void playing_changed(bool is_playing);
    void breakpoints_changed();
    /// Playing has stopped there.
    void at_break(StepNumber step);
    void at_end();
    void failed(const QString& message);

  private:
    class Worker;

    void seek(StepNumber step);
    void receive(int generation, std::shared_ptr<const Shown> shown, const QString& problem);
    void receive_breaks(int search, std::vector<StepNumber> steps);
    void show_waiting();
    void tick();

    std::shared_ptr<const Recording> recording_;
    std::shared_ptr<const Shown> shown_;
    std::shared_ptr<const Shown> waiting_;  ///< for whoever shows it
    StepNumber target_ = 0;
    StepLevel level_ = StepLevel::patch;
    double speed_ = 8.0;
    Breakpoints breakpoints_;
    std::vector<StepNumber> break_steps_;
    bool is_held_ = false, is_seeking_ = false, is_searching_ = false;
    int generation_ = 0, search_ = 0;  ///< answers to older ones are dropped
    QTimer timer_;
    QElapsedTimer clock_;  ///< since the last step that was played
    double owed_ = 0.0;    ///< steps that the clock asks for
    std::unique_ptr<Worker> worker_;
};

}  // namespace curvewright
