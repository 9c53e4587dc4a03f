#include "core/warp/equations.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

#include <Eigen/LU>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// Position of a node along a Morton curve through the box: 21 bits per direction, interleaved.
std::uint64_t morton_code(const Eigen::RowVector3d& position, const Eigen::RowVector3d& low, double size) {
    std::uint64_t code = 0;
    for (int d = 0; d < 3; ++d) {
        const double fraction = size > 0.0 ? (position[d] - low[d]) / size : 0.0;
        auto cell = static_cast<std::uint64_t>(std::clamp(fraction, 0.0, 1.0) * 2097151.0);
        // Spread the bits two apart.
        cell = (cell | cell << 32) & 0x1f00000000ffffULL;
        cell = (cell | cell << 16) & 0x1f0000ff0000ffULL;
        cell = (cell | cell << 8) & 0x100f00f00f00f00fULL;
        cell = (cell | cell << 4) & 0x10c30c30c30c30c3ULL;
        cell = (cell | cell << 2) & 0x1249249249249249ULL;
        code |= cell << d;
    }
    return code;
}

void sort_along_curve(const CurvedMesh& mesh, std::vector<Index>& nodes) {
    const Eigen::Matrix<double, 2, 3> box = bounding_box(mesh);
    const double size = (box.row(1) - box.row(0)).maxCoeff();
    std::vector<std::pair<std::uint64_t, Index>> keys;
    keys.reserve(nodes.size());
    for (const Index node : nodes) keys.emplace_back(morton_code(mesh.coordinates().row(node), box.row(0), size), node);
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = keys[i].second;
}

/// Cuts the nodes into pieces of nearly equal size, colours the pieces so that two of one colour share no element, and
/// puts the pieces of one colour next to each other.
SweepOrder order_by_stages(const MeshTopology& topology, std::vector<Index>& nodes) {
    const std::size_t count = nodes.size();
    const std::size_t piece_size = std::clamp<std::size_t>(count / 128, 256, 8192);
    const std::size_t pieces = std::max<std::size_t>(1, (count + piece_size / 2) / piece_size);
    const auto first_of = [&](std::size_t piece) { return piece * count / pieces; };
    std::vector<Index> piece_of(static_cast<std::size_t>(topology.node_count()), -1);
    for (std::size_t piece = 0; piece < pieces; ++piece)
        for (std::size_t i = first_of(piece); i < first_of(piece + 1); ++i)
            piece_of[nodes[i]] = static_cast<Index>(piece);
    std::vector<bool> is_adjacent(pieces * pieces, false);
    std::vector<Index> touched;
    for (Index element = 0; element < topology.element_count(); ++element) {
        touched.clear();
        for (const Index node : topology.element_nodes(element))
            if (piece_of[node] >= 0 && std::find(touched.begin(), touched.end(), piece_of[node]) == touched.end())
                touched.push_back(piece_of[node]);
        for (const Index a : touched)
            for (const Index b : touched) is_adjacent[static_cast<std::size_t>(a) * pieces + b] = true;
    }
    std::vector<int> color(pieces, -1);
    int colors = 0;
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        std::vector<bool> is_taken(static_cast<std::size_t>(colors) + 1, false);
        for (std::size_t other = 0; other < piece; ++other)
            if (is_adjacent[piece * pieces + other]) is_taken[static_cast<std::size_t>(color[other])] = true;
        color[piece] = static_cast<int>(std::find(is_taken.begin(), is_taken.end(), false) - is_taken.begin());
        colors = std::max(colors, color[piece] + 1);
    }
    SweepOrder order;
    std::vector<Index> sorted;
    sorted.reserve(count);
    for (int c = 0; c < colors; ++c) {
        order.stages.push_back(static_cast<Index>(order.pieces.size()));
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            if (color[piece] != c) continue;
            order.pieces.push_back(static_cast<Index>(sorted.size()));
            for (std::size_t i = first_of(piece); i < first_of(piece + 1); ++i) sorted.push_back(nodes[i]);
        }
    }
    order.stages.push_back(static_cast<Index>(order.pieces.size()));
    order.pieces.push_back(static_cast<Index>(count));
    nodes = std::move(sorted);
    return order;
}

}  // namespace

Numbering number_nodes(const CurvedMesh& mesh, const std::vector<bool>& is_given, bool condense) {
    const MeshTopology& topology = mesh.topology();
    Numbering numbering;
    std::vector<Index> condensed, given;
    std::vector<bool> is_condensed(is_given.size(), false);
    std::vector<Index> group_sizes;
    if (condense)
        for (Index element = 0; element < topology.element_count(); ++element) {
            const auto nodes = topology.element_nodes(element);
            const std::size_t before = condensed.size();
            for (const int local : reference_element(topology.element_type(element)).interior_nodes) {
                const Index node = nodes[static_cast<std::size_t>(local)];
                if (is_given[static_cast<std::size_t>(node)]) continue;
                is_condensed[static_cast<std::size_t>(node)] = true;
                condensed.push_back(node);
            }
            if (condensed.size() > before) group_sizes.push_back(static_cast<Index>(condensed.size() - before));
        }
    for (const std::vector<Index>* nodes : {&topology.interior_nodes(), &topology.boundary_nodes()})
        for (const Index node : *nodes)
            if (!is_given[static_cast<std::size_t>(node)] && !is_condensed[static_cast<std::size_t>(node)])
                numbering.nodes.push_back(node);
    sort_along_curve(mesh, numbering.nodes);
    numbering.sweep = order_by_stages(topology, numbering.nodes);
    numbering.solved = static_cast<Index>(numbering.nodes.size());
    numbering.nodes.insert(numbering.nodes.end(), condensed.begin(), condensed.end());
    numbering.free = static_cast<Index>(numbering.nodes.size());
    numbering.group_offsets.push_back(numbering.solved);
    for (const Index size : group_sizes) numbering.group_offsets.push_back(numbering.group_offsets.back() + size);
    for (Index node = 0; node < topology.node_count(); ++node)
        if (is_given[static_cast<std::size_t>(node)]) numbering.nodes.push_back(node);
    numbering.number_of.assign(static_cast<std::size_t>(topology.node_count()), -1);
    for (std::size_t number = 0; number < numbering.nodes.size(); ++number)
        numbering.number_of[numbering.nodes[number]] = static_cast<Index>(number);
    return numbering;
}

BlockMatrix weight_equations(const Numbering& numbering, const NeighbourSets& sets, const WeightTable& table,
                             const TaskContext& context) {
    BlockMatrix equations;
    equations.rows = numbering.free;
    equations.columns = static_cast<Index>(numbering.nodes.size());
    const auto rows = static_cast<std::size_t>(numbering.free);
    equations.offsets.resize(rows + 1);
    for (std::size_t row = 0; row <= rows; ++row) equations.offsets[row] = sets.offsets[row] + row;
    equations.column_of.resize(equations.offsets.back());
    equations.values.resize(equations.offsets.back());
    parallel_for(rows, 4096, context, {}, [&](std::size_t begin, std::size_t end) {
        std::vector<std::pair<Index, double>> entries;
        for (std::size_t row = begin; row < end; ++row) {
            entries.assign(1, {static_cast<Index>(row), 1.0});
            for (std::size_t k = sets.offsets[row]; k < sets.offsets[row + 1]; ++k)
                entries.emplace_back(numbering.number_of[sets.nodes[k]], -table.weights[k]);
            std::sort(entries.begin(), entries.end());
            for (std::size_t e = 0; e < entries.size(); ++e) {
                equations.column_of[equations.offsets[row] + e] = entries[e].first;
                equations.values[equations.offsets[row] + e] = entries[e].second;
            }
        }
    });
    return equations;
}

namespace {

/// Factors of one element's condensed nodes.
CondensedEquations::Group condense_group(const BlockMatrix& equations, Index first, Index last) {
    const int b = equations.block;
    const Index size = last - first;
    CondensedEquations::Group group;
    const auto row_begin = equations.offsets[first], row_end = equations.offsets[static_cast<std::size_t>(first) + 1];
    for (std::size_t k = row_begin; k < row_end; ++k)
        if (equations.column_of[k] < first || equations.column_of[k] >= last)
            group.columns.push_back(equations.column_of[k]);
    Eigen::MatrixXd own(size * b, size * b);
    Eigen::MatrixXd others(size * b, static_cast<Eigen::Index>(group.columns.size()) * b);
    for (Index row = first; row < last; ++row) {
        Eigen::Index other = 0;
        for (std::size_t k = equations.offsets[row]; k < equations.offsets[static_cast<std::size_t>(row) + 1]; ++k) {
            const Eigen::Map<const MultiVector> block(equations.block_at(k), b, b);
            const Index column = equations.column_of[k];
            if (column >= first && column < last)
                own.block((row - first) * b, (column - first) * b, b, b) = block;
            else
                others.block((row - first) * b, other++ * b, b, b) = block;
        }
    }
    const Eigen::PartialPivLU<Eigen::MatrixXd> factor(own);
    group.factors = factor.solve(others);
    if (!group.factors.allFinite()) throw SolverFailure("The equations of the nodes inside an element are singular.");
    return group;
}

}  // namespace

CondensedEquations condense(const Numbering& numbering, BlockMatrix equations, const TaskContext& context) {
    const int b = equations.block;
    const auto area = static_cast<std::size_t>(b * b);
    const auto solved = static_cast<std::size_t>(numbering.solved);
    CondensedEquations result;
    result.groups.resize(numbering.group_offsets.size() - 1);
    parallel_for(result.groups.size(), 256, context, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g)
            result.groups[g] = condense_group(equations, numbering.group_offsets[g], numbering.group_offsets[g + 1]);
    });
    std::vector<Index> group_of(static_cast<std::size_t>(numbering.free - numbering.solved));
    for (std::size_t g = 0; g < result.groups.size(); ++g)
        for (Index number = numbering.group_offsets[g]; number < numbering.group_offsets[g + 1]; ++number)
            group_of[static_cast<std::size_t>(number - numbering.solved)] = static_cast<Index>(g);

    BlockMatrix &matrix = result.matrix, &coupling = result.coupling;
    matrix.block = coupling.block = b;
    matrix.rows = matrix.columns = coupling.rows = numbering.solved;
    coupling.columns = numbering.given();
    matrix.offsets.assign(solved + 1, 0);
    coupling.offsets.assign(solved + 1, 0);
    for (std::size_t row = 0; row < solved; ++row)
        for (std::size_t k = equations.offsets[row]; k < equations.offsets[row + 1]; ++k) {
            if (equations.column_of[k] < numbering.solved) ++matrix.offsets[row + 1];
            if (equations.column_of[k] >= numbering.free) ++coupling.offsets[row + 1];
        }
    for (std::size_t row = 0; row < solved; ++row) {
        matrix.offsets[row + 1] += matrix.offsets[row];
        coupling.offsets[row + 1] += coupling.offsets[row];
    }
    for (BlockMatrix* target : {&matrix, &coupling}) {
        target->column_of.resize(target->offsets.back());
        target->values.resize(target->offsets.back() * area);
    }
    // The columns of a row hold those of every element that the row's node shares with a condensed node: no fill.
    const std::size_t grain = std::max<std::size_t>(2048, solved / 32 + 1);
    parallel_for(solved, grain, context, {}, [&](std::size_t begin, std::size_t end) {
        std::vector<double*> place(numbering.nodes.size(), nullptr);
        for (std::size_t row = begin; row < end; ++row) {
            if (row % 4096 == 0) context.check();
            std::size_t in_matrix = matrix.offsets[row], in_coupling = coupling.offsets[row];
            std::size_t first_condensed = equations.offsets[row + 1], last_condensed = first_condensed;
            for (std::size_t k = equations.offsets[row]; k < equations.offsets[row + 1]; ++k) {
                const Index column = equations.column_of[k];
                if (column >= numbering.solved && column < numbering.free) {
                    first_condensed = std::min(first_condensed, k);
                    last_condensed = k + 1;
                    continue;
                }
                const bool is_given = column >= numbering.free;
                BlockMatrix& target = is_given ? coupling : matrix;
                const std::size_t at = is_given ? in_coupling++ : in_matrix++;
                target.column_of[at] = is_given ? column - numbering.free : column;
                place[column] = target.block_at(at);
                std::copy_n(equations.block_at(k), area, place[column]);
            }
            for (std::size_t k = first_condensed; k < last_condensed; ++k) {
                const Index column = equations.column_of[k];
                const Index g = group_of[static_cast<std::size_t>(column - numbering.solved)];
                const CondensedEquations::Group& group = result.groups[g];
                const double* value = equations.block_at(k);
                const Eigen::Index factor_row = (column - numbering.group_offsets[g]) * b;
                for (std::size_t c = 0; c < group.columns.size(); ++c) {
                    double* target = place[group.columns[c]];
                    for (int r = 0; r < b; ++r)
                        for (int s = 0; s < b; ++s)
                            for (int t = 0; t < b; ++t)
                                target[r * b + t] -=
                                    value[r * b + s] *
                                    group.factors(factor_row + s, static_cast<Eigen::Index>(c) * b + t);
                }
            }
        }
    });
    return result;
}

CoarseSpace vertex_space(const CurvedMesh& mesh, const Numbering& numbering, int block) {
    const MeshTopology& topology = mesh.topology();
    // Per solved node: an element that it belongs to, and where in it.
    std::vector<std::pair<Index, int>> home(static_cast<std::size_t>(numbering.solved), {-1, 0});
    std::vector<Index> vertex_number(static_cast<std::size_t>(topology.node_count()), -1);
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto nodes = topology.element_nodes(element);
        const int corners = corner_count(topology.element_type(element).shape);
        for (std::size_t local = 0; local < nodes.size(); ++local) {
            const Index number = numbering.number_of[nodes[local]];
            if (number < 0 || number >= numbering.solved) continue;
            if (home[number].first < 0 || static_cast<int>(local) < corners)
                home[number] = {element, static_cast<int>(local)};
            if (static_cast<int>(local) < corners) vertex_number[nodes[local]] = 0;
        }
    }
    // Vertices in the order of the curve.
    std::vector<Index> vertices;
    for (Index number = 0; number < numbering.solved; ++number)
        if (vertex_number[numbering.nodes[number]] == 0) {
            vertex_number[numbering.nodes[number]] = static_cast<Index>(vertices.size());
            vertices.push_back(numbering.nodes[number]);
        }
    std::map<ElementType, Eigen::MatrixXd> linear;  // values of the linear shape functions at the nodes
    CoarseSpace space;
    space.prolongation.resize(numbering.solved, static_cast<Eigen::Index>(vertices.size()));
    std::vector<std::pair<Index, double>> entries;
    for (Index number = 0; number < numbering.solved; ++number) {
        space.prolongation.startVec(number);
        const auto [element, local] = home[number];
        const ElementType type = topology.element_type(element);
        const auto nodes = topology.element_nodes(element);
        entries.clear();
        if (type.shape == Shape::pyramid) {
            // No linear functions here: its vertices stand for themselves.
            if (local < corner_count(type.shape)) entries.emplace_back(vertex_number[nodes[local]], 1.0);
        } else {
            const auto [found, is_new] = linear.try_emplace(type);
            if (is_new) found->second = lagrange_basis({type.shape, 1}, reference_nodes(type)).values;
            for (int corner = 0; corner < corner_count(type.shape); ++corner) {
                const double value = found->second(local, corner);
                const Index vertex = vertex_number[nodes[static_cast<std::size_t>(corner)]];
                if (vertex >= 0 && value > 1e-12) entries.emplace_back(vertex, value);
            }
        }
        std::sort(entries.begin(), entries.end());
        for (const auto& [vertex, value] : entries) space.prolongation.insertBack(number, vertex) = value;
    }
    space.prolongation.finalize();

    const auto count = static_cast<Eigen::Index>(vertices.size());
    if (block == 1) {
        space.near_null = Eigen::MatrixXd::Ones(count, 1);
        return space;
    }
    const Eigen::RowVector3d center = bounding_box(mesh).colwise().mean();
    const double size = std::max(1e-300, (bounding_box(mesh).row(1) - bounding_box(mesh).row(0)).maxCoeff());
    space.near_null = Eigen::MatrixXd::Zero(count * block, block == 2 ? 3 : 6);
    for (Eigen::Index v = 0; v < count; ++v) {
        const Eigen::RowVector3d x = (mesh.coordinates().row(vertices[static_cast<std::size_t>(v)]) - center) / size;
        auto rows = space.near_null.middleRows(v * block, block);
        rows.leftCols(block).setIdentity();
        if (block == 2) {
            rows.col(2) << -x[1], x[0];
        } else {
            rows.col(3) << 0.0, -x[2], x[1];
            rows.col(4) << x[2], 0.0, -x[0];
            rows.col(5) << -x[1], x[0], 0.0;
        }
    }
    return space;
}

}  // namespace curvewright
