#pragma once

#include <optional>
#include <vector>

#include "core/quality/boundary_chain.h"
#include "core/quality/box_tree.h"
#include "core/quality/facet_crossing.h"

namespace curvewright {

/// A point near the boundary that is proved to be covered other than once.
struct WindingFault {
    int facet = 0;    ///< of the chain: the point lies just inside or just outside of it
    int winding = 0;  ///< covered so many times; < 0: the other way round
    Eigen::Vector3d point;
};

struct WindingOutcome {
    std::optional<WindingFault> fault;
    int unsettled_components = 0;
    int first_unsettled = -1;  ///< a facet of it
};

/// Follows lines through every component of a chain and counts how often they enter and leave the mesh. Between two
/// crossings the count is the winding number of the whole boundary there, which has to be 0 or 1. A component is
/// settled when a line crosses it. What a line crosses is proved: a piece whose tangent planes are nowhere parallel to
/// the line and whose boundary, seen along the line, winds around it once (not at all) meets the line once (never).
class WindingLines {
  public:
    WindingLines(const BoundaryChain& chain, const BoxTree& tree) : chain_(chain), tree_(tree) {}

    /// suspects: facets that are not proved to be apart from all others; lines go through them, too. Throws Cancelled.
    WindingOutcome follow(const std::vector<int>& suspects, const TaskContext& context);

  private:
    struct Line {
        Eigen::Vector3d point, direction;
        Projection projection;
    };
    /// A crossing: what it adds to the winding number, and between which distances along the line it lies.
    struct Hit {
        int piece = 0, change = 0;
        double low = 0.0, high = 0.0;
    };
    enum class Meeting { none, once, unknown };

    Line line_through(int facet, int attempt) const;
    bool is_near(const Line& line, const Box& box) const;
    Meeting meet(const Line& line, int piece, Hit& hit) const;
    Meeting meet_curve(const Line& line, const FacetForm& form, const FacetPiece& piece, int& change) const;
    Meeting meet_surface(const Line& line, const FacetForm& form, const FacetPiece& piece, int& change) const;
    /// Adds the hits of the line with a piece, cut as far as necessary; false if that cannot be told.
    bool collect(const Line& line, int piece, std::vector<Hit>& hits);
    /// Cuts pieces until no two hits overlap.
    bool part(const Line& line, std::vector<Hit>& hits);
    /// false: nothing was learnt.
    bool follow_line(const Line& line, std::vector<bool>& is_settled, WindingOutcome& outcome);

    const BoundaryChain& chain_;
    const BoxTree& tree_;
    FacetPieces pieces_;
};

}  // namespace curvewright
