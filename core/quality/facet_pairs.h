#pragma once

#include <cstdint>

#include "core/quality/boundary_chain.h"
#include "core/quality/separation.h"

namespace curvewright {

/// What is known of two facets, or of a facet and itself.
enum class FacetRelation {
    apart,      ///< proved to meet in common points and curves only
    crossing,   ///< proved to cross
    touching,   ///< somewhere so close that rounding hides whether they meet
    undecided,  ///< neither was found with the cuts that were allowed
};

/// Tells whether facets of a chain cross, by cutting them into pieces. Pieces without a common corner are apart when a
/// plane parts their control points. Pieces with one common corner P meet in P only when a plane through P parts the
/// cones of their control points seen from P. Pieces with a common edge e meet in e only when there are directions n
/// and m that are positive on the vectors that lead from the edge into one piece and on the negated ones of the other,
/// while along the edge n rises and m falls: in the coordinates x = (n - m) and y = (n + m), the edge is then the graph
/// of a function of slope below 1, one piece lies above it and the other below. One piece meets itself nowhere when
/// there are n positive on both derivatives' control vectors, and m positive on one's and negative on the other's; then
/// f(q) - f(p), an integral of them, never vanishes. One object per thread.
class FacetPairTest {
  public:
    explicit FacetPairTest(const BoundaryChain& chain) : chain_(chain) {}

    /// f == g: whether the facet crosses itself. most_cuts: of pieces, at most. Throws Cancelled.
    FacetRelation compare(int f, int g, std::int64_t most_cuts, const TaskContext& context);

  private:
    /// A corner of a piece as one of the chain: a point, a place on a curve, or one inside a facet.
    struct Place {
        int kind = 0;
        std::int64_t owner = 0, first = 0, second = 0;
        friend bool operator==(const Place&, const Place&) = default;
    };
    const FacetForm& form_of(int piece) const { return *chain_[pieces_[piece].facet].form; }
    Place place_of(int piece, int corner) const;
    /// Curve of the chain that an edge of a piece is a part of; -1: none.
    Index curve_of(int piece, const FacetForm::Edge& edge) const;
    bool is_injective(int piece);
    /// Whether it is proved that two different pieces meet in common corners and edges only.
    bool are_apart(int f, int g);
    bool part_at_corner(int f, int corner_f, int g, int corner_g);
    bool part_at_edge(int f, const FacetForm::Edge& edge_f, int g, const FacetForm::Edge& edge_g);
    bool cross(int f, int g) const;
    /// Puts what is left of the question about two pieces on the stack; false if neither can be cut any more.
    bool divide(int f, int g);

    const BoundaryChain& chain_;
    FacetPieces pieces_;
    DirectionSearch search_;
    std::vector<std::pair<int, int>> stack_;
    std::int64_t cuts_ = 0;
};

}  // namespace curvewright
