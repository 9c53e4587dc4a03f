#include "ui/tools/step_marks.h"

#include <cmath>
#include <numbers>

#include "ui/document/number_format.h"

namespace curvewright {
namespace {

using Point = std::array<double, 3>;

constexpr double arc_pixels = 34.0, tangent_pixels = 62.0, label_pixels = 56.0;

Point to_point(const Eigen::RowVector3d& row) {
    return {row[0], row[1], row[2]};
}

Eigen::RowVector3d to_row(const Point& point) {
    return {point[0], point[1], point[2]};
}

void add_angle(Marks& marks, const AngleMark& mark, double unit, bool is_second) {
    const Eigen::RowVector3d corner = to_row(mark.corner);
    const double turn =
        std::atan2(mark.edge_tangent[0] * mark.other_tangent[1] - mark.edge_tangent[1] * mark.other_tangent[0],
                   mark.edge_tangent.dot(mark.other_tangent));
    const double from = std::atan2(mark.edge_tangent[1], mark.edge_tangent[0]);
    const auto at = [&](double angle, double pixels) {
        return to_point(corner + pixels * unit * Eigen::RowVector3d(std::cos(angle), std::sin(angle), 0.0));
    };
    const MarkRole role = mark.signed_angle < 0.0 ? MarkRole::tangled_angle : MarkRole::angle;
    // Arcs that lie over each other when the element is tangled: of different radii.
    const double radius = arc_pixels + (is_second ? 9.0 : 0.0);
    MarkLine arc{{}, role, 1.0};
    const int pieces = std::max(2, static_cast<int>(std::ceil(std::abs(turn) / 0.1)));
    for (int i = 0; i <= pieces; ++i) arc.points.push_back(at(from + turn * i / pieces, radius));
    marks.lines.push_back(std::move(arc));
    const double other = from + turn;
    marks.lines.push_back({{to_point(corner), at(other, tangent_pixels)}, MarkRole::tangent, 1.0});
    if (!is_second) marks.lines.push_back({{to_point(corner), at(from, tangent_pixels)}, MarkRole::tangent, 1.0});
    const int degrees = static_cast<int>(std::lround(mark.signed_angle * 180.0 / std::numbers::pi));
    const QString text = (degrees < 0 ? QStringLiteral("−%1°") : QStringLiteral("%1°")).arg(std::abs(degrees));
    marks.texts.push_back({at(from + 0.5 * turn, label_pixels + (is_second ? 9.0 : 0.0)), text.toStdString(), role});
}

void add_contours(Marks& marks, const TrialResult& trial) {
    for (std::size_t i = 0; i < trial.contours.size(); ++i)
        for (const auto& line : trial.contours[i]) {
            MarkLine mark{{},
                          MarkRole::contour,
                          1.0 - static_cast<double>(i) /
                                    static_cast<double>(std::max<std::size_t>(2, trial.contours.size()) - 1)};
            for (const Eigen::Vector2d& point : line)
                mark.points.push_back(to_point(trial.landscape.at(point[0], point[1])));
            marks.lines.push_back(std::move(mark));
        }
}

}  // namespace

Marks step_marks(const StepExplanation& step, const Coordinates& positions, const Canvas& canvas,
                 const TrialResult* trial, bool with_contours) {
    Marks marks;
    if (!step.method || !step.focus) return marks;
    if (trial && with_contours) add_contours(marks, *trial);
    const double z = positions(*step.focus, 2);
    if (step.angles.size() == 4)
        for (std::size_t i = 0; i < 4; ++i) {
            // Of constant size, but never longer than a part of the edge.
            const double unit = std::min(canvas.units_per_pixel(to_row(step.angles[i].corner)),
                                         0.42 * step.edge_length / label_pixels);
            add_angle(marks, step.angles[i], unit, i >= 2);
        }
    if (step.path.size() > 1) marks.lines.push_back({step.path, MarkRole::path, 1.0});
    if (step.simplex && !step.end) {
        MarkLine simplex{{}, MarkRole::simplex, 1.0};
        for (const int i : {0, 1, 2, 0})
            simplex.points.push_back({step.simplex->simplex[static_cast<std::size_t>(i)][0],
                                      step.simplex->simplex[static_cast<std::size_t>(i)][1], z});
        marks.lines.push_back(std::move(simplex));
    }
    marks.points.push_back({step.focus_start, MarkRole::soft, 0.0});
    if (*step.method == UntangleMethod::unsigned_angles)
        for (const Index node : step.nodes)
            if (node != *step.focus) marks.points.push_back({to_point(positions.row(node)), MarkRole::soft, 0.6});
    if (*step.method == UntangleMethod::guaranteed) marks.points.push_back({step.worst_point, MarkRole::worst, 1.0});
    marks.points.push_back({to_point(positions.row(*step.focus)), MarkRole::selected, 1.0});
    if (trial) {
        std::vector<Point> path;
        for (const Eigen::RowVector3d& point : trial->outcome.path) path.push_back(to_point(point));
        if (path.size() > 1) marks.lines.push_back({std::move(path), MarkRole::ghost, 1.0});
        marks.points.push_back({to_point(trial->outcome.position), MarkRole::outcome, 1.0});
    }
    return marks;
}

}  // namespace curvewright
