#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/deform/deformation.h"
#include "core/deform/expression.h"
#include "core/deform/shapes.h"

namespace curvewright {
namespace {

using Point = Eigen::RowVector3d;

/// Every kind of operation as a function of one point. Compiled once per operation, called for each node.
class PointMap {
  public:
    explicit PointMap(const OperationKind& kind) : kind_(kind) {
        if (const auto* expression = std::get_if<Expression>(&kind))
            for (int d = 0; d < 3; ++d)
                if (expression->components[d]) compiled_[d].emplace(*expression->components[d]);
    }

    Point operator()(const Point& x) {
        return std::visit([&](const auto& kind) { return map(kind, x); }, kind_);
    }

  private:
    static Point map(const Translate& op, const Point& x) { return x + to_point(op.vector); }
    static Point map(const Rotate& op, const Point& x) {
        // Rodrigues' formula.
        const Point center = to_point(op.center), k = to_point(op.axis).normalized(), v = x - center;
        const double angle = op.angle_deg * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle);
        // As a change of x: what the axis does not turn stays to the bit, such as the z of a plane mesh.
        return x + (c - 1) * (v - k * v.dot(k)) + k.cross(v) * s;
    }
    static Point map(const Scale& op, const Point& x) {
        const Point center = to_point(op.center);
        return center + (x - center).cwiseProduct(to_point(op.factors));
    }
    static Point map(const Shear& op, const Point& x) {
        Point result = x;
        result[op.axis] += op.factor * (x[op.along] - op.origin);
        return result;
    }
    Point map(const Expression&, const Point& x) {
        Point result = x;
        for (int d = 0; d < 3; ++d)
            if (compiled_[d]) result[d] = compiled_[d]->evaluate(x[0], x[1], x[2]);
        return result;
    }
    template <class SnapTo>
    static Point map(const SnapTo& shape, const Point& x) {
        return project(shape, x);
    }

    const OperationKind& kind_;
    std::array<std::optional<CompiledExpression>, 3> compiled_;
};

std::string list_groups(const MeshTopology& topology) {
    std::string names;
    for (const PhysicalGroup& group : topology.groups())
        names += (names.empty() ? "" : ", ") + MeshTopology::display_name(group);
    return names.empty() ? "the mesh has no groups of its own; 'boundary' and 'all' always exist"
                         : "the mesh has " + names + ", and 'boundary' and 'all' always exist";
}

/// The operation done in part: a rotation by part of its angle; of all others the point goes part of its straight way.
OperationKind partial(const OperationKind& kind, double fraction) {
    const auto* rotation = std::get_if<Rotate>(&kind);
    if (!rotation) return kind;
    Rotate part = *rotation;
    part.angle_deg *= fraction;
    return part;
}

void apply_operations(const CurvedMesh& mesh, const OperationList& list, double fraction, const std::string& where,
                      Coordinates& x) {
    for (std::size_t i = 0; i < list.operations.size(); ++i) {
        const Operation& operation = list.operations[i];
        const auto nodes = mesh.topology().find_group_nodes(operation.group);
        if (!nodes)
            throw InvalidInput(fmt::format("{}operation {}: there is no group '{}' ({}).", where, i + 1,
                                           operation.group, list_groups(mesh.topology())));
        const auto fail = [&](const std::string& what) {
            throw InvalidInput(fmt::format("{}operation {} on group '{}': {}.", where, i + 1, operation.group, what));
        };
        const OperationKind kind = partial(operation.kind, fraction);
        const double way = std::holds_alternative<Rotate>(kind) ? 1.0 : fraction;
        std::optional<PointMap> map;
        try {
            map.emplace(kind);
        } catch (const InvalidInput& error) {
            fail(error.what());
        }
        for (Index node : *nodes) {
            Point moved;
            try {
                moved = (*map)(x.row(node));
            } catch (const InvalidInput& error) {
                fail(fmt::format("node {} cannot be moved: {}", mesh.topology().node_tag(node).value, error.what()));
            }
            if (!moved.allFinite())
                fail(fmt::format("node {} at ({}, {}, {}) would get a position that is not finite",
                                 mesh.topology().node_tag(node).value, x(node, 0), x(node, 1), x(node, 2)));
            if (way == 1.0)
                x.row(node) = moved;
            else
                x.row(node) += way * (moved - x.row(node));
        }
    }
}

void apply_table(const CurvedMesh& mesh, const NodeTable& table, const std::string& where, Coordinates& x) {
    const MeshTopology& topology = mesh.topology();
    std::vector<bool> is_given(static_cast<std::size_t>(topology.node_count()), false);
    for (const NodeTable::Row& row : table.rows) {
        const auto node = topology.find_node(row.tag);
        // A mesh of the deformed state may hold more (or other) nodes; a table that names a wrong node is a mistake.
        if (!node && table.is_mesh) continue;
        if (!node) throw InvalidInput(fmt::format("{}there is no node {} in the mesh.", where, row.tag.value));
        if (table.is_mesh && !topology.is_boundary_node(*node)) continue;
        is_given[*node] = true;
        x.row(*node) = to_point(row.position);
    }
    if (!table.is_mesh) return;
    for (Index node : topology.boundary_nodes())
        if (!is_given[node])
            throw InvalidInput(
                fmt::format("{}boundary node {} of the mesh has no position there; the deformed mesh must "
                            "have the same node tags.",
                            where, topology.node_tag(node).value));
}

}  // namespace

std::vector<Index> prescribed_interior_nodes(const CurvedMesh& mesh, const Deformation& deformation) {
    const MeshTopology& topology = mesh.topology();
    std::set<Index> prescribed;
    if (const auto* operations = std::get_if<OperationList>(&deformation.content)) {
        for (const Operation& operation : operations->operations) {
            bool is_lower = false, is_domain = false;
            for (const PhysicalGroup& group : topology.groups()) {
                if (MeshTopology::display_name(group) != operation.group) continue;
                (group.dimension < topology.dimension() ? is_lower : is_domain) = true;
            }
            const auto nodes = is_lower && !is_domain ? topology.find_group_nodes(operation.group) : std::nullopt;
            if (nodes) prescribed.insert(nodes->begin(), nodes->end());
        }
    } else if (const auto& table = std::get<NodeTable>(deformation.content); !table.is_mesh) {
        for (const NodeTable::Row& row : table.rows)
            if (const auto node = topology.find_node(row.tag)) prescribed.insert(*node);
    }
    std::vector<Index> interior;
    for (Index node : prescribed)
        if (topology.is_interior_node(node)) interior.push_back(node);
    return interior;
}

Coordinates apply_deformation(const CurvedMesh& mesh, const Deformation& deformation, double fraction) {
    if (!(fraction >= 0.0 && fraction <= 1.0))
        throw InvalidInput(fmt::format("The fraction of the deformation is {}; it must be from 0 to 1.", fraction));
    Coordinates x = mesh.coordinates();
    const std::string where = deformation.source.empty() ? std::string() : deformation.source + ": ";
    if (const auto* operations = std::get_if<OperationList>(&deformation.content))
        apply_operations(mesh, *operations, fraction, where, x);
    else
        apply_table(mesh, std::get<NodeTable>(deformation.content), where, x);
    const bool is_table = std::holds_alternative<NodeTable>(deformation.content);
    if (is_table && fraction < 1.0) x = mesh.coordinates() + fraction * (x - mesh.coordinates());
    return x;
}

}  // namespace curvewright
