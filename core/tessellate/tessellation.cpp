#include "core/tessellate/tessellation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"
#include "core/tessellate/interface_edges.h"

namespace curvewright {
namespace {

/// Patches per matrix product: enough to fill the caches, few enough to share the work.
constexpr Index batch_size = 64;
/// Deviation from the straight-sided map, relative to the size of the patch, that counts as rounding.
constexpr double straight_tolerance = 1e-9;

/// How a patch of one type is cut into straight pieces.
struct Stencil {
    BasisTable basis;                             ///< at the points of the pieces
    std::vector<std::array<Index, 3>> triangles;  ///< faces only
};

std::unique_ptr<const Stencil> make_stencil(ElementType type, int n) {
    auto stencil = std::make_unique<Stencil>();
    std::vector<std::array<double, 2>> points;
    const bool is_line = type.shape == Shape::line, is_triangle = type.shape == Shape::triangle;
    std::vector<Index> row_start;
    for (int j = 0; j <= (is_line ? 0 : n); ++j) {
        row_start.push_back(static_cast<Index>(points.size()));
        for (int i = 0; i <= (is_triangle ? n - j : n); ++i)
            points.push_back({static_cast<double>(i) / n, static_cast<double>(j) / n});
    }
    for (int j = 0; !is_line && j < n; ++j)
        for (int i = 0; i < (is_triangle ? n - j : n); ++i) {
            const Index a = row_start[j] + i, b = row_start[j + 1] + i;
            stencil->triangles.push_back({a, a + 1, b});
            if (!is_triangle || i + 1 < n - j) stencil->triangles.push_back({a + 1, b + 1, b});
        }
    Eigen::MatrixX3d x = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        x(static_cast<Eigen::Index>(i), 0) = points[i][0];
        x(static_cast<Eigen::Index>(i), 1) = points[i][1];
    }
    stencil->basis = lagrange_basis(type, x);
    return stencil;
}

const Stencil& find_stencil(ElementType type, int subdivisions) {
    static std::mutex mutex;
    static std::map<std::pair<ElementType, int>, std::unique_ptr<const Stencil>> cache;
    const std::lock_guard lock(mutex);
    auto& entry = cache[{type, subdivisions}];
    if (!entry) entry = make_stencil(type, subdivisions);
    return *entry;
}

/// What tells how curved a patch of one type is.
struct CurvatureProbe {
    /// nodes × nodes, per direction of the pieces' sides: second derivative at the nodes.
    std::vector<Eigen::MatrixXd> second_derivatives;
    /// nodes × nodes: a node's distance vector from its place on the straight-sided (multilinear) patch.
    Eigen::MatrixXd deviation;
};

std::unique_ptr<const CurvatureProbe> make_probe(ElementType type) {
    auto probe = std::make_unique<CurvatureProbe>();
    const Eigen::MatrixX3d nodes = reference_nodes(type);
    const BasisTable table = lagrange_basis(type, nodes);
    // The nodal differentiation matrices are exact on the polynomials of the patch, so their products are as well.
    const auto& g = table.gradients;
    if (type.shape == Shape::line) {
        probe->second_derivatives = {g[0] * g[0]};
    } else {
        const Eigen::MatrixXd uu = g[0] * g[0], uv = g[0] * g[1], vv = g[1] * g[1];
        probe->second_derivatives = {uu, vv, uu - 2.0 * uv + vv};
        if (type.shape == Shape::quadrilateral) probe->second_derivatives.push_back(uu + 2.0 * uv + vv);
    }
    const Eigen::MatrixXd straight = lagrange_basis({type.shape, 1}, nodes).values;
    probe->deviation = Eigen::MatrixXd::Identity(nodes.rows(), nodes.rows());
    probe->deviation.leftCols(straight.cols()) -= straight;
    return probe;
}

const CurvatureProbe& find_probe(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, std::unique_ptr<const CurvatureProbe>> cache;
    const std::lock_guard lock(mutex);
    auto& entry = cache[type];
    if (!entry) entry = make_probe(type);
    return *entry;
}

using PatchPoints = Eigen::Ref<const Eigen::MatrixXd>;

double longest_row(const PatchPoints& rows) {
    return rows.rowwise().norm().maxCoeff();
}

/// Whether two triangles draw a straight-sided quadrilateral exactly: plane and convex.
bool is_plain_quadrilateral(const PatchPoints& x, double tolerance) {
    const auto corner = [&](int i) { return Eigen::Vector3d(x.row(i % 4).transpose()); };
    const Eigen::Vector3d normal = (corner(2) - corner(0)).cross(corner(3) - corner(1));
    const double length = normal.norm();
    if (length == 0.0) return false;
    const Eigen::Vector3d twist = corner(0) - corner(1) + corner(2) - corner(3);
    if (std::abs(twist.dot(normal)) > tolerance * length) return false;
    for (int i = 0; i < 4; ++i)
        if ((corner(i + 1) - corner(i)).cross(corner(i + 3) - corner(i)).dot(normal) <= 0.0) return false;
    return true;
}

/// Number of pieces per side that a patch needs; 0 if it is straight. x: nodes × 3, relative to the origin.
int needed_subdivisions(ElementType type, const PatchPoints& x, double chord_tolerance, double rounding, int most) {
    const CurvatureProbe& probe = find_probe(type);
    const int corners = corner_count(type.shape);
    const double size = longest_row(x.topRows(corners).rowwise() - x.row(0));
    const double negligible = std::max(straight_tolerance * size, rounding);
    const bool is_straight = type.order == 1 || longest_row(probe.deviation * x) <= negligible;
    if (is_straight && (type.shape != Shape::quadrilateral || is_plain_quadrilateral(x, negligible))) return 0;
    double bend = 0.0;
    for (const auto& second : probe.second_derivatives) bend = std::max(bend, longest_row(second * x));
    if (!(chord_tolerance > 0.0)) return most;
    // A piece of parameter length h leaves its chord by at most h^2/8 times the second derivative.
    return static_cast<int>(
        std::min<double>(most, std::max(1.0, std::ceil(std::sqrt(bend / (8.0 * chord_tolerance))))));
}

/// A face or an edge, told by its sorted corners.
struct CornerKey {
    std::array<Index, 4> corners{-1, -1, -1, -1};
    Index element = 0;
    int local = 0;

    CornerKey(std::span<const Index> nodes, const SubElement& part, Index of_element, int of_local)
        : element(of_element), local(of_local) {
        const int count = corner_count(part.type.shape);
        for (int i = 0; i < count; ++i) corners[i] = nodes[part.nodes[i]];
        std::sort(corners.begin(), corners.end());
    }
    /// Of an edge, ascending. The unused places come first.
    std::array<Index, 2> ends() const { return {corners[2], corners[3]}; }
    bool operator<(const CornerKey& other) const {
        return std::tie(corners, element, local) < std::tie(other.corners, other.element, other.local);
    }
};

/// All faces (3D) of the visible elements.
std::vector<Facet> all_facets(const MeshTopology& topology, const std::vector<bool>& visible) {
    std::vector<Facet> facets;
    for (Index element = 0; element < topology.element_count(); ++element)
        for (std::size_t local = 0; local < reference_element(topology.element_type(element)).facets.size(); ++local)
            if (visible.empty() || visible[element]) facets.push_back({element, static_cast<int>(local)});
    return facets;
}

/// Faces (3D) that exactly one visible element has, in the order of the elements.
std::vector<Facet> find_skin(const MeshTopology& topology, const std::vector<bool>& visible) {
    if (visible.empty()) return topology.boundary_facets();
    std::vector<CornerKey> keys;
    for (Index element = 0; element < topology.element_count(); ++element) {
        if (!visible[element]) continue;
        const auto& facets = reference_element(topology.element_type(element)).facets;
        for (std::size_t local = 0; local < facets.size(); ++local)
            keys.emplace_back(topology.element_nodes(element), facets[local], element, static_cast<int>(local));
    }
    std::sort(keys.begin(), keys.end());
    std::vector<Facet> skin;
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i + 1;
        while (end < keys.size() && keys[end].corners == keys[i].corners) ++end;
        if (end == i + 1) skin.push_back({keys[i].element, keys[i].local});
        i = end;
    }
    std::sort(skin.begin(), skin.end(), [](const Facet& a, const Facet& b) {
        return std::pair(a.element, a.local) < std::pair(b.element, b.local);
    });
    return skin;
}

/// The nodes of a face the other way round: the normals of all faces of a mesh are to point to one side.
std::vector<Index> mirrored(ElementType type, const std::vector<Index>& nodes) {
    std::vector<Index> result;
    for (const int node : reference_element(type).mirrored) result.push_back(nodes[static_cast<std::size_t>(node)]);
    return result;
}

/// Which of some faces are on the mesh's own surface.
std::vector<bool> find_outer(const MeshTopology& topology, const std::vector<Facet>& facets) {
    const auto is_before = [](const Facet& a, const Facet& b) {
        return std::pair(a.element, a.local) < std::pair(b.element, b.local);
    };
    std::vector<bool> is_outer;
    for (const Facet& facet : facets)
        is_outer.push_back(
            std::binary_search(topology.boundary_facets().begin(), topology.boundary_facets().end(), facet, is_before));
    return is_outer;
}

/// Box of the drawn nodes; false if there is none.
bool find_box(const std::vector<Index>& nodes, const Coordinates& x, Eigen::RowVector3d& low,
              Eigen::RowVector3d& high) {
    if (nodes.empty()) return false;
    low = high = x.row(nodes.front());
    for (Index node : nodes) {
        low = low.cwiseMin(x.row(node));
        high = high.cwiseMax(x.row(node));
    }
    return true;
}

}  // namespace

Tessellation::Tessellation(const CurvedMesh& mesh, const std::vector<bool>& visible, const TessellationOptions& options)
    : options_(options), node_count_(mesh.topology().node_count()), is_solid_(mesh.topology().dimension() == 3) {
    const MeshTopology& topology = mesh.topology();
    if (!visible.empty() && visible.size() != static_cast<std::size_t>(topology.element_count()))
        throw InvalidInput(
            fmt::format("The mesh has {} elements but {} visibility flags.", topology.element_count(), visible.size()));
    if (!(options_.element_size > 0.0 && options_.element_size <= 1.0))
        throw InvalidInput(
            fmt::format("Elements are to be drawn at {} times their size; more than 0 and at most 1 was "
                        "expected.",
                        options_.element_size));
    if (is_shrunk()) topology_ = mesh.shared_topology();
    options_.min_subdivisions = std::max(1, options_.min_subdivisions);
    options_.max_subdivisions = std::max(options_.min_subdivisions, options_.max_subdivisions);
    options_.field_subdivisions = std::clamp(options_.field_subdivisions, 1, options_.max_subdivisions);
    const auto box = bounding_box(mesh);
    origin_ = 0.5 * (box.row(0) + box.row(1));
    diagonal_ = (box.row(1) - box.row(0)).norm();

    const auto add_patch = [&](std::vector<Patch>& patches, Index element, ElementType type,
                               const std::vector<Index>& nodes) {
        patches.push_back({element, type, 1, static_cast<Index>(patch_nodes_.size()), 0});
        patch_nodes_.insert(patch_nodes_.end(), nodes.begin(), nodes.end());
    };
    std::vector<bool> face_is_outer;
    if (is_solid_) {
        const std::vector<Facet> facets = is_shrunk() ? all_facets(topology, visible) : find_skin(topology, visible);
        if (!visible.empty() && !is_shrunk()) face_is_outer = find_outer(topology, facets);
        for (const Facet& facet : facets) {
            const ElementType type = reference_element(topology.element_type(facet.element)).facets[facet.local].type;
            std::vector<Index> nodes = topology.facet_nodes(facet);
            if (topology.is_reversed(facet.element)) nodes = mirrored(type, nodes);
            add_patch(faces_, facet.element, type, nodes);
        }
    } else {
        for (Index element = 0; element < topology.element_count(); ++element) {
            if (!visible.empty() && !visible[element]) continue;
            const auto nodes = topology.element_nodes(element);
            const ElementType type = topology.element_type(element);
            if (dimension(type.shape) == 2 || dimension(type.shape) == 1)
                add_patch(dimension(type.shape) == 2 ? faces_ : edges_, element, type, {nodes.begin(), nodes.end()});
        }
    }
    nodes_ = patch_nodes_;
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());

    find_edges(face_is_outer, topology);
    choose_subdivisions(faces_, mesh.coordinates());
    choose_subdivisions(edges_, mesh.coordinates());
    lay_out();
    move(mesh.coordinates());
}

void Tessellation::find_edges(const std::vector<bool>& face_is_outer, const MeshTopology& topology) {
    const auto interfaces = interface_edges(topology);
    line_is_boundary_.assign(edges_.size(), 1);
    line_is_interface_.assign(edges_.size(), 0);
    line_is_rim_.assign(edges_.size(), 0);
    std::vector<CornerKey> keys;
    for (std::size_t face = 0; face < faces_.size(); ++face) {
        const auto& sides = reference_element(faces_[face].type).edges;
        const std::span nodes(patch_nodes_.data() + faces_[face].first_node,
                              static_cast<std::size_t>(curvewright::node_count(faces_[face].type)));
        for (std::size_t local = 0; local < sides.size(); ++local)
            keys.emplace_back(nodes, sides[local], static_cast<Index>(face), static_cast<int>(local));
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i + 1;
        // Shrunk elements have all of their edges to themselves.
        const auto owner = [this, &keys](std::size_t key) { return faces_[keys[key].element].element; };
        while (end < keys.size() && keys[end].corners == keys[i].corners && (!is_shrunk() || owner(end) == owner(i)))
            ++end;
        const Patch& face = faces_[keys[i].element];
        const SubElement& side = reference_element(face.type).edges[keys[i].local];
        edges_.push_back({face.element, side.type, 1, static_cast<Index>(patch_nodes_.size()), 0});
        for (int node : side.nodes) patch_nodes_.push_back(Index(patch_nodes_[face.first_node + node]));
        line_is_boundary_.push_back(end == i + 1 && !is_shrunk() ? 1 : 0);
        const bool is_interface = std::binary_search(interfaces.begin(), interfaces.end(), keys[i].ends());
        line_is_interface_.push_back(is_interface && !is_shrunk() ? 1 : 0);
        std::size_t outer = 0;
        for (std::size_t key = i; key < end && !face_is_outer.empty(); ++key)
            outer += face_is_outer[static_cast<std::size_t>(keys[key].element)] ? 1 : 0;
        line_is_rim_.push_back(outer == 1 ? 1 : 0);
        i = end;
    }
}

Eigen::MatrixXd Tessellation::gather(const std::vector<Patch>& patches, std::size_t first, std::size_t count,
                                     const Coordinates& coordinates) const {
    const int nodes = curvewright::node_count(patches[first].type);
    Eigen::MatrixXd x(nodes, 3 * static_cast<Eigen::Index>(count));
    for (std::size_t k = 0; k < count; ++k)
        for (int i = 0; i < nodes; ++i)
            x.block<1, 3>(i, 3 * static_cast<Eigen::Index>(k)) =
                coordinates.row(patch_nodes_[patches[first + k].first_node + i]) - origin_;
    if (!is_shrunk()) return x;
    for (std::size_t k = 0; k < count; ++k) {
        const Index element = patches[first + k].element;
        const auto corners = topology_->element_nodes(element).first(
            static_cast<std::size_t>(corner_count(topology_->element_type(element).shape)));
        Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
        for (const Index corner : corners) center += coordinates.row(corner) / static_cast<double>(corners.size());
        center -= origin_;
        auto its = x.middleCols<3>(3 * static_cast<Eigen::Index>(k));
        its = (options_.element_size * (its.rowwise() - center)).rowwise() + center;
    }
    return x;
}

int Tessellation::wanted_subdivisions(const Patch& patch, const Coordinates& coordinates,
                                      const std::vector<Patch>& patches) const {
    const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * (origin_.cwiseAbs().maxCoeff() + diagonal_);
    const Eigen::MatrixXd x = gather(patches, static_cast<std::size_t>(&patch - patches.data()), 1, coordinates);
    const int needed =
        needed_subdivisions(patch.type, x, options_.chord_tolerance * diagonal_, rounding, options_.max_subdivisions);
    const bool is_linear =
        patch.type.shape == Shape::line || (patch.type.order == 1 && patch.type.shape != Shape::quadrilateral);
    const int for_field = is_linear ? 1 : options_.field_subdivisions;
    if (needed == 0) return for_field;
    // Few different numbers, so that neighbours mostly have the same points on the side that they share.
    int n = std::max(options_.min_subdivisions, for_field);
    while (n < needed) n *= 2;
    return std::min(n, options_.max_subdivisions);
}

void Tessellation::choose_subdivisions(std::vector<Patch>& patches, const Coordinates& coordinates) const {
    parallel_for(patches.size(), 256, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            patches[i].subdivisions = wanted_subdivisions(patches[i], coordinates, patches);
    });
}

void Tessellation::lay_out() {
    // Patches of one kind stand together, so that one matrix product makes the points of many.
    std::stable_sort(faces_.begin(), faces_.end(), [](const Patch& a, const Patch& b) {
        return std::tie(a.type, a.subdivisions) < std::tie(b.type, b.subdivisions);
    });
    Index points = 0;
    for (Patch& face : faces_) {
        const Stencil& stencil = find_stencil(face.type, face.subdivisions);
        face.first_point = points;
        for (const auto& triangle : stencil.triangles) {
            for (Index corner : triangle) triangles_.push_back(points + corner);
            triangle_elements_.push_back(face.element);
        }
        points += static_cast<Index>(stencil.basis.values.rows());
    }
    surface_points_.resize(3 * static_cast<std::size_t>(points));
    surface_normals_.resize(surface_points_.size());

    std::vector<std::size_t> order(edges_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
        return std::tie(edges_[a].type, edges_[a].subdivisions) < std::tie(edges_[b].type, edges_[b].subdivisions);
    });
    std::vector<Patch> sorted;
    std::vector<std::uint8_t> is_boundary, is_rim, is_interface;
    line_offsets_.push_back(0);
    for (std::size_t i : order) {
        sorted.push_back(edges_[i]);
        sorted.back().first_point = line_offsets_.back();
        is_boundary.push_back(line_is_boundary_[i]);
        is_rim.push_back(line_is_rim_[i]);
        is_interface.push_back(line_is_interface_[i]);
        line_elements_.push_back(edges_[i].element);
        line_offsets_.push_back(line_offsets_.back() + edges_[i].subdivisions + 1);
    }
    edges_ = std::move(sorted);
    line_is_boundary_ = std::move(is_boundary);
    line_is_rim_ = std::move(is_rim);
    line_is_interface_ = std::move(is_interface);
    edge_points_.resize(3 * static_cast<std::size_t>(line_offsets_.back()));
}

void Tessellation::move(const Coordinates& coordinates) {
    if (coordinates.rows() != node_count_)
        throw InvalidInput(
            fmt::format("The drawn mesh has {} nodes but {} positions were given.", node_count_, coordinates.rows()));
    move_patches(faces_, coordinates, surface_points_, &surface_normals_);
    move_patches(edges_, coordinates, edge_points_, nullptr);
}

std::vector<double> Tessellation::evaluate(const std::vector<double>& values, int components) const {
    if (components < 1 || values.size() != static_cast<std::size_t>(node_count_) * static_cast<std::size_t>(components))
        throw InvalidInput(fmt::format("The drawn mesh has {} nodes, but a field has {} values of {} components.",
                                       node_count_, values.size(), components));
    const auto width = static_cast<Eigen::Index>(components);
    std::vector<double> result(surface_points_.size() / 3 * static_cast<std::size_t>(components));
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const Rows> at_nodes(values.data(), node_count_, width);
    Eigen::Map<Rows> at_points(result.data(), static_cast<Eigen::Index>(surface_points_.size() / 3), width);
    parallel_for(faces_.size(), 256, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Patch& face = faces_[i];
            const Eigen::MatrixXd& basis = find_stencil(face.type, face.subdivisions).basis.values;
            Rows nodal(basis.cols(), width);
            for (Eigen::Index k = 0; k < basis.cols(); ++k)
                nodal.row(k) = at_nodes.row(patch_nodes_[face.first_node + k]);
            at_points.middleRows(face.first_point, basis.rows()).noalias() = basis * nodal;
        }
    });
    return result;
}

void Tessellation::move_patches(const std::vector<Patch>& patches, const Coordinates& coordinates,
                                std::vector<float>& points, std::vector<float>* normals) const {
    struct Batch {
        std::size_t first, count;
    };
    std::vector<Batch> batches;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const bool fits = !batches.empty() && batches.back().count < batch_size &&
                          patches[batches.back().first].type == patches[i].type &&
                          patches[batches.back().first].subdivisions == patches[i].subdivisions;
        if (fits)
            ++batches.back().count;
        else
            batches.push_back({i, 1});
    }
    parallel_for(batches.size(), 1, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const auto [first, count] = batches[b];
            const BasisTable& basis = find_stencil(patches[first].type, patches[first].subdivisions).basis;
            const Eigen::MatrixXd nodes = gather(patches, first, count, coordinates);
            const Eigen::MatrixXd x = basis.values * nodes;
            Eigen::MatrixXd du, dv;
            if (normals && is_solid_) {
                du = basis.gradients[0] * nodes;
                dv = basis.gradients[1] * nodes;
            }
            for (std::size_t k = 0; k < count; ++k)
                for (Eigen::Index i = 0; i < x.rows(); ++i) {
                    const auto column = 3 * static_cast<Eigen::Index>(k);
                    const std::size_t at =
                        3 * (static_cast<std::size_t>(patches[first + k].first_point) + static_cast<std::size_t>(i));
                    for (int d = 0; d < 3; ++d) points[at + d] = static_cast<float>(x(i, column + d));
                    if (!normals) continue;
                    Eigen::Vector3d normal(0.0, 0.0, 1.0);
                    if (is_solid_) {
                        const Eigen::Vector3d u = du.block<1, 3>(i, column).transpose();
                        const Eigen::Vector3d v = dv.block<1, 3>(i, column).transpose();
                        const Eigen::Vector3d area = u.cross(v);
                        if (area.norm() > 1e-12 * u.norm() * v.norm()) normal = area.normalized();
                    }
                    for (int d = 0; d < 3; ++d) (*normals)[at + d] = static_cast<float>(normal[d]);
                }
        }
    });
}

bool Tessellation::is_fine_enough(const Coordinates& coordinates, int part, int parts) const {
    if (coordinates.rows() != node_count_) return false;
    Eigen::RowVector3d low, high;
    if (!find_box(nodes_, coordinates, low, high)) return true;
    // Single precision is kept only near the origin.
    if ((0.5 * (low + high) - origin_).norm() > 2.0 * diagonal_) return false;
    const std::size_t count = faces_.size() + edges_.size();
    const auto begin_of = [&](int i) { return count * static_cast<std::size_t>(i) / static_cast<std::size_t>(parts); };
    const std::size_t first = begin_of(part);
    std::vector<std::uint8_t> is_too_coarse(begin_of(part + 1) - first, 0);
    parallel_for(is_too_coarse.size(), 256, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t at = first + i;
            const auto& patches = at < faces_.size() ? faces_ : edges_;
            const Patch& patch = patches[at < faces_.size() ? at : at - faces_.size()];
            is_too_coarse[i] = wanted_subdivisions(patch, coordinates, patches) > patch.subdivisions;
        }
    });
    return std::find(is_too_coarse.begin(), is_too_coarse.end(), 1) == is_too_coarse.end();
}

}  // namespace curvewright
