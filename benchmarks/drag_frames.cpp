// Frames of a drag in the real window, rasterising included: a hand that moves at 125 Hz for some seconds, in a view of
// 1000 × 700 pixels.
//
//     xvfb-run -a -s "-screen 0 1700x1100x24" build/bin/curvewright-drag-frames MESH...
//
// Prints a line per mesh: opening to the first picture, the wait for the response, frames per second, the frame time's
// median and 95th percentile, the longest time without an event loop, and how far the colours lag behind.

#include <algorithm>
#include <chrono>
#include <cstdio>

#include <fmt/format.h>
#include <QApplication>
#include <QElapsedTimer>
#include <QMouseEvent>
#include <QSettings>
#include <QTemporaryDir>
#include <QTimer>

#include "app/desktop/start_up.h"
#include "ui/main_window/main_window.h"
#include "ui/main_window/mesh_view.h"

using namespace curvewright;

namespace {

double seconds(const QElapsedTimer& timer) {
    return 1e-9 * static_cast<double>(timer.nsecsElapsed());
}

void run_until(const std::function<bool()>& is_done, double most_seconds) {
    QElapsedTimer timer;
    timer.start();
    // With a time limit processEvents() would not sleep: it would take a processor from what is measured.
    QTimer wake;
    wake.start(5);
    while (!is_done() && seconds(timer) < most_seconds) QApplication::processEvents(QEventLoop::WaitForMoreEvents);
}

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

void measure(Theme& theme, const QString& path) {
    MainWindow window(theme);
    window.resize(1400, 880);
    window.show();
    run_until([] { return false; }, 0.3);
    MeshView& view = window.view();

    QElapsedTimer timer;
    int drawn = 0;
    QObject::connect(&view, &MeshView::frame_drawn, &view, [&drawn] { ++drawn; });
    timer.start();
    window.open_file(path);
    run_until([&] { return window.document().has_mesh() && drawn > 0; }, 60.0);
    const double opening = seconds(timer);
    if (!window.document().has_mesh()) {
        std::printf("%s did not open\n", qPrintable(path));
        return;
    }
    run_until([] { return false; }, 2.0);  // the weights are computed in the background

    window.resize(window.size() + QSize(1000, 700) - view.size());
    run_until([] { return false; }, 0.3);
    if (view.size() != QSize(1000, 700))
        fmt::print(stderr, "The screen is too small: the view has {} × {} pixels instead of 1000 × 700.\n", view.width(),
                   view.height());

    const CurvedMesh& mesh = *window.document().state().mesh;
    EditSettings settings = window.edit().settings();
    settings.unit = GrabUnit::boundary;
    settings.direction = DragDirection::view_plane;
    window.edit().set_settings(settings);
    window.action(CommandId::tool_drag)->trigger();
    // The shortest component of the boundary that a node nearest to the eye belongs to: an inner circle, if there is
    // one.
    const BoundaryParts& parts = window.edit().boundary();
    Index held = mesh.topology().boundary_nodes().front();
    std::size_t fewest = parts.component_nodes_around(held).size();
    for (int component = 0; component < parts.component_count(); ++component) {
        const auto nodes = parts.component_nodes(component);
        if (nodes.size() < fewest) {
            fewest = nodes.size();
            held = nodes.front();
        }
    }
    if (parts.component_count() == 1) {
        settings.unit = GrabUnit::side;
        window.edit().set_settings(settings);
        const Eigen::Vector3d eye = view.view_axes().col(2);
        for (const Index node : mesh.topology().boundary_nodes())
            if (mesh.coordinates().row(node).dot(eye) > mesh.coordinates().row(held).dot(eye)) held = node;
    }
    const QPointF start = view.to_display(mesh.coordinates().row(held));
    const auto send = [&](QEvent::Type type, QPointF at, Qt::MouseButton button, Qt::MouseButtons buttons) {
        QMouseEvent event(type, at, view.mapToGlobal(at), button, buttons, {});
        QApplication::sendEvent(&view, &event);
    };
    send(QEvent::MouseMove, start, Qt::NoButton, Qt::NoButton);
    timer.start();
    send(QEvent::MouseButtonPress, start, Qt::LeftButton, Qt::LeftButton);
    run_until([&] { return window.drag().is_live(); }, 60.0);
    const double response = seconds(timer);
    if (!window.drag().is_live()) {
        std::printf("%s: the boundary was not taken\n", qPrintable(path));
        return;
    }

    std::vector<double> frames, lags, gaps;
    QElapsedTimer frame, since_positions, tick;
    bool is_behind = false;
    QObject::connect(&window.drag(), &LiveDrag::frame, &view, [&](const Coordinates&, const QualityReport* quality) {
        if (!is_behind) since_positions.start();
        is_behind = true;
        if (quality) {
            lags.push_back(seconds(since_positions));
            is_behind = false;
        }
    });
    frame.start();
    QObject::connect(&view, &MeshView::frame_drawn, &view, [&] {
        frames.push_back(seconds(frame));
        frame.start();
    });
    QTimer hand;
    hand.setTimerType(Qt::PreciseTimer);
    hand.setInterval(8);
    int step = 0;
    tick.start();
    QObject::connect(&hand, &QTimer::timeout, &view, [&] {
        gaps.push_back(seconds(tick));
        tick.start();
        const double angle = 0.05 * ++step;
        send(QEvent::MouseMove, start + QPointF(25.0 * std::sin(angle), 15.0 * std::sin(0.7 * angle)), Qt::NoButton,
             Qt::LeftButton);
    });
    timer.start();
    hand.start();
    run_until([] { return false; }, 4.0);
    hand.stop();
    const double time = seconds(timer);
    const auto count = static_cast<double>(frames.size());
    send(QEvent::MouseButtonRelease, start, Qt::LeftButton, Qt::NoButton);
    run_until([&] { return !window.drag().is_active(); }, 20.0);
    window.document().mark_unchanged();
    fmt::print("| {} | {} | {:.2f} | {:.0f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.0f} |\n",
               window.document().file_name().toStdString(), mesh.topology().element_count(), opening, 1e3 * response,
               count / time, 1e3 * quantile(frames, 0.5), 1e3 * quantile(frames, 0.95),
               1e3 * *std::max_element(gaps.begin(), gaps.end()), 1e3 * quantile(lags, 0.95));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (const std::string problem = prepare_display(argc, argv); !problem.empty()) {
        fmt::print(stderr, "The drag needs a display: {}\n", problem);
        return 1;
    }
    const QTemporaryDir settings;
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
    qputenv("XDG_DATA_HOME", settings.path().toLocal8Bit());
    QApplication application(argc, argv);
    if (const std::string problem = probe_opengl(); !problem.empty()) {
        fmt::print(stderr, "The drag needs OpenGL: {}\n", problem);
        return 1;
    }
    Theme theme(application);
    fmt::print(
        "| mesh | elements | open, s | response, ms | frames/s | median, ms | 95 %, ms | longest gap, ms | colours "
        "behind, ms |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 1; i < argc; ++i) measure(theme, QString::fromLocal8Bit(argv[i]));
    return 0;
}
