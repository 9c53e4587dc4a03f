#include "ui/document/recent_files.h"

#include <QFileInfo>
#include <QSettings>

#include "ui/document/preferences.h"

namespace curvewright {
namespace {
const QString key = QStringLiteral("recent_files");
}

QStringList RecentFiles::paths() const {
    QStringList present;
    for (const QString& path : QSettings().value(key).toStringList())
        if (QFileInfo::exists(path)) present << path;
    return present.mid(0, Preferences::load().recent_count);
}

void RecentFiles::add(const QString& path) {
    const QString absolute = QFileInfo(path).absoluteFilePath();
    QStringList list = paths();
    list.removeAll(absolute);
    list.prepend(absolute);
    QSettings().setValue(key, QStringList(list.mid(0, Preferences::load().recent_count)));
    emit changed();
}

void RecentFiles::clear() {
    QSettings().remove(key);
    emit changed();
}

}  // namespace curvewright
