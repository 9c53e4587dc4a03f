#include "core/deform/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "core/base/error.h"

namespace curvewright {
namespace {

using Point = Eigen::RowVector3d;

/// A plane curve (u -> position) with its first two derivatives.
struct CurvePoint {
    Eigen::Vector2d position, first, second;
};

/// Parameter in [lower, upper] of the closest point: the best of a fine grid, then Newton's method on the derivative of
/// the squared distance, falling back to the grid's answer if that would be worse.
double closest_parameter(const std::function<CurvePoint(double)>& curve, const Eigen::Vector2d& target, double lower,
                         double upper, int samples) {
    double best = lower, best_distance = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= samples; ++i) {
        const double u = lower + (upper - lower) * i / samples;
        const double distance = (curve(u).position - target).squaredNorm();
        if (distance < best_distance) {
            best_distance = distance;
            best = u;
        }
    }
    double u = best;
    for (int iteration = 0; iteration < 30; ++iteration) {
        const CurvePoint c = curve(u);
        const Eigen::Vector2d offset = c.position - target;
        const double gradient = offset.dot(c.first);
        const double hessian = c.first.squaredNorm() + offset.dot(c.second);
        const double step = gradient / (hessian > 1e-14 ? hessian : 1.0);
        const double next = std::clamp(u - step, lower, upper);
        if (next == u) break;
        u = next;
    }
    return (curve(u).position - target).squaredNorm() <= best_distance ? u : best;
}

/// Half thickness of a four-digit NACA profile of unit chord as a polynomial in u = sqrt(s), s the fraction of the
/// chord: 5 t (.2969 u - .126 u^2 - .3516 u^4 + .2843 u^6 - .1036 u^8), whose trailing edge is closed (Jacobs, Ward,
/// Pinkerton, NACA report 460, 1933, with the last coefficient changed to close it).
CurvePoint naca_point(double thickness, double u) {
    constexpr std::array<double, 9> coefficients = {0.0, 0.2969, -0.126, 0.0, -0.3516, 0.0, 0.2843, 0.0, -0.1036};
    double value = 0.0, first = 0.0, second = 0.0;
    for (int i = 8; i >= 0; --i) {
        second = second * u + 2 * first;
        first = first * u + value;
        value = value * u + coefficients[i];
    }
    const double scale = 5.0 * thickness;
    return {{u * u, scale * value}, {2 * u, scale * first}, {2.0, scale * second}};
}

}  // namespace

Point to_point(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

Point project(const SnapToCircle& shape, const Point& x) {
    Point result = x;
    const double dx = x[0] - shape.center[0], dy = x[1] - shape.center[1];
    const double length = std::sqrt(dx * dx + dy * dy);
    if (length == 0.0)
        throw InvalidInput("it lies on the centre of the circle and has no direction to be projected in");
    result[0] = shape.center[0] + dx * (shape.radius / length);
    result[1] = shape.center[1] + dy * (shape.radius / length);
    return result;
}

Point project(const SnapToSphere& shape, const Point& x) {
    const Point center = to_point(shape.center), offset = x - center;
    const double length = offset.norm();
    if (length == 0.0)
        throw InvalidInput("it lies on the centre of the sphere and has no direction to be projected in");
    return center + offset * (shape.radius / length);
}

Point project(const SnapToCylinder& shape, const Point& x) {
    const Point center = to_point(shape.center), axis = to_point(shape.axis), offset = x - center;
    const Point along = offset.dot(axis) * axis, radial = offset - along;
    const double length = radial.norm();
    if (length == 0.0)
        throw InvalidInput("it lies on the axis of the cylinder and has no direction to be projected in");
    return center + along + radial * (shape.radius / length);
}

Point project(const SnapToRevolution& shape, const Point& x) {
    const int k = shape.axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const double height = x[k], length = std::sqrt(x[i] * x[i] + x[j] * x[j]);
    const auto& profile = shape.profile;
    double radius = profile.front()[1];
    if (height >= profile.back()[0]) {
        radius = profile.back()[1];
    } else if (height > profile.front()[0]) {
        const auto upper = std::upper_bound(profile.begin(), profile.end(), height,
                                            [](double h, const std::array<double, 2>& p) { return h < p[0]; });
        const auto lower = upper - 1;
        radius = (*lower)[1] + ((*upper)[1] - (*lower)[1]) * (height - (*lower)[0]) / ((*upper)[0] - (*lower)[0]);
    }
    if (length == 0.0 && radius != 0.0)
        throw InvalidInput("it lies on the axis of the revolution and has no direction to be projected in");
    const double factor = length > 0.0 ? radius / length : 0.0;
    Point result = x;
    result[i] *= factor;
    result[j] *= factor;
    return result;
}

Point project(const SnapToEllipse& shape, const Point& x) {
    const Eigen::Vector2d target(x[0] - shape.center[0], x[1] - shape.center[1]);
    if (target.isZero(0.0) && shape.semi_axis_x == shape.semi_axis_y)
        throw InvalidInput("it lies on the centre of the circle and has no direction to be projected in");
    const auto curve = [&](double t) {
        const double c = std::cos(t), s = std::sin(t);
        const Eigen::Vector2d position(shape.semi_axis_x * c, shape.semi_axis_y * s);
        return CurvePoint{position, {-shape.semi_axis_x * s, shape.semi_axis_y * c}, -position};
    };
    const double t = closest_parameter(curve, target, -std::numbers::pi, std::numbers::pi, 720);
    const CurvePoint c = curve(t);
    return {shape.center[0] + c.position[0], shape.center[1] + c.position[1], x[2]};
}

Point project(const SnapToNaca& shape, const Point& x) {
    const double side = x[1] >= shape.leading_edge[1] ? 1.0 : -1.0;
    const Eigen::Vector2d target((x[0] - shape.leading_edge[0]) / shape.chord,
                                 std::abs(x[1] - shape.leading_edge[1]) / shape.chord);
    const auto curve = [&](double u) { return naca_point(shape.thickness, u); };
    const CurvePoint c = curve(closest_parameter(curve, target, 0.0, 1.0, 1000));
    return {shape.leading_edge[0] + shape.chord * c.position[0],
            shape.leading_edge[1] + shape.chord * side * c.position[1], x[2]};
}

}  // namespace curvewright
