/// curvewright [MESH] [--deformation FILE]: the window.

#include <cstdio>

#include <QApplication>
#include <QCommandLineParser>
#include <QFileInfo>
#include <QTimer>

#include "app/desktop/start_up.h"
#include "app/desktop/translations.h"
#include "ui/main_window/main_window.h"
#include "ui/panels/theme.h"

namespace {

/// What may stand on the command line.
struct Options {
    QCommandLineOption deformation{QStringLiteral("deformation"),
                                   QStringLiteral("Boundary deformation to load (.json .csv, or a mesh)."),
                                   QStringLiteral("FILE")};
    QCommandLineOption apply{QStringLiteral("apply"), QStringLiteral("Apply the deformation to the boundary at once.")};
    QCommandLineOption sample{QStringLiteral("sample"), QStringLiteral("Open a sample by its name."),
                              QStringLiteral("NAME")};
    QCommandLineOption theme{QStringLiteral("theme"), QStringLiteral("light, dark or system."), QStringLiteral("NAME")};
    QCommandLineOption size{QStringLiteral("size"), QStringLiteral("Size of the window, for example 1280x800."),
                            QStringLiteral("WxH")};
    QCommandLineOption screenshot{
        QStringLiteral("screenshot"),
        QStringLiteral("Save a picture of the window as PNG once everything is loaded, and quit."),
        QStringLiteral("FILE")};
    QCommandLineParser parser;

    Options() {
        parser.setApplicationDescription(QStringLiteral("Viewer, editor and untangler of curved high-order meshes."));
        parser.addHelpOption();
        parser.addVersionOption();
        parser.addPositionalArgument(QStringLiteral("MESH"), QStringLiteral("Mesh to open (.msh .msh.gz .vtu .vtk)."),
                                     QStringLiteral("[MESH]"));
        parser.addOptions({deformation, apply, sample, theme, size, screenshot});
    }
};

/// Saves a picture of the whole window once nothing is loading any more, and quits.
void take_screenshot_when_idle(curvewright::MainWindow& window, const QString& file) {
    auto* timer = new QTimer(&window);
    timer->setInterval(400);
    QObject::connect(timer, &QTimer::timeout, &window, [&window, file, timer] {
        // Once more after that: what the last job has changed is to be laid out first.
        const bool was_idle = timer->property("was_idle").toBool();
        timer->setProperty("was_idle", !window.jobs().runner().is_running());
        if (!was_idle || window.jobs().runner().is_running()) return;
        timer->stop();
        const bool is_saved = window.grab().save(file);
        if (!is_saved) std::fprintf(stderr, "%s: cannot be written.\n", qPrintable(file));
        QCoreApplication::exit(is_saved ? 0 : 1);
    });
    timer->start();
}

}  // namespace

int main(int argc, char** argv) {
    using namespace curvewright;
    QCoreApplication::setOrganizationName(QStringLiteral("curvewright"));
    QCoreApplication::setApplicationName(QStringLiteral("curvewright"));
    QCoreApplication::setApplicationVersion(QStringLiteral(CURVEWRIGHT_VERSION));
    Options options;
    // Answered before Qt looks for a display.
    for (int i = 1; i < argc; ++i) {
        for (const char* asked : {"-h", "--help", "--help-all", "-v", "--version"}) {
            if (qstrcmp(argv[i], asked) != 0) continue;
            const QCoreApplication application(argc, argv);
            options.parser.process(application);
        }
    }
    if (const std::string problem = prepare_display(argc, argv); !problem.empty()) {
        std::fprintf(stderr, "curvewright: %s\n", problem.c_str());
        return 1;
    }
    QApplication application(argc, argv);
    QGuiApplication::setApplicationDisplayName(QString());
    QGuiApplication::setDesktopFileName(QStringLiteral("curvewright"));

    QCommandLineParser& parser = options.parser;
    const auto usage_error = [](const QString& text) {
        std::fprintf(stderr, "curvewright: %s\n", qPrintable(text));
        return 2;
    };
    if (!parser.parse(QCoreApplication::arguments())) return usage_error(parser.errorText());
    if (parser.positionalArguments().size() > 1) return usage_error(QStringLiteral("expected one MESH at most."));

    if (const std::string problem = probe_opengl(); !problem.empty()) {
        std::fprintf(stderr, "curvewright: %s\n", problem.c_str());
        return 1;
    }

    // Words of Qt's in a language that the program does not speak would be a mixture.
    if (!install_translations(QLocale(), translation_folders(), &application).isEmpty())
        install_qt_translations(QLocale(), &application);

    Theme theme(application);
    MainWindow window(theme);
    if (parser.isSet(options.theme)) {
        const QString name = parser.value(options.theme);
        theme.set_choice(name == QLatin1String("dark")    ? Theme::Choice::dark
                         : name == QLatin1String("light") ? Theme::Choice::light
                                                          : Theme::Choice::follow_system);
    }
    if (parser.isSet(options.size)) {
        const QStringList parts = parser.value(options.size).split(QLatin1Char('x'));
        if (parts.size() != 2 || parts[0].toInt() <= 0 || parts[1].toInt() <= 0)
            return usage_error(QStringLiteral("--size expects WIDTHxHEIGHT."));
        window.resize(parts[0].toInt(), parts[1].toInt());
    }
    window.show();
    if (parser.isSet(options.sample)) {
        const Sample* found = window.samples().find(parser.value(options.sample));
        if (!found)
            return usage_error(QStringLiteral("there is no sample named '%1'.").arg(parser.value(options.sample)));
        window.open_sample(*found);
    } else if (!parser.positionalArguments().isEmpty()) {
        window.open_file(parser.positionalArguments().front(), parser.value(options.deformation),
                         parser.isSet(options.apply));
    } else if (parser.isSet(options.deformation)) {
        return usage_error(QStringLiteral("--deformation needs a MESH."));
    }
    if (parser.isSet(options.screenshot)) take_screenshot_when_idle(window, parser.value(options.screenshot));
    return QApplication::exec();
}
