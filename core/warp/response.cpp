#include "core/warp/response.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace curvewright {

AffineMotion AffineMotion::translation(const Eigen::Vector3d& vector) {
    AffineMotion motion;
    motion.shift = vector;
    return motion;
}
AffineMotion AffineMotion::rotation(const Eigen::Vector3d& axis, double angle) {
    AffineMotion motion;
    motion.linear = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    return motion;
}
AffineMotion AffineMotion::scaling(const Eigen::Vector3d& factors) {
    AffineMotion motion;
    motion.linear = factors.asDiagonal();
    return motion;
}
AffineMotion AffineMotion::shear(int axis, int along, double factor) {
    AffineMotion motion;
    motion.linear(axis, along) += factor;
    return motion;
}

ResponseField::ResponseField(const Warper& warper, const DraggedSet& set, ResponseKind kind,
                             const Eigen::Vector3d& origin, const TaskContext& context)
    : ResponseField(warper, set, kind, origin, warper.mesh().coordinates(), context) {}

ResponseField::ResponseField(const Warper& warper, const DraggedSet& set, ResponseKind kind,
                             const Eigen::Vector3d& origin, const Coordinates& start, const TaskContext& context,
                             const BoundaryFollowing& following)
    : dim_(warper.mesh().topology().dimension()),
      kind_(kind),
      origin_(origin),
      node_count_(warper.mesh().topology().node_count()) {
    const Index nodes = node_count_;
    if (start.rows() != nodes)
        throw InvalidInput(fmt::format("The positions are {} rows; the mesh has {} nodes.", start.rows(), nodes));
    if (!set.weights.empty() && set.weights.size() != set.nodes.size())
        throw InvalidInput(
            fmt::format("The dragged set has {} nodes and {} weights.", set.nodes.size(), set.weights.size()));
    // A projection mixes the directions.
    const bool has_projections =
        std::any_of(following.projections.begin(), following.projections.end(),
                    [](const Eigen::Matrix3d& projection) { return !projection.isIdentity(0.0); });
    is_vector_ = warper.fields_per_motion() > 1 || has_projections;
    MultiVector motions = dragged_motions(warper, set, start, is_vector_);
    if (!following.nodes.empty()) add_following(following, set, start, motions, context);
    SolveReport report;
    const MultiVector response = warper.extend(motions, report, context);
    for (Index node = 0; node < nodes; ++node)
        if (!response.row(node).isZero(0.0)) moving_.push_back(node);
    fields_.resize(static_cast<Eigen::Index>(moving_.size()), response.cols());
    for (std::size_t i = 0; i < moving_.size(); ++i)
        fields_.row(static_cast<Eigen::Index>(i)) = response.row(moving_[i]);
}

/// Functions of the position that a motion is made of, at the dragged nodes: the weight, and the weight times each
/// coordinate. nodes × functions, or with vectors nodes × (functions · dimension²): motion f along direction a is
/// column a of its own group of columns.
MultiVector ResponseField::dragged_motions(const Warper& warper, const DraggedSet& set, const Coordinates& start,
                                           bool is_vector) const {
    const MeshTopology& topology = warper.mesh().topology();
    const int functions = kind_ == ResponseKind::translation ? 1 : dim_ + 1;
    const int directions = is_vector ? dim_ : 1;
    MultiVector motions = MultiVector::Zero(node_count_, functions * directions * directions);
    for (std::size_t i = 0; i < set.nodes.size(); ++i) {
        const Index node = set.nodes[i];
        const auto& given = warper.given_nodes();
        if (!std::binary_search(given.begin(), given.end(), node))
            throw InvalidInput(
                node >= 0 && node < node_count_
                    ? fmt::format("Node {} cannot be dragged: its motion is not given, it follows others.",
                                  topology.node_tag(node).value)
                    : fmt::format("There is no node at position {}; the mesh has {} nodes.", node, node_count_));
        const double weight = set.weights.empty() ? 1.0 : set.weights[i];
        if (!std::isfinite(weight))
            throw InvalidInput(
                fmt::format("The weight of the dragged node {} is not finite.", topology.node_tag(node).value));
        for (int f = 0; f < functions; ++f) {
            const double value = f == 0 ? weight : weight * (start(node, f - 1) - origin_[f - 1]);
            for (int a = 0; a < directions; ++a) motions(node, (f * directions + a) * directions + a) = value;
        }
    }
    return motions;
}

/// Adds how the following nodes move: as their own warper says, projected.
void ResponseField::add_following(const BoundaryFollowing& following, const DraggedSet& set, const Coordinates& start,
                                  MultiVector& motions, const TaskContext& context) const {
    const Warper& warper = *following.warper;
    if (following.projections.size() != following.nodes.size() || warper.mesh().topology().node_count() != node_count_)
        throw InvalidInput("The following nodes of the boundary do not belong to the mesh that is dragged.");
    const bool is_elastic = warper.fields_per_motion() > 1;
    SolveReport report;
    const MultiVector response = warper.extend(dragged_motions(warper, set, start, is_elastic), report, context);
    const int functions = kind_ == ResponseKind::translation ? 1 : dim_ + 1;
    for (std::size_t i = 0; i < following.nodes.size(); ++i) {
        const Index node = following.nodes[i];
        if (!is_vector_) {
            motions.row(node) = response.row(node);
            continue;
        }
        const Eigen::MatrixXd projection = following.projections[i].topLeftCorner(dim_, dim_);
        for (int f = 0; f < functions; ++f)
            for (int a = 0; a < dim_; ++a) {
                const Eigen::Index group = static_cast<Eigen::Index>(f * dim_ + a) * dim_;
                Eigen::VectorXd moved = Eigen::VectorXd::Zero(dim_);
                if (is_elastic)
                    moved = response.row(node).segment(group, dim_).transpose();
                else
                    moved[a] = response(node, f);
                motions.row(node).segment(group, dim_) = (projection * moved).transpose();
            }
    }
}

namespace {

/// rows(row) = from(row) + the fields of the row times the coefficients of the motion. Scalar fields (Fields of them)
/// have a coefficient per coordinate; vector fields one coefficient and Dim columns each.
template <int Dim, int Fields, bool IsVector>
void add_response(const std::vector<Index>& nodes, const MultiVector& fields, const double* coefficients,
                  const Coordinates& start, Coordinates& result) {
    constexpr int width = IsVector ? Fields * Dim : Fields;
    parallel_for(nodes.size(), 8192, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double* field = fields.data() + i * width;
            const double* from = start.data() + static_cast<std::size_t>(nodes[i]) * 3;
            double* to = result.data() + static_cast<std::size_t>(nodes[i]) * 3;
            double sum[Dim];
            for (int d = 0; d < Dim; ++d) sum[d] = from[d];
            for (int f = 0; f < Fields; ++f)
                for (int d = 0; d < Dim; ++d)
                    sum[d] += IsVector ? coefficients[f] * field[f * Dim + d] : coefficients[f * Dim + d] * field[f];
            for (int d = 0; d < Dim; ++d) to[d] = sum[d];
        }
    });
}

}  // namespace

void ResponseField::apply(const AffineMotion& motion, const Coordinates& start, Coordinates& result) const {
    if (start.rows() != node_count_)
        throw InvalidInput(
            fmt::format("The positions are {} rows; the field's mesh has {} nodes.", start.rows(), node_count_));
    const Eigen::Matrix3d linear = motion.linear - Eigen::Matrix3d::Identity();
    if (kind_ == ResponseKind::translation && !linear.isZero(0.0))
        throw InvalidInput("This response field was made for translations; it cannot turn, scale or shear.");
    // Displacement of a dragged node: weight · (linear (x - origin) + shift), component by component a sum over
    // functions.
    const int functions = kind_ == ResponseKind::translation ? 1 : dim_ + 1;
    const auto coefficient = [&](int function, int a) {
        return function == 0 ? motion.shift[a] : linear(a, function - 1);
    };
    // Per function and direction of the motion.
    std::array<double, 12> coefficients{};
    for (int f = 0; f < functions; ++f)
        for (int a = 0; a < dim_; ++a) coefficients[static_cast<std::size_t>(f * dim_ + a)] = coefficient(f, a);
    if (result.rows() != start.rows()) result = start;
    const auto add = [&]<int Dim, int Functions>() {
        if (is_vector_)
            add_response<Dim, Functions * Dim, true>(moving_, fields_, coefficients.data(), start, result);
        else
            add_response<Dim, Functions, false>(moving_, fields_, coefficients.data(), start, result);
    };
    const bool is_translation = kind_ == ResponseKind::translation;
    if (dim_ == 2)
        is_translation ? add.operator()<2, 1>() : add.operator()<2, 3>();
    else
        is_translation ? add.operator()<3, 1>() : add.operator()<3, 4>();
}

double ResponseField::translation_share(Index node) const {
    const auto found = std::lower_bound(moving_.begin(), moving_.end(), node);
    if (found == moving_.end() || *found != node) return 0.0;
    return fields_(static_cast<Eigen::Index>(found - moving_.begin()), 0);
}

}  // namespace curvewright
