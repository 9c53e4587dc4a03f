#include "core/untangle/unmendable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

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
    constexpr int most_pivots = 200;
    for (int pivot = 0; pivot < most_pivots; ++pivot) {
        for (Eigen::Index i = 0; i < size; ++i) {
            square.col(i) = table.col(basis[static_cast<std::size_t>(i)]);
            basic_cost[i] = cost[basis[static_cast<std::size_t>(i)]];
        }
        const Eigen::PartialPivLU<Eigen::MatrixXd> solver(square);
        weights = solver.solve(wanted);
        const Eigen::VectorXd prices = square.transpose().partialPivLu().solve(basic_cost);
        Eigen::Index entering = 0;
        if (!((cost - table.transpose() * prices).minCoeff(&entering) < -1e-12)) break;
        const Eigen::VectorXd direction = solver.solve(table.col(entering));
        Eigen::Index leaving = -1;
        double step = std::numeric_limits<double>::infinity();
        for (Eigen::Index i = 0; i < size; ++i)
            if (direction[i] > 1e-12) {
                const double ratio = std::max(0.0, weights[i]) / direction[i];
                if (ratio < step) {
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

/// Points at which J is looked at: the lattice of its degree, with the corners first.
struct Samples {
    ElementType type;
    BasisTable basis;
    explicit Samples(ElementType t) : type(t), basis(lagrange_basis(t, points(t))) {}

    static Eigen::MatrixX3d points(ElementType type) {
        const int degree = dimension(type.shape) * (type.order - 1);
        return reference_nodes({type.shape, std::clamp(degree, 1, max_order)});
    }
    Eigen::VectorXd jacobians(const Eigen::MatrixX3d& x, double sign) const {
        const int dim = dimension(type.shape);
        std::array<Eigen::MatrixXd, 3> derivative;
        for (std::size_t k = 0; k < static_cast<std::size_t>(dim); ++k)
            derivative[k] = basis.gradients[k] * x.leftCols(dim);
        Eigen::VectorXd result(derivative[0].rows());
        Eigen::MatrixXd jacobian(dim, dim);
        for (Eigen::Index q = 0; q < result.size(); ++q) {
            for (int k = 0; k < dim; ++k) jacobian.row(k) = derivative[static_cast<std::size_t>(k)].row(q);
            result[q] = sign * jacobian.determinant();
        }
        return result;
    }
};

/// An element in the unit of length in which the one in question has extent one; J in units of its largest |J|.
struct Judged {
    Samples samples;
    std::span<const Index> nodes;
    Eigen::MatrixX3d given;  ///< in the mesh's unit
    Eigen::MatrixX3d x;
    double unit, sign, scale = 0.0, rounding = 0.0;
    Eigen::VectorXd now;

    Judged(const CurvedMesh& mesh, Index element, const OrientationSigns& signs, const Eigen::RowVector3d& center,
           double extent)
        : samples(mesh.topology().element_type(element)),
          nodes(mesh.topology().element_nodes(element)),
          given(mesh.element_coordinates(element)),
          x((given.rowwise() - center) / extent),
          unit(extent),
          sign(signs.of_element(mesh.topology(), element)) {
        now = samples.jacobians(x, sign);
        scale = now.cwiseAbs().maxCoeff();
        if (!(scale > 0.0)) return;
        // The error of Bézier coefficients is one of values of J, too.
        JacobianBounds bounds(samples.type);
        bounds.compute(x, sign);
        rounding = std::scalbn(bounds.coefficient_error(), bounds.exponent()) / scale + 1e-14;
        now /= scale;
    }
    /// Derivative of J by the position of a node, samples × dimension.
    Eigen::MatrixXd slopes(int node) const {
        const int dim = dimension(samples.type.shape);
        Eigen::MatrixXd result(now.size(), dim);
        for (int d = 0; d < dim; ++d) {
            Eigen::MatrixX3d moved = x;
            moved(node, d) += 1.0;
            result.col(d) = samples.jacobians(moved, sign) / scale - now;
        }
        return result;
    }
    /// The element's movable nodes that J at a corner depends on; of all that J depends on if corner is -1.
    std::vector<int> movable(int corner, const std::function<bool(Index)>& may_move) const {
        std::vector<int> result;
        for (int n = 0; n < static_cast<int>(nodes.size()); ++n) {
            if (!may_move(nodes[static_cast<std::size_t>(n)])) continue;
            const auto& edges = reference_element(samples.type).edges;
            if (corner < 0 || std::any_of(edges.begin(), edges.end(), [&](const SubElement& edge) {
                    return (edge.nodes[0] == corner || edge.nodes[1] == corner) &&
                           std::find(edge.nodes.begin(), edge.nodes.end(), n) != edge.nodes.end();
                }))
                result.push_back(n);
        }
        return result;
    }
};

/// Bounds of the rounding error of what is made of an element's nodes at one of its corners. Differences to the
/// corner's position are exact up to half an ulp, so that edges that lie in an axis-parallel line give exact zeros.
struct CornerTangents {
    Eigen::MatrixXd tangents;  ///< d x / d xi_k in row k, unit as Judged
    Eigen::MatrixXd errors;    ///< of the entries

    CornerTangents(const Judged& element, int corner) {
        const int dim = dimension(element.samples.type.shape);
        const Eigen::MatrixXd steps =
            (element.given.leftCols(dim).rowwise() - element.given.row(corner).head(dim)) / element.unit;
        tangents.resize(dim, dim);
        errors.resize(dim, dim);
        const double roundings = static_cast<double>(element.x.rows() + 6) * std::numeric_limits<double>::epsilon();
        for (int k = 0; k < dim; ++k) {
            const auto weights = element.samples.basis.gradients[static_cast<std::size_t>(k)].row(corner);
            tangents.row(k) = weights * steps;
            errors.row(k) = roundings * (weights.cwiseAbs() * steps.cwiseAbs());
        }
    }
};

/// Sum of the products that a determinant is made of, all with a plus.
double permanent(const Eigen::MatrixXd& m) {
    if (m.rows() == 2) return m(0, 0) * m(1, 1) + m(0, 1) * m(1, 0);
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        sum += m(0, i) * (m(1, j) * m(2, k) + m(1, k) * m(2, j));
    }
    return sum;
}

/// Of the determinant of a matrix whose entries have errors.
double determinant_error(const Eigen::MatrixXd& m, const Eigen::MatrixXd& errors) {
    constexpr double unit = 16.0 * std::numeric_limits<double>::epsilon();
    const Eigen::MatrixXd size = m.cwiseAbs();
    return permanent(size + errors) - permanent(size) + unit * permanent(size + errors);
}

/// A linear form of a tangent, scaled to length one, and the error of its entries.
struct TangentForm {
    Eigen::VectorXd form;
    double error = 0.0;
};

/// J at a corner as a linear form of the tangent of the edge that goes from there to another corner, scaled to length
/// one; zero where the other tangents leave J no choice. None if their nodes may move.
std::optional<TangentForm> tangent_form(const Judged& element, int corner, int end,
                                        const std::function<bool(Index)>& may_move) {
    const ReferenceElement& reference = reference_element(element.samples.type);
    const int dim = reference.dimension;
    const Eigen::MatrixX3d points = reference_nodes({element.samples.type.shape, 1});
    Eigen::MatrixXd tangents(dim, dim), errors(dim, dim), directions(dim, dim);
    const CornerTangents here(element, corner);
    int row = 0, replaced = 0;
    for (int other = 0; other <= dim; ++other) {
        if (other == corner) continue;
        if (other == end) replaced = row;
        const Eigen::RowVector3d along = points.row(other) - points.row(corner);
        // along has entries -1, 0 and 1: sums of two rows at most.
        tangents.row(row) = along.head(dim) * here.tangents;
        errors.row(row) = 2.0 * along.head(dim).cwiseAbs() * here.errors;
        directions.row(row++) = along.head(dim);
    }
    for (const SubElement& edge : reference.edges) {
        const bool is_here = edge.nodes[0] == corner || edge.nodes[1] == corner;
        const bool is_the_one = edge.nodes[0] == end || edge.nodes[1] == end;
        if (is_here && !is_the_one && std::any_of(edge.nodes.begin(), edge.nodes.end(), [&](int n) {
                return may_move(element.nodes[static_cast<std::size_t>(n)]);
            }))
            return std::nullopt;
    }
    if (may_move(element.nodes[static_cast<std::size_t>(corner)])) return std::nullopt;
    Eigen::VectorXd form(dim);
    double error = 0.0;
    errors.row(replaced).setZero();
    for (int d = 0; d < dim; ++d) {
        tangents.row(replaced) = Eigen::RowVectorXd::Unit(dim, d);
        form[d] = element.sign * tangents.determinant() / directions.determinant();
        error += determinant_error(tangents, errors) / std::abs(directions.determinant());
    }
    if (form.norm() <= error) return TangentForm{Eigen::VectorXd::Zero(dim), error};
    return TangentForm{form.normalized(), error / form.norm()};
}

/// Upper bound of the largest least value that the forms have at a tangent of entries up to 1.
double largest_least(const std::vector<TangentForm>& forms) {
    if (forms.empty()) return std::numeric_limits<double>::infinity();
    const auto rows = static_cast<Eigen::Index>(forms.size());
    Eigen::MatrixXd table(rows, forms[0].form.size());
    for (Eigen::Index i = 0; i < rows; ++i) table.row(i) = forms[static_cast<std::size_t>(i)].form.transpose();
    return largest_minimum(Eigen::VectorXd::Zero(rows), table, 1.0);
}
/// Whether some tangent makes all forms positive, by more than a little.
bool is_possible(const std::vector<TangentForm>& forms) {
    constexpr double little = 1e-10;
    return largest_least(forms) > little;
}
/// Whether that is certain: none makes all of them positive by more than their own errors.
bool is_surely_impossible(const std::vector<TangentForm>& forms) {
    double error = 4.0 * std::numeric_limits<double>::epsilon();
    for (const TangentForm& form : forms) error = std::max(error, form.error);
    return largest_least(forms) <= error;
}

/// What J has to be at some points, as affine functions of one node's position.
struct Program {
    std::vector<double> values;
    std::vector<Eigen::VectorXd> slopes;
    double rounding = 0.0;

    void add(const Judged& element, Index node, const std::function<bool(Index)>& may_move) {
        const auto own =
            static_cast<int>(std::find(element.nodes.begin(), element.nodes.end(), node) - element.nodes.begin());
        const std::vector<int> alone{own};
        const bool is_whole = element.movable(-1, may_move) == alone;
        const int corners = corner_count(element.samples.type.shape);
        std::optional<Eigen::MatrixXd> slope;
        for (Eigen::Index q = 0; q < element.now.size(); ++q) {
            if (!is_whole && (q >= corners || element.movable(static_cast<int>(q), may_move) != alone)) continue;
            if (!slope) slope = element.slopes(own);
            values.push_back(element.now[q]);
            slopes.push_back(slope->row(q).transpose());
            rounding = std::max(rounding, element.rounding);
        }
    }
    /// radius: of the positions that are considered, in extents of the element.
    double bound(double radius = 1000.0) const {
        if (values.empty()) return std::numeric_limits<double>::infinity();
        const auto rows = static_cast<Eigen::Index>(values.size()), dim = slopes[0].size();
        Eigen::MatrixXd table(rows, dim);
        for (Eigen::Index i = 0; i < rows; ++i) table.row(i) = slopes[static_cast<std::size_t>(i)].transpose();
        // The slopes are differences of values.
        const double slack = (1.0 + 2.0 * static_cast<double>(dim) * radius) * rounding;
        return largest_minimum(Eigen::Map<const Eigen::VectorXd>(values.data(), rows), table, radius) + slack;
    }
};

/// Whether J at a corner is positive beyond its own rounding error, however small it is for the element.
bool is_surely_positive(const Judged& element, int corner) {
    const CornerTangents here(element, corner);
    return element.sign * here.tangents.determinant() > determinant_error(here.tangents, here.errors);
}

/// Whether a program without a solution within the usual distance has none at all: with the boundary as it is, nodes of
/// a valid mesh are in the hull of the boundary. Facets bulge out of the box of their nodes, but not as far as this.
bool is_without_solution(const Program& program, const CurvedMesh& mesh, double extent,
                         const std::function<bool(Index)>& may_move) {
    const auto& boundary = mesh.topology().boundary_nodes();
    if (std::any_of(boundary.begin(), boundary.end(), may_move)) return false;
    const Coordinates& x = mesh.coordinates();
    Eigen::RowVector3d low = x.row(boundary.front()), high = low;
    for (const Index node : boundary) {
        low = low.cwiseMin(x.row(node));
        high = high.cwiseMax(x.row(node));
    }
    const double reach = 4.0 * ((high - low).norm() + extent) / extent;
    return program.bound(std::max(reach, 1000.0)) <= 0.0;
}

}  // namespace

std::optional<Impossibility> find_impossibility(const CurvedMesh& mesh, Index element,
                                                const OrientationSigns& signs, const NodeElements& node_elements,
                                                const std::function<bool(Index node)>& may_move,
                                                const std::function<bool(Index element)>& is_given_up) {
    const MeshTopology& topology = mesh.topology();
    const Eigen::MatrixX3d x = mesh.element_coordinates(element);
    const Eigen::RowVector3d center = x.colwise().mean();
    const double extent = (x.rowwise() - center).cwiseAbs().maxCoeff();
    if (!is_simplex(topology.element_type(element).shape) || !(extent > 0.0)) return std::nullopt;
    const Judged judged(mesh, element, signs, center, extent);
    if (!(judged.scale > 0.0)) return std::nullopt;
    const auto tag = [&](int n) { return topology.node_tag(judged.nodes[static_cast<std::size_t>(n)]).value; };
    const std::vector<int> movable = judged.movable(-1, may_move);

    const int corners = corner_count(judged.samples.type.shape);
    int worst = -1;
    for (int corner = 0; corner < corners; ++corner)
        if (judged.now[corner] <= judged.rounding && judged.movable(corner, may_move).empty() &&
            (worst < 0 || judged.now[corner] < judged.now[worst]) && !is_surely_positive(judged, corner))
            worst = corner;
    if (worst >= 0) {
        const double value = judged.now[worst];
        return Impossibility{
            value + judged.rounding,
            fmt::format("J at its corner at node {} stays {}: none of the nodes that it depends on may move",
                        tag(worst),
                        value < -judged.rounding ? fmt::format("{:.2g} of its largest |J|", value)
                                                 : std::string("zero up to rounding"))};
    }
    if (movable.empty()) {
        const double least = judged.now.minCoeff();
        if (!(least < -judged.rounding)) return std::nullopt;
        return Impossibility{
            least + judged.rounding,
            fmt::format("J stays {:.2g} of its largest |J| inside: none of its nodes may move", least)};
    }

    for (int corner = 0; corner < corners; ++corner)
        for (int end = 0; end < corners; ++end) {
            const auto form = end == corner ? std::nullopt : tangent_form(judged, corner, end, may_move);
            if (!form) continue;
            if (form->form.isZero(0.0))
                return Impossibility{0.0,
                                     fmt::format("J at its corner at node {} stays zero up to rounding: two of the "
                                                 "edges there have the same direction, and none of their nodes may "
                                                 "move",
                                                 tag(corner))};
            const Index from = judged.nodes[static_cast<std::size_t>(corner)];
            const Index to = judged.nodes[static_cast<std::size_t>(end)];
            std::vector<TangentForm> forms;
            for (const Index other : node_elements.of(from)) {
                if (other == element || (is_given_up && is_given_up(other))) continue;
                const auto nodes = topology.element_nodes(other);
                const auto last = nodes.begin() + corner_count(topology.element_type(other).shape);
                const auto other_corner = std::find(nodes.begin(), last, from),
                           other_end = std::find(nodes.begin(), last, to);
                if (other_corner == last || other_end == last) continue;
                const Judged neighbour(mesh, other, signs, center, extent);
                if (const auto its = tangent_form(neighbour, static_cast<int>(other_corner - nodes.begin()),
                                                  static_cast<int>(other_end - nodes.begin()), may_move))
                    forms.push_back(*its);
            }
            if (forms.empty() || !is_possible(forms)) continue;
            forms.push_back(*form);
            if (!is_possible(forms))
                return Impossibility{
                    0.0,
                    fmt::format("in whatever direction the edge to node {} leaves node {}, J there is at most zero in "
                                "this element or in one that shares the edge",
                                tag(end), tag(corner)),
                    is_surely_impossible(forms)};
        }

    for (const int n : movable) {
        const Index node = judged.nodes[static_cast<std::size_t>(n)];
        Program own;
        own.add(judged, node, may_move);
        if (own.values.empty()) continue;
        if (const double bound = own.bound(); bound <= 0.0)
            return Impossibility{bound,
                                 fmt::format("wherever node {} goes, J stays below {:.2g} of its largest |J| at one "
                                             "of the points where it depends on that node alone",
                                             tag(n), bound),
                                 is_without_solution(own, mesh, extent, may_move)};
        Program others;
        for (const Index other : node_elements.of(node)) {
            if (other == element || (is_given_up && is_given_up(other))) continue;
            const Judged neighbour(mesh, other, signs, center, extent);
            if (neighbour.scale > 0.0) others.add(neighbour, node, may_move);
        }
        if (others.values.empty() || others.bound() <= 0.0) continue;
        others.add(judged, node, may_move);
        if (const double bound = others.bound(); bound <= 0.0)
            return Impossibility{
                bound,
                fmt::format("wherever node {} goes, this element or one that shares the node has J below {:.2g} of "
                            "its largest |J| where J depends on that node alone",
                            tag(n), bound),
                is_without_solution(others, mesh, extent, may_move)};
    }
    return std::nullopt;
}

}  // namespace curvewright
