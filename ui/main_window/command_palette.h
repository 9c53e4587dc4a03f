#pragma once

#include <QDialog>

#include "ui/main_window/commands.h"

class QLineEdit;
class QListWidget;

namespace curvewright {

/// Every command by name: type a part of what it is called or does, Enter runs it. Commands that cannot run now are not
/// listed.
class CommandPalette : public QDialog {
    Q_OBJECT

  public:
    CommandPalette(const CommandActions& actions, QWidget* parent);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    void list_matches();
    void run_current();

    const CommandActions& actions_;
    QLineEdit* words_ = nullptr;
    QListWidget* list_ = nullptr;
};

}  // namespace curvewright
