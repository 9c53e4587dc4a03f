#pragma once

#include <functional>

#include <QString>

#include "ui/document/preferences.h"

class QWidget;

namespace curvewright {

class CommandActions;

enum class UnsavedAnswer { save, discard, cancel };

/// The questions that the window asks its user, replaceable so that a test can answer them.
struct Dialogs {
    /// Path of an existing file; "" = the user gave up.
    std::function<QString(QWidget* parent, const QString& title, const QString& folder, const QString& filters)>
        open_file;
    /// Path to write to; "" = the user gave up. filters is separated by ";;", selected gets the one that was chosen.
    std::function<QString(QWidget* parent, const QString& title, const QString& suggestion, const QString& filters,
                          QString& selected)>
        save_file;
    /// Whether work that a crash has left is to be recovered, thrown away, or kept for another time (cancel).
    std::function<UnsavedAnswer(QWidget* parent, const QString& message)> ask_recover;
    std::function<UnsavedAnswer(QWidget* parent, const QString& file_name)> ask_unsaved;
    /// An existing folder; "" = the user gave up.
    std::function<QString(QWidget* parent, const QString& title, const QString& folder)> choose_folder;
    /// One line of text; "" = the user gave up.
    std::function<QString(QWidget* parent, const QString& title, const QString& label, const QString& text)> ask_text;
    /// Tells and returns at once; the message stays until it is closed.
    std::function<void(QWidget* parent, const QString& title, const QString& message)> show_error;

    /// Qt's own.
    static Dialogs standard();
};

/// The page of Help > Keyboard and mouse: all keys as they are now.
void show_shortcuts(QWidget* parent, const CommandActions& actions, MouseHabits mouse);
void show_about(QWidget* parent);

}  // namespace curvewright
