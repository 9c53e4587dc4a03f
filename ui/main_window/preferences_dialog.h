#pragma once

#include <functional>

#include <QDialog>

#include "ui/document/edit_state.h"
#include "ui/document/preferences.h"
#include "ui/document/recent_files.h"
#include "ui/main_window/commands.h"

class QTabWidget;

namespace curvewright {

/// Edit > Preferences. What is chosen counts at once and is kept; there is nothing to confirm.
class PreferencesDialog : public QDialog {
    Q_OBJECT

  public:
    PreferencesDialog(const CommandActions& actions, EditState& edit, RecentFiles& recent, QWidget* parent);

    /// Brings up a page: "general", "view", "editing" or "keys".
    void show_page(const QString& name);

  signals:
    /// The preferences are others now, and stored.
    void changed();

  private:
    QWidget* make_general();
    QWidget* make_view();
    QWidget* make_editing();
    QWidget* make_keys();
    void add_page(QWidget* page, const QString& name, const QString& title);
    /// A check box that sets one of the preferences.
    QWidget* make_check(const char* object_name, const QString& text, const QString& tip, bool Preferences::*value);
    void change(const std::function<void(Preferences&)>& set);

    const CommandActions& actions_;
    EditState& edit_;
    RecentFiles& recent_;
    Preferences preferences_;
    QTabWidget* pages_ = nullptr;
};

}  // namespace curvewright
