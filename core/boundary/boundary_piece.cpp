#include "core/boundary/boundary_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// R_m(lambda) = prod over l < m of (p lambda - l) / (l + 1), m = 0..p, with derivatives by lambda.
struct Factors {
    std::array<double, max_order + 1> value, first, second;

    Factors(int order, double lambda) {
        value[0] = 1.0;
        first[0] = second[0] = 0.0;
        for (std::size_t m = 0; m < static_cast<std::size_t>(order); ++m) {
            const double z = order * lambda - static_cast<double>(m), scale = 1.0 / static_cast<double>(m + 1);
            value[m + 1] = value[m] * z * scale;
            first[m + 1] = (first[m] * z + order * value[m]) * scale;
            second[m + 1] = (second[m] * z + 2.0 * order * first[m]) * scale;
        }
    }
};

/// One-dimensional Lagrange basis function i of the order at the point whose factors are those of 1 - s and s.
struct LineValue {
    double value, first, second;
    LineValue(const Factors& a, const Factors& b, int order, int i) {
        const auto m = static_cast<std::size_t>(order - i), n = static_cast<std::size_t>(i);
        value = a.value[m] * b.value[n];
        first = a.value[m] * b.first[n] - a.first[m] * b.value[n];
        second = a.second[m] * b.value[n] - 2.0 * a.first[m] * b.first[n] + a.value[m] * b.second[n];
    }
};

constexpr int most_iterations = 40;

}  // namespace

BoundaryPiece::BoundaryPiece(ElementType type, Eigen::MatrixX3d x) : type_(type), x_(std::move(x)) {}

Eigen::Vector2d BoundaryPiece::reference_node(int node) const {
    const LatticePoint& point = reference_element(type_).lattice[static_cast<std::size_t>(node)];
    return Eigen::Vector2d(point[0], point[1]) / type_.order;
}

std::array<Eigen::Vector2d, 2> BoundaryPiece::edge(int i) const {
    const auto corner = [&](int c) -> Eigen::Vector2d {
        if (type_.shape != Shape::quadrilateral) return {c == 1 ? 1.0 : 0.0, c == 2 ? 1.0 : 0.0};
        return {c == 1 || c == 2 ? 1.0 : 0.0, c >= 2 ? 1.0 : 0.0};
    };
    return {corner(i), corner((i + 1) % corner_count())};
}

Jet BoundaryPiece::evaluate(const Eigen::Vector2d& at) const {
    const int p = type_.order;
    const auto& lattice = reference_element(type_).lattice;
    Jet jet;
    const auto add = [&](std::size_t node, double v, double dx, double dy, double dxx, double dxy, double dyy) {
        const Eigen::Vector3d x = x_.row(static_cast<Eigen::Index>(node)).transpose();
        jet.value += v * x;
        jet.first[0] += dx * x;
        jet.second[0] += dxx * x;
        if (is_curve()) return;
        jet.first[1] += dy * x;
        jet.second[1] += dxy * x;
        jet.second[2] += dyy * x;
    };
    const Factors u(p, at[0]), v(p, at[1]);
    if (type_.shape == Shape::triangle) {
        const Factors w(p, 1.0 - at[0] - at[1]);
        for (std::size_t node = 0; node < lattice.size(); ++node) {
            const auto i = static_cast<std::size_t>(lattice[node][0]), j = static_cast<std::size_t>(lattice[node][1]);
            const std::size_t k = static_cast<std::size_t>(p) - i - j;
            const double a = u.value[i], b = v.value[j], c = w.value[k];
            const double a1 = u.first[i], b1 = v.first[j], c1 = w.first[k], c2 = w.second[k];
            add(node, a * b * c, (a1 * c - a * c1) * b, (b1 * c - b * c1) * a,
                (u.second[i] * c - 2.0 * a1 * c1 + a * c2) * b, a1 * b1 * c - a1 * b * c1 - a * b1 * c1 + a * b * c2,
                (v.second[j] * c - 2.0 * b1 * c1 + b * c2) * a);
        }
        return jet;
    }
    const Factors u0(p, 1.0 - at[0]), v0(p, 1.0 - at[1]);
    for (std::size_t node = 0; node < lattice.size(); ++node) {
        const LineValue a(u0, u, p, lattice[node][0]);
        if (is_curve()) {
            add(node, a.value, a.first, 0.0, a.second, 0.0, 0.0);
            continue;
        }
        const LineValue b(v0, v, p, lattice[node][1]);
        add(node, a.value * b.value, a.first * b.value, a.value * b.first, a.second * b.value, a.first * b.first,
            a.value * b.second);
    }
    return jet;
}

bool BoundaryPiece::contains(const Eigen::Vector2d& at, double slack) const {
    if (at.minCoeff() < -slack) return false;
    return (type_.shape == Shape::triangle ? at.sum() : at.maxCoeff()) <= 1.0 + slack;
}

std::optional<Closest> BoundaryPiece::closest_inside(const Eigen::Vector3d& y, Eigen::Vector2d at) const {
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        const Jet jet = evaluate(at);
        const Eigen::Vector3d r = jet.value - y;
        const Eigen::Vector2d gradient(jet.first[0].dot(r), jet.first[1].dot(r));
        Eigen::Matrix2d metric, hessian;
        metric << jet.first[0].squaredNorm(), jet.first[0].dot(jet.first[1]), 0.0, jet.first[1].squaredNorm();
        metric(1, 0) = metric(0, 1);
        hessian << r.dot(jet.second[0]), r.dot(jet.second[1]), r.dot(jet.second[1]), r.dot(jet.second[2]);
        hessian += metric;
        // Gauss-Newton where the distance is not convex; nothing where the piece has no tangent plane.
        if (!(hessian.determinant() > 1e-3 * metric.determinant() && hessian.trace() > 0.0)) hessian = metric;
        if (!(hessian.determinant() > 1e-20 * hessian.trace() * hessian.trace())) return std::nullopt;
        const Eigen::Vector2d step = -hessian.inverse() * gradient;
        const double length = step.cwiseAbs().maxCoeff();
        at += std::min(1.0, 0.5 / length) * step;
        if (!contains(at, 0.3)) return std::nullopt;
        if (length > 1e-13) continue;
        if (!contains(at, 1e-12)) return std::nullopt;
        return Closest{at, -1, -1, (evaluate(at).value - y).squaredNorm()};
    }
    return std::nullopt;
}

Closest BoundaryPiece::closest_of_edge(const Eigen::Vector3d& y, int number, double s) const {
    const auto ends = edge(number);
    const Eigen::Vector2d along = ends[1] - ends[0];
    const auto jet_at = [&](double t) {
        const Jet jet = evaluate(ends[0] + t * along);
        return std::array<Eigen::Vector3d, 3>{jet.value - y, along[0] * jet.first[0] + along[1] * jet.first[1],
                                              along[0] * along[0] * jet.second[0] +
                                                  2.0 * along[0] * along[1] * jet.second[1] +
                                                  along[1] * along[1] * jet.second[2]};
    };
    auto [r, first, second] = jet_at(s);
    bool is_held = false;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        const double slope = first.dot(r), metric = first.squaredNorm();
        double curvature = metric + second.dot(r);
        if (!(curvature > 1e-3 * metric)) curvature = metric;
        if (!(curvature > 0.0)) break;
        const double wanted = s - slope / curvature;
        double next = std::clamp(wanted, 0.0, 1.0);
        is_held = std::abs(next - s) <= 1e-14 && std::abs(wanted - next) > 1e-12;
        if (std::abs(next - s) <= 1e-14) break;
        const double value = r.squaredNorm();
        std::array<Eigen::Vector3d, 3> jet = jet_at(next);
        // Within rounding of the minimum nothing decreases any more.
        for (int half = 0; half < 30 && jet[0].squaredNorm() > value * (1.0 + 1e-15); ++half) {
            next = 0.5 * (s + next);
            jet = jet_at(next);
        }
        s = next;
        r = jet[0];
        first = jet[1];
        second = jet[2];
    }
    Closest result{ends[0] + s * along, number, -1, r.squaredNorm()};
    if (is_held && (s == 0.0 || s == 1.0)) result.corner = s == 0.0 ? number : (number + 1) % corner_count();
    if (is_curve() || result.corner >= 0) result.edge = -1;
    return result;
}

Closest BoundaryPiece::closest(const Eigen::Vector3d& y, std::optional<Eigen::Vector2d> start) const {
    if (!start) {
        Eigen::Index nearest = 0;
        (x_.rowwise() - y.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
        start = reference_node(static_cast<int>(nearest));
    }
    if (is_curve()) {
        Closest best = closest_of_edge(y, 0, std::clamp((*start)[0], 0.0, 1.0));
        // A curve that turns back before its end may hold there what it has elsewhere.
        for (int i = 1; i < type_.order && best.corner >= 0; ++i) {
            const Closest candidate = closest_of_edge(y, 0, static_cast<double>(i) / type_.order);
            if (candidate.squared_distance < best.squared_distance) best = candidate;
        }
        return best;
    }
    if (const auto inside = closest_inside(y, *start)) return *inside;
    Closest best;
    best.squared_distance = std::numeric_limits<double>::infinity();
    for (int i = 0; i < corner_count(); ++i) {
        const auto ends = edge(i);
        const Eigen::Vector2d along = ends[1] - ends[0];
        const double s = std::clamp((*start - ends[0]).dot(along) / along.squaredNorm(), 0.0, 1.0);
        const Closest candidate = closest_of_edge(y, i, s);
        if (candidate.squared_distance < best.squared_distance) best = candidate;
    }
    return best;
}

Eigen::Matrix3d BoundaryPiece::closest_derivative(const Eigen::Vector3d& y, const Closest& closest) const {
    if (closest.corner >= 0) return Eigen::Matrix3d::Zero();
    const Jet jet = evaluate(closest.at);
    const Eigen::Vector3d r = jet.value - y;
    if (is_curve() || closest.edge >= 0) {
        Eigen::Vector2d along(1.0, 0.0);
        if (!is_curve()) along = edge(closest.edge)[1] - edge(closest.edge)[0];
        const Eigen::Vector3d first = along[0] * jet.first[0] + along[1] * jet.first[1];
        const Eigen::Vector3d second = along[0] * along[0] * jet.second[0] + 2.0 * along[0] * along[1] * jet.second[1] +
                                       along[1] * along[1] * jet.second[2];
        const double metric = first.squaredNorm();
        double curvature = metric + second.dot(r);
        if (!(curvature > 1e-3 * metric)) curvature = metric;
        if (!(curvature > 0.0)) return Eigen::Matrix3d::Zero();
        return first * first.transpose() / curvature;
    }
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << jet.first[0], jet.first[1];
    const Eigen::Matrix2d metric = tangents.transpose() * tangents;
    Eigen::Matrix2d hessian;
    hessian << r.dot(jet.second[0]), r.dot(jet.second[1]), r.dot(jet.second[1]), r.dot(jet.second[2]);
    hessian += metric;
    if (!(hessian.determinant() > 1e-3 * metric.determinant() && hessian.trace() > 0.0)) hessian = metric;
    if (!(hessian.determinant() > 1e-20 * hessian.trace() * hessian.trace())) return Eigen::Matrix3d::Zero();
    return tangents * hessian.inverse() * tangents.transpose();
}

}  // namespace curvewright
