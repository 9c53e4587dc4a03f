#include "core/quality/boundary_chain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/base/parallel.h"
#include "core/basis/lagrange.h"
#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

const SubElement& cell_of(const MeshTopology& topology, Facet facet) {
    return reference_element(topology.element_type(facet.element)).facets[static_cast<std::size_t>(facet.local)];
}

/// Points that lie within a tolerance of each other, found by a grid of much larger cells.
class PointGrid {
  public:
    explicit PointGrid(double tolerance) : tolerance_(tolerance), side_(1024 * tolerance) {}

    /// The point that was put in first within the tolerance of x, or else this one.
    Index find_or_add(Index node, const Eigen::RowVector3d& x) {
        std::array<std::array<std::int64_t, 2>, 3> cells{};
        for (int d = 0; d < 3; ++d)
            cells[d] = {static_cast<std::int64_t>(std::floor((x[d] - tolerance_) / side_)),
                        static_cast<std::int64_t>(std::floor((x[d] + tolerance_) / side_))};
        for (std::int64_t i = cells[0][0]; i <= cells[0][1]; ++i)
            for (std::int64_t j = cells[1][0]; j <= cells[1][1]; ++j)
                for (std::int64_t k = cells[2][0]; k <= cells[2][1]; ++k) {
                    const auto [begin, end] = grid_.equal_range(key(i, j, k));
                    Index found = -1;
                    for (auto it = begin; it != end; ++it)
                        if ((it->second.second - x).cwiseAbs().maxCoeff() <= tolerance_)
                            found = found < 0 ? it->second.first : std::min(found, it->second.first);
                    if (found >= 0) return found;
                }
        const auto place = [&](int d) { return static_cast<std::int64_t>(std::floor(x[d] / side_)); };
        grid_.emplace(key(place(0), place(1), place(2)), std::pair(node, x));
        return node;
    }

  private:
    static std::uint64_t key(std::int64_t i, std::int64_t j, std::int64_t k) {
        std::uint64_t hash = 0;
        for (const std::int64_t part : {i, j, k}) {
            hash = (hash ^ static_cast<std::uint64_t>(part)) * 0x9e3779b97f4a7c15ULL;
            hash ^= hash >> 29;
        }
        return hash;
    }

    double tolerance_, side_;
    std::unordered_multimap<std::uint64_t, std::pair<Index, Eigen::RowVector3d>> grid_;
};

std::array<Index, 4> sorted_corners(const ChainFacet& facet) {
    std::array<Index, 4> corners = facet.corners;
    std::sort(corners.begin(), corners.end());
    return corners;
}

std::vector<Index> corner_loop(const ChainFacet& facet) {
    std::vector<Index> loop;
    for (const int corner : facet.form->loop) loop.push_back(facet.corners[static_cast<std::size_t>(corner)]);
    return loop;
}

}  // namespace

BoundaryChain::BoundaryChain(const CurvedMesh& mesh, const OrientationSigns& signs, const TaskContext& context)
    : dimension_(mesh.topology().dimension()) {
    find_points(mesh);
    context.check();
    gather(mesh, signs);
    cancel(mesh);
    context.check();
    if (dimension_ == 3) find_curves(mesh);
    convert(mesh, context);
    find_components();
}

void BoundaryChain::find_points(const CurvedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = low;
    bool is_first = true;
    for (const Index node : topology.boundary_nodes()) {
        const Eigen::Vector3d x = mesh.coordinates().row(node).transpose();
        low = is_first ? x : low.cwiseMin(x).eval();
        high = is_first ? x : high.cwiseMax(x).eval();
        is_first = false;
    }
    // Far from the origin, the distance from the middle is exact; near it, nothing is subtracted.
    for (int d = 0; d < 3; ++d) {
        const double middle = 0.5 * low[d] + 0.5 * high[d];
        if (std::abs(middle) > 2 * (high[d] - low[d])) center_[d] = middle;
    }
    const double largest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
    tolerance_ = std::max(64 * unit_roundoff * largest, std::numeric_limits<double>::min());
    PointGrid grid(tolerance_);
    point_.assign(static_cast<std::size_t>(topology.node_count()), -1);
    for (const Index node : topology.boundary_nodes())
        point_[static_cast<std::size_t>(node)] = grid.find_or_add(node, mesh.coordinates().row(node));
}

std::vector<Index> BoundaryChain::points_of(const CurvedMesh& mesh, Facet facet) const {
    std::vector<Index> points;
    const auto nodes = mesh.topology().element_nodes(facet.element);
    for (const int node : cell_of(mesh.topology(), facet).nodes)
        points.push_back(point_[static_cast<std::size_t>(nodes[static_cast<std::size_t>(node)])]);
    return points;
}

void BoundaryChain::gather(const CurvedMesh& mesh, const OrientationSigns& signs) {
    const MeshTopology& topology = mesh.topology();
    for (const Facet& facet : topology.boundary_facets()) {
        ChainFacet& chain = facets_.emplace_back();
        chain.facet = facet;
        const SubElement& cell = cell_of(topology, facet);
        const auto nodes = topology.element_nodes(facet.element);
        chain.form = &FacetForm::get(cell.type);
        chain.sense = outward_sense(topology.element_type(facet.element), facet.local);
        if (signs.of_element(topology, facet.element) < 0.0) chain.sense = -chain.sense;
        for (std::size_t k = 0; k < chain.form->loop.size(); ++k)
            chain.corners[static_cast<std::size_t>(chain.form->loop[k])] = point_[nodes[cell.nodes[k]]];
    }
}

bool BoundaryChain::coincide(const CurvedMesh& mesh, ElementType type_a, const std::vector<Index>& a,
                             ElementType type_b, const std::vector<Index>& b, CornerMatch match) const {
    if (type_a.order < type_b.order) {
        // The inverse of a reflection is itself; that of a rotation turns back.
        const int count = corner_count(type_a.shape);
        const CornerMatch inverse{match.sense < 0 ? match.first : (count - match.first) % count, match.sense};
        return coincide(mesh, type_b, b, type_a, a, inverse);
    }
    if (type_a == type_b) {
        const std::vector<int>& nodes = matched_nodes(type_a, match);
        for (std::size_t k = 0; k < nodes.size(); ++k)
            if (a[k] != b[static_cast<std::size_t>(nodes[k])]) return false;
        return true;
    }
    // b's nodes in the order in which a's would be on a cell of b's order, evaluated at a's nodes.
    const std::vector<int>& nodes = matched_nodes(type_b, match);
    const BasisTable basis = lagrange_basis(type_b, reference_nodes(type_a));
    for (std::size_t k = 0; k < a.size(); ++k) {
        Eigen::RowVector3d x = -mesh.coordinates().row(a[k]);
        for (std::size_t node = 0; node < nodes.size(); ++node)
            x += basis.values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(node)) *
                 mesh.coordinates().row(b[static_cast<std::size_t>(nodes[node])]);
        if (!(x.cwiseAbs().maxCoeff() <= tolerance_)) return false;
    }
    return true;
}

BoundaryChain::Contact BoundaryChain::compare(const CurvedMesh& mesh, const ChainFacet& a, const ChainFacet& b,
                                              int& sense) const {
    const CornerMatch match = match_corners(corner_loop(a), corner_loop(b));
    sense = match.sense;
    if (match.sense == 0 || a.form->type.shape != b.form->type.shape) return Contact::none;
    if (coincide(mesh, a.form->type, points_of(mesh, a.facet), b.form->type, points_of(mesh, b.facet), match))
        return Contact::coincident;
    return a.form->type != b.form->type ? Contact::unmatched : Contact::none;
}

void BoundaryChain::cancel(const CurvedMesh& mesh) {
    std::vector<std::pair<std::array<Index, 4>, int>> keys;
    for (int facet = 0; facet < size(); ++facet) keys.emplace_back(sorted_corners((*this)[facet]), facet);
    std::sort(keys.begin(), keys.end());
    std::vector<bool> is_gone(facets_.size(), false);
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i + 1;
        while (end < keys.size() && keys[end].first == keys[i].first) ++end;
        for (std::size_t a = i; a < end; ++a)
            for (std::size_t b = a + 1; b < end; ++b) {
                const auto first = static_cast<std::size_t>(keys[a].second);
                const auto second = static_cast<std::size_t>(keys[b].second);
                const ChainFacet &f = facets_[first], &g = facets_[second];
                int sense = 0;
                const Contact contact = compare(mesh, f, g, sense);
                if (contact == Contact::unmatched) unmatched_.push_back({f.facet, g.facet});
                if (contact != Contact::coincident) continue;
                if (f.sense == sense * g.sense)
                    doubled_.push_back({f.facet, g.facet});
                else
                    is_gone[first] = is_gone[second] = true;
            }
        i = end;
    }
    std::sort(doubled_.begin(), doubled_.end(), [](const auto& a, const auto& b) {
        return std::pair(a[0].element, a[0].local) < std::pair(b[0].element, b[0].local);
    });
    std::vector<ChainFacet> kept;
    for (std::size_t facet = 0; facet < facets_.size(); ++facet)
        if (!is_gone[facet]) kept.push_back(facets_[facet]);
    facets_ = std::move(kept);
}

void BoundaryChain::find_curves(const CurvedMesh& mesh) {
    struct Record {
        std::array<Index, 2> ends;
        int facet = 0, edge = 0;
    };
    std::vector<Record> records;
    for (int facet = 0; facet < size(); ++facet) {
        const ChainFacet& chain = (*this)[facet];
        for (int edge = 0; edge < static_cast<int>(chain.form->edges.size()); ++edge) {
            const Index a = chain.corners[chain.form->edges[edge].a], b = chain.corners[chain.form->edges[edge].b];
            records.push_back({{std::min(a, b), std::max(a, b)}, facet, edge});
            facets_[facet].runs_back[edge] = a > b;
        }
    }
    std::sort(records.begin(), records.end(), [](const Record& a, const Record& b) {
        return std::tie(a.ends, a.facet, a.edge) < std::tie(b.ends, b.facet, b.edge);
    });
    // A line cell's nodes: both ends, then those between them. The points of an edge follow from the facet's cell.
    const auto line_points = [&](const Record& record) {
        const ChainFacet& chain = (*this)[record.facet];
        const ReferenceElement& cell = reference_element(chain.form->type);
        const FacetForm::Edge& edge = chain.form->edges[record.edge];
        const auto& loop = chain.form->loop;
        const auto place = [&](int corner) {
            return cell.lattice[static_cast<std::size_t>(std::find(loop.begin(), loop.end(), corner) - loop.begin())];
        };
        LatticePoint from = place(edge.a), to = place(edge.b);
        if (chain.runs_back[record.edge]) std::swap(from, to);
        const std::vector<Index> points = points_of(mesh, chain.facet);
        const int p = chain.form->type.order;
        std::vector<Index> line;
        for (const LatticePoint& own : reference_element({Shape::line, p}).lattice) {
            LatticePoint at{};
            for (int d = 0; d < 3; ++d) at[d] = from[d] + own[0] * (to[d] - from[d]) / p;
            line.push_back(points[static_cast<std::size_t>(cell.find_node(at))]);
        }
        return line;
    };
    Index curves = 0;
    for (std::size_t i = 0; i < records.size();) {
        std::size_t end = i + 1;
        while (end < records.size() && records[end].ends == records[i].ends) ++end;
        std::vector<std::tuple<int, std::vector<Index>, Index>> known;  // order, points, curve
        for (; i < end; ++i) {
            const int order = (*this)[records[i].facet].form->type.order;
            const std::vector<Index> line = line_points(records[i]);
            Index curve = -1;
            for (const auto& [other_order, other, number] : known)
                if (curve < 0 && coincide(mesh, {Shape::line, order}, line, {Shape::line, other_order}, other, {0, 1}))
                    curve = number;
            if (curve < 0) {
                curve = curves++;
                known.emplace_back(order, line, curve);
            }
            facets_[records[i].facet].edges[records[i].edge] = curve;
        }
    }
}

void BoundaryChain::convert(const CurvedMesh& mesh, const TaskContext& context) {
    std::size_t count = 0;
    for (ChainFacet& chain : facets_) {
        chain.first_control = count;
        count += static_cast<std::size_t>(chain.form->size);
    }
    control_.resize(count);
    parallel_for(facets_.size(), 256, context, {}, [&](std::size_t begin, std::size_t end) {
        using Rows = Eigen::Matrix<long double, Eigen::Dynamic, 3>;
        for (std::size_t i = begin; i < end; ++i) {
            ChainFacet& chain = facets_[i];
            const std::vector<Index> points = points_of(mesh, chain.facet);
            Rows x(chain.form->size, 3);
            for (int node = 0; node < chain.form->size; ++node)
                for (int d = 0; d < 3; ++d)
                    x(node, d) = d < dimension_
                                     ? mesh.coordinates()(points[static_cast<std::size_t>(node)], d) - center_[d]
                                     : 0.0;
            const Eigen::Matrix<long double, 1, 3> origin = x.row(0);
            x.rowwise() -= origin;
            const auto extent = static_cast<double>(x.cwiseAbs().maxCoeff());
            Rows c = chain.form->to_bernstein * x;
            c.rowwise() += origin;
            FacetPiece piece;
            Eigen::Vector3d* control = control_.data() + chain.first_control;
            for (int k = 0; k < chain.form->size; ++k) control[k] = c.row(k).cast<double>().transpose();
            piece.control.assign(control, control + chain.form->size);
            const auto largest = static_cast<double>(c.cwiseAbs().maxCoeff());
            chain.error = piece.error = chain.form->conversion_error * extent + 2 * unit_roundoff * largest;
            piece.find_box();
            chain.box = piece.box;
        }
    });
}

void BoundaryChain::find_components() {
    std::vector<std::pair<Index, int>> ridges;
    for (int facet = 0; facet < size(); ++facet) {
        const ChainFacet& chain = (*this)[facet];
        for (const Index ridge : dimension_ == 2 ? chain.corners : chain.edges)
            if (ridge >= 0) ridges.emplace_back(ridge, facet);
    }
    std::sort(ridges.begin(), ridges.end());
    std::vector<std::vector<int>> neighbours(facets_.size());
    for (std::size_t i = 0; i < ridges.size();) {
        std::size_t end = i + 1;
        while (end < ridges.size() && ridges[end].first == ridges[i].first) ++end;
        if (end - i == 2) {
            neighbours[ridges[i].second].push_back(ridges[i + 1].second);
            neighbours[ridges[i + 1].second].push_back(ridges[i].second);
        }
        i = end;
    }
    components_.assign(facets_.size(), -1);
    std::vector<int> front;
    for (int seed = 0; seed < size(); ++seed) {
        if (components_[seed] >= 0) continue;
        components_[seed] = component_count_;
        front.assign(1, seed);
        while (!front.empty()) {
            const int facet = front.back();
            front.pop_back();
            for (const int neighbour : neighbours[facet])
                if (components_[neighbour] < 0) {
                    components_[neighbour] = component_count_;
                    front.push_back(neighbour);
                }
        }
        ++component_count_;
    }
}

}  // namespace curvewright
