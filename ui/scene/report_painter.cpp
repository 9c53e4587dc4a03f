#include "ui/scene/report_painter.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ui/palette/quality_colors.h"
#include "ui/scene/offscreen.h"

namespace curvewright {
namespace {

std::string css(const Color& color) {
    const auto byte = [](double channel) { return static_cast<int>(std::lround(255.0 * channel)); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(color[0]), byte(color[1]), byte(color[2]));
}

}  // namespace

ReportColors report_colors() {
    return {[](double scaled_jacobian) { return css(quality_map(scaled_jacobian)); }, css(tangled_color()),
            css(undecided_color())};
}

ReportPainter::ReportPainter(const CurvedMesh& before, const QualityReport& quality_before, const CurvedMesh& after,
                             const QualityReport& quality_after)
    : before_(before), after_(after), quality_before_(quality_before), quality_after_(quality_after) {}

std::string ReportPainter::paint(const PictureWish& wish) {
    SceneOptions options;
    options.show_legend = false;
    scene_.set_options(options);
    scene_.set_highlighted_elements({});
    // The camera is set on the mesh as it was, so that both pictures of a pair are taken from the same place.
    scene_.set_mesh(&before_, &quality_before_);
    scene_.look(ViewDirection::isometric);
    if (wish.element) look_at(*wish.element);
    if (wish.is_result) scene_.set_mesh(&after_, &quality_after_);
    return draw_png(scene_, wish.width, wish.height);
}

void ReportPainter::look_at(Index element) {
    const MeshTopology& topology = before_.topology();
    // All of it, as it was and as it is.
    Eigen::MatrixX3d x = before_.element_coordinates(element);
    const Eigen::Index count = x.rows();
    x.conservativeResize(2 * count, Eigen::NoChange);
    x.bottomRows(count) = after_.element_coordinates(element);
    const Eigen::RowVector3d center = 0.5 * (x.colwise().minCoeff() + x.colwise().maxCoeff());
    const double radius = (x.rowwise() - center).rowwise().norm().maxCoeff();
    if (topology.dimension() == 3) {
        if (!node_elements_) node_elements_ = elements_of_nodes(topology);
        const Eigen::RowVector3d to_eye = scene_.view_axes().col(2).transpose();
        const Eigen::RowVector3d middle = before_.element_center(element);
        std::vector<Index> shown{element};
        for (const Index node : topology.element_nodes(element))
            for (const Index other : node_elements_->of(node))
                if (other != element && (before_.element_center(other) - middle).dot(to_eye) <= 0.0)
                    shown.push_back(other);
        std::sort(shown.begin(), shown.end());
        shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
        SceneOptions options = scene_.options();
        options.only_elements = std::move(shown);
        scene_.set_options(options);
    }
    scene_.set_highlighted_elements({element});
    constexpr double room = 1.8;
    scene_.focus_ball(center, room * radius);
}

}  // namespace curvewright
