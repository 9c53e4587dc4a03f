#include "core/untangle/face_nodes.h"

#include <stdexcept>

#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

Eigen::RowVectorXd mean_weights(const ReferenceElement& element) {
    Eigen::RowVectorXd weights = Eigen::RowVectorXd::Zero(element.node_count());
    for (const SubElement& edge : element.edges)
        for (std::size_t i = 2; i < edge.nodes.size(); ++i) weights[edge.nodes[i]] = 1.0;
    return weights / weights.sum();
}

Eigen::RowVectorXd blend_weights(const ReferenceElement& element, LatticePoint point) {
    const double p = element.type.order;
    const std::array<double, 3> barycentric{(p - point[0] - point[1]) / p, point[0] / p, point[1] / p};
    Eigen::RowVectorXd weights = Eigen::RowVectorXd::Zero(element.node_count());
    for (int corner = 0; corner < 3; ++corner) weights[corner] = barycentric[corner];
    for (const SubElement& edge : element.edges) {
        const double a = barycentric[edge.nodes[0]], b = barycentric[edge.nodes[1]], s = 0.5 * (1.0 + b - a);
        const double extension = a * b / (s * (1.0 - s));
        const Eigen::RowVectorXd curve = lagrange_basis(edge.type, Eigen::RowVector3d(s, 0.0, 0.0)).values.row(0);
        for (std::size_t i = 0; i < edge.nodes.size(); ++i)
            weights[edge.nodes[i]] += extension * curve[static_cast<Eigen::Index>(i)];
        weights[edge.nodes[0]] -= extension * (1.0 - s);
        weights[edge.nodes[1]] -= extension * s;
    }
    return weights;
}

}  // namespace

FaceNodes::FaceNodes(int order, FaceRule rule) {
    const ReferenceElement& element = reference_element({Shape::triangle, order});
    if (rule == FaceRule::mean && order > 3) throw std::invalid_argument("the mean is for triangles of order 3");
    local_nodes_ = &element.interior_nodes;
    weights_.resize(static_cast<Eigen::Index>(local_nodes_->size()), element.node_count());
    for (Eigen::Index i = 0; i < weights_.rows(); ++i)
        weights_.row(i) = rule == FaceRule::mean ? mean_weights(element)
                                                 : blend_weights(element, element.lattice[(*local_nodes_)[i]]);
}

void FaceNodes::place(std::span<const Index> nodes, Coordinates& x, const KeptNodes* kept) const {
    // Relative to a corner, so that rounding does not grow with the distance from the origin.
    const Eigen::RowVector2d origin = x.row(nodes[0]).head<2>();
    for (Eigen::Index i = 0; i < weights_.rows(); ++i) {
        if (kept && kept->is_kept(nodes[(*local_nodes_)[i]])) continue;
        Eigen::RowVector2d sum = Eigen::RowVector2d::Zero();
        for (std::size_t j = 1; j < nodes.size(); ++j) {
            const double weight = weights_(i, static_cast<Eigen::Index>(j));
            if (weight != 0.0) sum += weight * (x.row(nodes[j]).head<2>() - origin);
        }
        x.row(nodes[(*local_nodes_)[i]]).head<2>() = origin + sum;
    }
}

}  // namespace curvewright
