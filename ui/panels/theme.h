#pragma once

#include <vector>

#include <QColor>
#include <QHash>
#include <QIcon>
#include <QObject>
#include <QString>
#include <QTemporaryDir>

class QApplication;
class QFont;
class QWidget;

namespace curvewright {

/// The look of the program: named colours of resources/palette.json, and what follows from them (palette, style sheet,
/// icons). One object per program, handed to whoever draws.
class Theme : public QObject {
    Q_OBJECT

  public:
    enum class Choice { follow_system, light, dark };

    /// Remembers whether the system's palette is dark; to be made before anything changes the application's palette.
    explicit Theme(QApplication& application);

    Choice choice() const { return choice_; }
    bool is_dark() const { return is_dark_; }
    /// Restyles the windows and the palette of the whole application.
    void set_choice(Choice choice);
    /// From now on the window and those that belong to it (dialogs, menus, tips) have the style sheet. As a sheet of
    /// the application Qt would apply it to each widget once per level above it: 155 ms instead of 35.
    void dress(QWidget* window);

    /// A colour by its name in palette.json. pre: the name exists.
    QColor color(const QString& name) const;
    /// resources/icons/NAME.svg in the colours of the theme, with a disabled variant.
    QIcon icon(const QString& name) const;
    /// The same with its lines in one of the colours of palette.json.
    QIcon icon(const QString& name, const QString& color_name) const;
    /// The program's own icon, which has colours of its own.
    static QIcon program_icon();

    /// Text sizes: the system's font, one step smaller, one step larger.
    static QFont small_font();
    static QFont large_font();

  signals:
    void changed();

  private:
    QByteArray recolored(const QString& icon_name, const QColor& line, const QColor& accent) const;
    QString style_sheet() const;

    QApplication& application_;
    bool is_system_dark_ = false, is_dark_ = false;
    Choice choice_ = Choice::follow_system;
    QHash<QString, QColor> colors_;
    std::vector<QWidget*> windows_;  ///< that have the style sheet
    QTemporaryDir icon_files_;       ///< style sheets take images from files only
};

}  // namespace curvewright
