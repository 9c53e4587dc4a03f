#include "tests/scene/scene_meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/mesh/elevate.h"

namespace curvewright {
namespace {

CurvedMesh make_mesh(Shape shape, const std::vector<std::array<double, 3>>& points, const std::vector<Index>& nodes) {
    MeshData data;
    Coordinates x(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        data.node_tags.push_back({static_cast<std::int64_t>(i) + 1});
        x.row(static_cast<Eigen::Index>(i)) << points[i][0], points[i][1], points[i][2];
    }
    ElementBlock block{{shape, 1}, 0, nodes, {}};
    for (std::size_t e = 0; e < nodes.size() / corner_count(shape); ++e)
        block.tags.push_back({static_cast<std::int64_t>(e) + 1});
    data.blocks.push_back(block);
    return {std::make_shared<MeshTopology>(std::move(data)), std::move(x)};
}

}  // namespace

CurvedMesh make_ring(double unit, const Eigen::RowVector3d& offset) {
    constexpr int around = 9, across = 2;
    std::vector<std::array<double, 3>> points;
    std::vector<Index> nodes;
    for (int j = 0; j <= across; ++j)
        for (int i = 0; i <= around; ++i) points.push_back({double(i) / around, double(j) / across, 0.0});
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < around; ++i) {
            const Index a = j * (around + 1) + i;
            for (Index corner : {a, a + around + 2, a + 1, a, a + around + 1, a + around + 2}) nodes.push_back(corner);
        }
    const CurvedMesh straight = elevate(make_mesh(Shape::triangle, points, nodes), 3);
    Coordinates x = straight.coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const double angle = 1.5 * std::numbers::pi * x(i, 0), radius = 1.0 + x(i, 1);
        x.row(i) << radius * std::cos(angle), radius * std::sin(angle), 0.0;
    }
    // The inner nodes of the element's side on the hole (its corners are 0 and 2, its side nodes 7 and 8).
    const auto element = straight.topology().element_nodes(tangled_ring_element);
    for (int node : {7, 8}) x.row(element[node]) *= 1.6;
    x = unit * x;
    x.rowwise() += offset;
    return straight.with_coordinates(x);
}

CurvedMesh make_ball() {
    constexpr int n = 4;
    std::vector<std::array<double, 3>> points;
    const auto at = [](int i, int j, int k) { return static_cast<Index>((k * (n + 1) + j) * (n + 1) + i); };
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) points.push_back({2.0 * i / n - 1.0, 2.0 * j / n - 1.0, 2.0 * k / n - 1.0});
    std::vector<Index> nodes;
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                std::array<int, 3> axes{0, 1, 2};
                do {
                    std::array<int, 3> corner{i, j, k};
                    std::array<Index, 4> its{at(i, j, k)};
                    for (std::size_t step = 0; step < 3; ++step) {
                        ++corner[static_cast<std::size_t>(axes[step])];
                        its[step + 1] = at(corner[0], corner[1], corner[2]);
                    }
                    const bool is_even =
                        axes == std::array{0, 1, 2} || axes == std::array{1, 2, 0} || axes == std::array{2, 0, 1};
                    if (!is_even) std::swap(its[1], its[2]);
                    nodes.insert(nodes.end(), its.begin(), its.end());
                } while (std::next_permutation(axes.begin(), axes.end()));
            }
    const CurvedMesh cube = elevate(make_mesh(Shape::tetrahedron, points, nodes), 2);
    Coordinates x = cube.coordinates();
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const double length = x.row(i).norm();
        if (length > 0.0) x.row(i) *= x.row(i).cwiseAbs().maxCoeff() / length;
    }
    return cube.with_coordinates(x);
}

QualityReport make_report(const CurvedMesh& mesh, const std::vector<Index>& tangled,
                          const std::vector<Index>& undecided) {
    QualityReport report;
    report.elements.resize(static_cast<std::size_t>(mesh.topology().element_count()));
    report.summary.min = 1.0;
    for (std::size_t i = 0; i < report.elements.size(); ++i) {
        ElementQuality& its = report.elements[i];
        const auto index = static_cast<Index>(i);
        its.validity = Validity::valid;
        its.scaled_jacobian = 0.35 + 0.65 * static_cast<double>((7 * i) % 11) / 10.0;
        if (std::find(tangled.begin(), tangled.end(), index) != tangled.end()) {
            its.validity = Validity::invalid;
            its.scaled_jacobian = -0.125;
        } else if (std::find(undecided.begin(), undecided.end(), index) != undecided.end()) {
            its.validity = Validity::undecided;
            its.scaled_jacobian = 0.01;
        }
        report.summary.min = std::min(report.summary.min, its.scaled_jacobian);
        report.summary.max = std::max(report.summary.max, its.scaled_jacobian);
        report.summary.mean += its.scaled_jacobian / static_cast<double>(report.elements.size());
    }
    report.summary.invalid = static_cast<Index>(tangled.size());
    report.summary.undecided = static_cast<Index>(undecided.size());
    report.summary.valid = mesh.topology().element_count() - report.summary.invalid - report.summary.undecided;
    return report;
}

}  // namespace curvewright
