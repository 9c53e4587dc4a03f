#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/basis/element_type.h"

namespace curvewright {

/// Value and derivatives of a polynomial curve or surface S at a point. Curves: first[0] and second[0] only.
struct Jet {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    std::array<Eigen::Vector3d, 2> first{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    /// By (xi, xi), (xi, eta), (eta, eta).
    std::array<Eigen::Vector3d, 3> second{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
};

/// Where the closest point of a piece lies: inside, or held by one of its edges or corners, beyond which the point in
/// question is.
struct Closest {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< reference coordinates
    int edge = -1, corner = -1;                    ///< that it is held by; -1 = by none
    double squared_distance = 0.0;
};

/// A Lagrange line, triangle or quadrilateral in space. Which numbers its nodes carry is the caller's business.
class BoundaryPiece {
  public:
    /// x: node_count(type) × 3, this program's order.
    BoundaryPiece(ElementType type, Eigen::MatrixX3d x);

    const ElementType& type() const { return type_; }
    bool is_curve() const { return type_.shape == Shape::line; }
    int corner_count() const { return curvewright::corner_count(type_.shape); }
    const Eigen::MatrixX3d& nodes() const { return x_; }
    /// Reference coordinates of a node, of the middle.
    Eigen::Vector2d reference_node(int node) const;
    /// Reference coordinates of the ends of an edge: corners i and i + 1. A line has one edge, itself.
    std::array<Eigen::Vector2d, 2> edge(int i) const;

    /// Lagrange basis by Silvester's products (see lagrange_basis), with second derivatives.
    Jet evaluate(const Eigen::Vector2d& at) const;

    /// A point of the piece that is closest to y: Newton's method from the start (not given: the node next to y), and,
    /// where that leaves the piece, the closest point of its edges.
    Closest closest(const Eigen::Vector3d& y, std::optional<Eigen::Vector2d> start) const;

    /// Derivative of that point by y, 3 × 3: S_i (S_i·S_j + (S - y)·S_ij)^-1 S_j^T, inside; along the edge, held by an
    /// edge; zero, held by a corner.
    Eigen::Matrix3d closest_derivative(const Eigen::Vector3d& y, const Closest& closest) const;

  private:
    std::optional<Closest> closest_inside(const Eigen::Vector3d& y, Eigen::Vector2d at) const;
    Closest closest_of_edge(const Eigen::Vector3d& y, int edge, double start) const;
    bool contains(const Eigen::Vector2d& at, double slack) const;

    ElementType type_;
    Eigen::MatrixX3d x_;
};

}  // namespace curvewright
