#include <cstdio>

#include <QApplication>
#include <QDir>
#include <QSettings>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <QTest>

#include "app/desktop/start_up.h"
#include "tests/gui/gui_test_support.h"
#include "ui/main_window/mesh_view.h"

/// Makes the one test object of the program; defined beside its class.
QObject* make_test();

namespace curvewright::testing {
namespace {
Theme* the_theme = nullptr;
}
Theme& theme() {
    return *the_theme;
}
}  // namespace curvewright::testing

int main(int argc, char** argv) {
    using namespace curvewright;
    if (const std::string problem = prepare_display(argc, argv); !problem.empty()) {
        std::fprintf(stderr, "The tests of the window need a display: %s\n", problem.c_str());
        return 1;
    }
    const QTemporaryDir settings;
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
    QCoreApplication::setOrganizationName(QStringLiteral("curvewright-test"));
    QCoreApplication::setApplicationName(QStringLiteral("curvewright-test"));
    // Of its own: other tests run beside this one.
    qputenv("XDG_DATA_HOME", settings.path().toLocal8Bit());
    QApplication application(argc, argv);
    if (const std::string problem = probe_opengl(); !problem.empty()) {
        std::fprintf(stderr, "The tests of the window need OpenGL: %s\n", problem.c_str());
        return 1;
    }
    MeshView::first_drawing_mode = DrawingMode::at_once;
    Theme theme(application);
    testing::the_theme = &theme;
    const std::unique_ptr<QObject> test(make_test());
    return QTest::qExec(test.get(), argc, argv);
}
