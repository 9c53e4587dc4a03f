#pragma once

#include <optional>

#include <QString>
#include <QVector>

namespace curvewright {

/// One sample mesh, as sample_meshes/MANIFEST lists it. Paths are absolute.
struct Sample {
    QString name, title, description;
    QString mesh_path, deformation_path, thumbnail_path;
    int dimension = 2, order = 1;
    long long elements = 0;
    enum class Task { warp, untangle } task = Task::warp;
    /// The mesh file holds the boundary already deformed.
    bool is_deformed = false;
    std::optional<double> beta;  ///< that untangles it by signed angles
};

/// The samples that belong to this program. Looks in $CURVEWRIGHT_SAMPLES, then beside the program as it is built
/// (../../sample_meshes) and installed (../share/curvewright/sample_meshes), and in the sources that it was built from.
class SampleCatalog {
  public:
    /// Reads the catalog; empty (with error() telling why) if there is none or it is malformed.
    static SampleCatalog load();
    static SampleCatalog load(const QString& folder);

    const QVector<Sample>& samples() const { return samples_; }
    const Sample* find(const QString& name) const;
    const QString& error() const { return error_; }

  private:
    QVector<Sample> samples_;
    QString error_;
};

}  // namespace curvewright
