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
    /// the midpoint takes the place of corner b, near_b the other. count: number of polynomials that are split at once;
    /// the arrays have size() × count entries, those of one position beside each other. No aliasing.
    void bisect(int a, int b, int count, const double* coefficients, double* near_a, double* near_b) const;

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

/// Index set of the Bernstein polynomials on a product of one to three simplices (Farin, ch. 15 and 17), with a degree
/// for each: B_a(u) B_b(v) … . Coefficients are ordered by the positions in the factors, the last factor's running
/// fastest. With one factor this is a BernsteinSimplex.
class BernsteinForm {
  public:
    /// A corner of the product: a corner of every factor.
    struct Corner {
        int position = 0;  ///< of the coefficient that is the value there
        std::array<int, 3> of_factor{};
    };

    /// dimensions: of the factors (see simplex_factors); their sum is at most 3. degrees: as many.
    BernsteinForm(const std::vector<int>& dimensions, const std::vector<int>& degrees);

    int dimension() const { return dimension_; }
    int size() const { return static_cast<int>(multinomials_.size()); }
    const std::vector<const BernsteinSimplex*>& factors() const { return factors_; }
    const std::vector<Corner>& corners() const { return corners_; }
    /// Products of the factors' multinomials, each correct to two roundings.
    const std::vector<double>& multinomials() const { return multinomials_; }

    /// Splits every factor's polynomial like BernsteinSimplex::bisect: at the midpoint of the edge (a, b) of one
    /// factor.
    void bisect(int factor, int a, int b, const double* coefficients, double* near_a, double* near_b) const;

    /// Entries of this form's box: the multi-indices of every simplex padded to a cube, so that the place of a sum of
    /// multi-indices is the sum of their places.
    int box_size() const;
    /// Place of every coefficient in the box of a form of the same factors and of degrees that are at least as high.
    std::vector<int> places_in_box_of(const BernsteinForm& other) const;

  private:
    int dimension_ = 0;
    std::vector<const BernsteinSimplex*> factors_;
    std::vector<Corner> corners_;
    std::vector<double> multinomials_;
};

/// Matrix of extended precision (64 bits of mantissa where the machine has them).
using ExtendedMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// Bézier coefficients from nodal values: size × nodes, nodes in this program's order. Silvester's functions are
/// products of linear forms with integer coefficients, so each entry is a quotient of two integers, found exactly and
/// rounded once (relative error 2^-63).
const ExtendedMatrix& lagrange_to_bernstein(ElementType simplex);

}  // namespace curvewright
