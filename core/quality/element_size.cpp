#include "core/quality/element_size.h"

#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include <Eigen/Geometry>

#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/quadrature.h"

namespace curvewright {
namespace {

/// Gradients of the shape functions at the points of a rule that is exact for J.
struct SizeRule {
    BasisTable basis;
    Eigen::VectorXd weights;
};

const SizeRule& size_rule(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, SizeRule> cache;
    const std::lock_guard lock(mutex);
    auto [entry, is_new] = cache.try_emplace(type);
    if (is_new) {
        // J is a product of one derivative per direction: on simplices of degree dim (p - 1) in total, otherwise of
        // degree dim p - 1 in each direction.
        const int dim = dimension(type.shape);
        const int degree = is_simplex(type.shape) ? dim * (type.order - 1) : dim * type.order - 1;
        try {
            const QuadratureRule rule = quadrature(type.shape, std::max(degree, 1));
            entry->second = {lagrange_basis(type, rule.points), rule.weights};
        } catch (...) {
            cache.erase(entry);
            throw;
        }
    }
    return entry->second;
}

double size_of(const SizeRule& rule, int dim, const Eigen::MatrixX3d& x) {
    std::array<Eigen::MatrixX3d, 3> tangents;
    for (int d = 0; d < dim; ++d) tangents[d] = rule.basis.gradients[d] * x;
    double size = 0.0;
    for (Eigen::Index q = 0; q < rule.weights.size(); ++q) {
        const Eigen::Vector3d u = tangents[0].row(q).transpose();
        double measure = u.norm();
        if (dim > 1) {
            const Eigen::Vector3d normal = u.cross(Eigen::Vector3d(tangents[1].row(q).transpose()));
            measure = dim == 2 ? normal.norm() : std::abs(normal.dot(tangents[2].row(q).transpose()));
        }
        size += rule.weights[q] * measure;
    }
    return size;
}

}  // namespace

std::vector<double> element_sizes(const CurvedMesh& mesh, const TaskContext& context) {
    const MeshTopology& topology = mesh.topology();
    std::vector<double> sizes(static_cast<std::size_t>(topology.element_count()));
    parallel_for(sizes.size(), 64, context, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto element = static_cast<Index>(i);
            const ElementType type = topology.element_type(element);
            if (type.shape == Shape::pyramid) {
                sizes[i] = std::numeric_limits<double>::quiet_NaN();
                continue;
            }
            sizes[i] = size_of(size_rule(type), dimension(type.shape), mesh.element_coordinates(element));
        }
    });
    return sizes;
}

}  // namespace curvewright
