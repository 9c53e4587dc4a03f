#include "core/quality/facet_match.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// A facet with its corners, in their order and sorted (unused places -1).
struct CornerFacet {
    std::array<Index, 4> sorted{-1, -1, -1, -1}, loop{-1, -1, -1, -1};
    Facet facet;
    int corners = 0;
};

/// The facets of all elements, grouped by their least corner.
std::vector<CornerFacet> facets_by_corner(const MeshTopology& topology) {
    std::vector<CornerFacet> facets;
    std::vector<std::size_t> first(static_cast<std::size_t>(topology.node_count()) + 1, 0);
    const ReferenceElement* cell = nullptr;
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto nodes = topology.element_nodes(element);
        const ElementType type = topology.element_type(element);
        if (cell == nullptr || cell->type != type) cell = &reference_element(type);
        const auto& own = cell->facets;
        for (std::size_t local = 0; local < own.size(); ++local) {
            CornerFacet& facet = facets.emplace_back();
            facet.facet = {element, static_cast<int>(local)};
            facet.corners = corner_count(own[local].type.shape);
            for (int i = 0; i < facet.corners; ++i) facet.loop[i] = nodes[own[local].nodes[i]];
            facet.sorted = facet.loop;
            std::sort(facet.sorted.begin(), facet.sorted.begin() + facet.corners);
            ++first[static_cast<std::size_t>(facet.sorted[0]) + 1];
        }
    }
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<CornerFacet> grouped(facets.size());
    for (const CornerFacet& facet : facets) grouped[first[static_cast<std::size_t>(facet.sorted[0])]++] = facet;
    for (auto begin = grouped.begin(); begin != grouped.end();) {
        auto end = begin;
        while (end != grouped.end() && end->sorted[0] == begin->sorted[0]) ++end;
        std::stable_sort(begin, end, [](const CornerFacet& a, const CornerFacet& b) { return a.sorted < b.sorted; });
        begin = end;
    }
    return grouped;
}

std::span<const Index> loop_of(const CornerFacet& facet) {
    return {facet.loop.data(), static_cast<std::size_t>(facet.corners)};
}

bool have_same_nodes(std::vector<Index> a, std::vector<Index> b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
}

}  // namespace

CornerMatch match_corners(std::span<const Index> a, std::span<const Index> b) {
    const int count = static_cast<int>(a.size());
    if (a.size() != b.size()) return {};
    for (int first = 0; first < count; ++first)
        for (const int sense : {1, -1}) {
            bool matches = true;
            for (int k = 0; k < count && matches; ++k)
                matches =
                    a[static_cast<std::size_t>(k)] == b[static_cast<std::size_t>((first + sense * k + count) % count)];
            if (matches) return {first, count == 2 && first == 1 ? -1 : sense};
        }
    return {};
}

const std::vector<int>& matched_nodes(ElementType type, CornerMatch match) {
    static std::mutex mutex;
    static std::map<std::tuple<ElementType, int, int>, std::vector<int>> cache;
    const std::lock_guard lock(mutex);
    std::vector<int>& nodes = cache[{type, match.first, match.sense}];
    if (!nodes.empty()) return nodes;
    const ReferenceElement& element = reference_element(type);
    const int count = corner_count(type.shape), p = type.order;
    // The map is affine: corner 0 and the corners next to it tell it.
    const auto place = [&](int k) { return element.lattice[(match.first + match.sense * k + 2 * count) % count]; };
    const LatticePoint origin = place(0), along_u = place(1), along_v = place(count - 1);
    for (const LatticePoint& own : element.lattice) {
        LatticePoint other{};
        for (int d = 0; d < 3; ++d)
            other[d] = origin[d] + own[0] * (along_u[d] - origin[d]) / p +
                       (count > 2 ? own[1] * (along_v[d] - origin[d]) / p : 0);
        nodes.push_back(element.find_node(other));
    }
    return nodes;
}

int outward_sense(ElementType type, int local) {
    const ReferenceElement& element = reference_element(type);
    const SubElement& facet = element.facets[static_cast<std::size_t>(local)];
    const auto point = [&](int node) {
        const LatticePoint& p = element.lattice[static_cast<std::size_t>(node)];
        return Eigen::Vector3d(p[0], p[1], p[2]);
    };
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    const int corners = corner_count(type.shape);
    for (int corner = 0; corner < corners; ++corner) center += point(corner) / corners;
    const Eigen::Vector3d origin = point(facet.nodes[0]), u = point(facet.nodes[1]) - origin;
    if (element.dimension == 2) return u.cross(center - origin).z() > 0.0 ? 1 : -1;
    const Eigen::Vector3d v = point(facet.nodes[corner_count(facet.type.shape) - 1]) - origin;
    return u.cross(v).dot(origin - center) > 0.0 ? 1 : -1;
}

namespace {

/// What facets of elements need again and again.
struct ElementFacets {
    const ReferenceElement* element = nullptr;
    std::vector<int> senses;
};

/// Facets that have the same corners: tells whether and why they are in conflict.
class ConflictFinder {
  public:
    ConflictFinder(const MeshTopology& topology, const std::vector<bool>& is_reversed)
        : topology_(topology), is_reversed_(is_reversed) {
        for (const ElementBlock& block : topology.blocks()) {
            if (block.size() == 0 || dimension(block.type.shape) != topology.dimension()) continue;
            ElementFacets& known = facets_[block.type];
            known.element = &reference_element(block.type);
            known.senses.clear();
            for (std::size_t local = 0; local < known.element->facets.size(); ++local)
                known.senses.push_back(outward_sense(block.type, static_cast<int>(local)));
        }
    }

    std::optional<FacetConflict> inspect(std::span<const CornerFacet> facets) {
        if (facets.size() < 2) return std::nullopt;
        const CornerFacet &a = facets[0], &b = facets[1];
        const SubElement &cell_a = cell(a.facet), &cell_b = cell(b.facet);
        const CornerMatch match = match_corners(loop_of(a), loop_of(b));
        if (facets.size() == 2 && match.sense != 0 && cell_a.type == cell_b.type && are_in_order(a, b, match)) {
            if (side(a.facet) != match.sense * side(b.facet)) return std::nullopt;
            return FacetConflict{FacetConflict::Kind::same_side, a.facet, b.facet};
        }
        // Facets with other nodes between their corners lie on the boundary, all of them: their geometry decides.
        const std::vector<Index> nodes = topology_.facet_nodes(a.facet);
        for (std::size_t k = 1; k < facets.size(); ++k)
            if (!have_same_nodes(nodes, topology_.facet_nodes(facets[k].facet))) return std::nullopt;
        const auto kind = facets.size() > 2 ? FacetConflict::Kind::shared_by_many : FacetConflict::Kind::other_order;
        return FacetConflict{kind, a.facet, b.facet};
    }

  private:
    const ElementFacets& of(Index element) {
        const ElementType type = topology_.element_type(element);
        if (last_ == nullptr || last_->element->type != type) last_ = &facets_.at(type);
        return *last_;
    }
    const SubElement& cell(Facet facet) { return of(facet.element).element->facets[facet.local]; }
    int side(Facet facet) {
        const int sense = of(facet.element).senses[facet.local];
        return !is_reversed_.empty() && is_reversed_[static_cast<std::size_t>(facet.element)] ? -sense : sense;
    }
    bool are_in_order(const CornerFacet& a, const CornerFacet& b, CornerMatch match) {
        const SubElement& cell_a = cell(a.facet);
        const std::vector<int>& nodes_b = cell(b.facet).nodes;
        if (cell_a.nodes.size() == static_cast<std::size_t>(a.corners)) return true;
        const auto of_a = topology_.element_nodes(a.facet.element), of_b = topology_.element_nodes(b.facet.element);
        const std::vector<int>& matched = matched_nodes(cell_a.type, match);
        for (std::size_t k = 0; k < matched.size(); ++k)
            if (of_a[cell_a.nodes[k]] != of_b[nodes_b[static_cast<std::size_t>(matched[k])]]) return false;
        return true;
    }

    const MeshTopology& topology_;
    const std::vector<bool>& is_reversed_;
    std::map<ElementType, ElementFacets> facets_;
    const ElementFacets* last_ = nullptr;
};

}  // namespace

std::vector<FacetConflict> find_facet_conflicts(const MeshTopology& topology, const std::vector<bool>& is_reversed) {
    std::vector<FacetConflict> conflicts;
    const std::vector<CornerFacet> facets = facets_by_corner(topology);
    ConflictFinder finder(topology, is_reversed);
    for (std::size_t i = 0; i < facets.size();) {
        std::size_t end = i + 1;
        while (end < facets.size() && facets[end].sorted == facets[i].sorted) ++end;
        if (const auto conflict = finder.inspect({&facets[i], end - i})) conflicts.push_back(*conflict);
        i = end;
    }
    std::sort(conflicts.begin(), conflicts.end(), [](const FacetConflict& a, const FacetConflict& b) {
        return std::pair(a.a.element, a.a.local) < std::pair(b.a.element, b.a.local);
    });
    return conflicts;
}

}  // namespace curvewright
