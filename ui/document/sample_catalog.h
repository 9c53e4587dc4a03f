#pragma once

#include <optional>

#include <QString>
#include <QStringList>
#include <QVector>

#include "core/untangle/untangle_options.h"
#include "core/warp/warp.h"

namespace curvewright {

/// One sample mesh, as sample_meshes/MANIFEST lists it. Paths are absolute.
struct Sample {
    QString name, title, description, look_for;
    QString mesh_path, deformation_path, thumbnail_path;
    int chapter = 0;              ///< of the thesis, 2 to 4; 0: none of its examples
    QStringList figures, tables;  ///< of the thesis, such as "2.5"
    int dimension = 2, order = 1;
    long long elements = 0;
    enum class Task { warp, untangle } task = Task::warp;
    /// The mesh file holds the boundary already deformed.
    bool is_deformed = false;
    Weighting weighting = Weighting::convex;
    UntangleMethod method = UntangleMethod::guaranteed;
    /// The method as it was published, without what this program adds to it.
    bool is_as_published = false;
    std::optional<double> beta;            ///< of signed angles; none: chosen for every edge
    std::optional<double> result_minimum;  ///< scaled Jacobian that the method, so set up, reaches

    /// "Figure 2.5"; empty if there is none.
    QString figures_text() const;
    /// "Figure 2.5 · Tables 2.3, 2.4"; empty if it is nowhere in the thesis.
    QString reference() const;
    /// False for a large mesh that has not been made yet.
    bool is_there() const;
    /// How to make it, in a sentence.
    QString how_to_make() const;
};

/// "Chapter 2: warping"; what belongs to no chapter has a title too.
QString chapter_title(int chapter);

/// The samples that belong to this program. Looks in $CURVEWRIGHT_SAMPLES, then beside the program as it is built
/// (../../sample_meshes) and installed (../share/curvewright/sample_meshes), and in the sources that it was built from.
class SampleCatalog {
  public:
    /// Reads the catalog; empty (with error() telling why) if there is none or it is malformed.
    static SampleCatalog load();
    static SampleCatalog load(const QString& folder);

    const QVector<Sample>& samples() const { return samples_; }
    /// Those that the catalog has samples of, in order; those without a chapter last.
    QVector<int> chapters() const;
    QVector<Sample> of_chapter(int chapter) const;
    const Sample* find(const QString& name) const;
    const QString& error() const { return error_; }

  private:
    QVector<Sample> samples_;
    QString error_;
};

}  // namespace curvewright
