#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace curvewright::testing {

/// Algorithm 3 of the thesis: infeasible-start Newton method on the full KKT system of
/// min -sum c log w subject to A w = b, from w = 1 / n.
inline Eigen::VectorXd convex_weights_by_kkt(const Eigen::MatrixXd& offsets, const Eigen::VectorXd& c) {
    const Eigen::Index n = offsets.rows(), m = offsets.cols() + 1;
    Eigen::MatrixXd a(m, n);
    a.topRows(m - 1) = offsets.transpose();
    a.row(m - 1).setOnes();
    const Eigen::VectorXd b = Eigen::VectorXd::Unit(m, m - 1);
    Eigen::VectorXd w = Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n)), nu = Eigen::VectorXd::Zero(m);
    const auto residual = [&](const Eigen::VectorXd& weights, const Eigen::VectorXd& multipliers) {
        Eigen::VectorXd r(n + m);
        r << Eigen::VectorXd(-c.cwiseQuotient(weights)) + a.transpose() * multipliers, a * weights - b;
        return r;
    };
    for (int iteration = 0; iteration < 500; ++iteration) {
        const Eigen::VectorXd r = residual(w, nu);
        if (r.norm() < 1e-12 * static_cast<double>(n)) break;
        Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + m, n + m);
        kkt.topLeftCorner(n, n).diagonal() = c.cwiseQuotient(w.cwiseAbs2());
        kkt.topRightCorner(n, m) = a.transpose();
        kkt.bottomLeftCorner(m, n) = a;
        const Eigen::VectorXd step = kkt.partialPivLu().solve(-r);
        double t = 1.0;
        while ((w + t * step.head(n)).minCoeff() <= 0.0) t *= 0.5;
        while (t > 1e-12 && residual(w + t * step.head(n), nu + t * step.tail(m)).norm() > (1 - 0.1 * t) * r.norm())
            t *= 0.5;
        w += t * step.head(n);
        nu += t * step.tail(m);
    }
    return w;
}

}  // namespace curvewright::testing
