#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/basis/element_type.h"

namespace curvewright {

/// Index set of the Bernstein polynomials of one degree on a simplex of dimension 1 to 3, and the tables of the
/// operations on their coefficients. A polynomial is sum_a c_a B_a with B_a = (n! / prod a_i!) prod lambda_i^a_i over
/// the multi-indices a = (a_0, …, a_dim) of sum n. Farin, "Curves and Surfaces for CAGD", ch. 17. Immutable; built once
/// per (dim, degree).
class BernsteinSimplex {
  public:
    static const BernsteinSimplex& get(int dimension, int degree);

    int dimension() const { return dimension_; }
    int degree() const { return degree_; }
    int size() const { return static_cast<int>(indices_.size()); }
    /// Multi-indices (a_0, a_1, …); entries past the dimension are 0.
    const std::vector<std::array<int, 4>>& indices() const { return indices_; }
    /// Position of a multi-index given a_1, a_2, a_3.
    int position(int i, int j, int k) const { return position_[(i * (degree_ + 1) + j) * (degree_ + 1) + k]; }
    /// n! / prod a_i!, exact.
    const std::vector<double>& multinomials() const { return multinomials_; }
    /// Positions of the coefficients that are the values at corners 0..dimension.
    const std::array<int, 4>& corners() const { return corners_; }

    /// Splits the simplex at the midpoint of the edge (a, b) by de Casteljau's algorithm. near_a gets the half in which
    /// the midpoint takes the place of corner b, near_b the other. All arrays have size() entries; no aliasing.
    void bisect(int a, int b, const double* coefficients, double* near_a, double* near_b) const;

  private:
    BernsteinSimplex(int dimension, int degree);

    int dimension_, degree_;
    std::vector<std::array<int, 4>> indices_;
    std::vector<int> position_;
    std::vector<double> multinomials_;
    std::array<int, 4> corners_{};
    /// Per edge (a < b): all lines of positions parallel to the edge, from the a end to the b end.
    std::array<std::array<std::vector<std::vector<int>>, 4>, 4> lines_;
};

using ExtendedMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// Bézier coefficients from nodal values: size × nodes, nodes in this program's order. Silvester's functions are products
/// of linear forms with integer coefficients, so each entry is a quotient of two integers, found exactly and rounded once
/// (relative error 2^-63).
const ExtendedMatrix& lagrange_to_bernstein(ElementType simplex);

}  // namespace curvewright
