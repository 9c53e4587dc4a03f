#include "core/tessellate/plane_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/basis/reference_element.h"
#include "core/tessellate/solid_basis.h"

namespace curvewright {
namespace {

/// Deviation from an affine image, relative to the size of the element, that counts as rounding.
constexpr double affine_tolerance = 1e-9;
/// Distance from the plane, relative to the size of the mesh, that counts as none: far below single precision.
constexpr double plane_tolerance = 1e-10;

struct Tetrahedron {
    std::array<Index, 4> corners;       ///< positively oriented
    std::array<Index, 6> sides;         ///< numbers of its sides: 01, 02, 03, 12, 13, 23
    std::array<std::int8_t, 4> facets;  ///< facet of the element that the face opposite to a corner lies on, or -1
};
constexpr std::array<std::array<int, 2>, 6> side_corners{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// [a][b]: which side joins two corners.
constexpr std::array<std::array<int, 4>, 4> side_between{{{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}}};

/// The reference element divided into tetrahedra: those of Freudenthal's division of the unit cube that lie in the part
/// of it that the reference element is an affine image of (u1 >= u2 >= u3 is a tetrahedron, u1 >= u2 a prism,
/// u3 <= u1, u2 a pyramid).
struct Lattice {
    std::vector<std::array<double, 3>> points;  ///< reference coordinates
    std::vector<Tetrahedron> tetrahedra;
    std::vector<std::array<Index, 2>> sides;  ///< of the tetrahedra, each once: points, ascending
    Eigen::MatrixXd values;                   ///< points × nodes
};

bool is_in_shape(Shape shape, const std::array<int, 3>& u) {
    switch (shape) {
        case Shape::tetrahedron:
            return u[0] >= u[1] && u[1] >= u[2];
        case Shape::prism:
            return u[0] >= u[1];
        case Shape::pyramid:
            return u[0] >= u[2] && u[1] >= u[2];
        default:
            return true;
    }
}

std::array<int, 3> to_reference(Shape shape, const std::array<int, 3>& u) {
    switch (shape) {
        case Shape::tetrahedron:
            return {u[0] - u[1], u[1] - u[2], u[2]};
        case Shape::prism:
            return {u[0] - u[1], u[1], u[2]};
        case Shape::pyramid:
            return {u[0] - u[2], u[1] - u[2], u[2]};
        default:
            return u;
    }
}

std::unique_ptr<const Lattice> make_lattice(const SolidBasis& basis, int n) {
    auto lattice = std::make_unique<Lattice>();
    const Shape shape = basis.type().shape;
    const ReferenceElement& element = reference_element(basis.type());
    // Per facet the plane that it lies in: a · x = b.
    struct FacetPlane {
        Eigen::Vector3d a;
        double b;
    };
    std::vector<FacetPlane> facets;
    for (const SubElement& facet : element.facets) {
        std::array<Eigen::Vector3d, 3> x;
        for (std::size_t i = 0; i < 3; ++i) {
            const LatticePoint& at = element.lattice[static_cast<std::size_t>(facet.nodes[i])];
            x[i] = Eigen::Vector3d(at[0], at[1], at[2]) / basis.type().order;
        }
        const Eigen::Vector3d a = (x[1] - x[0]).cross(x[2] - x[0]);
        facets.push_back({a, a.dot(x[0])});
    }
    std::vector<std::uint8_t> facets_of;  // per point, one bit per facet
    std::map<std::array<int, 3>, Index> number;
    std::array<int, 3> u{};
    for (u[2] = 0; u[2] <= n; ++u[2])
        for (u[1] = 0; u[1] <= n; ++u[1])
            for (u[0] = 0; u[0] <= n; ++u[0]) {
                if (!is_in_shape(shape, u)) continue;
                number[u] = static_cast<Index>(lattice->points.size());
                const auto at = to_reference(shape, u);
                const Eigen::Vector3d x = Eigen::Vector3d(at[0], at[1], at[2]) / n;
                lattice->points.push_back({x[0], x[1], x[2]});
                std::uint8_t bits = 0;
                for (std::size_t f = 0; f < facets.size(); ++f)
                    if (std::abs(facets[f].a.dot(x) - facets[f].b) < 1e-9) bits |= std::uint8_t(1u << f);
                facets_of.push_back(bits);
            }
    std::map<std::array<Index, 2>, Index> side_number;
    const auto add_tetrahedron = [&](const std::array<Index, 4>& corners) {
        Tetrahedron its{corners, {}, {}};
        for (std::size_t side = 0; side < 6; ++side) {
            std::array<Index, 2> ends{corners[side_corners[side][0]], corners[side_corners[side][1]]};
            std::sort(ends.begin(), ends.end());
            const auto [entry, is_new] = side_number.try_emplace(ends, static_cast<Index>(lattice->sides.size()));
            if (is_new) lattice->sides.push_back(ends);
            its.sides[side] = entry->second;
        }
        for (std::size_t opposite = 0; opposite < 4; ++opposite) {
            unsigned bits = 0xff;
            for (std::size_t corner = 0; corner < 4; ++corner)
                if (corner != opposite) bits &= facets_of[static_cast<std::size_t>(corners[corner])];
            its.facets[opposite] = -1;
            for (int f = 0; f < 8; ++f)
                if (bits >> f & 1u) its.facets[opposite] = static_cast<std::int8_t>(f);
        }
        lattice->tetrahedra.push_back(its);
    };
    for (u[2] = 0; u[2] < n; ++u[2])
        for (u[1] = 0; u[1] < n; ++u[1])
            for (u[0] = 0; u[0] < n; ++u[0]) {
                std::array<int, 3> axes{0, 1, 2};
                do {
                    std::array<int, 3> corner = u;
                    bool is_inside = is_in_shape(shape, corner);
                    std::array<Index, 4> corners{is_inside ? number[corner] : -1};
                    for (std::size_t step = 0; step < 3; ++step) {
                        ++corner[static_cast<std::size_t>(axes[step])];
                        is_inside = is_inside && is_in_shape(shape, corner);
                        corners[step + 1] = is_inside ? number[corner] : -1;
                    }
                    if (!is_inside) continue;
                    const bool is_even = (axes[1] - axes[0] + 3) % 3 == 1;
                    if (!is_even) std::swap(corners[1], corners[2]);
                    add_tetrahedron(corners);
                } while (std::next_permutation(axes.begin(), axes.end()));
            }
    const auto count = static_cast<Eigen::Index>(lattice->points.size());
    Eigen::MatrixXd transposed(basis.node_count(), count);
    for (Eigen::Index i = 0; i < count; ++i)
        basis.evaluate(lattice->points[static_cast<std::size_t>(i)], transposed.col(i).data());
    lattice->values = transposed.transpose();
    return lattice;
}

/// All that depends on the type of an element.
struct Stencil {
    SolidBasis basis;
    /// nodes × 4, orthonormal columns that span the affine functions at the nodes.
    Eigen::MatrixXd affine;
    /// How far the values of a function between the nodes can exceed those at the nodes (Lebesgue's constant, sampled).
    double excess = 1.0;

    explicit Stencil(ElementType type) : basis(type) {
        const auto nodes = static_cast<Eigen::Index>(basis.node_count());
        Eigen::MatrixXd ones(nodes, 4);
        for (Eigen::Index i = 0; i < nodes; ++i) {
            const LatticePoint& at = reference_element(type).lattice[static_cast<std::size_t>(i)];
            ones.row(i) << 1.0, at[0], at[1], at[2];
        }
        affine = Eigen::HouseholderQR<Eigen::MatrixXd>(ones).householderQ() * Eigen::MatrixXd::Identity(nodes, 4);
        if (type.order == 1 && type.shape != Shape::pyramid) return;
        const Lattice& fine = lattice(std::min(12, 2 * type.order + 1));
        excess = 1.2 * fine.values.cwiseAbs().rowwise().sum().maxCoeff();
    }

    const Lattice& lattice(int n) const {
        const std::lock_guard lock(mutex_);
        auto& entry = lattices_[n];
        if (!entry) entry = make_lattice(basis, n);
        return *entry;
    }

  private:
    mutable std::mutex mutex_;
    mutable std::map<int, std::unique_ptr<const Lattice>> lattices_;
};

const Stencil& find_stencil(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, std::unique_ptr<const Stencil>> cache;
    const std::lock_guard lock(mutex);
    auto& entry = cache[type];
    if (!entry) entry = std::make_unique<Stencil>(type);
    return *entry;
}

/// What the cut elements of a piece of the loop give; numbers of points are the piece's own.
struct Section {
    std::vector<float> points, line_points;
    std::vector<Index> point_elements;
    std::vector<double> point_shapes;
    std::vector<Index> triangles, triangle_elements, line_offsets{0}, line_elements;
    std::vector<std::int8_t> line_facets;
};

/// Cuts one element after the other; keeps its buffers.
class ElementCutter {
  public:
    ElementCutter(const Eigen::RowVector3d& normal, double offset, double zero, double chord_tolerance,
                  const PlaneCutOptions& options)
        : normal_(normal), offset_(offset), zero_(zero), chord_tolerance_(chord_tolerance), options_(options) {}

    /// x: nodes × 3, relative to the origin. Adds to the section and tells where the element is.
    PlaneCut::Side cut(ElementType type, const Eigen::MatrixX3d& x, Index element, Section& section) {
        if (type != type_) {
            stencil_ = &find_stencil(type);
            type_ = type;
        }
        x_ = &x;
        distances_ = x * normal_.transpose();
        distances_.array() -= offset_;
        const Lattice& lattice = choose_lattice();
        lattice_ = &lattice;
        at_lattice_.noalias() = lattice.values * distances_;
        bool has_near = false, has_far = false;
        for (double& distance : at_lattice_) {
            if (std::abs(distance) <= zero_) distance = 0.0;
            (distance < 0.0 ? has_near : has_far) = true;
        }
        if (!has_near || !has_far) return has_near ? PlaneCut::Side::kept : PlaneCut::Side::removed;
        return march(element, section) ? PlaneCut::Side::cut : PlaneCut::Side::kept;
    }

  private:
    const Lattice& choose_lattice() {
        // Distance of the nodes from the nearest affine image of the reference element.
        const Eigen::MatrixX3d& x = *x_;
        const double size = (x.rowwise() - x.row(0)).rowwise().norm().maxCoeff();
        const double deviation =
            (x - stencil_->affine * (stencil_->affine.transpose() * x)).rowwise().norm().maxCoeff();
        is_affine_ = deviation <= std::max(affine_tolerance * size, zero_);
        if (is_affine_) return stencil_->lattice(1);
        // A quadratic side whose middle is d from its chord is about d / 2 from the nearest affine one, and n pieces
        // are d / n^2 from it.
        const double wanted = chord_tolerance_ > 0.0 ? std::ceil(std::sqrt(2.0 * deviation / chord_tolerance_))
                                                     : options_.max_subdivisions;
        int n = std::max(1, options_.min_subdivisions);
        while (n < wanted && n < options_.max_subdivisions) n += std::max(1, n / 2);
        return stencil_->lattice(std::min(n, std::max(options_.max_subdivisions, 1)));
    }

    double distance_at(const std::array<double, 3>& point) {
        stencil_->basis.evaluate(point, shape_.data());
        return shape_.dot(distances_);
    }

    /// The point of a lattice side that lies in the plane: its reference coordinates, and in shape_ the values there.
    void find_crossing(const std::array<Index, 2>& side) {
        const auto &a = lattice_->points[static_cast<std::size_t>(side[0])],
                   &b = lattice_->points[static_cast<std::size_t>(side[1])];
        double low = 0.0, high = 1.0, at_low = at_lattice_[side[0]], at_high = at_lattice_[side[1]];
        shape_.resize(stencil_->basis.node_count());
        double t = 0.5;
        const auto point_at = [&](double s) {
            return std::array{a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
        };
        // Regula falsi with Illinois's halving: keeps the bracket, and is exact at once where the distance is linear.
        constexpr int most_steps = 40;
        int last_side = 0;
        for (int step = 0; step < most_steps; ++step) {
            t = std::clamp((low * at_high - high * at_low) / (at_high - at_low), low, high);
            const double here = distance_at(point_at(t));
            if (is_affine_ || std::abs(here) <= 0.1 * zero_ || high - low < 1e-15) break;
            if ((here < 0.0) == (at_low < 0.0)) {
                low = t;
                at_low = here;
                if (last_side < 0) at_high *= 0.5;
                last_side = -1;
            } else {
                high = t;
                at_high = here;
                if (last_side > 0) at_low *= 0.5;
                last_side = 1;
            }
        }
        reference_.push_back(point_at(t));
    }

    Index add_point(Section& section) {
        const Eigen::RowVector3d at = shape_.transpose() * *x_;
        for (int d = 0; d < 3; ++d) section.points.push_back(static_cast<float>(at[d]));
        section.point_elements.push_back(element_);
        section.point_shapes.insert(section.point_shapes.end(), shape_.data(), shape_.data() + shape_.size());
        return first_point_ + static_cast<Index>(reference_.size()) - 1;
    }

    /// The point of the section on a side of the lattice; one in a lattice point in the plane is shared by all sides
    /// that end there.
    Index crossing(Index side, Section& section) {
        const auto& ends = lattice_->sides[static_cast<std::size_t>(side)];
        for (const Index end : ends) {
            if (at_lattice_[end] != 0.0) continue;
            Index& its = point_in_[static_cast<std::size_t>(end)];
            if (its < 0) {
                reference_.push_back(lattice_->points[static_cast<std::size_t>(end)]);
                shape_ = lattice_->values.row(end).transpose();
                its = add_point(section);
            }
            return its;
        }
        Index& its = point_on_[static_cast<std::size_t>(side)];
        if (its < 0) {
            find_crossing(ends);
            its = add_point(section);
        }
        return its;
    }

    /// Whether the section has any area.
    bool march(Index element, Section& section) {
        element_ = element;
        point_on_.assign(lattice_->sides.size(), -1);
        point_in_.assign(lattice_->points.size(), -1);
        reference_.clear();
        for (auto& segments : segments_) segments.clear();
        first_point_ = static_cast<Index>(section.points.size() / 3);
        const std::size_t first_triangle = section.triangles.size();
        for (const Tetrahedron& tetrahedron : lattice_->tetrahedra) {
            std::array<int, 4> near{}, far{};
            int nears = 0, fars = 0;
            for (int corner = 0; corner < 4; ++corner)
                if (at_lattice_[tetrahedron.corners[corner]] < 0.0)
                    near[nears++] = corner;
                else
                    far[fars++] = corner;
            if (nears == 0 || fars == 0) continue;
            const auto point = [&](int a, int b) { return crossing(tetrahedron.sides[side_between[a][b]], section); };
            const auto& start = lattice_->points[static_cast<std::size_t>(tetrahedron.corners[near[0]])];
            const auto& end = lattice_->points[static_cast<std::size_t>(tetrahedron.corners[far[0]])];
            const Eigen::Vector3d across(end[0] - start[0], end[1] - start[1], end[2] - start[2]);
            if (nears == 1) {
                add_triangle({point(near[0], far[0]), point(near[0], far[1]), point(near[0], far[2])}, across, element,
                             section);
            } else if (fars == 1) {
                add_triangle({point(near[0], far[0]), point(near[1], far[0]), point(near[2], far[0])}, across, element,
                             section);
            } else {
                const Index a = point(near[0], far[0]), b = point(near[0], far[1]), c = point(near[1], far[1]),
                            d = point(near[1], far[0]);
                add_triangle({a, b, c}, across, element, section);
                add_triangle({a, c, d}, across, element, section);
            }
            for (int opposite = 0; opposite < 4; ++opposite) {
                const int facet = tetrahedron.facets[opposite];
                if (facet < 0) continue;
                std::array<Index, 2> ends{};
                int found = 0;
                for (int i = 0; i < nears; ++i)
                    for (int j = 0; j < fars; ++j)
                        if (near[i] != opposite && far[j] != opposite && found < 2)
                            ends[found++] = point(near[i], far[j]);
                if (found == 2 && ends[0] != ends[1]) segments_[facet].push_back(ends);
            }
        }
        if (section.triangles.size() == first_triangle) {
            // The plane touches a node or an edge.
            section.points.resize(3 * static_cast<std::size_t>(first_point_));
            section.point_elements.resize(static_cast<std::size_t>(first_point_));
            section.point_shapes.resize(section.point_shapes.size() - reference_.size() * shape_.size());
            return false;
        }
        for (std::size_t facet = 0; facet < segments_.size(); ++facet) chain(segments_[facet], facet, element, section);
        return true;
    }

    void add_triangle(std::array<Index, 3> corners, const Eigen::Vector3d& across, Index element, Section& section) {
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
        const auto at = [this](Index point) {
            return Eigen::Vector3d(reference_[static_cast<std::size_t>(point - first_point_)].data());
        };
        const Eigen::Vector3d a = at(corners[0]);
        if ((at(corners[1]) - a).cross(at(corners[2]) - a).dot(across) < 0.0) std::swap(corners[1], corners[2]);
        section.triangles.insert(section.triangles.end(), corners.begin(), corners.end());
        section.triangle_elements.push_back(element);
    }

    /// Joins segments that share an end to polylines.
    void chain(std::vector<std::array<Index, 2>>& segments, std::size_t facet, Index element, Section& section) {
        for (auto& ends : segments)
            if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
        std::sort(segments.begin(), segments.end());
        segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
        std::vector<bool> is_used(segments.size(), false);
        const auto count_at = [&](Index point) {
            return std::count_if(segments.begin(), segments.end(),
                                 [&](const auto& ends) { return ends[0] == point || ends[1] == point; });
        };
        const auto take_next = [&](Index point) -> Index {
            for (std::size_t i = 0; i < segments.size(); ++i) {
                if (is_used[i] || (segments[i][0] != point && segments[i][1] != point)) continue;
                is_used[i] = true;
                return segments[i][0] == point ? segments[i][1] : segments[i][0];
            }
            return -1;
        };
        const auto follow = [&](Index start) {
            for (Index point = start; point >= 0; point = take_next(point)) {
                const auto at = section.points.begin() + 3 * static_cast<std::ptrdiff_t>(point);
                section.line_points.insert(section.line_points.end(), at, at + 3);
            }
            section.line_offsets.push_back(static_cast<Index>(section.line_points.size() / 3));
            section.line_elements.push_back(element);
            section.line_facets.push_back(static_cast<std::int8_t>(facet));
        };
        // Open lines from their ends first; what is left are closed ones.
        for (int pass = 0; pass < 2; ++pass)
            for (std::size_t i = 0; i < segments.size(); ++i)
                for (const Index end : segments[i])
                    if (!is_used[i] && (pass == 1 || count_at(end) == 1)) follow(end);
    }

    Eigen::RowVector3d normal_;
    double offset_, zero_, chord_tolerance_;
    const PlaneCutOptions& options_;

    ElementType type_;
    const Stencil* stencil_ = nullptr;
    const Lattice* lattice_ = nullptr;
    const Eigen::MatrixX3d* x_ = nullptr;
    bool is_affine_ = false;
    Eigen::VectorXd distances_, at_lattice_, shape_;  ///< of the nodes; of the lattice's points; shape functions
    std::vector<Index> point_on_, point_in_;          ///< per side, per lattice point: number of the section's point
    std::vector<std::array<double, 3>> reference_;    ///< of the element's points of the section
    Index element_ = 0;
    Index first_point_ = 0;
    std::array<std::vector<std::array<Index, 2>>, 6> segments_;  ///< per facet
};

/// A face, told by its sorted corners, and one of its polylines.
struct FaceLine {
    std::array<Index, 4> corners{-1, -1, -1, -1};
    Index element = 0;
    std::size_t line = 0;
};

}  // namespace

PlaneCut::PlaneCut(const CurvedMesh& mesh, const CuttingPlane& plane, const std::vector<bool>& visible,
                   const PlaneCutOptions& options)
    : topology_(mesh.shared_topology()), plane_(plane) {
    const MeshTopology& topology = mesh.topology();
    const auto element_count = static_cast<std::size_t>(topology.element_count());
    if (!visible.empty() && visible.size() != element_count)
        throw InvalidInput(
            fmt::format("The mesh has {} elements but {} visibility flags.", element_count, visible.size()));
    if (!(std::abs(plane.normal.norm() - 1.0) < 1e-6 && std::isfinite(plane.offset)))
        throw InvalidInput("The normal of a plane that cuts a mesh must have length 1.");
    sides_.assign(element_count, Side::removed);
    const auto box = bounding_box(mesh);
    origin_ = 0.5 * (box.row(0) + box.row(1));
    if (topology.dimension() != 3) return;

    const double diagonal = (box.row(1) - box.row(0)).norm();
    const double rounding = 64.0 * std::numeric_limits<double>::epsilon() * (origin_.cwiseAbs().maxCoeff() + diagonal);
    const double zero = std::max(plane_tolerance * diagonal, rounding);
    const double offset = plane.offset - plane.normal.dot(origin_);
    const Coordinates& coordinates = mesh.coordinates();

    // Most elements are told by their nodes: far from the plane, compared with how much an element can bulge.
    std::vector<double> distances(static_cast<std::size_t>(topology.node_count()));
    parallel_for(distances.size(), 8192, {}, {}, [&](std::size_t begin, std::size_t end) {
        for (std::size_t node = begin; node < end; ++node)
            distances[node] = plane.normal.dot(coordinates.row(static_cast<Eigen::Index>(node)) - origin_) - offset;
    });
    std::vector<std::uint8_t> may_be_cut(element_count, 0);
    parallel_for(element_count, 2048, {}, {}, [&](std::size_t begin, std::size_t end) {
        const Stencil* stencil = nullptr;
        ElementType type;
        for (std::size_t element = begin; element < end; ++element) {
            if (!visible.empty() && !visible[element]) continue;
            const auto index = static_cast<Index>(element);
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (const Index node : topology.element_nodes(index)) {
                low = std::min(low, distances[static_cast<std::size_t>(node)]);
                high = std::max(high, distances[static_cast<std::size_t>(node)]);
            }
            const ElementType its = topology.element_type(index);
            if (!stencil || its != type) {
                stencil = &find_stencil(its);
                type = its;
            }
            const double reach = 0.5 * (stencil->excess - 1.0) * (high - low) + zero;
            may_be_cut[element] = low - reach <= 0.0 && high + reach >= 0.0;
            sides_[element] = low + high < 0.0 ? Side::kept : Side::removed;
        }
    });
    std::vector<Index> candidates;
    for (std::size_t element = 0; element < element_count; ++element)
        if (may_be_cut[element]) candidates.push_back(static_cast<Index>(element));

    constexpr std::size_t grain = 32;
    std::vector<Section> sections((candidates.size() + grain - 1) / grain);
    parallel_for(candidates.size(), grain, {}, {}, [&](std::size_t begin, std::size_t end) {
        ElementCutter cutter(plane.normal, offset, zero, options.chord_tolerance * diagonal, options);
        Section& section = sections[begin / grain];
        for (std::size_t i = begin; i < end; ++i) {
            const Index element = candidates[i];
            const ElementType type = topology.element_type(element);
            Eigen::MatrixX3d x = mesh.element_coordinates(element).rowwise() - origin_;
            if (options.element_size != 1.0) {
                const Eigen::RowVector3d center = x.topRows(corner_count(type.shape)).colwise().mean();
                x = (options.element_size * (x.rowwise() - center)).rowwise() + center;
            }
            sides_[static_cast<std::size_t>(element)] = cutter.cut(type, x, element, section);
        }
    });

    std::vector<FaceLine> lines;
    for (const Section& section : sections) {
        const auto first_point = static_cast<Index>(points_.size() / 3);
        const auto first_line_point = static_cast<Index>(line_points_.size() / 3);
        points_.insert(points_.end(), section.points.begin(), section.points.end());
        point_elements_.insert(point_elements_.end(), section.point_elements.begin(), section.point_elements.end());
        point_shapes_.insert(point_shapes_.end(), section.point_shapes.begin(), section.point_shapes.end());
        for (const Index point : section.triangles) triangles_.push_back(first_point + point);
        triangle_elements_.insert(triangle_elements_.end(), section.triangle_elements.begin(),
                                  section.triangle_elements.end());
        line_points_.insert(line_points_.end(), section.line_points.begin(), section.line_points.end());
        for (std::size_t line = 0; line < section.line_elements.size(); ++line) {
            const Index element = section.line_elements[line];
            FaceLine face{{-1, -1, -1, -1}, element, line_elements_.size()};
            const auto nodes = topology.element_nodes(element);
            const SubElement& facet = reference_element(topology.element_type(element))
                                          .facets[static_cast<std::size_t>(section.line_facets[line])];
            for (int corner = 0; corner < corner_count(facet.type.shape); ++corner)
                face.corners[static_cast<std::size_t>(corner)] =
                    nodes[static_cast<std::size_t>(facet.nodes[static_cast<std::size_t>(corner)])];
            std::sort(face.corners.begin(), face.corners.end());
            lines.push_back(face);
            line_offsets_.push_back(first_line_point + section.line_offsets[line + 1]);
            line_elements_.push_back(element);
        }
    }
    line_is_first_.assign(lines.size(), 1);
    if (options.element_size != 1.0) return;  // shrunk elements have all of their faces to themselves
    std::sort(lines.begin(), lines.end(), [](const FaceLine& a, const FaceLine& b) {
        return std::tie(a.corners, a.element, a.line) < std::tie(b.corners, b.element, b.line);
    });
    for (std::size_t i = 1, first = 0; i < lines.size(); ++i) {
        if (lines[i].corners != lines[first].corners) first = i;
        line_is_first_[lines[i].line] = lines[i].element == lines[first].element;
    }
}

std::vector<double> PlaneCut::evaluate(const std::vector<double>& values, int components) const {
    const auto width = static_cast<std::size_t>(std::max(components, 1));
    if (components < 1 || values.size() != static_cast<std::size_t>(topology_->node_count()) * width)
        throw InvalidInput(fmt::format("The mesh that is cut has {} nodes, but a field has {} values of {} components.",
                                       topology_->node_count(), values.size(), components));
    std::vector<double> result(point_elements_.size() * width, 0.0);
    const double* shape = point_shapes_.data();
    for (std::size_t point = 0; point < point_elements_.size(); ++point)
        for (const Index node : topology_->element_nodes(point_elements_[point])) {
            for (std::size_t c = 0; c < width; ++c)
                result[point * width + c] += *shape * values[static_cast<std::size_t>(node) * width + c];
            ++shape;
        }
    return result;
}

}  // namespace curvewright
