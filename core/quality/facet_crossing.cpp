#include "core/quality/facet_crossing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace curvewright {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

/// Bound of the error of a product with a unit vector, of differences of points of both pieces.
double product_error(const FacetPiece& f, const FacetPiece& g) {
    const double extent = (f.box.high.cwiseMax(g.box.high) - f.box.low.cwiseMin(g.box.low)).norm();
    return 4 * (f.error + g.error) + 32 * unit_roundoff * extent;
}

struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

bool leads_across(const FacetForm& form_f, const FacetPiece& f, const FacetForm& form_g, const FacetPiece& g) {
    const Vector3d start = f.control[form_f.corners[0]], chord = f.control[form_f.corners[1]] - start;
    const double length = chord.norm(), error = product_error(f, g);
    if (!(length > 8 * error)) return false;
    const Vector3d x = chord / length, y(-x.y(), x.x(), 0.0);
    Range slab, width;
    for (const Vector3d& c : f.control) slab.add(y.dot(c - start));
    for (const Vector3d& c : g.control) width.add(x.dot(c - start));
    if (!(width.low > error && width.high < length - error)) return false;
    const double first = y.dot(g.control[form_g.corners[0]] - start),
                 last = y.dot(g.control[form_g.corners[1]] - start);
    return std::min(first, last) < slab.low - error && std::max(first, last) > slab.high + error;
}

bool pierces(const FacetForm& form_f, const FacetPiece& f, const FacetForm& form_g, const FacetPiece& g) {
    const Vector3d origin = g.control[form_g.corners[0]];
    const double error = product_error(f, g);
    Vector3d normal = Vector3d::Zero();
    const auto corner = [&](int k) -> const Vector3d& { return g.control[form_g.corners[form_g.loop[k]]]; };
    const int corners = form_g.corner_count();
    normal = corners == 3 ? (corner(1) - corner(0)).cross(corner(2) - corner(0))
                          : (corner(2) - corner(0)).cross(corner(3) - corner(1));
    const double size = normal.norm();
    if (!(size > 0.0)) return false;
    normal /= size;
    Range slab;
    for (const Vector3d& c : g.control) slab.add(normal.dot(c - origin));
    for (const FacetForm::Edge& edge : form_f.edges) {
        const Vector3d &start = f.control[form_f.corners[edge.a]], &end = f.control[form_f.corners[edge.b]];
        const double first = normal.dot(start - origin), last = normal.dot(end - origin);
        if (!(std::min(first, last) < slab.low - error && std::max(first, last) > slab.high + error)) continue;
        const Vector3d chord = end - start;
        const Projection along(chord);
        const Vector3d middle = 0.5 * (start + end);
        double radius = 0.0;
        for (const int position : edge.positions)
            radius = std::max(radius, along.of(f.control[position] - middle).norm());
        int winding = 0;
        if (find_projected_winding(form_g, g, along, middle, radius + error, winding) && winding != 0) return true;
    }
    return false;
}

}  // namespace

Projection::Projection(const Vector3d& direction) {
    axes[2] = direction.normalized();
    axes[0] = axes[2].unitOrthogonal();
    axes[1] = axes[2].cross(axes[0]);
}

bool find_projected_winding(const FacetForm& form, const FacetPiece& piece, const Projection& projection,
                            const Vector3d& center, double radius, int& winding) {
    double angle = 0.0;
    const int corners = form.corner_count();
    const double slack = radius + 2 * product_error(piece, piece) +
                         32 * unit_roundoff * (piece.control.front() - center).cwiseAbs().maxCoeff();
    for (int k = 0; k < corners; ++k) {
        const int a = form.loop[static_cast<std::size_t>(k)],
                  b = form.loop[static_cast<std::size_t>((k + 1) % corners)];
        const auto edge = std::find_if(form.edges.begin(), form.edges.end(), [&](const FacetForm::Edge& candidate) {
            return std::min(a, b) == candidate.a && std::max(a, b) == candidate.b;
        });
        const Vector2d from = projection.of(piece.control[form.corners[a]] - center);
        const Vector2d to = projection.of(piece.control[form.corners[b]] - center);
        // A line that parts the edge's control points from the center: across the bisector of its ends' directions, or
        // along its chord.
        const Vector2d chord = to - from;
        const std::array<Vector2d, 2> normals{from.normalized() + to.normalized(), Vector2d(-chord.y(), chord.x())};
        bool is_parted = false;
        for (const Vector2d& normal : normals) {
            const double length = normal.norm();
            if (is_parted || !(length > 0.0)) continue;
            const double side = normal.dot(from) < 0.0 ? -1.0 : 1.0;
            is_parted = true;
            for (const int position : edge->positions)
                is_parted =
                    is_parted && side * normal.dot(projection.of(piece.control[position] - center)) > length * slack;
        }
        if (!is_parted) return false;
        angle += std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
    }
    winding = static_cast<int>(std::lround(angle / (2 * std::numbers::pi)));
    return true;
}

bool curves_cross(const FacetForm& form_f, const FacetPiece& f, const FacetForm& form_g, const FacetPiece& g) {
    return leads_across(form_f, f, form_g, g) || leads_across(form_g, g, form_f, f);
}

bool surfaces_cross(const FacetForm& form_f, const FacetPiece& f, const FacetForm& form_g, const FacetPiece& g) {
    return pierces(form_f, f, form_g, g) || pierces(form_g, g, form_f, f);
}

}  // namespace curvewright
