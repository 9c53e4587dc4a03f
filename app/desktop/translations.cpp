#include "app/desktop/translations.h"

#include <memory>

#include <QCoreApplication>
#include <QLibraryInfo>
#include <QTranslator>

namespace curvewright {
namespace {

/// The file taken; "" = none.
QString install(const QLocale& locale, const QString& name, const QStringList& folders, QObject* owner) {
    for (const QString& folder : folders) {
        auto translator = std::make_unique<QTranslator>();
        if (!translator->load(locale, name, QStringLiteral("_"), folder)) continue;
        const QString file = translator->filePath();
        translator->setParent(owner);
        QCoreApplication::installTranslator(translator.release());
        return file;
    }
    return {};
}

}  // namespace

QStringList install_translations(const QLocale& locale, const QStringList& folders, QObject* owner) {
    if (locale.language() == QLocale::English || locale.language() == QLocale::C) return {};
    const QString file = install(locale, QStringLiteral("curvewright"), folders, owner);
    return file.isEmpty() ? QStringList() : QStringList{file};
}

QStringList translation_folders() {
    const QString program = QCoreApplication::applicationDirPath();
    return {QStringLiteral(":/curvewright/translations"), program + QStringLiteral("/translations"),
            program + QStringLiteral("/../share/curvewright/translations"), program};
}

void install_qt_translations(const QLocale& locale, QObject* owner) {
    install(locale, QStringLiteral("qtbase"),
            QStringList{QLibraryInfo::path(QLibraryInfo::TranslationsPath)} + translation_folders(), owner);
}

}  // namespace curvewright
