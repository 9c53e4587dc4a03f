#include "tests/gui/gui_test_support.h"

#include <fstream>

#include <QApplication>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QTreeWidget>

#include "core/io/mesh_io.h"
#include "core/quality/quality.h"
#include "tests/support/mesh_factory.h"

namespace curvewright::testing {
namespace {

void write_text(const QString& path, const char* text) {
    std::ofstream(path.toStdString()) << text;
}

}  // namespace

Inputs::Inputs() {
    const CurvedMesh square = square_mesh(4, 3);
    write_mesh(path(QStringLiteral("square.msh")).toStdString(), square);
    write_mesh(path(QStringLiteral("clockwise.msh")).toStdString(), flip_orientation(square));
    const Eigen::MatrixX3d corners{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
    write_mesh(path(QStringLiteral("quad.msh")).toStdString(), single_element({Shape::quadrilateral, 1}, corners));
    write_mesh(path(QStringLiteral("cube.msh")).toStdString(), cube_mesh(2, 2));
    write_text(
        path(QStringLiteral("bump.json")),
        R"json({"operations": [{"group": "bottom", "type": "expression", "y": "y + 0.06 * sin(4 * pi * x)^2"}]})json");
    write_text(path(QStringLiteral("gentle.json")),
               R"json({"operations": [{"group": "bottom", "type": "expression", "y": "y + 0.02 * sin(pi * x)"}]})json");
    write_text(path(QStringLiteral("malformed.msh")), "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 1 2\n");
}

WindowUnderTest::WindowUnderTest() {
    Dialogs dialogs;
    dialogs.open_file = [this](QWidget*, const QString&, const QString&, const QString&) { return file_answer; };
    dialogs.save_file = [this](QWidget*, const QString&, const QString&, const QString& filters, QString& selected) {
        for (const QString& filter : filters.split(QStringLiteral(";;")))
            if (!filter_answer.isEmpty() && filter.contains(filter_answer)) selected = filter;
        return file_answer;
    };
    dialogs.ask_recover = [this](QWidget*, const QString& message) {
        recover_questions << message;
        return recover_answer;
    };
    dialogs.ask_unsaved = [this](QWidget*, const QString&) {
        ++unsaved_questions;
        return unsaved_answer;
    };
    dialogs.choose_folder = [this](QWidget*, const QString&, const QString&) { return file_answer; };
    dialogs.ask_text = [this](QWidget*, const QString&, const QString&, const QString& text) {
        text_suggestion = text;
        return text_answer.isNull() ? text : text_answer;
    };
    dialogs.show_error = [this](QWidget*, const QString&, const QString& message) { errors << message; };
    window = std::make_unique<MainWindow>(theme(), dialogs);
    window->resize(1280, 800);
    window->show();
    window->activateWindow();  // shortcuts go to the active window only
    if (!QTest::qWaitForWindowActive(window.get())) qFatal("The window did not appear.");
}

WindowUnderTest::~WindowUnderTest() = default;

void WindowUnderTest::click(const char* button_name) {
    auto* button = find<QAbstractButton>(button_name);
    if (!button->isVisible()) qFatal("%s is not visible.", button_name);
    QTest::mouseClick(button, Qt::LeftButton);
}

QString WindowUnderTest::text(const char* label_name) {
    return find<QLabel>(label_name)->text();
}

bool WindowUnderTest::wait_for_job() {
    return QTest::qWaitFor([this] { return !window->jobs().runner().is_running(); }, 60000);
}

void WindowUnderTest::open(const QString& path, const QString& deformation) {
    window->open_file(path, deformation);
    if (!wait_for_job() || !window->document().has_mesh()) qFatal("%s did not open.", qPrintable(path));
}

void choose_in_row(QTreeWidget* tree, QTreeWidgetItem* item, const QString& text) {
    tree->scrollToItem(item);
    const QRect row = tree->visualItemRect(item);
    QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, QPoint(row.right() - 8, row.center().y()));
    auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
    QVERIFY(menu);
    for (QAction* action : menu->actions())
        if (action->text() == text)
            return QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
    QFAIL("The menu does not offer that.");
}

}  // namespace curvewright::testing
