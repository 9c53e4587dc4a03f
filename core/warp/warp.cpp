#include "core/warp/warp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <Eigen/QR>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/boundary/boundary_parts.h"
#include "core/mesh/conformity.h"
#include "core/mesh/renumbering.h"
#include "core/warp/elasticity.h"
#include "core/warp/equations.h"

namespace curvewright {

namespace {

void check(const CurvedMesh& mesh, const WarpOptions& options) {
    const MeshTopology& topology = mesh.topology();
    if (topology.dimension() < 2) throw Unsupported("Warping needs a mesh of dimension 2 or 3.");
    if (topology.boundary_nodes().empty())
        throw Unsupported("The mesh has no boundary that could be moved; it is closed, or it has no elements.");
    if (topology.dimension() == 2) {
        const double plane = mesh.coordinates()(topology.boundary_nodes().front(), 2);
        for (const std::vector<Index>* nodes : {&topology.boundary_nodes(), &topology.interior_nodes()})
            for (const Index node : *nodes)
                if (mesh.coordinates()(node, 2) != plane)
                    throw Unsupported(fmt::format(
                        "Node {} lies at z = {}, others at z = {}; a mesh of surface elements must lie in a plane of "
                        "constant z to be warped.",
                        topology.node_tag(node).value, mesh.coordinates()(node, 2), plane));
    }
    if (!(options.distance_power >= 0.0 && options.distance_power <= 8.0))
        throw InvalidInput(fmt::format("The distance power is {}; it must be from 0 to 8.", options.distance_power));
    if (!(options.sharing_power >= -8.0 && options.sharing_power <= 8.0))
        throw InvalidInput(fmt::format("The sharing power is {}; it must be from -8 to 8.", options.sharing_power));
    if (!(options.residual_tolerance > 0.0 && options.residual_tolerance < 1.0))
        throw InvalidInput(
            fmt::format("The residual tolerance is {}; it must be between 0 and 1.", options.residual_tolerance));
    if (options.weighting == Weighting::custom && !options.custom_weights)
        throw InvalidInput("Custom weights were asked for, but no weighting is given.");
}

WeightFunction weighting_of(const WarpOptions& options) {
    switch (options.weighting) {
        case Weighting::convex:
            return convex_weighting(options.distance_power, options.sharing_power);
        case Weighting::affine:
            return affine_weighting(options.distance_power, options.sharing_power);
        default:
            return options.custom_weights;
    }
}

/// Throws if there are nodes without the weights that were asked for.
void refuse(const std::vector<Index>& outside_hull, const std::vector<Index>& degenerate,
            const MeshTopology& topology) {
    const auto throw_for = [&](const std::vector<Index>& nodes, const char* what) {
        if (!nodes.empty())
            throw SolverFailure(fmt::format("{} {} {}; the first is node {}.", nodes.size(),
                                            nodes.size() == 1 ? "node" : "nodes", what,
                                            topology.node_tag(nodes.front()).value));
    };
    throw_for(outside_hull, "on or outside the hull of the neighbours, where there are no convex weights");
    throw_for(degenerate, "with neighbours that all lie on a line or in a plane");
}

/// Factors that make the rows of D_I more symmetric: a weight is about the neighbour's influence over the sum of the
/// patch's influences, and the part of the influence that shared elements give is the same seen from both ends.
Eigen::VectorXd symmetric_scale(const Numbering& numbering, const NeighbourSets& sets, double sharing_power) {
    Eigen::VectorXd scale = Eigen::VectorXd::Zero(numbering.solved);
    for (Index row = 0; row < numbering.solved; ++row)
        for (const std::uint16_t shared : sets.shared_elements_of(static_cast<std::size_t>(row)))
            scale[row] += real_power(shared, sharing_power);
    return scale;
}

/// The affine function of the position that fits values at some nodes best, by least squares; or only the constant that
/// does.
class AffineFit {
  public:
    AffineFit() = default;
    AffineFit(const CurvedMesh& mesh, const std::vector<Index>& nodes, bool is_constant)
        : slopes_(is_constant ? 0 : mesh.topology().dimension()) {
        const Eigen::Matrix<double, 2, 3> box = bounding_box(mesh);
        center_ = box.colwise().mean();
        size_ = std::max(std::numeric_limits<double>::min(), (box.row(1) - box.row(0)).maxCoeff());
        orthogonal_.compute(evaluate(mesh, nodes));
    }
    /// values: one row per node. Returns (slopes + 1) × k.
    Eigen::MatrixXd fit(const Eigen::MatrixXd& values) const { return orthogonal_.solve(values); }
    /// The basis functions at nodes: nodes × (slopes + 1).
    Eigen::MatrixXd evaluate(const CurvedMesh& mesh, const std::vector<Index>& nodes) const {
        Eigen::MatrixXd basis(static_cast<Eigen::Index>(nodes.size()), slopes_ + 1);
        for (Eigen::Index i = 0; i < basis.rows(); ++i) {
            basis.row(i).head(slopes_) =
                (mesh.coordinates().row(nodes[static_cast<std::size_t>(i)]) - center_).head(slopes_) / size_;
            basis(i, slopes_) = 1.0;
        }
        return basis;
    }

  private:
    int slopes_ = 2;
    Eigen::RowVector3d center_;
    double size_ = 1.0;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> orthogonal_;
};

}  // namespace

struct Warper::Data {
    Data(const CurvedMesh& m, const WarpOptions& o) : mesh(numbered_alike(m)), options(o) {
        if (mesh.shared_topology() != m.shared_topology()) given = m;
    }

    CurvedMesh mesh;                  ///< numbered alike
    std::optional<CurvedMesh> given;  ///< as it was given, if that is another one
    WarpOptions options;
    WarpReport report;
    std::vector<Index> given_nodes, following_nodes;
    Numbering numbering;
    int block = 1;
    BlockMatrix coupling;
    std::vector<CondensedEquations::Group> groups;
    AffineFit affine;
    std::optional<LinearSolver> solver;

    void set_up(const TaskContext& context);
    BlockMatrix equations(CoarseSpace& coarse, const TaskContext& context);
};

BlockMatrix Warper::Data::equations(CoarseSpace& coarse, const TaskContext& context) {
    Stopwatch watch;
    if (options.weighting == Weighting::elastic) {
        BlockMatrix result = elastic_equations(mesh, numbering, {options.poisson_ratio, options.stiffening}, context);
        report.weights_seconds = watch.seconds();
        coarse = vertex_space(mesh, numbering, block);
        return result;
    }
    const NeighbourSets sets = find_neighbours(mesh.topology(), numbering.free_nodes(), options.neighbours, context);
    if (sets.nodes.size() + sets.centers.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw Unsupported(fmt::format("The warp of this mesh has {} weights; at most {} are supported.",
                                      sets.nodes.size(), std::numeric_limits<int>::max()));
    report.neighbours_seconds = watch.seconds();
    watch = {};
    Coordinates mirrors;
    if (!following_nodes.empty()) {
        const BoundaryParts boundary(mesh);
        mirrors = Coordinates::Zero(mesh.topology().node_count(), 3);
        for (const Index node : following_nodes)
            mirrors.row(node) = boundary.normal(mesh.coordinates(), node).transpose();
    }
    const WeightTable table = compute_weights(mesh, sets, weighting_of(options), context, mirrors);
    for (std::size_t i = 0; i < sets.centers.size(); ++i) {
        if (table.status[i] == PatchStatus::outside_hull) report.outside_hull.push_back(sets.centers[i]);
        if (table.status[i] == PatchStatus::degenerate) report.degenerate.push_back(sets.centers[i]);
    }
    std::sort(report.outside_hull.begin(), report.outside_hull.end());
    std::sort(report.degenerate.begin(), report.degenerate.end());
    if (options.outside_hull == OutsideHull::refuse) refuse(report.outside_hull, report.degenerate, mesh.topology());
    BlockMatrix result = weight_equations(numbering, sets, table, context);
    for (const double value : result.values)
        if (!std::isfinite(value)) throw SolverFailure("The weighting gave a weight that is not finite.");
    coarse = vertex_space(mesh, numbering, block);
    coarse.row_scale =
        symmetric_scale(numbering, sets, options.weighting == Weighting::custom ? 0.0 : options.sharing_power);
    report.weights_seconds = watch.seconds();
    return result;
}

void Warper::Data::set_up(const TaskContext& context) {
    check(mesh, options);
    const MeshTopology& topology = mesh.topology();
    std::vector<bool> is_given(static_cast<std::size_t>(topology.node_count()), false);
    for (const Index node : topology.boundary_nodes()) is_given[static_cast<std::size_t>(node)] = true;
    for (const Index node : options.following_nodes) {
        if (node < 0 || node >= topology.node_count())
            throw InvalidInput(fmt::format("There is no node at position {} to follow; the mesh has {} nodes.", node,
                                           topology.node_count()));
        if (!topology.is_boundary_node(node) || !is_given[static_cast<std::size_t>(node)]) continue;
        is_given[static_cast<std::size_t>(node)] = false;
        following_nodes.push_back(node);
    }
    for (const Index node : options.prescribed_nodes) {
        if (node < 0 || node >= topology.node_count())
            throw InvalidInput(fmt::format("There is no node at position {} to be prescribed; the mesh has {} nodes.",
                                           node, topology.node_count()));
        if (topology.is_interior_node(node)) is_given[static_cast<std::size_t>(node)] = true;
    }
    for (Index node = 0; node < topology.node_count(); ++node)
        if (is_given[static_cast<std::size_t>(node)]) given_nodes.push_back(node);
    if (given_nodes.empty())
        throw InvalidInput(
            "All nodes of the boundary are to follow; at least one whose position is given was expected.");
    const bool is_elastic = options.weighting == Weighting::elastic;
    block = is_elastic ? topology.dimension() : 1;
    // Sets with all nodes of an element have room for what condensation adds; smaller ones have not.
    const bool condenses = options.condense && (is_elastic || options.neighbours != NeighbourKind::edge_connected);
    numbering = number_nodes(mesh, is_given, condenses);
    report.interior_nodes = numbering.free;
    report.condensed_nodes = numbering.free - numbering.solved;
    if (numbering.free == 0) {
        report.solver_note = "The mesh has no interior nodes; only its boundary moves.";
        return;
    }
    // Following nodes move by what happens along the boundary: of all affine motions they take part in translations
    // only.
    affine = AffineFit(mesh, given_nodes, !following_nodes.empty());
    LinearSystem system;
    BlockMatrix all = equations(system.coarse, context);
    const Stopwatch watch;
    CondensedEquations condensed = condense(numbering, std::move(all), context);
    coupling = std::move(condensed.coupling);
    groups = std::move(condensed.groups);
    system.matrix = std::move(condensed.matrix);
    system.is_symmetric = is_elastic;
    system.sweep = numbering.sweep;
    if (numbering.solved > 0)
        solver.emplace(
            std::move(system),
            SolverOptions{options.solver, options.ordering, options.residual_tolerance, options.max_iterations},
            context);
    report.solve_seconds = watch.seconds();
}

Warper::Warper(const CurvedMesh& mesh, const WarpOptions& options, const TaskContext& context) {
    require_conforming(mesh, context);
    auto data = std::make_unique<Data>(mesh, options);
    data->set_up(context);
    data_ = std::move(data);
}
Warper::~Warper() = default;
Warper::Warper(Warper&&) noexcept = default;

const CurvedMesh& Warper::mesh() const {
    return data_->given ? *data_->given : data_->mesh;
}
const WarpOptions& Warper::options() const {
    return data_->options;
}
const std::vector<Index>& Warper::given_nodes() const {
    return data_->given_nodes;
}
const WarpReport& Warper::setup_report() const {
    return data_->report;
}
int Warper::fields_per_motion() const {
    return data_->block;
}

MultiVector Warper::extend(const MultiVector& displacements, SolveReport& solve, const TaskContext& context) const {
    const Data& data = *data_;
    const Numbering& numbering = data.numbering;
    const Eigen::Index block = data.block, columns = displacements.cols(), motions = columns / block;
    if (displacements.rows() != data.mesh.topology().node_count() || motions * block != columns)
        throw InvalidInput(
            fmt::format("The motion to be extended is {} × {}; expected {} rows and a multiple of {} "
                        "columns.",
                        displacements.rows(), columns, data.mesh.topology().node_count(), block));
    MultiVector result = MultiVector::Zero(displacements.rows(), columns);
    Eigen::MatrixXd given(static_cast<Eigen::Index>(data.given_nodes.size()), columns);
    for (Eigen::Index i = 0; i < given.rows(); ++i) {
        const Index node = data.given_nodes[static_cast<std::size_t>(i)];
        result.row(node) = displacements.row(node);
        given.row(i) = displacements.row(node);
    }
    solve = {};
    solve.note = data.report.solver_note;
    if (numbering.free == 0 || given.isZero(0.0)) return result;

    // The affine part is taken as it is; the equations are left with the rest.
    const Eigen::MatrixXd affine = data.affine.fit(given);
    given -= data.affine.evaluate(data.mesh, data.given_nodes) * affine;
    const std::vector<Index> free_nodes = numbering.free_nodes();
    const Eigen::MatrixXd free_affine = data.affine.evaluate(data.mesh, free_nodes) * affine;

    // Unknowns of a node below each other, one column per motion.
    const auto pack = [&](const Eigen::MatrixXd& rows) {
        MultiVector packed(rows.rows() * block, motions);
        for (Eigen::Index i = 0; i < rows.rows(); ++i)
            for (Eigen::Index m = 0; m < motions; ++m)
                for (Eigen::Index d = 0; d < block; ++d) packed(i * block + d, m) = rows(i, m * block + d);
        return packed;
    };
    const MultiVector given_packed = pack(given);
    MultiVector right_hand_side, solved;
    if (numbering.solved > 0) {
        multiply(data.coupling, given_packed, right_hand_side, context);
        right_hand_side = -right_hand_side;
        solved = data.solver->solve(right_hand_side, solve, context);
    }
    MultiVector free(static_cast<Eigen::Index>(numbering.free) * block, motions);
    if (solved.rows() > 0) free.topRows(solved.rows()) = solved;
    parallel_for(data.groups.size(), 1024, context, {}, [&](std::size_t begin, std::size_t end) {
        MultiVector others;
        for (std::size_t g = begin; g < end; ++g) {
            const CondensedEquations::Group& group = data.groups[g];
            others.resize(static_cast<Eigen::Index>(group.columns.size()) * block, motions);
            for (std::size_t c = 0; c < group.columns.size(); ++c) {
                const Index number = group.columns[c];
                const auto target = static_cast<Eigen::Index>(c) * block;
                if (number < numbering.solved)
                    others.middleRows(target, block) = free.middleRows(number * block, block);
                else
                    others.middleRows(target, block) =
                        given_packed.middleRows((number - numbering.free) * block, block);
            }
            free.middleRows(numbering.group_offsets[g] * block, group.factors.rows()).noalias() =
                -group.factors * others;
        }
    });
    for (Index number = 0; number < numbering.free; ++number)
        for (Eigen::Index m = 0; m < motions; ++m)
            for (Eigen::Index d = 0; d < block; ++d)
                result(numbering.nodes[number], m * block + d) =
                    free_affine(number, m * block + d) + free(number * block + d, m);
    return result;
}

WarpResult Warper::move(const Coordinates& boundary_positions, const TaskContext& context) const {
    const Data& data = *data_;
    const MeshTopology& topology = data.mesh.topology();
    const Coordinates& start = data.mesh.coordinates();
    if (boundary_positions.rows() != topology.node_count())
        throw InvalidInput(fmt::format("The boundary positions are {} rows; the mesh has {} nodes.",
                                       boundary_positions.rows(), topology.node_count()));
    const int dim = topology.dimension();
    WarpResult result{start, data.report};
    MultiVector displacement = MultiVector::Zero(topology.node_count(), dim);
    for (const Index node : data.given_nodes) {
        if (!boundary_positions.row(node).allFinite())
            throw InvalidInput(
                fmt::format("The new position of node {} is not finite.", topology.node_tag(node).value));
        if (dim == 2 && boundary_positions(node, 2) != start(node, 2))
            throw InvalidInput(
                fmt::format("Boundary node {} of the 2D mesh would leave its plane (z = {} instead of {}); "
                            "a deformation of a 2D mesh must keep z.",
                            topology.node_tag(node).value, boundary_positions(node, 2), start(node, 2)));
        result.coordinates.row(node) = boundary_positions.row(node);
        displacement.row(node) = (boundary_positions.row(node) - start.row(node)).head(dim);
    }
    const Stopwatch watch;
    SolveReport solve;
    const MultiVector moved = extend(displacement, solve, context);
    for (Index number = 0; number < data.numbering.free; ++number) {
        const Index node = data.numbering.nodes[number];
        result.coordinates.row(node).head(dim) += moved.row(node);
    }
    if (!result.coordinates.allFinite()) throw SolverFailure("The warp gave positions that are not finite.");
    result.report.solver = solve.solver;
    result.report.solver_note = solve.note;
    result.report.iterations = solve.iterations;
    result.report.residual = solve.residual;
    result.report.solve_seconds += watch.seconds();
    return result;
}

WarpResult warp(const CurvedMesh& mesh, const Coordinates& boundary_positions, const WarpOptions& options,
                const TaskContext& context) {
    return Warper(mesh, options, context).move(boundary_positions, context);
}

}  // namespace curvewright
