#include "core/mesh/conformity.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/base/error.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

using Point = Eigen::RowVector3d;

/// How far a node may be from a facet on which it lies, relative to the facet's extent: coordinates in single precision
/// and with seven digits are that good.
constexpr double contact_tolerance = 1e-6;
/// Cosine of the angle between outward directions at which two facets face each other. Curved edges and their chords
/// differ by some degrees.
constexpr double facing = -0.8;

/// Points in a balanced binary tree: a range is split at its median along its longest side.
class PointTree {
  public:
    PointTree(const Coordinates& x, std::vector<Index> nodes) : x_(x), nodes_(std::move(nodes)) {
        axes_.resize(nodes_.size());
        build(0, nodes_.size());
    }
    /// Appends the nodes within a closed box.
    void find(const Eigen::Array3d& low, const Eigen::Array3d& high, std::vector<Index>& found) const {
        find(0, nodes_.size(), low, high, found);
    }

  private:
    void build(std::size_t begin, std::size_t end) {
        if (end - begin < 2) return;
        Eigen::Array3d low = x_.row(nodes_[begin]).transpose(), high = low;
        for (std::size_t i = begin; i < end; ++i) {
            low = low.min(x_.row(nodes_[i]).transpose().array());
            high = high.max(x_.row(nodes_[i]).transpose().array());
        }
        int axis = 0;
        (high - low).maxCoeff(&axis);
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [this](std::size_t i) { return nodes_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end),
                         [&](Index a, Index b) { return std::pair(x_(a, axis), a) < std::pair(x_(b, axis), b); });
        axes_[middle] = static_cast<char>(axis);
        build(begin, middle);
        build(middle + 1, end);
    }
    void find(std::size_t begin, std::size_t end, const Eigen::Array3d& low, const Eigen::Array3d& high,
              std::vector<Index>& found) const {
        if (begin >= end) return;
        const std::size_t middle = begin + (end - begin) / 2;
        const auto x = x_.row(nodes_[middle]).transpose().array();
        const int axis = axes_[middle];
        if (low[axis] <= x[axis]) find(begin, middle, low, high, found);
        if ((x >= low).all() && (x <= high).all()) found.push_back(nodes_[middle]);
        if (x[axis] <= high[axis]) find(middle + 1, end, low, high, found);
    }

    const Coordinates& x_;
    std::vector<Index> nodes_;
    std::vector<char> axes_;
};

/// Squared distance of a point from a triangle (Ericson, "Real-Time Collision Detection", 5.1.5, by minimising over the
/// edges when the projection is outside).
double distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const Point d = b - a;
    const double length2 = d.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
    return (p - a - t * d).norm();
}

double distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
    const Point u = b - a, v = c - a, w = p - a;
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), wu = w.dot(u), wv = w.dot(v);
    const double determinant = uu * vv - uv * uv;
    if (determinant > 0.0) {
        const double s = (vv * wu - uv * wv) / determinant, t = (uu * wv - uv * wu) / determinant;
        if (s >= 0.0 && t >= 0.0 && s + t <= 1.0) return (w - s * u - t * v).norm();
    }
    return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

/// Bounds of the sum of the absolute shape functions on a line (Lebesgue constants of equispaced nodes), order 0 to 10.
constexpr std::array<double, 11> lebesgue = {1, 1, 1.25, 1.64, 2.21, 3.11, 4.55, 6.93, 10.95, 17.85, 29.9};

/// An unmatched facet as geometry.
struct FacetShape {
    ElementType type;
    Eigen::MatrixX3d x;   ///< its nodes
    double extent = 0.0;  ///< diagonal of their box
    double bulge = 0.0;   ///< the facet is no farther than this from the straight one on its corners

    FacetShape(const CurvedMesh& mesh, Facet facet, const std::vector<Index>& nodes)
        : type(reference_element(mesh.topology().element_type(facet.element)).facets[facet.local].type),
          x(static_cast<Eigen::Index>(nodes.size()), 3) {
        for (std::size_t i = 0; i < nodes.size(); ++i)
            x.row(static_cast<Eigen::Index>(i)) = mesh.coordinates().row(nodes[i]);
        extent = (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
    }
    /// straight: shape functions of order 1 at the nodes.
    void find_bulge(const Eigen::MatrixXd& straight) {
        const int corners = corner_count(type.shape);
        if (type.order > 1) {
            const double away = (x - straight * x.topRows(corners)).rowwise().norm().maxCoeff();
            const double factor = lebesgue[static_cast<std::size_t>(type.order)];
            // 1.1: the constants of triangles are less than that times the squares of those of lines.
            bulge = away * (type.shape == Shape::line ? factor : 1.1 * factor * factor);
        }
        // The bilinear facet against the two triangles that distance() takes for it.
        if (type.shape == Shape::quadrilateral) bulge += 0.25 * (x.row(0) - x.row(1) + x.row(2) - x.row(3)).norm();
    }
    /// From the straight facet.
    double distance(const Point& p) const {
        if (type.shape == Shape::line) return distance_to_segment(p, x.row(0), x.row(1));
        const double d = distance_to_triangle(p, x.row(0), x.row(1), x.row(2));
        if (type.shape == Shape::triangle) return d;
        return std::min(d, distance_to_triangle(p, x.row(0), x.row(2), x.row(3)));
    }
    int dimension() const { return curvewright::dimension(type.shape); }
};

/// Rows: tangents of a facet at a reference point.
Eigen::MatrixX3d tangents(const FacetShape& facet, const BasisTable& basis) {
    Eigen::MatrixX3d result(facet.dimension(), 3);
    for (int k = 0; k < facet.dimension(); ++k) result.row(k) = basis.gradients[k].row(0) * facet.x;
    return result;
}

/// The reference point of a facet whose image is p; none if p is not on the facet. Gauss-Newton steps, which converge
/// like Newton's where the distance is zero.
std::optional<Point> reference_point(const FacetShape& facet, const Point& p) {
    Point u = facet.type.shape == Shape::triangle ? Point(1.0 / 3, 1.0 / 3, 0)
                                                  : Point(0.5, facet.dimension() > 1 ? 0.5 : 0.0, 0.0);
    const double tolerance = contact_tolerance * facet.extent;
    double distance = 0.0;
    for (int step = 0; step < 25; ++step) {
        const BasisTable basis = lagrange_basis(facet.type, u);
        const Point residual = p - basis.values.row(0) * facet.x;
        distance = residual.norm();
        const Eigen::MatrixX3d t = tangents(facet, basis);
        const Eigen::VectorXd change = (t * t.transpose()).fullPivLu().solve(t * residual.transpose());
        if (!change.allFinite() || change.norm() < 1e-14) break;
        u.head(facet.dimension()) += change.transpose();
        if (u.cwiseAbs().maxCoeff() > 4.0) return std::nullopt;
        if (change.norm() < 1e-9 && distance < tolerance) break;
    }
    constexpr double slack = 1e-5;
    const bool is_inside = u.minCoeff() >= -slack &&
                           (facet.type.shape == Shape::triangle ? u.sum() <= 1.0 + slack : u.maxCoeff() <= 1.0 + slack);
    if (!is_inside || distance > tolerance) return std::nullopt;
    return u;
}

class Search {
  public:
    Search(const CurvedMesh& mesh, const TaskContext& context)
        : mesh_(mesh), topology_(mesh.topology()), facets_(topology_.boundary_facets()), context_(context) {
        nodes_.reserve(facets_.size());
        for (const Facet& facet : facets_) nodes_.push_back(topology_.facet_nodes(facet));
        number_by_corners();
    }

    Nonconformity run() {
        if (topology_.dimension() < 2) return {};
        find_unlike_orders();
        find_halved_quadrilaterals();
        std::sort(result_.unlike.begin(), result_.unlike.end(), [](const UnlikeFacets& a, const UnlikeFacets& b) {
            const auto key = [](const UnlikeFacets& f) {
                return std::array{f.one.element, f.one.local, f.other.element, f.other.local};
            };
            return key(a) < key(b);
        });
        find_hanging();
        return std::move(result_);
    }

  private:
    const SubElement& part(std::size_t f) const {
        return reference_element(topology_.element_type(facets_[f].element)).facets[facets_[f].local];
    }

    /// Facets with the same corners get the same number.
    void number_by_corners() {
        std::vector<std::pair<std::array<Index, 4>, std::size_t>> keys;
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            std::array<Index, 4> corners{-1, -1, -1, -1};
            for (int i = 0; i < corner_count(part(f).type.shape); ++i) corners[i] = nodes_[f][i];
            std::sort(corners.begin(), corners.end());
            keys.emplace_back(corners, f);
        }
        std::sort(keys.begin(), keys.end());
        twins_.resize(facets_.size());
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (i == 0 || keys[i].first != keys[i - 1].first) groups_.emplace_back();
            groups_.back().push_back(keys[i].second);
            twins_[keys[i].second] = groups_.size() - 1;
        }
    }

    void find_unlike_orders() {
        for (const std::vector<std::size_t>& group : groups_)
            for (std::size_t i = 1; i < group.size(); ++i)
                if (part(group[i]).type != part(group.front()).type)
                    result_.unlike.push_back({facets_[group.front()], facets_[group[i]]});
    }

    void find_halved_quadrilaterals() {
        std::map<std::array<Index, 3>, std::size_t> triangles;
        for (std::size_t f = 0; f < facets_.size(); ++f)
            if (part(f).type.shape == Shape::triangle) triangles.emplace(corners(f, {0, 1, 2}), f);
        if (triangles.empty()) return;
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            if (part(f).type.shape != Shape::quadrilateral) continue;
            for (const std::array<int, 3>& half : {std::array{0, 1, 2}, {1, 2, 3}, {0, 2, 3}, {0, 1, 3}}) {
                const auto found = triangles.find(corners(f, half));
                if (found != triangles.end() && facets_[found->second].element != facets_[f].element)
                    result_.unlike.push_back({facets_[f], facets_[found->second]});
            }
        }
    }
    std::array<Index, 3> corners(std::size_t f, const std::array<int, 3>& positions) const {
        std::array<Index, 3> result{nodes_[f][positions[0]], nodes_[f][positions[1]], nodes_[f][positions[2]]};
        std::sort(result.begin(), result.end());
        return result;
    }

    void find_hanging() {
        const PointTree tree(mesh_.coordinates(), topology_.boundary_nodes());
        facets_of_.resize(static_cast<std::size_t>(topology_.node_count()));
        std::map<ElementType, Eigen::MatrixXd> straight;
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            const ElementType type = part(f).type;
            if (!straight.contains(type))
                straight[type] = lagrange_basis({type.shape, 1}, reference_nodes(type)).values;
            for (const Index node : nodes_[f]) facets_of_[node].push_back(f);
        }
        std::vector<Index> found;
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            if (f % 1024 == 0) context_.check();
            FacetShape shape(mesh_, facets_[f], nodes_[f]);
            shape.find_bulge(straight[shape.type]);
            const double reach = shape.bulge + contact_tolerance * shape.extent;
            found.clear();
            tree.find(shape.x.colwise().minCoeff().transpose().array() - reach,
                      shape.x.colwise().maxCoeff().transpose().array() + reach, found);
            std::sort(found.begin(), found.end());
            for (const Index node : found)
                if (shape.distance(mesh_.coordinates().row(node)) <= reach) examine(f, shape, node);
        }
    }

    void examine(std::size_t f, const FacetShape& shape, Index node) {
        const Point p = mesh_.coordinates().row(node);
        for (std::size_t i = 0; i < nodes_[f].size(); ++i)
            if (nodes_[f][i] == node ||
                (shape.x.row(static_cast<Eigen::Index>(i)) - p).norm() <= contact_tolerance * shape.extent)
                return;
        // The other side of a facet with these corners: of another order, which is told, or of a slit.
        for (const std::size_t own : facets_of_[node])
            if (twins_[own] == twins_[f]) return;
        const std::optional<Point> u = reference_point(shape, p);
        if (!u) return;
        const Point out = outward(f, shape, *u);
        bool faces = false;
        for (const std::size_t own : facets_of_[node]) {
            const auto position = std::find(nodes_[own].begin(), nodes_[own].end(), node) - nodes_[own].begin();
            const FacetShape own_shape(mesh_, facets_[own], nodes_[own]);
            faces = faces || out.dot(outward(own, own_shape, reference_nodes(own_shape.type).row(position))) < facing;
        }
        if (!faces) return;
        constexpr double near = 1e-4;
        bool is_on_edge = shape.type.shape == Shape::line || u->head(2).minCoeff() < near;
        is_on_edge = is_on_edge || (shape.type.shape == Shape::triangle ? u->sum() : u->maxCoeff()) > 1.0 - near;
        auto& list = is_one_body(node, nodes_[f].front()) ? result_.hanging : result_.touching;
        list.push_back({node, facets_[f], is_on_edge});
    }

    /// Whether a chain of elements, each of which shares a node with the next, leads from one node to the other.
    bool is_one_body(Index a, Index b) {
        if (body_.empty()) {
            body_.resize(static_cast<std::size_t>(topology_.node_count()));
            std::iota(body_.begin(), body_.end(), 0);
            for (Index element = 0; element < topology_.element_count(); ++element) {
                const auto nodes = topology_.element_nodes(element);
                for (const Index node : nodes) {
                    const Index one = root(nodes.front()), other = root(node);
                    body_[std::max(one, other)] = std::min(one, other);
                }
            }
        }
        return root(a) == root(b);
    }
    Index root(Index node) {
        while (body_[node] != node) node = body_[node] = body_[body_[node]];
        return node;
    }

    /// Unit vector across a facet at a reference point, away from the element's middle; zero where it is not defined.
    Point outward(std::size_t f, const FacetShape& shape, const Point& u) const {
        const BasisTable basis = lagrange_basis(shape.type, u);
        Point across = basis.values.row(0) * shape.x - mesh_.element_center(facets_[f].element);
        Eigen::MatrixX3d t = tangents(shape, basis);
        for (Eigen::Index k = 0; k < t.rows(); ++k) {
            for (Eigen::Index j = 0; j < k; ++j) t.row(k) -= t.row(k).dot(t.row(j)) * t.row(j);
            if (!(t.row(k).norm() > 0.0)) return Point::Zero();
            t.row(k).normalize();
            across -= across.dot(t.row(k)) * t.row(k);
        }
        const double length = across.norm();
        return length > 0.0 ? Point(across / length) : Point::Zero();
    }

    const CurvedMesh& mesh_;
    const MeshTopology& topology_;
    const std::vector<Facet>& facets_;
    const TaskContext& context_;
    std::vector<std::vector<Index>> nodes_;         ///< of every facet
    std::vector<std::size_t> twins_;                ///< per facet: its group
    std::vector<std::vector<std::size_t>> groups_;  ///< facets with the same corners
    std::vector<std::vector<std::size_t>> facets_of_;
    std::vector<Index> body_;  ///< forest of the nodes that elements connect; made when it is needed
    Nonconformity result_;
};

std::string first_of(std::size_t count) {
    return count > 1 ? fmt::format(" (the first of {})", count) : std::string();
}

}  // namespace

Nonconformity find_nonconformity(const CurvedMesh& mesh, const TaskContext& context) {
    return Search(mesh, context).run();
}

std::string describe(const Nonconformity& nonconformity, const MeshTopology& topology) {
    if (!nonconformity.unlike.empty()) {
        const UnlikeFacets& first = nonconformity.unlike.front();
        const auto text = [&](Facet facet) {
            return fmt::format("{} ({})", topology.element_tag(facet.element).value,
                               name(topology.element_type(facet.element)));
        };
        return fmt::format("Element {} and its neighbour {} have other nodes than each other on their common {}{}",
                           text(first.one), text(first.other), topology.dimension() == 2 ? "edge" : "face",
                           first_of(nonconformity.unlike.size()));
    }
    const HangingNode& first = nonconformity.hanging.front();
    return fmt::format("Node {} hangs on {} of element {}{}", topology.node_tag(first.node).value,
                       first.is_on_edge ? "an edge" : "a face", topology.element_tag(first.facet.element).value,
                       first_of(nonconformity.hanging.size()));
}

void require_conforming(const CurvedMesh& mesh, const TaskContext& context) {
    const Nonconformity found = find_nonconformity(mesh, context);
    if (!found.conforms())
        throw Unsupported(describe(found, mesh.topology()) +
                          "; moving nodes would tear the elements apart there, so only meshes whose facets match can "
                          "be moved.");
}

}  // namespace curvewright
