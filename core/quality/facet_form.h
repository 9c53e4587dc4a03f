#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/basis/bernstein.h"
#include "core/basis/element_type.h"

namespace curvewright {

/// Bézier form of a curved facet: a line (facet of a 2D mesh), a triangle or a quadrilateral. Control points are
/// ordered by the positions of BernsteinSimplex; those of a quadrilateral by its position in u, then in v.
///
/// Corners: those of the line and the triangle in their order; of the quadrilateral (0,0), (0,1), (1,0), (1,1) in
/// (u, v).
struct FacetForm {
    struct Edge {
        int a = 0, b = 0;            ///< corners
        std::vector<int> positions;  ///< of the control points along it, from a to b
        /// For the facet's other control points or its derivative across the edge: the vector c[0] - (c[1] + c[2]) / 2.
        /// Every point of the facet that is not on the edge is a point of the edge plus a combination of these vectors
        /// with non-negative factors that do not all vanish.
        std::vector<std::array<int, 3>> across;
    };

    ElementType type;
    int size = 0;              ///< number of control points
    std::vector<int> corners;  ///< positions of the control points that are the corners
    std::vector<int> loop;     ///< corners in the order of the reference cell (VTK's), around it
    std::vector<Edge> edges;   ///< a line has itself
    std::array<std::vector<std::array<int, 2>>, 2>
        steps;                      ///< along u and v: the derivative's control vectors c[0] - c[1]
    ExtendedMatrix to_bernstein;    ///< from the nodes in the facet's own order
    double conversion_error = 0.0;  ///< of a control point, per unit of the nodes' extent

    /// Made at the first call; safe to call from several threads. type: of a line, triangle or quadrilateral.
    static const FacetForm& get(ElementType type);

    int corner_count() const { return static_cast<int>(corners.size()); }
    /// Control points of the two parts that a cut through the middle of edge (a, b) leaves; a quadrilateral is cut
    /// through the opposite edge, too, and a line beside its middle. No aliasing; each array has `size` entries.
    void bisect(const Edge& edge, const Eigen::Vector3d* whole, Eigen::Vector3d* near_a, Eigen::Vector3d* near_b) const;
};

/// Parameters of a corner of a piece, in units of 2^-50.
using FacetParameter = std::array<std::int64_t, 2>;
inline constexpr std::int64_t facet_parameter_one = std::int64_t{1} << 50;

/// The parameters of a form's corners.
FacetParameter corner_parameter(const FacetForm& form, int corner);

/// An axis-parallel box.
struct Box {
    Eigen::Vector3d low, high;
    bool overlaps(const Box& other) const {
        return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
    }
    double diagonal() const { return (high - low).norm(); }
};

/// A part of a facet.
struct FacetPiece {
    int facet = 0;
    int first_child = -1;                     ///< of two; -1: not cut yet
    std::array<FacetParameter, 4> corners{};  ///< per corner of the form
    std::vector<Eigen::Vector3d> control;
    double error = 0.0;  ///< bound of the distance of every coordinate of every control point from the exact one
    Box box;             ///< of the control points, error included

    void find_box();
};

/// Facets and the pieces they are cut into, for one task at a time. One object per thread.
class FacetPieces {
  public:
    void clear() { used_ = 0; }
    int add(int facet, const FacetForm& form, const Eigen::Vector3d* control, double error);
    const FacetPiece& operator[](int piece) const { return pieces_[static_cast<std::size_t>(piece)]; }
    /// Whether a piece is large enough to be cut, for its coordinates' errors and its parameters.
    bool is_divisible(const FacetForm& form, int piece) const;
    /// Cuts a piece through its longest edge, once; first child, the second follows.
    int divide(const FacetForm& form, int piece);
    int count() const { return used_; }

  private:
    int take();
    static const FacetForm::Edge& longest_edge(const FacetForm& form, const FacetPiece& piece);

    std::vector<FacetPiece> pieces_;
    int used_ = 0;
};

}  // namespace curvewright
