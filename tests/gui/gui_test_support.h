#pragma once

#include <memory>

#include <QString>
#include <QTemporaryDir>
#include <QTest>

#include "ui/main_window/main_window.h"

class QTreeWidget;
class QTreeWidgetItem;

namespace curvewright::testing {

/// The theme of the test program (one per program).
Theme& theme();

/// A folder with small inputs, made when asked for and removed at the end:
/// square.msh      32 straight triangles of order 3 on the unit square, groups bottom, right, top, left, domain
/// bump.json       bends "bottom" into the square, so far that leaving the interior behind tangles elements
/// gentle.json     a little bend that tangles nothing
/// malformed.msh   a mesh file that breaks off
/// clockwise.msh   the square with all triangles numbered clockwise
/// cube.msh        48 tetrahedra of order 2
/// quad.msh        one quadrilateral: a mesh whose quality is not available
class Inputs {
  public:
    Inputs();
    QString path(const QString& name) const { return folder_.filePath(name); }

  private:
    QTemporaryDir folder_;
};

/// A window whose questions are answered by the test.
struct WindowUnderTest {
    WindowUnderTest();
    ~WindowUnderTest();

    /// A visible child by its object name; fails the program if there is none.
    template <class Widget>
    Widget* find(const char* name) {
        auto* widget = window->findChild<Widget*>(QLatin1String(name));
        if (!widget) qFatal("The window has no %s.", name);
        return widget;
    }
    void click(const char* button_name);
    QString text(const char* label_name);
    /// Opens a mesh and waits until it is there.
    void open(const QString& path, const QString& deformation = {});
    /// Waits until no job runs.
    bool wait_for_job();

    Inputs inputs;
    QString file_answer, filter_answer;    ///< what the file dialogs answer
    QString text_answer, text_suggestion;  ///< what the question for a text answers (null: what is suggested), and that
    UnsavedAnswer unsaved_answer = UnsavedAnswer::cancel;  ///< what the question about unsaved changes answers
    int unsaved_questions = 0;                             ///< how often it was asked
    QStringList recover_questions;                         ///< about work that a crash left
    /// What they get; asked as soon as a window is there, so for all windows.
    static inline UnsavedAnswer recover_answer = UnsavedAnswer::cancel;
    QStringList errors;  ///< messages shown
    std::unique_ptr<MainWindow> window;
};

/// Clicks on the second column of a row that offers choices and takes one from the menu that opens.
void choose_in_row(QTreeWidget* tree, QTreeWidgetItem* item, const QString& text);

}  // namespace curvewright::testing
