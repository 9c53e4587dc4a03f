#include "core/quality/winding_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace curvewright {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
constexpr int most_attempts = 24;
constexpr int attempts_at_suspects = 4;
/// Pieces that a line may be cut off from one facet, at most.
constexpr int most_pieces = 4000;

/// Bound of the error of a product of a unit vector and the difference of a control point and the line's point.
double height_error(const FacetPiece& piece, const Vector3d& point) {
    return 4 * piece.error +
           64 * unit_roundoff *
               ((piece.box.high - point).cwiseAbs().maxCoeff() + (piece.box.low - point).cwiseAbs().maxCoeff());
}

/// A fraction that looks random and is the same every time.
double fraction(int facet, int attempt, int which) {
    const double x = 0.6180339887498949 * (facet + 1) + 0.7548776662466927 * (attempt + 1) + 0.5698402909980532 * which;
    return x - std::floor(x);
}

}  // namespace

WindingLines::Line WindingLines::line_through(int facet, int attempt) const {
    const FacetForm& form = *chain_[facet].form;
    const Vector3d* c = chain_.control(facet);
    // A point of a piece that is left by some cuts, chosen so as to miss corners and edges.
    std::vector<Vector3d> here(c, c + form.size), near_a(here.size()), near_b(here.size());
    for (int cut = 0; cut < 6; ++cut) {
        const auto& edge = form.edges[static_cast<std::size_t>(cut) % form.edges.size()];
        form.bisect(edge, here.data(), near_a.data(), near_b.data());
        here = fraction(facet, attempt, cut) < 0.5 ? near_a : near_b;
    }
    Vector3d point = Vector3d::Zero();
    for (const Vector3d& x : here) point += x / static_cast<double>(here.size());
    const auto mean_step = [&](int d) {
        Vector3d sum = Vector3d::Zero();
        for (const auto& [a, b] : form.steps[d]) sum += here[a] - here[b];
        return sum;
    };
    Vector3d direction;
    if (chain_.dimension() == 2) {
        const Vector3d along = mean_step(0);
        direction = Vector3d(-along.y(), along.x(), 0.0);
    } else {
        direction = mean_step(0).cross(mean_step(1));
    }
    if (!(direction.norm() > 0.0)) direction = Vector3d(0.6, 0.8, chain_.dimension() == 2 ? 0.0 : 0.3);
    direction.normalize();
    const double tilt = 0.05 + 0.03 * attempt;
    for (int d = 0; d < chain_.dimension(); ++d) direction[d] += tilt * (fraction(facet, attempt, 10 + d) - 0.5);
    direction.normalize();
    return {point, direction, Projection(direction)};
}

bool WindingLines::is_near(const Line& line, const Box& box) const {
    // Distance of the box's middle from the line against the half extents seen along the line.
    const Vector3d middle = 0.5 * (box.low + box.high) - line.point, half = 0.5 * (box.high - box.low);
    if (chain_.dimension() == 2) {
        const Vector2d normal(-line.direction.y(), line.direction.x());
        return std::abs(normal.dot(middle.head<2>())) <= 1.000001 * normal.cwiseAbs().dot(half.head<2>());
    }
    for (int axis = 0; axis < 2; ++axis) {
        const Vector3d& normal = line.projection.axes[axis];
        if (std::abs(normal.dot(middle)) > 1.000001 * normal.cwiseAbs().dot(half)) return false;
    }
    return true;
}

WindingLines::Meeting WindingLines::meet_curve(const Line& line, const FacetForm& form, const FacetPiece& piece,
                                               int& change) const {
    const Vector3d normal(-line.direction.y(), line.direction.x(), 0.0);
    const double error = height_error(piece, line.point);
    bool above = true, below = true, rises = true, falls = true;
    for (const Vector3d& c : piece.control) {
        const double height = normal.dot(c - line.point);
        above = above && height > error;
        below = below && height < -error;
    }
    if (above || below) return Meeting::none;
    for (const auto& [a, b] : form.steps[0]) {
        const double step = normal.dot(piece.control[a] - piece.control[b]);
        rises = rises && step > error;
        falls = falls && step < -error;
    }
    const double first = normal.dot(piece.control[form.corners[0]] - line.point);
    const double last = normal.dot(piece.control[form.corners[1]] - line.point);
    if (!(rises || falls) || std::abs(first) <= error || std::abs(last) <= error) return Meeting::unknown;
    if ((first > 0.0) == (last > 0.0)) return Meeting::none;
    // The inside is to the left of a facet of sense +1: a facet that falls leads down, and the line to its left.
    change = falls ? 1 : -1;
    return Meeting::once;
}

WindingLines::Meeting WindingLines::meet_surface(const Line& line, const FacetForm& form, const FacetPiece& piece,
                                                 int& change) const {
    const double error = height_error(piece, line.point);
    const Projection& projection = line.projection;
    // Off the line by a line that parts the projected control points from it: square to their middle's direction, or to
    // an axis.
    Vector2d middle = Vector2d::Zero();
    for (const Vector3d& c : piece.control) middle += projection.of(c - line.point);
    for (const Vector2d& normal : {middle, Vector2d(1, 0), Vector2d(-1, 0), Vector2d(0, 1), Vector2d(0, -1)}) {
        const double slack = 2 * error * normal.norm();
        bool is_off = true;
        for (const Vector3d& c : piece.control) is_off = is_off && normal.dot(projection.of(c - line.point)) > slack;
        if (is_off) return Meeting::none;
    }
    bool positive = true, negative = true;
    for (const auto& [a, b] : form.steps[0]) {
        const Vector2d u = projection.of(piece.control[a] - piece.control[b]);
        for (const auto& [c, d] : form.steps[1]) {
            const Vector2d v = projection.of(piece.control[c] - piece.control[d]);
            const double determinant = u.x() * v.y() - u.y() * v.x();
            const double slack =
                2 * error * (u.norm() + v.norm() + 2 * error) + 8 * unit_roundoff * u.norm() * v.norm();
            positive = positive && determinant > slack;
            negative = negative && determinant < -slack;
        }
    }
    if (!(positive || negative)) return Meeting::unknown;
    int winding = 0;
    if (!find_projected_winding(form, piece, projection, line.point, error, winding)) return Meeting::unknown;
    if (winding == 0) return Meeting::none;
    if (std::abs(winding) != 1) return Meeting::unknown;
    // Where the normal of sense +1, outward, goes with the line, the line leaves.
    change = positive ? -1 : 1;
    return Meeting::once;
}

WindingLines::Meeting WindingLines::meet(const Line& line, int index, Hit& hit) const {
    const FacetPiece& piece = pieces_[index];
    const ChainFacet& facet = chain_[piece.facet];
    if (!is_near(line, piece.box)) return Meeting::none;
    const Meeting meeting = chain_.dimension() == 2 ? meet_curve(line, *facet.form, piece, hit.change)
                                                    : meet_surface(line, *facet.form, piece, hit.change);
    if (meeting != Meeting::once) return meeting;
    hit.piece = index;
    hit.change *= facet.sense;
    const double error = height_error(piece, line.point);
    hit.low = std::numeric_limits<double>::infinity();
    hit.high = -hit.low;
    for (const Vector3d& c : piece.control) {
        const double distance = line.direction.dot(c - line.point);
        hit.low = std::min(hit.low, distance - error);
        hit.high = std::max(hit.high, distance + error);
    }
    return meeting;
}

bool WindingLines::collect(const Line& line, int first, std::vector<Hit>& hits) {
    std::vector<int> stack{first};
    const int limit = pieces_.count() + most_pieces;
    while (!stack.empty()) {
        const int piece = stack.back();
        stack.pop_back();
        Hit hit;
        const Meeting meeting = meet(line, piece, hit);
        if (meeting == Meeting::once) hits.push_back(hit);
        if (meeting != Meeting::unknown) continue;
        const FacetForm& form = *chain_[pieces_[piece].facet].form;
        if (pieces_.count() > limit || !pieces_.is_divisible(form, piece)) return false;
        const int half = pieces_.divide(form, piece);
        stack.push_back(half);
        stack.push_back(half + 1);
    }
    return true;
}

bool WindingLines::part(const Line& line, std::vector<Hit>& hits) {
    for (int round = 0; round < 200; ++round) {
        std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
            return std::tuple(a.low, a.high, a.piece) < std::tuple(b.low, b.high, b.piece);
        });
        std::vector<Hit> next;
        bool overlap = false;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const bool meets_before = i > 0 && hits[i - 1].high >= hits[i].low;
            const bool meets_after = i + 1 < hits.size() && hits[i].high >= hits[i + 1].low;
            if (!meets_before && !meets_after) {
                next.push_back(hits[i]);
                continue;
            }
            overlap = true;
            const FacetForm& form = *chain_[pieces_[hits[i].piece].facet].form;
            if (!pieces_.is_divisible(form, hits[i].piece)) return false;
            const int half = pieces_.divide(form, hits[i].piece);
            if (!collect(line, half, next) || !collect(line, half + 1, next)) return false;
        }
        hits = std::move(next);
        if (!overlap) return true;
    }
    return false;
}

bool WindingLines::follow_line(const Line& line, std::vector<bool>& is_settled, WindingOutcome& outcome) {
    pieces_.clear();
    std::vector<Hit> hits;
    bool is_known = true;
    tree_.visit([&](const Box& box) { return is_known && is_near(line, box); },
                [&](int facet) {
                    const ChainFacet& own = chain_[facet];
                    const int piece = pieces_.add(facet, *own.form, chain_.control(facet), own.error);
                    is_known = is_known && collect(line, piece, hits);
                });
    if (!is_known || !part(line, hits)) return false;
    int winding = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        winding += hits[i].change;
        if (winding == 0 || winding == 1) continue;
        const double far = i + 1 < hits.size() ? hits[i + 1].low : hits[i].high;
        outcome.fault = {pieces_[hits[i].piece].facet, winding,
                         line.point + 0.5 * (hits[i].high + far) * line.direction};
        return true;
    }
    if (winding != 0) return false;
    for (const Hit& hit : hits)
        is_settled[static_cast<std::size_t>(chain_.components()[pieces_[hit.piece].facet])] = true;
    return true;
}

WindingOutcome WindingLines::follow(const std::vector<int>& suspects, const TaskContext& context) {
    WindingOutcome outcome;
    std::vector<std::vector<int>> members(static_cast<std::size_t>(chain_.component_count()));
    for (int facet = 0; facet < chain_.size(); ++facet)
        members[static_cast<std::size_t>(chain_.components()[facet])].push_back(facet);
    std::vector<bool> is_settled(members.size(), false);
    for (std::size_t component = 0; component < members.size(); ++component) {
        context.check();
        const auto& facets = members[component];
        for (int attempt = 0; attempt < most_attempts && !is_settled[component]; ++attempt) {
            const std::size_t choice = facets.size() * static_cast<std::size_t>(attempt) / most_attempts;
            follow_line(line_through(facets[choice], attempt), is_settled, outcome);
            if (outcome.fault) return outcome;
        }
        if (is_settled[component]) continue;
        if (outcome.unsettled_components++ == 0) outcome.first_unsettled = facets.front();
    }
    for (const int facet : suspects) {
        context.check();
        for (int attempt = 0; attempt < attempts_at_suspects; ++attempt) {
            const bool is_told = follow_line(line_through(facet, attempt), is_settled, outcome);
            if (outcome.fault) return outcome;
            if (is_told) break;
        }
    }
    return outcome;
}

}  // namespace curvewright
