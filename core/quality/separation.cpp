#include "core/quality/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace curvewright {
namespace {

using Eigen::Vector3d;

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
constexpr int most_steps = 24;

/// Weights of the points whose combination is closest to the origin among those with the given points, if all of them
/// are positive.
bool combine(const std::array<const Vector3d*, 3>& points, int count, Vector3d& closest) {
    if (count == 1) {
        closest = *points[0];
        return true;
    }
    const Vector3d a = *points[0], u = *points[1] - a;
    if (count == 2) {
        const double length = u.squaredNorm(), t = -a.dot(u) / length;
        if (!(length > 0.0 && t > 0.0 && t < 1.0)) return false;
        closest = a + t * u;
        return true;
    }
    const Vector3d v = *points[2] - a;
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), au = -a.dot(u), av = -a.dot(v);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-14 * uu * vv)) return false;
    const double s = (au * vv - av * uv) / determinant, t = (av * uu - au * uv) / determinant;
    if (!(s > 0.0 && t > 0.0 && s + t < 1.0)) return false;
    closest = a + s * u + t * v;
    return true;
}

bool holds_origin(const std::array<Vector3d, 4>& p) {
    for (int i = 0; i < 4; ++i) {
        const Vector3d &a = p[(i + 1) % 4], &b = p[(i + 2) % 4], &c = p[(i + 3) % 4];
        const Vector3d normal = (b - a).cross(c - a);
        if (normal.dot(-a) * normal.dot(p[i] - a) <= 0.0) return false;
    }
    return true;
}

}  // namespace

void ClosestToOrigin::add(const Vector3d& point) {
    points_[static_cast<std::size_t>(count_++)] = point;
    if (count_ == 4 && holds_origin(points_)) {
        closest_.setZero();
        count_ = 3;
        return;
    }
    double least = std::numeric_limits<double>::infinity();
    int best = 1;
    for (int subset = 1; subset < 1 << count_; ++subset) {
        std::array<const Vector3d*, 3> chosen{};
        int chosen_count = 0;
        bool fits = true;
        for (int i = 0; i < count_; ++i) {
            if ((subset >> i & 1) == 0) continue;
            fits = chosen_count < 3;
            if (!fits) break;
            chosen[static_cast<std::size_t>(chosen_count++)] = &points_[static_cast<std::size_t>(i)];
        }
        Vector3d candidate;
        if (!fits || !combine(chosen, chosen_count, candidate) || !(candidate.squaredNorm() < least)) continue;
        least = candidate.squaredNorm();
        closest_ = candidate;
        best = subset;
    }
    int kept = 0;
    for (int i = 0; i < count_; ++i)
        if ((best >> i & 1) != 0) points_[static_cast<std::size_t>(kept++)] = points_[static_cast<std::size_t>(i)];
    count_ = std::min(kept, 3);
}

void DirectionSearch::clear() {
    vectors_.clear();
    slack_.clear();
}

void DirectionSearch::shrink(std::size_t size) {
    vectors_.resize(size);
    slack_.resize(size);
}

void DirectionSearch::add(const Vector3d& w, double error) {
    const double length = w.norm();
    if (!(length > 0.0)) {
        vectors_.push_back(Vector3d::UnitX());
        slack_.push_back(std::numeric_limits<double>::infinity());
        return;
    }
    vectors_.push_back(w / length);
    slack_.push_back(2 * error / length + 16 * unit_roundoff);
}

bool DirectionSearch::exists() {
    Vector3d n = Vector3d::Zero();
    for (std::size_t k = 0; k < vectors_.size(); ++k) {
        if (!(slack_[k] < 1.0)) return false;
        n += vectors_[k];
    }
    ClosestToOrigin simplex;
    for (int step = 0; step < most_steps; ++step) {
        const double length = n.norm();
        double least = std::numeric_limits<double>::infinity();
        std::size_t support = 0;
        bool holds = true;
        for (std::size_t k = 0; k < vectors_.size(); ++k) {
            const double product = n.dot(vectors_[k]);
            holds = holds && product > length * slack_[k];
            if (product < least) {
                least = product;
                support = k;
            }
        }
        if (holds) return true;
        if (step > 0 && least >= length * length * (1 - 1e-12)) return false;
        simplex.add(vectors_[support]);
        n = simplex.closest();
        if (!(n.squaredNorm() > 1e-28)) return false;
    }
    return false;
}

bool are_separable(const std::vector<Vector3d>& f, const std::vector<Vector3d>& g, double error) {
    Vector3d n = Vector3d::Zero();
    for (const Vector3d& c : f) n += c / static_cast<double>(f.size());
    for (const Vector3d& d : g) n -= d / static_cast<double>(g.size());
    const Vector3d origin = g.front();
    double extent = 0.0;
    for (const Vector3d& c : f) extent = std::max(extent, (c - origin).cwiseAbs().maxCoeff());
    for (const Vector3d& d : g) extent = std::max(extent, (d - origin).cwiseAbs().maxCoeff());
    const double slack = 4 * error + 32 * unit_roundoff * extent;
    ClosestToOrigin simplex;
    for (int step = 0; step < most_steps; ++step) {
        const double length = n.norm();
        if (!(length > 0.0)) return false;
        double least = std::numeric_limits<double>::infinity(), most = -least;
        const Vector3d *lowest = nullptr, *highest = nullptr;
        for (const Vector3d& c : f) {
            const double height = n.dot(c - origin);
            if (height < least) {
                least = height;
                lowest = &c;
            }
        }
        for (const Vector3d& d : g) {
            const double height = n.dot(d - origin);
            if (height > most) {
                most = height;
                highest = &d;
            }
        }
        if (least - most > length * slack) return true;
        if (step > 0 && least - most >= length * length * (1 - 1e-12)) return false;
        simplex.add(*lowest - *highest);
        n = simplex.closest();
    }
    return false;
}

}  // namespace curvewright
