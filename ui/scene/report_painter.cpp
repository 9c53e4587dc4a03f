#include "ui/scene/report_painter.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

#include "ui/palette/quality_colors.h"
#include "ui/scene/offscreen.h"

namespace curvewright {
namespace {

/// Of the element's ball: what is seen around it, half the picture's height, and as far as its corners.
constexpr double seen = 1.8, reach = 5.0;

std::string css(const Color& color) {
    const auto byte = [](double channel) { return static_cast<int>(std::lround(255.0 * channel)); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(color[0]), byte(color[1]), byte(color[2]));
}

SceneOptions picture_options() {
    SceneOptions options;
    options.show_legend = false;
    return options;
}

QualityReport part_of(const QualityReport& quality, const std::vector<Index>& elements) {
    QualityReport part = quality;
    part.elements.clear();
    for (const Index element : elements) part.elements.push_back(quality.elements[static_cast<std::size_t>(element)]);
    return part;
}

}  // namespace

/// An element and what is around it, as a mesh of its own: drawn as finely as the picture needs, and quickly.
struct ReportPainter::Surroundings {
    Index element = 0, local = 0;
    Eigen::RowVector3d center;
    double radius = 0.0;
    std::shared_ptr<const CurvedMesh> before, after;
    QualityReport quality_before, quality_after;

    void cut_out(const State& was, const State& is, const std::vector<Index>& elements) {
        const MeshTopology& topology = was.mesh.topology();
        MeshData data;
        std::vector<Index> nodes;  // of the whole mesh
        std::unordered_map<Index, Index> number_of;
        for (std::size_t i = 0; i < elements.size(); ++i) {
            const Index each = elements[i];
            if (each == element) local = static_cast<Index>(i);
            const ElementType type = topology.element_type(each);
            if (data.blocks.empty() || data.blocks.back().type != type) data.blocks.push_back({type, 0, {}, {}});
            ElementBlock& block = data.blocks.back();
            block.tags.push_back(topology.element_tag(each));
            for (const Index node : topology.element_nodes(each)) {
                const auto [found, is_new] = number_of.try_emplace(node, static_cast<Index>(nodes.size()));
                if (is_new) {
                    nodes.push_back(node);
                    data.node_tags.push_back(topology.node_tag(node));
                }
                block.nodes.push_back(found->second);
            }
        }
        Coordinates positions_before(static_cast<Eigen::Index>(nodes.size()), 3), positions_after = positions_before;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            positions_before.row(static_cast<Eigen::Index>(i)) = was.mesh.coordinates().row(nodes[i]);
            positions_after.row(static_cast<Eigen::Index>(i)) = is.mesh.coordinates().row(nodes[i]);
        }
        before = std::make_shared<const CurvedMesh>(std::make_shared<const MeshTopology>(std::move(data)),
                                                    std::move(positions_before));
        after = std::make_shared<const CurvedMesh>(before->with_coordinates(std::move(positions_after)));
        quality_before = part_of(was.quality, elements);
        quality_after = part_of(is.quality, elements);
    }
};

ReportColors report_colors() {
    return {[](double scaled_jacobian) { return css(quality_map(scaled_jacobian)); }, css(tangled_color()),
            css(undecided_color())};
}

ReportPainter::ReportPainter(const CurvedMesh& before, const QualityReport& quality_before, const CurvedMesh& after,
                             const QualityReport& quality_after)
    : before_{before, quality_before}, after_{after, quality_after} {
    scene_.set_options(picture_options());
}

ReportPainter::~ReportPainter() = default;

std::string ReportPainter::paint(const PictureWish& wish) {
    return wish.element ? paint_element(wish) : paint_whole(wish);
}

// The camera is set on the mesh as it was, so that both pictures of a pair are taken from the same place.

std::string ReportPainter::paint_whole(const PictureWish& wish) {
    scene_.set_highlighted_elements({});
    scene_.set_mesh(&before_.mesh, &before_.quality);
    scene_.look(ViewDirection::isometric);
    if (wish.is_result) scene_.set_mesh(&after_.mesh, &after_.quality);
    return draw_png(scene_, wish.width, wish.height);
}

std::string ReportPainter::paint_element(const PictureWish& wish) {
    if (!surroundings_ || surroundings_->element != *wish.element) {
        auto around = std::make_unique<Surroundings>();
        around->element = *wish.element;
        // All of it, as it was and as it is.
        Eigen::MatrixX3d x = before_.mesh.element_coordinates(around->element);
        const Eigen::Index count = x.rows();
        x.conservativeResize(2 * count, Eigen::NoChange);
        x.bottomRows(count) = after_.mesh.element_coordinates(around->element);
        around->center = 0.5 * (x.colwise().minCoeff() + x.colwise().maxCoeff());
        around->radius = (x.rowwise() - around->center).rowwise().norm().maxCoeff();
        around->cut_out(before_, after_, neighbours(around->element, around->center, around->radius));
        scene_.set_mesh(nullptr, nullptr);
        surroundings_ = std::move(around);
    }
    const Surroundings& around = *surroundings_;
    scene_.set_highlighted_elements({});
    scene_.set_mesh(around.before.get(), &around.quality_before);
    scene_.look(ViewDirection::isometric);
    scene_.focus_ball(around.center, seen * around.radius);
    if (wish.is_result) scene_.set_mesh(around.after.get(), &around.quality_after);
    scene_.set_highlighted_elements({around.local});
    return draw_png(scene_, wish.width, wish.height);
}

/// The element and those that are seen with it, ascending. In 3D: those that share a node with it, but for those in
/// front of it.
std::vector<Index> ReportPainter::neighbours(Index element, const Eigen::RowVector3d& center, double radius) {
    const CurvedMesh& mesh = before_.mesh;
    const MeshTopology& topology = mesh.topology();
    std::vector<Index> result{element};
    if (topology.dimension() == 3) {
        if (!node_elements_) node_elements_ = elements_of_nodes(topology);
        const Eigen::RowVector3d middle = mesh.element_center(element), to_eye(1.0, -1.3, 0.85);
        for (const Index node : topology.element_nodes(element))
            for (const Index other : node_elements_->of(node))
                if (other != element && (mesh.element_center(other) - middle).dot(to_eye) <= 0.0)
                    result.push_back(other);
    } else {
        for (Index other = 0; other < topology.element_count(); ++other) {
            const Eigen::MatrixX3d x = mesh.element_coordinates(other);
            const bool is_near = ((x.colwise().minCoeff() - center).array() <= reach * radius).all() &&
                                 ((x.colwise().maxCoeff() - center).array() >= -reach * radius).all();
            if (is_near) result.push_back(other);
        }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

}  // namespace curvewright
