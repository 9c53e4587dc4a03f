#include "core/boundary/boundary_shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <Eigen/Geometry>

#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"
#include "core/boundary/disjoint_sets.h"

namespace curvewright {
namespace {

/// Unit tangent of a line at a point, turned to the side of its chord; zero where there is none.
Eigen::Vector3d chord_tangent(const BoundaryPiece& line, double s) {
    const Eigen::Vector3d chord = (line.nodes().row(1) - line.nodes().row(0)).transpose();
    const Eigen::Vector3d tangent = line.evaluate({s, 0.0}).first[0];
    if (!(tangent.norm() > 1e-9 * chord.norm())) return Eigen::Vector3d::Zero();
    return tangent.normalized() * (tangent.dot(chord) < 0.0 ? -1.0 : 1.0);
}

/// Unit normal of a surface at a point, turned to the side of its straight-sided face; zero where there is none.
Eigen::Vector3d chord_normal(const BoundaryPiece& face, const Eigen::Vector2d& at) {
    const auto corner = [&](int c) -> Eigen::Vector3d { return face.nodes().row(c).transpose(); };
    const int corners = face.corner_count();
    const Eigen::Vector3d flat = corners == 3 ? (corner(1) - corner(0)).cross(corner(2) - corner(0))
                                              : (corner(2) - corner(0)).cross(corner(3) - corner(1));
    const Jet jet = face.evaluate(at);
    const Eigen::Vector3d normal = jet.first[0].cross(jet.first[1]);
    if (!(normal.norm() > 1e-9 * flat.norm())) return Eigen::Vector3d::Zero();
    return normal.normalized() * (normal.dot(flat) < 0.0 ? -1.0 : 1.0);
}

std::vector<Index> sorted(std::vector<Index> nodes) {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

}  // namespace

BoundaryShape::BoundaryShape(const CurvedMesh& mesh, const BoundaryRules& rules)
    : topology_(mesh.shared_topology()),
      x_(mesh.coordinates()),
      cosine_(std::cos(rules.feature_angle * std::numbers::pi / 180.0)) {
    const MeshTopology& topology = *topology_;
    const BoundaryModes modes = resolve(rules, topology);
    const auto count = static_cast<std::size_t>(topology.node_count());
    is_point_.assign(count, 0);
    freedom_.assign(count, 0);
    feet_.assign(count, {});
    for (const ElementBlock& block : topology.blocks())
        if (block.type.shape == Shape::vertex)
            for (const Index node : block.nodes) is_point_[node] = 1;
    const auto& entities = topology.data().node_entities;
    for (std::size_t node = 0; node < entities.size(); ++node)
        if (entities[node].dimension == 0) is_point_[node] = 1;
    for (Index node = 0; node < topology.node_count(); ++node) {
        const bool is_geometry = topology.is_boundary_node(node) || topology.is_interface_node(node);
        if (!is_geometry && !topology.is_interior_node(node)) continue;  // of no element
        if (modes.nodes[node] == BoundaryMode::free) freedom_[node] = topology.dimension();
        if (is_geometry && modes.nodes[node] == BoundaryMode::free) ++free_nodes_;
    }

    const std::vector<Facet> facets = geometry_facets(topology);
    facet_count_ = facets.size();
    if (topology.dimension() == 2) {
        std::vector<std::vector<Index>> lines;
        std::vector<std::array<int, 2>> labels;
        for (std::size_t f = 0; f < facets.size(); ++f) {
            lines.push_back(topology.facet_nodes(facets[f]));
            labels.push_back({modes.facet_entities[f], static_cast<int>(modes.facets[f])});
        }
        add_curves(lines, labels, mesh, modes);
    } else {
        add_surfaces(mesh, facets, modes);
    }
    for (const Foot& foot : feet_) sliding_nodes_ += foot.piece >= 0 ? 1 : 0;
}

int BoundaryShape::add_piece(ElementType type, const std::vector<Index>& nodes, const Coordinates& x) {
    Eigen::MatrixX3d positions(static_cast<Eigen::Index>(nodes.size()), 3);
    for (std::size_t i = 0; i < nodes.size(); ++i) positions.row(static_cast<Eigen::Index>(i)) = x.row(nodes[i]);
    pieces_.emplace_back(type, std::move(positions));
    piece_nodes_.push_back(nodes);
    neighbours_.emplace_back();
    return static_cast<int>(pieces_.size()) - 1;
}

void BoundaryShape::connect(int first, const std::vector<int>& parts, const std::vector<char>& is_corner) {
    std::map<std::pair<int, Index>, std::vector<int>> around;  // part and node
    for (int piece = first; piece < static_cast<int>(pieces_.size()); ++piece)
        for (int c = 0; c < pieces_[piece].corner_count(); ++c) {
            const Index node = piece_nodes_[piece][static_cast<std::size_t>(c)];
            if (!is_corner[node]) around[{parts[static_cast<std::size_t>(piece - first)], node}].push_back(piece);
        }
    for (const auto& [key, group] : around)
        for (const int piece : group)
            for (const int other : group)
                if (other != piece) neighbours_[piece].push_back(other);
    for (auto& list : neighbours_) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
}

void BoundaryShape::add_curves(const std::vector<std::vector<Index>>& lines,
                               const std::vector<std::array<int, 2>>& labels, const CurvedMesh& mesh,
                               const BoundaryModes& modes) {
    const int first = static_cast<int>(pieces_.size());
    std::map<Index, std::vector<std::pair<int, int>>> ends;  // node -> lines and which of their ends
    for (std::size_t i = 0; i < lines.size(); ++i) {
        add_piece({Shape::line, static_cast<int>(lines[i].size()) - 1}, lines[i], mesh.coordinates());
        for (int end = 0; end < 2; ++end)
            ends[lines[i][static_cast<std::size_t>(end)]].emplace_back(static_cast<int>(i), end);
    }
    std::vector<char> is_corner(is_point_);
    DisjointSets parts(lines.size());
    for (const auto& [node, meeting] : ends) {
        bool goes_on = meeting.size() == 2 && !is_corner[node];
        if (goes_on) {
            const auto& [a, end_a] = meeting[0];
            const auto& [b, end_b] = meeting[1];
            // Away from the node along both: opposite where the curve goes on.
            const Eigen::Vector3d u = chord_tangent(pieces_[first + a], end_a) * (end_a == 0 ? 1.0 : -1.0);
            const Eigen::Vector3d v = chord_tangent(pieces_[first + b], end_b) * (end_b == 0 ? 1.0 : -1.0);
            goes_on = labels[static_cast<std::size_t>(a)] == labels[static_cast<std::size_t>(b)] &&
                      (u.isZero() || v.isZero() || -u.dot(v) >= cosine_);
            if (goes_on) parts.join(a, b);
        }
        if (!goes_on) is_corner[node] = 1;
    }
    std::vector<int> part;
    parts.label(part);
    connect(first, part, is_corner);
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t n = 0; n < lines[i].size(); ++n) {
            const Index node = lines[i][n];
            if (modes.nodes[node] != BoundaryMode::slide) continue;
            feet_[node] = {};
            freedom_[node] = 0;
            if (is_corner[node]) continue;
            feet_[node].piece = first + static_cast<int>(i);
            feet_[node].closest.at = pieces_[first + static_cast<int>(i)].reference_node(static_cast<int>(n));
            freedom_[node] = 1;
        }
}

void BoundaryShape::add_surfaces(const CurvedMesh& mesh, const std::vector<Facet>& facets, const BoundaryModes& modes) {
    const MeshTopology& topology = *topology_;
    struct Side {
        int facet, edge;
    };
    std::map<std::array<Index, 2>, std::vector<Side>> edges;
    const auto edge_nodes = [&](const Side& side) {
        std::vector<Index> nodes;
        for (const int n :
             reference_element(pieces_[side.facet].type()).edges[static_cast<std::size_t>(side.edge)].nodes)
            nodes.push_back(piece_nodes_[side.facet][static_cast<std::size_t>(n)]);
        return nodes;
    };
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const ElementType element = topology.element_type(facets[f].element);
        const ElementType type = reference_element(element).facets[static_cast<std::size_t>(facets[f].local)].type;
        add_piece(type, topology.facet_nodes(facets[f]), mesh.coordinates());
    }
    for (int f = 0; f < static_cast<int>(facets.size()); ++f)
        for (int e = 0; e < pieces_[f].corner_count(); ++e) {
            const std::vector<Index> nodes = edge_nodes({f, e});
            edges[{std::min(nodes[0], nodes[1]), std::max(nodes[0], nodes[1])}].push_back({f, e});
        }

    // Curves that a group names; those on no facet are curves of their own inside the domain.
    std::set<std::vector<Index>> named;
    std::vector<std::vector<Index>> feature_lines;
    std::set<int> named_entities;
    for (const Entity& entity : topology.entities())
        if (entity.dimension == 1 && !entity.physical_tags.empty()) named_entities.insert(entity.tag);
    for (const ElementBlock& block : topology.blocks()) {
        if (block.type.shape != Shape::line || !named_entities.contains(block.entity_tag)) continue;
        const auto size = static_cast<std::ptrdiff_t>(node_count(block.type));
        for (auto first = block.nodes.begin(); first != block.nodes.end(); first += size) {
            const std::vector<Index> line(first, first + size);
            if (!named.insert(sorted(line)).second ||
                edges.contains({std::min(line[0], line[1]), std::max(line[0], line[1])}))
                continue;
            const bool is_inside = std::all_of(line.begin(), line.end(), [&](Index node) {
                return topology.is_interface_node(node) || topology.is_boundary_node(node);
            });
            if (is_inside) feature_lines.push_back(line);
        }
    }

    const auto turns = [&](const Side& a, const Side& b) {
        const std::vector<Index> nodes_a = edge_nodes(a);
        for (const double s : {0.0, 0.5, 1.0}) {
            const auto at = [&](const Side& side) -> Eigen::Vector2d {
                const auto& edge =
                    reference_element(pieces_[side.facet].type()).edges[static_cast<std::size_t>(side.edge)].nodes;
                const bool is_reversed = piece_nodes_[side.facet][static_cast<std::size_t>(edge[0])] != nodes_a[0];
                const double t = is_reversed ? 1.0 - s : s;
                return (1.0 - t) * pieces_[side.facet].reference_node(edge[0]) +
                       t * pieces_[side.facet].reference_node(edge[1]);
            };
            const Eigen::Vector3d u = chord_normal(pieces_[a.facet], at(a)), v = chord_normal(pieces_[b.facet], at(b));
            if (!u.isZero() && !v.isZero() && u.dot(v) < cosine_) return true;
        }
        return false;
    };
    DisjointSets parts(facets.size());
    std::vector<char> is_feature_node(is_point_);
    for (const auto& [key, sides] : edges) {
        const std::vector<Index> nodes = edge_nodes(sides[0]);
        bool is_smooth = sides.size() == 2 && !named.contains(sorted(nodes));
        if (is_smooth) {
            const int a = sides[0].facet, b = sides[1].facet;
            is_smooth = modes.facet_entities[static_cast<std::size_t>(a)] ==
                            modes.facet_entities[static_cast<std::size_t>(b)] &&
                        modes.facets[static_cast<std::size_t>(a)] == modes.facets[static_cast<std::size_t>(b)] &&
                        sorted(nodes) == sorted(edge_nodes(sides[1])) && !turns(sides[0], sides[1]);
            if (is_smooth) parts.join(a, b);
        }
        if (is_smooth) continue;
        for (const Side& side : sides) {
            const std::vector<Index> own = edge_nodes(side);
            if (&side == &sides[0] || sorted(own) != sorted(nodes)) feature_lines.push_back(own);
            for (const Index node : own) is_feature_node[node] = 1;
        }
    }
    // A node that two smooth parts share without a feature edge between them belongs to neither.
    std::vector<int> part_of(static_cast<std::size_t>(topology.node_count()), -1);
    std::vector<int> part;
    parts.label(part);
    for (std::size_t f = 0; f < facets.size(); ++f)
        for (const Index node : piece_nodes_[f]) {
            if (part_of[node] >= 0 && part_of[node] != part[f]) is_feature_node[node] = 1;
            part_of[node] = part[f];
        }
    for (int f = 0; f < static_cast<int>(facets.size()); ++f)
        for (std::size_t n = 0; n < piece_nodes_[f].size(); ++n) {
            const Index node = piece_nodes_[f][n];
            if (modes.nodes[node] != BoundaryMode::slide || is_feature_node[node] || feet_[node].piece >= 0) continue;
            feet_[node].piece = f;
            feet_[node].closest.at = pieces_[f].reference_node(static_cast<int>(n));
            freedom_[node] = 2;
        }
    connect(0, part, std::vector<char>(is_point_.size(), 0));
    add_curves(feature_lines, std::vector<std::array<int, 2>>(feature_lines.size()), mesh, modes);
}

Foot BoundaryShape::project(const Eigen::Vector3d& y, const Foot& start) const {
    Foot best{start.piece, pieces_[start.piece].closest(y, start.closest.at)};
    const std::size_t most_steps = 4 * pieces_.size();
    for (std::size_t step = 0; step < most_steps; ++step) {
        if (best.closest.edge < 0 && best.closest.corner < 0) break;
        // The corners that the place is at or between: a neighbour must have them all.
        const std::vector<Index>& nodes = piece_nodes_[best.piece];
        std::vector<Index> needed;
        if (best.closest.corner >= 0) {
            needed.push_back(nodes[static_cast<std::size_t>(best.closest.corner)]);
        } else {
            const auto c = static_cast<std::size_t>(best.closest.edge);
            needed = {nodes[c], nodes[(c + 1) % static_cast<std::size_t>(pieces_[best.piece].corner_count())]};
        }
        Foot next = best;
        for (const int other : neighbours_[best.piece]) {
            const auto begin = piece_nodes_[other].begin(), end = begin + pieces_[other].corner_count();
            if (!std::all_of(needed.begin(), needed.end(), [&](Index n) { return std::find(begin, end, n) != end; }))
                continue;
            const Foot candidate{other, pieces_[other].closest(y, {})};
            if (candidate.closest.squared_distance < next.closest.squared_distance) next = candidate;
        }
        if (next.piece == best.piece) break;
        best = next;
    }
    return best;
}

Eigen::Matrix<double, 3, Eigen::Dynamic> BoundaryShape::tangents(const Foot& foot) const {
    const BoundaryPiece& piece = pieces_[foot.piece];
    const auto corner = [&](int c) -> Eigen::Vector3d { return piece.nodes().row(c).transpose(); };
    const Jet jet = piece.evaluate(foot.closest.at);
    const Eigen::Vector3d chord = corner(1) - corner(0);
    if (piece.is_curve()) {
        const Eigen::Vector3d along = jet.first[0].norm() > 1e-6 * chord.norm() ? jet.first[0] : chord;
        if (!(along.norm() > 0.0)) return Eigen::Matrix<double, 3, Eigen::Dynamic>(3, 0);
        return along.normalized();
    }
    const Eigen::Vector3d flat = chord.cross(corner(2) - corner(0));
    Eigen::Vector3d normal = jet.first[0].cross(jet.first[1]);
    if (!(normal.norm() > 1e-6 * flat.norm())) normal = flat;
    if (!(normal.norm() > 0.0)) return Eigen::Matrix<double, 3, Eigen::Dynamic>(3, 0);
    normal.normalize();
    Eigen::Matrix<double, 3, 2> result;
    result.col(0) = normal.unitOrthogonal();
    result.col(1) = normal.cross(result.col(0));
    return result;
}

double BoundaryShape::largest_distance(const Coordinates& x) const {
    std::vector<double> largest(facet_count_, 0.0);  // squared
    parallel_for(largest.size(), 32, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const std::vector<Index>& nodes = piece_nodes_[f];
            if (std::all_of(nodes.begin(), nodes.end(), [&](Index n) { return x.row(n) == x_.row(n); })) continue;
            const ElementType type = pieces_[f].type();
            Eigen::MatrixX3d moved(static_cast<Eigen::Index>(nodes.size()), 3);
            for (std::size_t i = 0; i < nodes.size(); ++i) moved.row(static_cast<Eigen::Index>(i)) = x.row(nodes[i]);
            const BoundaryPiece facet(type, moved);
            const Eigen::MatrixX3d samples = reference_nodes({type.shape, std::min(max_order, 3 * type.order + 2)});
            for (Eigen::Index q = 0; q < samples.rows(); ++q) {
                const Eigen::Vector3d y = facet.evaluate(samples.row(q).head<2>().transpose()).value;
                Foot start{static_cast<int>(f), {}};
                start.closest.at = samples.row(q).head<2>().transpose();
                double distance = project(y, start).closest.squared_distance;
                // Going downhill may have ended in a valley: also begin where each of the facet's nodes came from.
                for (std::size_t i = 0; i < nodes.size() && distance > 0.0; ++i)
                    if (slides(nodes[i])) {
                        const Foot other = project(y, feet_[nodes[i]]);
                        distance = std::min(distance, other.closest.squared_distance);
                    }
                largest[f] = std::max(largest[f], distance);
            }
        }
    });
    double result = 0.0;
    for (const double value : largest) result = std::max(result, value);
    return std::sqrt(result);
}

}  // namespace curvewright
