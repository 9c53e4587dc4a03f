#include "core/untangle/constrained_objective.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace curvewright {
namespace {

/// Of the limit is taken so much less that rounding does not lead beyond it.
constexpr double inside = 1.0 - 1e-9;

}  // namespace

ConstrainedObjective::Bend::Bend(const Eigen::VectorXd& v, double its_bend) : bend(its_bend) {
    if (bend > 0.0) shrink = 1.0 / std::sqrt(1.0 + bend * bend * v.squaredNorm());
}

Eigen::VectorXd ConstrainedObjective::Bend::pull_back(const Eigen::VectorXd& v, const Eigen::VectorXd& gradient) const {
    const double turn = shrink * shrink * bend * bend;
    return shrink * (gradient - turn * v.dot(gradient) * v);
}

Eigen::MatrixXd ConstrainedObjective::Bend::derivative(const Eigen::VectorXd& v) const {
    const double turn = shrink * shrink * bend * bend;
    return shrink * (Eigen::MatrixXd::Identity(v.size(), v.size()) - turn * v * v.transpose());
}

ConstrainedObjective::ConstrainedObjective(PatchObjective objective, const BoundaryShape* boundary,
                                           const Coordinates& x, std::vector<Foot> feet, const MoveLimit* limit)
    : objective_(std::move(objective)), boundary_(boundary), limit_(limit) {
    start_ = objective_.variables(x);
    const std::vector<Index>& nodes = patch().nodes;
    if ((feet.empty() && !limit_) || nodes.empty()) return;
    dimension_ = static_cast<int>(start_.size() / static_cast<Eigen::Index>(nodes.size()));
    cartesian_ = start_;
    if (limit_) free_bend_ = objective_.size() / (inside * limit_->distance);
    std::size_t next_foot = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Eigen::Index first = static_cast<Eigen::Index>(i) * dimension_;
        if (feet.empty() || !boundary_->slides(nodes[i])) {
            if (limit_) {
                leashes_.push_back({nodes[i], first, variable_count_, limit_->read->row(nodes[i]).transpose()});
                variable_count_ += dimension_;
                continue;
            }
            for (int d = 0; d < dimension_; ++d) others_.emplace_back(first + d, variable_count_++);
            continue;
        }
        Slide& slide = slides_.emplace_back();
        slide.node = nodes[i];
        slide.cartesian = first;
        slide.variable = variable_count_;
        slide.origin = x.row(nodes[i]).transpose();
        slide.foot = feet[next_foot++];
        slide.tangents = boundary_->tangents(slide.foot);
        slide.bend = bend_of_slide(slide);
        variable_count_ += boundary_->sliding_directions(nodes[i]);
    }
    start_ = Eigen::VectorXd::Zero(variable_count_);
    for (const auto& [cartesian, variable] : others_) start_[variable] = cartesian_[cartesian];
    for (const Leash& leash : leashes_) {
        const Eigen::VectorXd step = (x.row(leash.node).transpose() - leash.read).head(dimension_) / objective_.size();
        const double used = std::min(free_bend_ * step.norm(), inside);
        start_.segment(leash.variable, dimension_) = step / std::sqrt(1.0 - used * used);
    }
}

double ConstrainedObjective::bend_of_slide(const Slide& slide) const {
    if (!limit_) return 0.0;
    const double gone = (slide.origin - limit_->read->row(slide.node).transpose()).norm();
    const double left = std::max(inside * limit_->distance - gone, 1e-9 * limit_->distance);
    return objective_.size() / (0.5 * left);
}

Eigen::Vector3d ConstrainedObjective::leashed(const Leash& leash, const Eigen::VectorXd& variables) const {
    const Eigen::VectorXd v = variables.segment(leash.variable, dimension_);
    Eigen::Vector3d x = leash.read;
    x.head(dimension_) += objective_.size() * Bend(v, free_bend_).shrink * v;
    return x;
}

Eigen::Vector3d ConstrainedObjective::target(const Slide& slide, const Eigen::VectorXd& variables) const {
    const Eigen::VectorXd u = variables.segment(slide.variable, slide.tangents.cols());
    return slide.origin + objective_.size() * Bend(u, slide.bend).shrink * (slide.tangents * u);
}

Foot ConstrainedObjective::foot_of(const Slide& slide, const Eigen::VectorXd& variables) const {
    return boundary_->project(target(slide, variables), slide.foot);
}

void ConstrainedObjective::recentre(Eigen::VectorXd& variables) {
    for (Slide& slide : slides_) {
        auto u = variables.segment(slide.variable, slide.tangents.cols());
        if (!u.isZero(0.0)) {
            slide.foot = foot_of(slide, variables);
            slide.origin = boundary_->position(slide.foot);
            slide.tangents = boundary_->tangents(slide.foot);
            slide.bend = bend_of_slide(slide);
        }
        variables.segment(slide.variable, boundary_->sliding_directions(slide.node)).setZero();
    }
}

double ConstrainedObjective::evaluate(const Eigen::VectorXd& variables, const DistortionOptions& options,
                                      Eigen::VectorXd& gradient) {
    if (slides_.empty() && leashes_.empty()) return objective_.evaluate(variables, options, gradient);
    const Eigen::RowVector3d center = objective_.center();
    std::vector<Tangents> derivatives(slides_.size());
    parallel_for(slides_.size(), 64, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Slide& slide = slides_[i];
            const Eigen::Vector3d y = target(slide, variables);
            const Foot foot = boundary_->project(y, slide.foot);
            const Eigen::Vector3d x = boundary_->position(foot);
            derivatives[i] = boundary_->derivative(y, foot) * slide.tangents;
            if (slide.bend > 0.0) {
                const Eigen::VectorXd u = variables.segment(slide.variable, slide.tangents.cols());
                derivatives[i] = derivatives[i] * Bend(u, slide.bend).derivative(u);
            }
            for (int d = 0; d < dimension_; ++d)
                cartesian_[slide.cartesian + d] = (x[d] - center[d]) / objective_.size();
        }
    });
    for (const auto& [cartesian, variable] : others_) cartesian_[cartesian] = variables[variable];
    for (const Leash& leash : leashes_) {
        const Eigen::Vector3d x = leashed(leash, variables);
        for (int d = 0; d < dimension_; ++d) cartesian_[leash.cartesian + d] = (x[d] - center[d]) / objective_.size();
    }
    const double value = objective_.evaluate(cartesian_, options, cartesian_gradient_);
    gradient.setZero(variable_count_);
    for (const auto& [cartesian, variable] : others_) gradient[variable] = cartesian_gradient_[cartesian];
    for (const Leash& leash : leashes_) {
        const Eigen::VectorXd v = variables.segment(leash.variable, dimension_);
        gradient.segment(leash.variable, dimension_) =
            Bend(v, free_bend_).pull_back(v, cartesian_gradient_.segment(leash.cartesian, dimension_));
    }
    for (std::size_t i = 0; i < slides_.size(); ++i)
        gradient.segment(slides_[i].variable, derivatives[i].cols()) =
            derivatives[i].topRows(dimension_).transpose() *
            cartesian_gradient_.segment(slides_[i].cartesian, dimension_);
    return value;
}

void ConstrainedObjective::store(const Eigen::VectorXd& variables, Coordinates& x) const {
    if (slides_.empty() && leashes_.empty()) return objective_.store(variables, x);
    Eigen::VectorXd cartesian = cartesian_;
    for (const auto& [to, from] : others_) cartesian[to] = variables[from];
    objective_.store(cartesian, x);
    for (const Leash& leash : leashes_)
        x.row(leash.node).head(dimension_) = leashed(leash, variables).head(dimension_).transpose();
    // Directly, without the rounding of the change of units: a node that has not moved stays bit for bit.
    for (const Slide& slide : slides_) {
        const bool has_moved = !variables.segment(slide.variable, slide.tangents.cols()).isZero(0.0);
        const Eigen::Vector3d position = has_moved ? boundary_->position(foot_of(slide, variables)) : slide.origin;
        x.row(slide.node).head(dimension_) = position.head(dimension_).transpose();
    }
}

std::vector<Foot> ConstrainedObjective::feet(const Eigen::VectorXd& variables) const {
    std::vector<Foot> result;
    for (const Slide& slide : slides_) result.push_back(foot_of(slide, variables));
    return result;
}

}  // namespace curvewright
