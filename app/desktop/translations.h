#pragma once

#include <QLocale>
#include <QStringList>

class QObject;

namespace curvewright {

/// Installs the translation of a language, curvewright_LANGUAGE.qm of the first folder that has one; the installed
/// translators belong to `owner`. Returns the files taken: none for English, or if there is none.
QStringList install_translations(const QLocale& locale, const QStringList& folders, QObject* owner);
/// Where they are looked for: in the program, beside it as it is built and installed.
QStringList translation_folders();
/// Those of Qt's own words (the buttons of dialogs), from where Qt is installed or the same folders.
void install_qt_translations(const QLocale& locale, QObject* owner);

}  // namespace curvewright
