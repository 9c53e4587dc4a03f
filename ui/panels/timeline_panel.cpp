#include "ui/panels/timeline_panel.h"

#include <algorithm>

#include <QAction>
#include <QComboBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMenu>
#include <QSettings>
#include <QToolButton>
#include <QVBoxLayout>

#include "ui/document/number_format.h"
#include "ui/panels/form_fields.h"
#include "ui/panels/timeline_track.h"
#include "ui/panels/widgets.h"

namespace curvewright {

TimelinePanel::TimelinePanel(StepPlayer& player, EditState& edit, const Theme& theme, QWidget* parent)
    : QWidget(parent), player_(player), edit_(edit), theme_(theme) {
    setObjectName(QStringLiteral("timeline_panel"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(12, 6, 12, 6);
    layout->setSpacing(4);
    make_transport();

    track_ = new TimelineTrack(player, theme);
    layout->addWidget(track_, 1);
    setFocusProxy(track_);

    connect(&player, &StepPlayer::opened_changed, this, [this](bool is_open) {
        if (!is_open) return;
        show_breakpoints();
        track_->setFocus();
    });
    connect(&player, &StepPlayer::step_changed, this, &TimelinePanel::show_step);
    connect(&player, &StepPlayer::playing_changed, this, &TimelinePanel::show_icons);
    connect(&player, &StepPlayer::breakpoints_changed, this, &TimelinePanel::show_breakpoints);
    connect(&player, &StepPlayer::level_changed, this,
            [this](StepLevel level) { level_->setCurrentIndex(level_->findData(static_cast<int>(level))); });
    connect(&player, &StepPlayer::speed_changed, this, [this](double speed) { speed_->setValue(speed); });
    connect(&player, &StepPlayer::at_break, this, [this](StepNumber step) {
        emit told(tr("Stopped at a breakpoint, step %1.").arg(format_count(static_cast<long long>(step))));
    });
    connect(&theme, &Theme::changed, this, &TimelinePanel::show_icons);
    show_icons();
}

QToolButton* TimelinePanel::add_button(const char* name, const QString& tip, const std::function<void()>& press) {
    auto* button = new QToolButton;
    button->setObjectName(QStringLiteral("timeline_") + QLatin1String(name));
    button->setProperty("icon_name", QLatin1String(name));
    button->setToolTip(tip);
    button->setAccessibleName(tip);
    // A click leaves the keyboard with the track: Space plays, the arrows step.
    button->setFocusPolicy(Qt::TabFocus);
    connect(button, &QToolButton::clicked, this, press);
    buttons_ << button;
    return button;
}

void TimelinePanel::make_transport() {
    auto* line = new QHBoxLayout;
    line->setSpacing(2);
    const auto last = [this] { return player_.recording()->step_count() - 1; };
    line->addWidget(add_button("to_start", tr("To the start (Home)"), [this] { player_.go_to(0); }));
    line->addWidget(add_button("step_back", tr("A step back (left arrow)"), [this] { player_.step_by(-1); }));
    play_ = add_button("play", tr("Play or pause (Space)"), [this] {
        if (player_.is_playing())
            player_.pause();
        else
            player_.play();
    });
    line->addWidget(play_);
    line->addWidget(add_button("step_forward", tr("A step forward (right arrow)"), [this] { player_.step_by(1); }));
    line->addWidget(add_button("to_end", tr("To the end (End)"), [this, last] {
        if (player_.is_open()) player_.go_to(last());
    }));
    line->addSpacing(6);
    line->addWidget(add_button("step_into",
                               tr("Step into: from passes to patches, from patches to iterations (down arrow)"),
                               [this] { player_.step_into(); }));
    line->addWidget(add_button("step_out", tr("Step out: to the end of the patch or of the pass (up arrow)"),
                               [this] { player_.step_out(); }));
    line->addSpacing(8);
    level_ = make_choice("timeline_level", tr("How far one step goes."),
                         {{tr("Passes"), int(StepLevel::pass), tr("to the end of a pass over the mesh.")},
                          {tr("Patches"), int(StepLevel::patch),
                           tr("to the next nodes that were moved together, or the next increment.")},
                          {tr("Iterations"), int(StepLevel::iteration), tr("everything that the method did.")}});
    level_->setCurrentIndex(level_->findData(int(player_.level())));
    line->addWidget(level_);
    line->addSpacing(4);
    speed_ = new LogSpinBox;
    speed_->setObjectName(QStringLiteral("timeline_speed"));
    speed_->setLocale(QLocale::c());
    speed_->setDecimals(1);
    speed_->setRange(StepPlayer::min_speed, StepPlayer::max_speed);
    speed_->setSuffix(tr("/s", "steps per second"));
    speed_->setToolTip(tr("Steps per second when playing; if the view is slower, steps are passed over"));
    const double speed = QSettings().value(QStringLiteral("timeline/speed"), player_.speed()).toDouble();
    player_.set_speed(speed);
    speed_->setValue(player_.speed());
    line->addWidget(speed_);
    line->addSpacing(12);
    // One over the other: the place alone can fill the width of a small window.
    auto* texts = new QVBoxLayout;
    texts->setContentsMargins(0, 0, 0, 0);
    texts->setSpacing(0);
    place_ = make_label(QString(), "");
    place_->setObjectName(QStringLiteral("timeline_place"));
    quality_ = make_label(QString(), "");
    quality_->setObjectName(QStringLiteral("timeline_quality"));
    for (QLabel* label : {place_, quality_}) {
        label->setFont(Theme::small_font());
        label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
        texts->addWidget(label);
    }
    line->addLayout(texts, 1);
    line->addSpacing(8);

    jump_ = new QToolButton;
    jump_->setObjectName(QStringLiteral("timeline_jump"));
    jump_->setText(tr("Jump to"));
    jump_->setToolTip(tr("Go to the worst moment, or to where an element became valid"));
    jump_->setMenu(make_jump_menu());
    breaks_ = new QToolButton;
    breaks_->setObjectName(QStringLiteral("timeline_breakpoints"));
    breaks_->setToolTip(
        tr("Breakpoints, where playing stops: at what happens to selected elements or nodes, or to min J"));
    breaks_->setMenu(make_break_menu());
    for (QToolButton* button : {jump_, breaks_}) {
        button->setPopupMode(QToolButton::InstantPopup);
        button->setFocusPolicy(Qt::TabFocus);
        line->addWidget(button);
    }
    line->addSpacing(4);
    line->addWidget(add_button("close", tr("Close the timeline; the view shows the present mesh again"),
                               [this] { emit close_requested(); }));
    static_cast<QVBoxLayout*>(layout())->addLayout(line);

    connect(level_, &QComboBox::currentIndexChanged, this, [this] { player_.set_level(chosen<StepLevel>(level_)); });
    connect(speed_, &QDoubleSpinBox::valueChanged, this, [this](double value) {
        player_.set_speed(value);
        QSettings().setValue(QStringLiteral("timeline/speed"), value);
    });
}

QMenu* TimelinePanel::make_jump_menu() {
    auto* menu = new QMenu(this);
    const auto add = [&](const char* name, const QString& text, auto press) {
        QAction* action = menu->addAction(text, this, press);
        action->setObjectName(QLatin1String(name));
        return action;
    };
    add("jump_worst", tr("The &worst moment"), [this] {
        if (player_.is_open()) player_.go_to(worst_step(*player_.recording()));
    });
    QAction* selected = add("jump_selected", tr("The &selected element became valid"),
                            [this] { jump_to_validity(edit_.elements().front()); });
    add("jump_element", tr("An &element became valid…"), [this] { ask_element(); });
    menu->addSeparator();
    add("jump_start", tr("&Start"), [this] { player_.go_to(0); });
    add("jump_end", tr("&End"), [this] {
        if (player_.is_open()) player_.go_to(player_.recording()->step_count() - 1);
    });
    const auto follow = [this, selected] { selected->setEnabled(edit_.elements().size() == 1); };
    connect(&edit_, &EditState::selection_changed, selected, follow);
    follow();
    return menu;
}

QMenu* TimelinePanel::make_break_menu() {
    auto* menu = new QMenu(this);
    QAction* elements =
        menu->addAction(tr("Selected &elements"), this, [this] { add_breakpoints(edit_.elements(), {}); });
    elements->setObjectName(QStringLiteral("break_elements"));
    QAction* nodes = menu->addAction(tr("Selected &nodes"), this, [this] { add_breakpoints({}, edit_.nodes()); });
    nodes->setObjectName(QStringLiteral("break_nodes"));
    crossing_ = menu->addAction(tr("Min J crosses &0"));
    crossing_->setObjectName(QStringLiteral("break_crossing"));
    crossing_->setCheckable(true);
    connect(crossing_, &QAction::triggered, this, [this](bool is_on) {
        Breakpoints breakpoints = player_.breakpoints();
        breakpoints.min_crosses_zero = is_on;
        player_.set_breakpoints(breakpoints);
    });
    menu->addSeparator();
    menu->addAction(tr("&Clear"), this, [this] { player_.set_breakpoints({}); })
        ->setObjectName(QStringLiteral("break_clear"));
    const auto follow = [this, elements, nodes] {
        elements->setEnabled(!edit_.elements().empty());
        nodes->setEnabled(!edit_.nodes().empty());
    };
    connect(&edit_, &EditState::selection_changed, elements, follow);
    follow();
    return menu;
}

void TimelinePanel::add_breakpoints(const IndexSet& elements, const IndexSet& nodes) {
    Breakpoints breakpoints = player_.breakpoints();
    breakpoints.elements = united(breakpoints.elements, elements);
    breakpoints.nodes = united(breakpoints.nodes, nodes);
    player_.set_breakpoints(breakpoints);
}

void TimelinePanel::ask_element() {
    if (!player_.is_open() || !ask_) return;
    const QString text = ask_(tr("Jump to where an element became valid"), tr("Element")).trimmed();
    if (text.isEmpty() || !player_.is_open()) return;
    bool is_number = false;
    const qlonglong tag = text.toLongLong(&is_number);
    const MeshTopology& topology = player_.recording()->mesh().topology();
    for (Index element = 0; is_number && element < topology.element_count(); ++element)
        if (topology.element_tag(element).value == tag) return jump_to_validity(element);
    emit told(tr("The mesh has no element %1.").arg(text));
}

void TimelinePanel::jump_to_validity(Index element) {
    if (!player_.is_open()) return;
    const QString tag = QString::number(player_.recording()->mesh().topology().element_tag(element).value);
    const auto step = step_of_validity(*player_.recording(), element);
    if (!step) {
        emit told(tr("Element %1 is not valid at the end.").arg(tag));
        return;
    }
    player_.go_to(*step);
    emit told(*step == 0
                  ? tr("Element %1 was valid all along.").arg(tag)
                  : tr("Element %1 is valid from step %2 on.").arg(tag, format_count(static_cast<long long>(*step))));
}

void TimelinePanel::show_icons() {
    for (QToolButton* button : buttons_) {
        QString name = button->property("icon_name").toString();
        if (button == play_ && player_.is_playing()) name = QStringLiteral("pause");
        button->setIcon(theme_.icon(name));
    }
}

QString TimelinePanel::place_text(const Recording& recording, StepNumber step) {
    QStringList text;
    const auto of = [](const QString& what, qsizetype number, qsizetype count) {
        return tr("%1 %2/%3", "pass 2/3").arg(what, format_count(number), format_count(count));
    };
    const auto passes = recording.passes();
    const auto patches = recording.patches();
    if (const auto pass = recording.pass_of(step)) text << of(tr("pass"), passes[*pass].number, passes.back().number);
    if (const auto patch = recording.patch_of(step)) {
        const RecordedPatch& its = patches[*patch];
        const auto next = std::partition_point(patches.begin(), patches.end(),
                                               [&](const RecordedPatch& p) { return p.pass <= its.pass; });
        text << of(tr("patch"), its.number, (next - 1)->number)
             << of(tr("step"), step - its.first, its.last - its.first);
    } else {
        text << of(tr("step"), step, recording.step_count() - 1);
    }
    if (recording.kind(step) == StepKind::increment) {
        const auto increment = std::get<WarpIncrement>(recording.read(step));
        const QString percent = short_number(100.0 * increment.fraction);
        text << (increment.is_accepted ? tr("%1 % of the motion") : tr("%1 % of the motion: refused")).arg(percent);
    }
    return text.join(QStringLiteral(" · "));
}

void TimelinePanel::show_step() {
    const auto& shown = player_.shown();
    place_->setText(place_text(*player_.recording(), shown.step));
    place_->setToolTip(player_.recording()->is_complete()
                           ? place_->text()
                           : tr("%1\nThe recording ends early: there was no room for more steps.").arg(place_->text()));
    if (!shown.has_quality) return;  // it follows
    const QualitySummary& summary = shown.quality.summary;
    const Index not_valid = summary.invalid + summary.undecided;
    quality_->setText(tr("min J %1, %2")
                          .arg(format_number(summary.min), not_valid == 0 ? tr("all valid")
                                                           : summary.invalid > 0
                                                               ? tr("%1 tangled").arg(format_count(not_valid))
                                                               : tr("%1 undecided").arg(format_count(not_valid))));
    set_tone(quality_, summary.invalid > 0 ? "alarm" : not_valid > 0 ? "warning" : "good");
}

void TimelinePanel::show_breakpoints() {
    const Breakpoints& breakpoints = player_.breakpoints();
    crossing_->setChecked(breakpoints.min_crosses_zero);
    breaks_->setText(breakpoints.is_empty()
                         ? tr("Stop at")
                         : tr("Stop at %1", "number of breakpoints")
                               .arg(format_count(static_cast<long long>(player_.break_steps().size()))));
}

void TimelinePanel::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Space && event->modifiers() == Qt::NoModifier)
        play_->click();
    else
        QWidget::keyPressEvent(event);
}

}  // namespace curvewright
