#include "core/untangle/unmendable.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/LU>

#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"
#include "core/quality/jacobian_bounds.h"

namespace curvewright {
namespace {

/// Upper bound of max over x in [-radius, radius]^d of min over rows of values + slopes x, by the simplex method on the
/// dual program: minimise values·w + radius |slopes^T w|_1 over w >= 0 with sum w = 1. Any such w gives a bound, so
/// ending early costs tightness only.
double largest_minimum(const Eigen::VectorXd& values, const Eigen::MatrixXd& slopes, double radius) {
    const Eigen::Index rows = values.size(), dim = slopes.cols(), size = dim + 1;
    // Columns: the rows' (1, slope), then for every coordinate -e and +e at the cost of the radius.
    const Eigen::Index columns = rows + 2 * dim;
    Eigen::MatrixXd table = Eigen::MatrixXd::Zero(size, columns);
    Eigen::VectorXd cost(columns);
    table.row(0).head(rows).setOnes();
    table.block(1, 0, dim, rows) = slopes.transpose();
    cost.head(rows) = values;
    cost.tail(2 * dim).setConstant(radius);
    for (Eigen::Index d = 0; d < dim; ++d) {
        table(d + 1, rows + 2 * d) = -1.0;
        table(d + 1, rows + 2 * d + 1) = 1.0;
    }
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(size);
    wanted[0] = 1.0;
    std::vector<Eigen::Index> basis = {0};
    for (Eigen::Index d = 0; d < dim; ++d) basis.push_back(rows + 2 * d + (slopes(0, d) > 0.0 ? 0 : 1));
    Eigen::MatrixXd square(size, size);
    Eigen::VectorXd basic_cost(size), weights(size);
    constexpr int most_pivots = 500;
    for (int pivot = 0; pivot < most_pivots; ++pivot) {
        for (Eigen::Index i = 0; i < size; ++i) {
            square.col(i) = table.col(basis[static_cast<std::size_t>(i)]);
            basic_cost[i] = cost[basis[static_cast<std::size_t>(i)]];
        }
        const Eigen::PartialPivLU<Eigen::MatrixXd> solver(square);
        weights = solver.solve(wanted);
        const Eigen::VectorXd prices = square.transpose().partialPivLu().solve(basic_cost);
        // Bland's rule: the first column that pays, and the first of the rows that give way soonest.
        Eigen::Index entering = -1;
        for (Eigen::Index c = 0; c < columns && entering < 0; ++c)
            if (cost[c] - prices.dot(table.col(c)) < -1e-12) entering = c;
        if (entering < 0) break;
        const Eigen::VectorXd direction = solver.solve(table.col(entering));
        Eigen::Index leaving = -1;
        double step = std::numeric_limits<double>::infinity();
        for (Eigen::Index i = 0; i < size; ++i)
            if (direction[i] > 1e-12) {
                const double ratio = std::max(0.0, weights[i]) / direction[i];
                if (ratio < step ||
                    (ratio == step && basis[static_cast<std::size_t>(i)] < basis[static_cast<std::size_t>(leaving)])) {
                    step = ratio;
                    leaving = i;
                }
            }
        if (leaving < 0) break;
        basis[static_cast<std::size_t>(leaving)] = entering;
    }
    Eigen::VectorXd w = Eigen::VectorXd::Zero(rows);
    for (Eigen::Index i = 0; i < size; ++i)
        if (const Eigen::Index c = basis[static_cast<std::size_t>(i)]; c < rows) w[c] = std::max(0.0, weights[i]);
    const double sum = w.sum();
    if (!(sum > 0.0)) return std::numeric_limits<double>::infinity();
    w /= sum;
    return values.dot(w) + radius * (slopes.transpose() * w).lpNorm<1>();
}

/// J at the samples of an element whose largest extent is one.
struct Samples {
    ElementType type;
    BasisTable basis;
    explicit Samples(ElementType t)
        : type(t),
          basis(lagrange_basis(t, reference_nodes({t.shape, std::min(max_order, dimension(t.shape) * t.order)}))) {}

    Eigen::VectorXd jacobians(const Eigen::MatrixX3d& x, double sign) const {
        const int dim = dimension(type.shape);
        std::array<Eigen::MatrixXd, 3> derivative;
        for (int k = 0; k < dim; ++k)
            derivative[static_cast<std::size_t>(k)] = basis.gradients[static_cast<std::size_t>(k)] * x.leftCols(dim);
        Eigen::VectorXd result(derivative[0].rows());
        for (Eigen::Index q = 0; q < result.size(); ++q) {
            Eigen::MatrixXd jacobian(dim, dim);
            for (int k = 0; k < dim; ++k) jacobian.row(k) = derivative[static_cast<std::size_t>(k)].row(q);
            result[q] = sign * jacobian.determinant();
        }
        return result;
    }
};

}  // namespace

std::optional<Impossibility> find_impossibility(const CurvedMesh& mesh, Index element, double sign,
                                                const std::function<bool(Index node)>& may_move) {
    const MeshTopology& topology = mesh.topology();
    const ElementType type = topology.element_type(element);
    const auto nodes = topology.element_nodes(element);
    const ReferenceElement& reference = reference_element(type);
    Eigen::MatrixX3d x = mesh.element_coordinates(element);
    const Eigen::RowVector3d center = x.colwise().mean();
    x.rowwise() -= center;
    const double extent = x.cwiseAbs().maxCoeff();
    if (!(extent > 0.0)) return std::nullopt;
    x /= extent;
    const int dim = reference.dimension;

    // The corners are among the samples' points as much as among the Bézier points, where the rounding is known.
    JacobianBounds bounds(type);
    bounds.compute(x, sign);
    const double unit = std::scalbn(1.0, bounds.exponent());
    const double rounding = bounds.coefficient_error() * unit;
    const Samples samples(type);
    const Eigen::VectorXd now = samples.jacobians(x, sign);
    const double scale = now.cwiseAbs().maxCoeff();
    if (!(scale > 0.0)) return std::nullopt;

    std::vector<int> movable;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (may_move(nodes[i])) movable.push_back(static_cast<int>(i));

    std::optional<Impossibility> worst;
    for (int corner = 0; corner <= dim; ++corner) {
        const bool depends = std::any_of(reference.edges.begin(), reference.edges.end(), [&](const SubElement& edge) {
            return (edge.nodes[0] == corner || edge.nodes[1] == corner) &&
                   std::any_of(edge.nodes.begin(), edge.nodes.end(),
                               [&](int n) { return std::find(movable.begin(), movable.end(), n) != movable.end(); });
        });
        if (depends) continue;
        Eigen::Index q = 0;
        const Eigen::MatrixX3d points =
            reference_nodes({type.shape, std::min(max_order, dimension(type.shape) * type.order)});
        Eigen::RowVector3d at = Eigen::RowVector3d::Zero();
        if (corner > 0) at[corner - 1] = 1.0;
        (points.rowwise() - at).rowwise().squaredNorm().minCoeff(&q);
        if (now[q] > rounding) continue;
        const double bound = (now[q] + rounding) / scale;
        if (worst && worst->bound <= bound) continue;
        const char* const who =
            movable.empty() ? "none of the element's nodes may move" : "none of the nodes that it depends on may move";
        const auto tag = topology.node_tag(nodes[static_cast<std::size_t>(corner)]).value;
        worst = Impossibility{bound,
                              now[q] < -rounding
                                  ? fmt::format("J at its corner at node {} stays {:.2g} of its largest |J|: {}", tag,
                                                now[q] / scale, who)
                                  : fmt::format("J at its corner at node {} stays zero up to rounding: {}", tag, who)};
    }
    if (worst) return worst;
    if (movable.empty()) {
        Eigen::Index q = 0;
        const double least = now.minCoeff(&q);
        if (!(least < -rounding)) return std::nullopt;
        return Impossibility{
            (least + rounding) / scale,
            fmt::format("J has the value {:.2g} of its largest |J| in it: none of its nodes may move", least / scale)};
    }
    if (movable.size() > 1) return std::nullopt;

    const int free = movable[0];
    Eigen::MatrixXd slopes(now.size(), dim);
    Eigen::MatrixX3d moved = x;
    for (int d = 0; d < dim; ++d) {
        moved = x;
        moved(free, d) += 1.0;
        slopes.col(d) = samples.jacobians(moved, sign) - now;
    }
    constexpr double radius = 1000.0;
    // The slopes are differences of values with these rounding errors.
    const double slack = (1.0 + 2.0 * dim * radius) * (rounding + 1e-14 * scale);
    const double bound = largest_minimum(now, slopes, radius) + slack;
    if (bound > 0.0) return std::nullopt;
    return Impossibility{
        bound / scale, fmt::format("wherever its only node that may move ({}) goes, J is at most {:.2g} of its largest "
                                   "|J| somewhere in the element",
                                   topology.node_tag(nodes[static_cast<std::size_t>(free)]).value, bound / scale)};
}

}  // namespace curvewright
