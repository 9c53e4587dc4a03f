#pragma once

#include "core/quality/facet_form.h"

namespace curvewright {

/// Whether two pieces of curves in the plane z = 0 are proved to cross: in some frame, one of them leads from the left
/// to the right of a box within a slab, and the other one, between its ends, from below the slab to above it.
bool curves_cross(const FacetForm& form_f, const FacetPiece& f, const FacetForm& form_g, const FacetPiece& g);

/// Whether two pieces of surfaces are proved to cross: an edge of one leads from one side of the other's control points
/// to the other side, and seen along the edge's chord, the other's boundary winds around all of the edge, so that the
/// number of intersections, each with its sign, is not 0.
bool surfaces_cross(const FacetForm& form_f, const FacetPiece& f, const FacetForm& form_g, const FacetPiece& g);

/// Winding number of the boundary of a piece of a surface, projected along the normalised direction axes[2], around all
/// points within `radius` of `center`. axes: right-handed and orthonormal. Nothing if the boundary's control points do
/// not tell.
struct Projection {
    std::array<Eigen::Vector3d, 3> axes;
    explicit Projection(const Eigen::Vector3d& direction);
    Eigen::Vector2d of(const Eigen::Vector3d& x) const { return {axes[0].dot(x), axes[1].dot(x)}; }
};
bool find_projected_winding(const FacetForm& form, const FacetPiece& piece, const Projection& projection,
                            const Eigen::Vector3d& center, double radius, int& winding);

}  // namespace curvewright
