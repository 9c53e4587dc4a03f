#include "core/mesh/elevate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// Identity of a new node: the corners (positions in the old mesh, ascending) with a non-zero multilinear weight, and
/// those weights as integers in lowest terms; then, after (-1, 0), the other old nodes of the edge or face that it lies
/// on. Neighbours compute the same key for the same node; the two sides of a slit, which have corners in common but not
/// the nodes between them, compute different ones.
using NodeKey = std::vector<std::pair<Index, long>>;

/// What a node of the new cell is in terms of the old cell; positions are those in the cells.
struct PlannedNode {
    std::vector<std::pair<int, long>> corners;          ///< with their multilinear weights, times order^dimension
    std::vector<int> between;                           ///< old nodes, not corners, of the edge or face it lies on
    int same = -1;                                      ///< the old node that lies at the same lattice point
    std::vector<std::pair<int, double>> interpolation;  ///< the old cell's shape functions there
};

/// Integer multilinear weights of the corners at every lattice point: nodes × corners.
Eigen::MatrixXd corner_weights(ElementType type) {
    if (type.shape == Shape::vertex) return Eigen::MatrixXd::Ones(1, 1);
    if (type.shape == Shape::pyramid) {
        // Bilinear on every layer, and the layer shrinks to the apex.
        const std::vector<LatticePoint>& lattice = reference_element(type).lattice;
        Eigen::MatrixXd weights(static_cast<Eigen::Index>(lattice.size()), 5);
        for (std::size_t node = 0; node < lattice.size(); ++node) {
            const auto [i, j, k] = lattice[node];
            const int m = type.order - k;
            weights.row(static_cast<Eigen::Index>(node)) << (m - i) * (m - j), i * (m - j), i * j, (m - i) * j,
                m > 0 ? k * m : 1;
        }
        return weights;
    }
    double scale = 1.0;
    for (int d = 0; d < dimension(type.shape); ++d) scale *= type.order;
    return scale * lagrange_basis({type.shape, 1}, reference_nodes(type)).values;
}

bool is_identity(ElementType from, int order) {
    return from.shape == Shape::vertex || from.order == order;
}

std::vector<PlannedNode> make_plan(ElementType from, ElementType to) {
    const Eigen::MatrixXd weights = corner_weights(to), old_weights = corner_weights(from);
    const bool has_basis = from.shape != Shape::vertex && from.shape != Shape::pyramid;
    Eigen::MatrixXd values;
    if (has_basis) values = lagrange_basis(from, reference_nodes(to)).values;
    std::vector<PlannedNode> plan(static_cast<std::size_t>(weights.rows()));
    for (Eigen::Index i = 0; i < weights.rows(); ++i) {
        PlannedNode& node = plan[static_cast<std::size_t>(i)];
        for (int c = 0; c < weights.cols(); ++c)
            if (const long weight = std::lround(weights(i, c)); weight != 0) node.corners.emplace_back(c, weight);
        if (node.corners.size() == 1) node.same = node.corners.front().first;
        const LatticePoint point = from.shape == Shape::vertex ? LatticePoint{} : reference_element(to).lattice[i];
        for (int old = 0; old < static_cast<int>(old_weights.rows()); ++old) {
            // On the same edge or face: no corner counts there that does not count here.
            bool is_on = true;
            for (int c = 0; c < weights.cols(); ++c)
                is_on = is_on && (std::lround(old_weights(old, c)) == 0 || std::lround(weights(i, c)) != 0);
            if (!is_on) continue;
            if (old >= static_cast<int>(weights.cols())) node.between.push_back(old);
            if (has_basis && values(i, old) != 0.0) node.interpolation.emplace_back(old, values(i, old));
            if (from.shape == Shape::vertex) continue;
            const LatticePoint& at = reference_element(from).lattice[old];
            bool is_same = true;
            for (int d = 0; d < 3; ++d) is_same = is_same && at[d] * to.order == point[d] * from.order;
            if (is_same) node.same = old;
        }
    }
    return plan;
}

/// Sorted corners of an edge or face, by which cells of different orders meet.
using Corners = std::vector<Index>;

/// Edges and faces that cells of different orders have in common.
std::set<Corners> find_shared_between_orders(const MeshTopology& topology) {
    std::set<int> orders;
    for (const ElementBlock& block : topology.blocks())
        if (block.size() > 0 && dimension(block.type.shape) > 0) orders.insert(block.type.order);
    std::set<Corners> result;
    if (orders.size() < 2) return result;
    std::map<Corners, int> order_of;
    for (const ElementBlock& block : topology.blocks()) {
        if (dimension(block.type.shape) == 0) continue;
        const ReferenceElement& cell = reference_element(block.type);
        const auto per_cell = static_cast<std::size_t>(node_count(block.type));
        std::vector<const SubElement*> parts;
        for (const auto* list : {&cell.edges, &cell.faces})
            for (const SubElement& part : *list) parts.push_back(&part);
        for (std::size_t first = 0; first < block.nodes.size(); first += per_cell)
            for (const SubElement* part : parts) {
                Corners corners;
                for (int i = 0; i < corner_count(part->type.shape); ++i)
                    corners.push_back(block.nodes[first + static_cast<std::size_t>(part->nodes[i])]);
                std::sort(corners.begin(), corners.end());
                const auto [entry, is_new] = order_of.try_emplace(corners, block.type.order);
                if (!is_new && entry->second != block.type.order) result.insert(corners);
            }
    }
    return result;
}

/// Makes the mesh of another order, cell by cell.
class Elevation {
  public:
    Elevation(const CurvedMesh& mesh, const ElevateOptions& options)
        : mesh_(mesh), old_(mesh.topology()), options_(options), between_orders_(find_shared_between_orders(old_)) {
        const auto box = bounding_box(mesh);
        diagonal_ = (box.row(1) - box.row(0)).norm();
        data_.entities = old_.entities();
        data_.groups = old_.groups();
        data_.blocks.resize(old_.blocks().size());
    }

    ElevateResult run(const TaskContext& context) {
        for (const ElementBlock& block : old_.blocks()) plan_of(block.type);
        keep_old_nodes();
        // Cells of low dimension first, so that a new node is classified on the lowest entity it lies on.
        std::vector<std::size_t> by_dimension(old_.blocks().size());
        std::iota(by_dimension.begin(), by_dimension.end(), 0u);
        std::stable_sort(by_dimension.begin(), by_dimension.end(), [&](std::size_t a, std::size_t b) {
            return dimension(old_.blocks()[a].type.shape) < dimension(old_.blocks()[b].type.shape);
        });
        for (const std::size_t block : by_dimension) make_block(block, context);
        Coordinates coordinates(static_cast<Eigen::Index>(positions_.size()), 3);
        for (std::size_t i = 0; i < positions_.size(); ++i)
            coordinates.row(static_cast<Eigen::Index>(i)) = positions_[i];
        NodeSources sources = find_sources();
        data_.periodic = periodic_of_new_order(old_, data_);
        data_.partitioning = old_.data().partitioning;
        return {
            {std::make_shared<const MeshTopology>(std::move(data_)), std::move(coordinates)}, std::move(sources), {}};
    }

  private:
    /// A cell of the old mesh and a node of what it becomes.
    struct Origin {
        std::size_t block = 0;
        Index cell = -1;  ///< -1: the old node itself, whose position is `node`
        Index node = 0;
    };

    bool keeps() const { return options_.geometry == ElevatedGeometry::kept; }

    ElementType new_type(ElementType type) const {
        return {type.shape, type.shape == Shape::vertex ? 1 : options_.order};
    }

    const std::vector<PlannedNode>& plan_of(ElementType type) {
        const auto found = plans_.find(type);
        if (found != plans_.end()) return found->second;
        if (type.shape == Shape::pyramid && options_.order > 1 && !(keeps() && is_identity(type, options_.order)))
            throw Unsupported(type.order == 1 || !keeps() ? "Pyramids cannot be raised above order 1."
                                                          : "Pyramids above order 1 cannot get another order but 1.");
        return plans_.emplace(type, make_plan(type, new_type(type))).first->second;
    }

    std::span<const Index> cell_nodes(const ElementBlock& block, Index cell) const {
        const auto count = static_cast<std::size_t>(node_count(block.type));
        return std::span(block.nodes).subspan(static_cast<std::size_t>(cell) * count, count);
    }

    void make_key(const PlannedNode& node, std::span<const Index> cell) {
        key_.clear();
        long divisor = 0;
        for (const auto& [corner, weight] : node.corners) {
            key_.emplace_back(cell[static_cast<std::size_t>(corner)], weight);
            divisor = std::gcd(divisor, weight);
        }
        std::sort(key_.begin(), key_.end());
        // The scale differs between dimensions (an edge's node seen from a face): reduce to lowest terms.
        for (auto& [corner, weight] : key_) weight /= divisor;
        if (node.between.empty()) return;
        if (!between_orders_.empty()) {
            Corners corners;
            for (const auto& [corner, weight] : key_) corners.push_back(corner);
            if (between_orders_.contains(corners)) return;
        }
        const auto end = static_cast<std::ptrdiff_t>(key_.size()) + 1;
        key_.emplace_back(-1, 0);
        for (const int old : node.between) key_.emplace_back(cell[static_cast<std::size_t>(old)], 0);
        std::sort(key_.begin() + end, key_.end());
    }

    /// Old nodes that stay: corners of cells, nodes of no cell, and those that a node of the new lattice falls upon.
    void keep_old_nodes() {
        const auto count = static_cast<std::size_t>(old_.node_count());
        std::vector<bool> in_cell(count, false), stays(count, false);
        std::map<NodeKey, std::pair<Index, Origin>> kept;
        for (std::size_t b = 0; b < old_.blocks().size(); ++b) {
            const ElementBlock& block = old_.blocks()[b];
            const std::vector<PlannedNode>& plan = plan_of(block.type);
            for (const Index node : block.nodes) in_cell[node] = true;
            for (Index cell = 0; cell < block.size(); ++cell) {
                const auto nodes = cell_nodes(block, cell);
                for (const PlannedNode& node : plan) {
                    if (node.same < 0 || (!keeps() && node.corners.size() > 1)) continue;
                    const Index old = nodes[static_cast<std::size_t>(node.same)];
                    if (node.corners.size() > 1 && !between_orders_.empty()) {
                        // Of two nodes at one place, from cells of two orders, the first stays.
                        make_key(node, nodes);
                        if (kept.try_emplace(key_, old, Origin{b, cell, 0}).first->second.first != old) continue;
                    }
                    stays[old] = true;
                }
            }
        }
        new_index_.assign(count, -1);
        for (Index node = 0; node < old_.node_count(); ++node) {
            if (keeps()) next_tag_ = std::max(next_tag_, old_.node_tag(node).value);
            if (in_cell[node] && !stays[node]) continue;
            new_index_[node] = static_cast<Index>(data_.node_tags.size());
            data_.node_tags.push_back(old_.node_tag(node));
            if (has_entities()) data_.node_entities.push_back(old_.data().node_entities[node]);
            positions_.emplace_back(mesh_.coordinates().row(node));
            origins_.push_back({0, -1, node});
            next_tag_ = std::max(next_tag_, old_.node_tag(node).value);
        }
        makers_ = origins_;
        for (const auto& [key, value] : kept) {
            created_.emplace(key, new_index_[value.first]);
            makers_[new_index_[value.first]] = value.second;
        }
    }

    bool has_entities() const { return !old_.data().node_entities.empty(); }

    void make_block(std::size_t b, const TaskContext& context) {
        const ElementBlock& source = old_.blocks()[b];
        ElementBlock& target = data_.blocks[b];
        target.type = new_type(source.type);
        target.entity_tag = source.entity_tag;
        target.tags = source.tags;
        const std::vector<PlannedNode>& plan = plan_of(source.type);
        target.nodes.reserve(plan.size() * static_cast<std::size_t>(source.size()));
        for (Index cell = 0; cell < source.size(); ++cell) {
            if (cell % 1024 == 0) context.report("Changing the order", static_cast<double>(cell) / source.size());
            const auto nodes = cell_nodes(source, cell);
            for (std::size_t i = 0; i < plan.size(); ++i) {
                const PlannedNode& node = plan[i];
                // Within one order, all cells that share a node see it at the same place of the lattice.
                const bool is_plain = between_orders_.empty() || node.corners.size() == 1;
                if (node.same >= 0 && is_plain && (keeps() || node.corners.size() == 1))
                    target.nodes.push_back(new_index_[nodes[static_cast<std::size_t>(node.same)]]);
                else
                    target.nodes.push_back(find_or_make({b, cell, static_cast<Index>(i)}, node, nodes));
            }
        }
    }

    Index find_or_make(const Origin& origin, const PlannedNode& node, std::span<const Index> cell) {
        const ElementBlock& block = old_.blocks()[origin.block];
        make_key(node, cell);
        const auto [entry, is_new] = created_.try_emplace(key_, static_cast<Index>(data_.node_tags.size()));
        const Index index = entry->second;
        if (is_new) {
            positions_.push_back(position(block.type, node, cell));
            origins_.push_back(origin);
            makers_.push_back(origin);
            data_.node_tags.push_back({++next_tag_});
            if (has_entities()) data_.node_entities.push_back({dimension(block.type.shape), block.entity_tag});
        } else if (keeps() && !between_orders_.empty()) {
            settle(index, origin, position(block.type, node, cell));
        }
        return index;
    }

    Eigen::RowVector3d position(ElementType type, const PlannedNode& node, std::span<const Index> cell) const {
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        if (keeps() && type.order > 1) {
            for (const auto& [old, weight] : node.interpolation)
                sum += weight * mesh_.coordinates().row(cell[static_cast<std::size_t>(old)]);
            return sum;
        }
        double total = 0.0;
        for (const auto& [corner, weight] : key_) {
            if (corner < 0) break;
            total += static_cast<double>(weight);
        }
        for (const auto& [corner, weight] : key_) {
            if (corner < 0) break;
            sum += static_cast<double>(weight) / total * mesh_.coordinates().row(corner);
        }
        return sum;
    }

    /// A node that cells of several orders share: elements count more than the cells on their boundary, and among their
    /// like those of higher order. Elements have to agree.
    void settle(Index index, const Origin& origin, const Eigen::RowVector3d& at) {
        const ElementBlock& now = old_.blocks()[origin.block];
        const Origin& maker = makers_[index];
        const ElementBlock& before = old_.blocks()[maker.block];
        if (now.type.order == before.type.order && now.type.shape == before.type.shape) return;
        const bool is_element = dimension(now.type.shape) == old_.dimension();
        const bool was_element = dimension(before.type.shape) == old_.dimension();
        if (is_element && was_element && (at - positions_[index]).norm() > 1e-8 * diagonal_)
            throw Unsupported(fmt::format(
                "Element {} (P{}) and its neighbour {} (P{}) do not have the same edge or face between them, so that "
                "no common order keeps the geometry of both; --straight straightens them.",
                before.tags[maker.cell].value, before.type.order, now.tags[origin.cell].value, now.type.order));
        if (is_element == was_element ? now.type.order > before.type.order : is_element) {
            positions_[index] = at;
            origins_[index] = makers_[index] = origin;
        }
    }

    NodeSources find_sources() {
        NodeSources sources;
        for (const Origin& origin : origins_) {
            if (origin.cell < 0) {
                sources.add_copy(origin.node);
                continue;
            }
            const ElementBlock& block = old_.blocks()[origin.block];
            const auto nodes = cell_nodes(block, origin.cell);
            for (const auto& [old, weight] : plan_of(block.type)[static_cast<std::size_t>(origin.node)].interpolation) {
                sources.nodes.push_back(nodes[static_cast<std::size_t>(old)]);
                sources.weights.push_back(weight);
            }
            sources.offsets.push_back(sources.nodes.size());
        }
        return sources;
    }

    const CurvedMesh& mesh_;
    const MeshTopology& old_;
    const ElevateOptions& options_;
    std::set<Corners> between_orders_;
    double diagonal_ = 0.0;
    std::map<ElementType, std::vector<PlannedNode>> plans_;
    MeshData data_;
    std::vector<Eigen::RowVector3d> positions_;
    std::vector<Origin> origins_;
    std::vector<Origin> makers_;    ///< like origins_, and of old nodes that stay the cell that says where they are
    std::vector<Index> new_index_;  ///< of old nodes; -1 = goes
    std::map<NodeKey, Index> created_;
    NodeKey key_;
    std::int64_t next_tag_ = 0;
};

/// The lattice of twice the order: the nodes of an element and what lies midway between neighbours.
Eigen::MatrixX3d finer_lattice(ElementType type) {
    std::set<LatticePoint> sums;
    const std::vector<LatticePoint>& lattice = reference_element(type).lattice;
    for (const LatticePoint& a : lattice)
        for (const LatticePoint& b : lattice) {
            int farthest = 0;
            for (int d = 0; d < 3; ++d) farthest = std::max(farthest, std::abs(a[d] - b[d]));
            if (farthest <= 1) sums.insert({a[0] + b[0], a[1] + b[1], a[2] + b[2]});
        }
    Eigen::MatrixX3d points(static_cast<Eigen::Index>(sums.size()), 3);
    Eigen::Index row = 0;
    for (const LatticePoint& sum : sums)
        points.row(row++) = Eigen::RowVector3d(sum[0], sum[1], sum[2]) / (2.0 * type.order);
    return points;
}

/// The largest distance between the images of one reference point; none if no element can differ.
std::optional<GeometryDistance> measure(const CurvedMesh& from, const CurvedMesh& to, const ElevateOptions& options,
                                        const TaskContext& context) {
    const MeshTopology& topology = from.topology();
    const bool is_kept = options.geometry == ElevatedGeometry::kept;
    struct Tables {
        Eigen::MatrixXd old, now;
    };
    std::map<ElementType, Tables> tables;
    std::optional<GeometryDistance> result;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const ElementType type = topology.element_type(element);
        if (is_kept ? type.order <= options.order : type.order == 1) continue;
        if (!result) result.emplace(GeometryDistance{0.0, 0.0, element, 0});
        if (type.shape == Shape::pyramid) {
            ++result->unmeasured;
            continue;
        }
        if (element % 1024 == 0) context.report("Measuring", static_cast<double>(element) / topology.element_count());
        const auto [entry, is_new] = tables.try_emplace(type);
        if (is_new) {
            const Eigen::MatrixX3d samples = finer_lattice(type);
            entry->second = {lagrange_basis(type, samples).values,
                             lagrange_basis({type.shape, options.order}, samples).values};
        }
        const double distance = (entry->second.old * from.element_coordinates(element) -
                                 entry->second.now * to.element_coordinates(element))
                                    .rowwise()
                                    .norm()
                                    .maxCoeff();
        if (distance > result->absolute) {
            result->absolute = distance;
            result->element = element;
        }
    }
    if (result) {
        const auto box = bounding_box(from);
        const double diagonal = (box.row(1) - box.row(0)).norm();
        result->relative = diagonal > 0.0 ? result->absolute / diagonal : 0.0;
    }
    return result;
}

}  // namespace

ElevateResult elevate(const CurvedMesh& mesh, const ElevateOptions& options, const TaskContext& context) {
    if (options.order < 1 || options.order > max_order)
        throw Unsupported(fmt::format("Order {} is not supported; orders 1 to {} are.", options.order, max_order));
    ElevateResult result = Elevation(mesh, options).run(context);
    result.distance = measure(mesh, result.mesh, options, context);
    return result;
}

CurvedMesh elevate(const CurvedMesh& mesh, int order, const TaskContext& context) {
    return elevate(mesh, ElevateOptions{order, ElevatedGeometry::kept}, context).mesh;
}

}  // namespace curvewright
