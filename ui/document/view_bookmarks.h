#pragma once

#include <array>
#include <optional>

#include <QJsonObject>
#include <QList>
#include <QObject>
#include <QString>

namespace curvewright {

/// Where a camera is, in the mesh's space.
struct ViewPose {
    std::array<double, 3> position{}, focus{}, up{};
    double scale = 1.0;  ///< half the height of what is seen, in parallel projection
    bool operator==(const ViewPose&) const = default;

    /// Bit by bit. Members that are missing have their defaults; none if something in it is no pose.
    QJsonObject to_json() const;
    static std::optional<ViewPose> from_json(const QJsonObject& json);
};

/// A view that can be gone back to.
struct ViewBookmark {
    QString name;
    ViewPose pose;
    QJsonObject shown;  ///< what of the mesh is to be seen; for who shows it to read
};

/// The bookmarks of the open mesh, kept in the settings by the mesh's file: at most so many of it, and of so many
/// meshes used last.
class ViewBookmarks : public QObject {
    Q_OBJECT

  public:
    static constexpr int most_of_a_mesh = 40, most_meshes = 50;

    explicit ViewBookmarks(QObject* parent = nullptr);

    /// The bookmarks are those of this file from here on; "" = of none, and nothing can be added.
    void set_mesh(const QString& path);
    const QString& mesh() const { return path_; }
    const QList<ViewBookmark>& list() const { return list_; }
    bool is_full() const { return list_.size() >= most_of_a_mesh; }
    /// A name that none of them has.
    QString new_name() const;
    /// pre: not is_full(), a mesh is set.
    void add(const ViewBookmark& bookmark);
    void set_list(const QList<ViewBookmark>& list);

  signals:
    void changed();

  private:
    void read();
    void write() const;

    QString path_;
    QList<ViewBookmark> list_;
};

}  // namespace curvewright
