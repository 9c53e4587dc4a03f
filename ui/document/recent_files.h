#pragma once

#include <QObject>
#include <QStringList>

namespace curvewright {

/// The mesh files opened last, newest first, kept in the settings. Files that are gone are left out.
class RecentFiles : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;

    /// At most as many as the preferences say.
    QStringList paths() const;
    void add(const QString& path);
    void clear();

  signals:
    void changed();
};

}  // namespace curvewright
