// How long the window stands still: what people do most, done by a script in the real window, and per action the time
// until everything is seen and the longest time without an event loop.
//
//     xvfb-run -a -s "-screen 0 1700x1100x24" build/bin/curvewright-window-gaps MESH...
//
// Every mesh is opened in the window that still shows the one before.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include <fmt/format.h>
#include <QApplication>
#include <QComboBox>
#include <QDialog>
#include <QElapsedTimer>
#include <QFileInfo>
#include <QMouseEvent>
#include <QPushButton>
#include <QSettings>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTimer>

#include "app/desktop/start_up.h"
#include "ui/jobs/mesh_state.h"
#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"
#include "ui/main_window/picture_dialog.h"
#include "ui/panels/clip_bar.h"
#include "ui/panels/color_bar.h"

using namespace curvewright;

namespace {

constexpr double most_seconds = 120.0;  ///< of an action

double seconds(const QElapsedTimer& timer) {
    return 1e-9 * static_cast<double>(timer.nsecsElapsed());
}

/// Turns the event loop and notes the longest time between two turns.
class Loop {
  public:
    Loop() {
        // Something to do every millisecond, so that only what takes long makes a gap.
        beat_.setTimerType(Qt::PreciseTimer);
        beat_.setInterval(1);
        QObject::connect(&beat_, &QTimer::timeout, [this] { note(); });
        beat_.start();
    }

    void start() {
        longest_ = 0.0;
        since_.start();
    }
    double longest() const { return longest_; }

    void run_until(const std::function<bool()>& is_done, double seconds_at_most) {
        QElapsedTimer timer;
        timer.start();
        // The beat wakes it. With a time limit processEvents() would not sleep: it would take a processor from the rest.
        do QApplication::processEvents(QEventLoop::WaitForMoreEvents);
        while (!is_done() && seconds(timer) < seconds_at_most);
    }
    void rest(double time) {
        run_until([] { return false; }, time);
    }

  private:
    void note() {
        longest_ = std::max(longest_, seconds(since_));
        since_.start();
    }

    QTimer beat_;
    QElapsedTimer since_;
    double longest_ = 0.0;
};

class Script {
  public:
    explicit Script(Theme& theme) : window_(theme, answers()) {
        window_.resize(1400, 880);
        window_.show();
        loop_.rest(0.5);
        window_.resize(window_.size() + QSize(1000, 700) - window_.view().size());
        loop_.rest(0.3);
    }

    void run(const QString& path) {
        fmt::print("\n{}\n\n| action | time, ms | longest gap, ms |\n| --- | --- | --- |\n",
                   QFileInfo(path).fileName().toStdString());
        measure("open", [&] { window_.open_file(path); });
        if (!window_.document().has_mesh()) {
            fmt::print("{} did not open.\n", path.toStdString());
            return;
        }
        const bool is_solid = window_.document().state().mesh->topology().dimension() == 3;
        const MeshState start = window_.document().state();
        MeshState bent = make_state(start.mesh->with_coordinates(bent_positions(*start.mesh)), {}, &start);
        measure("a step is done", [&] {
            window_.document().apply(
                QStringLiteral("Bend"), bent,
                place_action(start.mesh->topology(), start.mesh->coordinates(), bent.mesh->coordinates()));
        });
        measure("undo", [&] { trigger(CommandId::undo); });
        measure("redo", [&] { trigger(CommandId::redo); });
        measure("colours: distance moved", [&] { choose_colors(4); });
        measure("colours: size", [&] { choose_colors(3); });
        measure("colours: scaled Jacobian", [&] { choose_colors(0); });
        measure("before and after, on", [&] { trigger(CommandId::compare); });
        measure("before and after, off", [&] { trigger(CommandId::compare); });
        if (is_solid) {
            auto* bar = window_.findChild<ClipBar*>();
            bar->set_setting({0, false, 0.5, false});
            measure("clip whole elements, on", [&] { trigger(CommandId::clip); });
            measure("clip moved", [&] { bar->set_setting({0, false, 0.4, false}); });
            measure("cut through", [&] { bar->set_setting({0, false, 0.4, true}); });
            measure("cut moved", [&] { bar->set_setting({0, false, 0.6, true}); });
            measure("cut, off", [&] { trigger(CommandId::clip); });
        }
        measure("elements apart, on", [&] { trigger(CommandId::shrink); });
        measure("elements apart, off", [&] { trigger(CommandId::shrink); });
        measure("nodes, on", [&] { trigger(CommandId::nodes); });
        measure("nodes, off", [&] { trigger(CommandId::nodes); });
        measure("element numbers, on", [&] { trigger(CommandId::element_numbers); });
        measure("element numbers, off", [&] { trigger(CommandId::element_numbers); });
        measure("select all", [&] { trigger(CommandId::select_all); });
        measure("select nothing", [&] { trigger(CommandId::select_none); });
        work_with_mouse(start);
        measure("dark", [&] { trigger(CommandId::theme_dark); });
        measure("light", [&] { trigger(CommandId::theme_light); });
        measure("window made larger", [&] { window_.resize(window_.size() + QSize(60, 40)); });
        measure("window made smaller", [&] { window_.resize(window_.size() - QSize(60, 40)); });
        for (const auto& [name, id] : {std::pair{"page of shortcuts", CommandId::shortcuts},
                                       {"commands", CommandId::palette},
                                       {"preferences", CommandId::preferences}}) {
            measure(name, [&] { trigger(id); });
            for (QDialog* dialog : window_.findChildren<QDialog*>()) dialog->close();
        }
        measure("save", [&] {
            saved_ = folder_.filePath(QStringLiteral("saved.msh"));
            trigger(CommandId::save_as);
        });
        measure("picture dialog", [&] { trigger(CommandId::save_picture); });
        if (auto* dialog = window_.findChild<PictureDialog*>()) {
            dialog->findChild<QComboBox*>(QStringLiteral("size_preset"))->setCurrentIndex(3);  // 3840 × 2160
            loop_.rest(1.0);
            measure("picture, 3840 × 2160", [&] {
                saved_ = folder_.filePath(QStringLiteral("picture.png"));
                dialog->findChild<QPushButton*>(QStringLiteral("picture_save"))->click();
            });
        }
        window_.document().mark_unchanged();
        measure("close", [&] { trigger(CommandId::close_mesh); });
        measure("open again", [&] { window_.open_file(path); });
    }

  private:
    void work_with_mouse(const MeshState& state) {
        const MeshView& view = window_.view();
        const QPointF middle(0.5 * view.width(), 0.5 * view.height());
        const auto pass = [&](QPointF from, QPointF to, Qt::MouseButtons buttons) {
            constexpr int moves = 60;
            for (int i = 0; i <= moves; ++i) {
                send_mouse(QEvent::MouseMove, from + (to - from) * (double(i) / moves), Qt::NoButton, buttons);
                loop_.run_until([] { return true; }, 0.0);
            }
        };
        const auto pull = [&](QPointF from, QPointF to) {
            send_mouse(QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton);
            loop_.run_until([&] { return !window_.drag().is_active() || window_.drag().is_live(); }, 60.0);
            pass(from, to, Qt::LeftButton);
            send_mouse(QEvent::MouseButtonRelease, to, Qt::LeftButton, Qt::NoButton);
            loop_.run_until([&] { return !window_.drag().is_active(); }, 60.0);
        };
        trigger(CommandId::tool_select);
        measure("the pointer passes over it", [&] { pass(0.2 * middle, 1.8 * middle, Qt::NoButton); });
        measure("a box around half of it", [&] { pull(0.1 * middle, middle * 1.2); });
        measure("selection grown", [&] { trigger(CommandId::select_grow); });
        measure("select nothing", [&] { trigger(CommandId::select_none); });
        trigger(CommandId::tool_drag);
        const Index held = state.mesh->topology().boundary_nodes().front();
        const QPointF start = window_.view().to_display(window_.document().state().mesh->coordinates().row(held));
        measure("a boundary is dragged and let go", [&] { pull(start, start + QPointF(20.0, 10.0)); });
        measure("undo", [&] { trigger(CommandId::undo); });
        trigger(CommandId::tool_look);
        measure("the mesh is turned or moved", [&] { pull(middle, middle + QPointF(150.0, 60.0)); });
        measure("fit", [&] { trigger(CommandId::fit); });
        measure("an element is clicked", [&] { pull(0.7 * middle, 0.7 * middle); });
    }

    void send_mouse(QEvent::Type type, QPointF at, Qt::MouseButton button, Qt::MouseButtons buttons) {
        QMouseEvent event(type, at, window_.view().mapToGlobal(at), button, buttons, {});
        QApplication::sendEvent(&window_.view(), &event);
    }

    Dialogs answers() {
        Dialogs dialogs = Dialogs::standard();
        dialogs.save_file = [this](QWidget*, const QString&, const QString&, const QString&, QString&) {
            return saved_;
        };
        dialogs.ask_unsaved = [](QWidget*, const QString&) { return UnsavedAnswer::discard; };
        dialogs.show_error = [](QWidget*, const QString& title, const QString& message) {
            fmt::print(stderr, "{}: {}\n", title.toStdString(), message.toStdString());
        };
        return dialogs;
    }

    void trigger(CommandId id) { window_.action(id)->trigger(); }

    /// index: in the list of the bar.
    void choose_colors(int index) {
        window_.findChild<ColorBar*>()->findChild<QComboBox*>(QStringLiteral("color_quantity"))->setCurrentIndex(index);
    }

    /// The mesh, a little bent.
    static Coordinates bent_positions(const CurvedMesh& mesh) {
        const auto box = bounding_box(mesh);
        const Eigen::RowVector3d size = (box.row(1) - box.row(0)).cwiseMax(1e-12);
        Coordinates positions = mesh.coordinates();
        for (Eigen::Index i = 0; i < positions.rows(); ++i)
            positions(i, 1) += 0.02 * size[1] * std::sin(3.0 * (positions(i, 0) - box(0, 0)) / size[0]);
        return positions;
    }

    bool is_settled() {
        if (window_.jobs().runner().is_running()) return false;
        for (const char* name : {"mesh_view", "before_view"}) {
            const auto* view = window_.findChild<MeshView*>(QLatin1String(name));
            if (view->isVisible() && view->has_frame_under_way()) return false;
        }
        const auto* dialog = window_.findChild<PictureDialog*>();
        return !dialog || (!dialog->is_busy() && !dialog->is_drawing_preview());
    }

    void measure(const char* name, const std::function<void()>& act) {
        loop_.rest(0.4);
        QElapsedTimer timer;
        timer.start();
        loop_.start();
        act();
        // Settled is what stays so for a while: some things wait for a turn or two of the loop.
        constexpr double calm = 0.25;
        double settled = -1.0;
        while (seconds(timer) < most_seconds) {
            loop_.run_until([] { return true; }, 0.0);
            if (!is_settled())
                settled = -1.0;
            else if (settled < 0.0)
                settled = seconds(timer);
            if (settled >= 0.0 && seconds(timer) > settled + calm) break;
        }
        fmt::print("| {} | {:.0f} | {:.0f} |\n", name, 1e3 * std::max(settled, 0.0), 1e3 * loop_.longest());
        std::fflush(stdout);
    }

    Loop loop_;
    QTemporaryDir folder_;
    QString saved_;
    MainWindow window_;
};

}  // namespace

int main(int argc, char** argv) {
    if (const std::string problem = prepare_display(argc, argv); !problem.empty()) {
        fmt::print(stderr, "The window needs a display: {}\n", problem);
        return 1;
    }
    const QTemporaryDir settings;
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
    qputenv("XDG_DATA_HOME", settings.path().toLocal8Bit());
    QApplication application(argc, argv);
    if (const std::string problem = probe_opengl(); !problem.empty()) {
        fmt::print(stderr, "The window needs OpenGL: {}\n", problem);
        return 1;
    }
    Theme theme(application);
    Script script(theme);
    for (int i = 1; i < argc; ++i) script.run(QString::fromLocal8Bit(argv[i]));
    return 0;
}
