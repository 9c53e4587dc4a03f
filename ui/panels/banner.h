#pragma once

#include <functional>

#include <QWidget>

#include "ui/panels/theme.h"

class QLabel;
class QPushButton;

namespace curvewright {

/// A line over the view that warns of something and offers to put it right, or tells of something that was done.
class Banner : public QWidget {
    Q_OBJECT

  public:
    explicit Banner(const Theme& theme, QWidget* parent = nullptr);

    /// Shows a text; action may be "" (no button).
    void show_warning(const QString& text, const QString& action);
    void show_note(const QString& text, const QString& action);
    QString text() const;

  signals:
    void action_triggered();

  private:
    void show_text(const QString& text, const QString& action, const char* tone);

    QLabel *warning_icon_ = nullptr, *note_icon_ = nullptr;
    QLabel* text_ = nullptr;
    QPushButton* action_ = nullptr;
};

}  // namespace curvewright
