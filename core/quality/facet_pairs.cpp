#include "core/quality/facet_pairs.h"

#include <algorithm>

#include "core/quality/facet_crossing.h"

namespace curvewright {
namespace {

using Eigen::Vector3d;

/// Once two facets are found to touch, how many cuts may yet look for a place where they cross.
constexpr std::int64_t cuts_after_contact = 200;

/// Which edge of the facet a parameter lies on and how far along it from its corner a, if any.
bool lies_on(const FacetForm& form, const FacetForm::Edge& edge, const FacetParameter& at, std::int64_t& distance) {
    const FacetParameter a = corner_parameter(form, edge.a), b = corner_parameter(form, edge.b);
    for (int d = 0; d < 2; ++d) {
        if (a[d] == b[d]) continue;
        distance = a[d] < b[d] ? at[d] - a[d] : a[d] - at[d];
        const int other = 1 - d;
        if (a[other] == b[other]) return at[other] == a[other];
        return at[0] + at[1] == facet_parameter_one;  // the third edge of a triangle
    }
    return false;
}

}  // namespace

FacetPairTest::Place FacetPairTest::place_of(int index, int corner) const {
    const FacetPiece& piece = pieces_[index];
    const ChainFacet& facet = chain_[piece.facet];
    const FacetForm& form = *facet.form;
    const FacetParameter& at = piece.corners[static_cast<std::size_t>(corner)];
    for (int k = 0; k < form.corner_count(); ++k)
        if (at == corner_parameter(form, k)) return {0, facet.corners[static_cast<std::size_t>(k)], 0, 0};
    if (chain_.dimension() == 3)
        for (std::size_t k = 0; k < form.edges.size(); ++k) {
            std::int64_t distance = 0;
            if (!lies_on(form, form.edges[k], at, distance)) continue;
            return {1, facet.edges[k], facet.runs_back[k] ? facet_parameter_one - distance : distance, 0};
        }
    return {2, piece.facet, at[0], at[1]};
}

Index FacetPairTest::curve_of(int index, const FacetForm::Edge& edge) const {
    const FacetPiece& piece = pieces_[index];
    const ChainFacet& facet = chain_[piece.facet];
    std::int64_t distance = 0;
    for (std::size_t k = 0; k < facet.form->edges.size(); ++k)
        if (lies_on(*facet.form, facet.form->edges[k], piece.corners[edge.a], distance) &&
            lies_on(*facet.form, facet.form->edges[k], piece.corners[edge.b], distance))
            return facet.edges[k];
    return -1;
}

bool FacetPairTest::is_injective(int index) {
    const FacetPiece& piece = pieces_[index];
    const FacetForm& form = form_of(index);
    const auto step = [&](const std::array<int, 2>& c) -> Vector3d {
        return piece.control[c[0]] - piece.control[c[1]];
    };
    search_.clear();
    for (const auto& c : form.steps[0]) search_.add(step(c), 2 * piece.error);
    const std::size_t along_u = search_.size();
    for (const auto& c : form.steps[1]) search_.add(step(c), 2 * piece.error);
    if (!search_.exists()) return false;
    if (form.steps[1].empty()) return true;
    search_.shrink(along_u);
    for (const auto& c : form.steps[1]) search_.add_negated(step(c), 2 * piece.error);
    return search_.exists();
}

bool FacetPairTest::part_at_corner(int f, int corner_f, int g, int corner_g) {
    search_.clear();
    for (const auto& [index, corner, sign] : {std::tuple(f, corner_f, 1.0), std::tuple(g, corner_g, -1.0)}) {
        const FacetPiece& piece = pieces_[index];
        const int apex = form_of(index).corners[static_cast<std::size_t>(corner)];
        for (int k = 0; k < form_of(index).size; ++k)
            if (k != apex) search_.add(sign * (piece.control[k] - piece.control[apex]), 2 * piece.error);
    }
    return search_.exists();
}

bool FacetPairTest::part_at_edge(int f, const FacetForm::Edge& edge_f, int g, const FacetForm::Edge& edge_g) {
    search_.clear();
    const auto add_across = [&](int index, const FacetForm::Edge& edge, double sign) {
        const std::vector<Vector3d>& c = pieces_[index].control;
        for (const auto& [at, a, b] : edge.across)
            search_.add(sign * ((c[at] - c[a]) - 0.5 * (c[b] - c[a])), 2 * pieces_[index].error);
    };
    add_across(f, edge_f, 1.0);
    add_across(g, edge_g, -1.0);
    const std::size_t across = search_.size();
    for (const double sign : {1.0, -1.0}) {
        search_.shrink(across);
        for (std::size_t k = 1; k < edge_f.positions.size(); ++k)
            search_.add(sign * (pieces_[f].control[edge_f.positions[k]] - pieces_[f].control[edge_f.positions[k - 1]]),
                        2 * pieces_[f].error);
        if (!search_.exists()) return false;
    }
    return true;
}

bool FacetPairTest::are_apart(int f, int g) {
    const FacetPiece &piece_f = pieces_[f], &piece_g = pieces_[g];
    if (!piece_f.box.overlaps(piece_g.box)) return true;
    const FacetForm &form_f = form_of(f), &form_g = form_of(g);
    std::array<Place, 4> places;
    for (int b = 0; b < form_g.corner_count(); ++b) places[b] = place_of(g, b);
    std::array<std::array<int, 2>, 4> common{};
    int count = 0;
    for (int a = 0; a < form_f.corner_count(); ++a) {
        const Place own = place_of(f, a);
        for (int b = 0; b < form_g.corner_count() && count < 4; ++b)
            if (own == places[b]) common[count++] = {a, b};
    }
    if (count == 0) return are_separable(piece_f.control, piece_g.control, piece_f.error + piece_g.error);
    if (count == 1) return part_at_corner(f, common[0][0], g, common[0][1]);
    if (count != 2 || chain_.dimension() == 2) return false;
    const auto find_edge = [](const FacetForm& form, int a, int b) -> const FacetForm::Edge* {
        for (const FacetForm::Edge& edge : form.edges)
            if (edge.a == std::min(a, b) && edge.b == std::max(a, b)) return &edge;
        return nullptr;
    };
    const FacetForm::Edge* edge_f = find_edge(form_f, common[0][0], common[1][0]);
    const FacetForm::Edge* edge_g = find_edge(form_g, common[0][1], common[1][1]);
    if (edge_f == nullptr || edge_g == nullptr) return false;
    // Within one facet the edge is the image of the same segment; of two facets, it is a part of the same curve.
    if (piece_f.facet != piece_g.facet) {
        const Index curve = curve_of(f, *edge_f);
        if (curve < 0 || curve != curve_of(g, *edge_g)) return false;
    }
    return part_at_edge(f, *edge_f, g, *edge_g);
}

bool FacetPairTest::cross(int f, int g) const {
    if (chain_.dimension() == 2) return curves_cross(form_of(f), pieces_[f], form_of(g), pieces_[g]);
    return surfaces_cross(form_of(f), pieces_[f], form_of(g), pieces_[g]);
}

bool FacetPairTest::divide(int f, int g) {
    if (f == g) {
        if (!pieces_.is_divisible(form_of(f), f)) return false;
        const int half = pieces_.divide(form_of(f), f);
        stack_.emplace_back(half, half + 1);
        stack_.emplace_back(half + 1, half + 1);
        stack_.emplace_back(half, half);
        ++cuts_;
        return true;
    }
    const bool f_is_larger = pieces_[f].box.diagonal() >= pieces_[g].box.diagonal();
    for (const bool cuts_f : {f_is_larger, !f_is_larger}) {
        const int cut = cuts_f ? f : g;
        if (!pieces_.is_divisible(form_of(cut), cut)) continue;
        const int half = pieces_.divide(form_of(cut), cut);
        for (const int part : {half + 1, half}) stack_.push_back(cuts_f ? std::pair(part, g) : std::pair(f, part));
        ++cuts_;
        return true;
    }
    return false;
}

FacetRelation FacetPairTest::compare(int f, int g, std::int64_t most_cuts, const TaskContext& context) {
    pieces_.clear();
    stack_.clear();
    cuts_ = 0;
    const auto add = [&](int facet) {
        return pieces_.add(facet, *chain_[facet].form, chain_.control(facet), chain_[facet].error);
    };
    const int first = add(f), second = f == g ? first : add(g);
    stack_.emplace_back(first, second);
    bool touches = false;
    while (!stack_.empty()) {
        const auto [a, b] = stack_.back();
        stack_.pop_back();
        if (a == b ? is_injective(a) : are_apart(a, b)) continue;
        if (a != b && cross(a, b)) return FacetRelation::crossing;
        if (cuts_ >= most_cuts) return touches ? FacetRelation::touching : FacetRelation::undecided;
        if ((cuts_ & 255) == 255) context.check();
        if (divide(a, b)) continue;
        if (!touches) most_cuts = std::min(most_cuts, cuts_ + cuts_after_contact);
        touches = true;
    }
    return touches ? FacetRelation::touching : FacetRelation::apart;
}

}  // namespace curvewright
