#include "ui/document/view_bookmarks.h"

#include <algorithm>
#include <cmath>

#include <QCryptographicHash>
#include <QDateTime>
#include <QFileInfo>
#include <QJsonArray>
#include <QJsonDocument>
#include <QSettings>

namespace curvewright {
namespace {

const QString group = QStringLiteral("bookmarks");

QString key_of(const QString& path) {
    const QByteArray hash = QCryptographicHash::hash(path.toUtf8(), QCryptographicHash::Sha1).toHex();
    return group + QLatin1Char('/') + QString::fromLatin1(hash);
}

QJsonArray to_array(const std::array<double, 3>& vector) {
    return {vector[0], vector[1], vector[2]};
}

/// False if there is something else than three finite numbers.
bool read_vector(const QJsonValue& value, std::array<double, 3>& vector) {
    const QJsonArray array = value.toArray();
    if (array.size() != 3) return false;
    for (int i = 0; i < 3; ++i) {
        if (!array[i].isDouble() || !std::isfinite(array[i].toDouble())) return false;
        vector[static_cast<std::size_t>(i)] = array[i].toDouble();
    }
    return true;
}

QJsonObject read_object(const QString& key) {
    return QJsonDocument::fromJson(QSettings().value(key).toString().toUtf8()).object();
}

}  // namespace

QJsonObject ViewPose::to_json() const {
    return {{QStringLiteral("position"), to_array(position)},
            {QStringLiteral("focus"), to_array(focus)},
            {QStringLiteral("up"), to_array(up)},
            {QStringLiteral("scale"), scale}};
}

std::optional<ViewPose> ViewPose::from_json(const QJsonObject& json) {
    ViewPose pose;
    if (!read_vector(json[QStringLiteral("position")], pose.position) ||
        !read_vector(json[QStringLiteral("focus")], pose.focus) || !read_vector(json[QStringLiteral("up")], pose.up))
        return {};
    pose.scale = json[QStringLiteral("scale")].toDouble(pose.scale);
    if (!std::isfinite(pose.scale) || pose.scale <= 0.0 || pose.position == pose.focus) return {};
    return pose;
}

ViewBookmarks::ViewBookmarks(QObject* parent) : QObject(parent) {}

void ViewBookmarks::set_mesh(const QString& path) {
    const QString absolute = path.isEmpty() ? QString() : QFileInfo(path).absoluteFilePath();
    path_ = absolute;
    read();
    emit changed();
}

void ViewBookmarks::read() {
    list_.clear();
    if (path_.isEmpty()) return;
    for (const auto& value : read_object(key_of(path_))[QStringLiteral("views")].toArray()) {
        const QJsonObject json = value.toObject();
        const auto pose = ViewPose::from_json(json[QStringLiteral("pose")].toObject());
        const QString name = json[QStringLiteral("name")].toString();
        if (pose && !name.isEmpty() && !is_full())
            list_ << ViewBookmark{name, *pose, json[QStringLiteral("shown")].toObject()};
    }
}

void ViewBookmarks::write() const {
    if (path_.isEmpty()) return;
    QSettings settings;
    if (list_.isEmpty()) {
        settings.remove(key_of(path_));
        return;
    }
    QJsonArray views;
    for (const ViewBookmark& bookmark : list_)
        views << QJsonObject{{QStringLiteral("name"), bookmark.name},
                             {QStringLiteral("pose"), bookmark.pose.to_json()},
                             {QStringLiteral("shown"), bookmark.shown}};
    const QJsonObject json{{QStringLiteral("mesh"), path_},
                           {QStringLiteral("used"), double(QDateTime::currentMSecsSinceEpoch())},
                           {QStringLiteral("views"), views}};
    settings.setValue(key_of(path_), QString::fromUtf8(QJsonDocument(json).toJson(QJsonDocument::Compact)));

    settings.beginGroup(group);
    QStringList keys = settings.childKeys();
    settings.endGroup();
    if (keys.size() <= most_meshes) return;
    const auto used = [](const QString& key) {
        return read_object(group + QLatin1Char('/') + key)[QStringLiteral("used")].toDouble();
    };
    std::sort(keys.begin(), keys.end(), [&](const QString& a, const QString& b) { return used(a) > used(b); });
    for (const QString& key : keys.mid(most_meshes)) settings.remove(group + QLatin1Char('/') + key);
}

QString ViewBookmarks::new_name() const {
    for (int number = 1;; ++number) {
        const QString name = tr("View %1").arg(number);
        if (std::none_of(list_.begin(), list_.end(), [&](const ViewBookmark& its) { return its.name == name; }))
            return name;
    }
}

void ViewBookmarks::add(const ViewBookmark& bookmark) {
    Q_ASSERT(!is_full() && !path_.isEmpty());
    list_ << bookmark;
    write();
    emit changed();
}

void ViewBookmarks::set_list(const QList<ViewBookmark>& list) {
    list_ = list.mid(0, most_of_a_mesh);
    write();
    emit changed();
}

}  // namespace curvewright
