#pragma once

#include <QString>

class QLabel;
class QPushButton;
class QWidget;

namespace curvewright {

/// A label in one of the roles that the style sheet knows: "title", "section", "muted", or "" for plain text.
QLabel* make_label(const QString& text, const char* role);
/// A label whose text wraps.
QLabel* make_paragraph(const QString& text, const char* role);
/// The button of a panel's main action.
QPushButton* make_primary_button(const QString& text, const QString& object_name);
/// A line that is clicked to show or hide what is below it; checked = shown, not checked at first. Who makes it
/// connects toggled().
QPushButton* make_fold_button(const QString& text, const QString& object_name);
/// Colours a label by what it says: "alarm", "good", "warning", "muted", or "" for plain text.
void set_tone(QLabel* label, const char* tone);
/// Reads the style sheet again after a dynamic property of the widget has changed.
void restyle(QWidget* widget);

}  // namespace curvewright
