#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/mesh/node_elements.h"
#include "core/report/report_charts.h"
#include "core/report/report_pictures.h"
#include "ui/scene/mesh_scene.h"

namespace curvewright {

/// The colours of the scaled Jacobian, for a report.
ReportColors report_colors();

/// Draws the pictures of a report without a window, always in the same way: light, with the default colours.
class ReportPainter {
  public:
    /// All of them must live as long as the painter.
    ReportPainter(const CurvedMesh& before, const QualityReport& quality_before, const CurvedMesh& after,
                  const QualityReport& quality_after);
    ~ReportPainter();

    /// The bytes of a PNG file. Throws Unsupported where nothing can be drawn (see render_png).
    std::string paint(const PictureWish& wish);

  private:
    struct State {
        const CurvedMesh& mesh;
        const QualityReport& quality;
    };
    struct Surroundings;

    std::string paint_whole(const PictureWish& wish);
    std::string paint_element(const PictureWish& wish);
    std::vector<Index> neighbours(Index element, const Eigen::RowVector3d& center, double radius);

    State before_, after_;
    MeshScene scene_;
    std::optional<NodeElements> node_elements_;   ///< 3D
    std::unique_ptr<Surroundings> surroundings_;  ///< of the element that was painted last
};

}  // namespace curvewright
