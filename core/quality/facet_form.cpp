#include "core/quality/facet_form.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <mutex>

#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
/// Lines are cut at this many sixteenths, not in their middle: curves that cross in the middle of both, as symmetric
/// ones do, would otherwise cross in common corners of their pieces at all depths, and no crossing of pieces would show
/// it.
constexpr int line_cut = 7;

void fill_line(FacetForm& form) {
    const int p = form.type.order;
    form.corners = {0, p};
    form.loop = {0, 1};
    FacetForm::Edge edge{0, 1, {}, {}};
    for (int i = 0; i <= p; ++i) edge.positions.push_back(i);
    form.edges.push_back(std::move(edge));
    for (int i = 0; i < p; ++i) form.steps[0].push_back({i + 1, i});
}

void fill_triangle(FacetForm& form) {
    const int p = form.type.order;
    const BernsteinSimplex& simplex = BernsteinSimplex::get(2, p);
    const BernsteinSimplex& lower = BernsteinSimplex::get(2, p - 1);
    const auto position = [&](std::array<int, 4> index, int raised) {
        ++index[raised];
        return simplex.position(index[1], index[2], 0);
    };
    form.corners = {simplex.corners()[0], simplex.corners()[1], simplex.corners()[2]};
    form.loop = {0, 1, 2};
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
        const int other = 3 - a - b;
        FacetForm::Edge edge{a, b, {}, {}};
        for (int i = 0; i <= p; ++i) {
            std::array<int, 4> index{};
            index[a] = p - i;
            index[b] = i;
            edge.positions.push_back(simplex.position(index[1], index[2], 0));
        }
        for (const auto& index : lower.indices())
            edge.across.push_back({position(index, other), position(index, a), position(index, b)});
        form.edges.push_back(std::move(edge));
    }
    for (const auto& index : lower.indices())
        for (int d = 0; d < 2; ++d) form.steps[d].push_back({position(index, d + 1), position(index, 0)});
}

void fill_quadrilateral(FacetForm& form) {
    const int p = form.type.order, side = p + 1;
    const auto at = [side](int u, int v) { return u * side + v; };
    form.corners = {at(0, 0), at(0, p), at(p, 0), at(p, p)};
    form.loop = {0, 2, 3, 1};
    const auto add = [&](int a, int b, bool along_u, int fixed) {
        FacetForm::Edge edge{a, b, {}, {}};
        for (int i = 0; i <= p; ++i) {
            const int on = along_u ? at(i, fixed) : at(fixed, i);
            edge.positions.push_back(on);
            for (int j = 0; j <= p; ++j)
                if (j != fixed) edge.across.push_back({along_u ? at(i, j) : at(j, i), on, on});
        }
        form.edges.push_back(std::move(edge));
    };
    add(0, 2, true, 0);
    add(1, 3, true, p);
    add(0, 1, false, 0);
    add(2, 3, false, p);
    for (int i = 0; i < p; ++i)
        for (int j = 0; j <= p; ++j) {
            form.steps[0].push_back({at(i + 1, j), at(i, j)});
            form.steps[1].push_back({at(j, i + 1), at(j, i)});
        }
}

/// De Casteljau's algorithm at the place where lines are cut.
void cut_line(int p, const Eigen::Vector3d* whole, Eigen::Vector3d* near_a, Eigen::Vector3d* near_b) {
    constexpr double t = line_cut / 16.0;
    std::copy_n(whole, p + 1, near_b);
    near_a[0] = whole[0];
    for (int round = 1; round <= p; ++round) {
        for (int i = 0; i <= p - round; ++i) near_b[i] = (1 - t) * near_b[i] + t * near_b[i + 1];
        near_a[round] = near_b[0];
    }
}

ExtendedMatrix conversion(ElementType type) {
    if (type.shape != Shape::quadrilateral) return lagrange_to_bernstein(type);
    const ElementType line{Shape::line, type.order};
    const ExtendedMatrix& along = lagrange_to_bernstein(line);
    const ReferenceElement& one = reference_element(line);
    const auto& lattice = reference_element(type).lattice;
    const Eigen::Index side = along.rows();
    ExtendedMatrix matrix(side * side, side * side);
    for (std::size_t node = 0; node < lattice.size(); ++node) {
        const int u = one.find_node({lattice[node][0], 0, 0}), v = one.find_node({lattice[node][1], 0, 0});
        for (Eigen::Index i = 0; i < side; ++i)
            for (Eigen::Index j = 0; j < side; ++j)
                matrix(i * side + j, static_cast<Eigen::Index>(node)) = along(i, u) * along(j, v);
    }
    return matrix;
}

}  // namespace

const FacetForm& FacetForm::get(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, std::unique_ptr<const FacetForm>> cache;
    const std::lock_guard lock(mutex);
    auto& entry = cache[type];
    if (entry) return *entry;
    auto form = std::make_unique<FacetForm>();
    form->type = type;
    form->size = node_count(type);
    if (type.shape == Shape::line) fill_line(*form);
    if (type.shape == Shape::triangle) fill_triangle(*form);
    if (type.shape == Shape::quadrilateral) fill_quadrilateral(*form);
    form->to_bernstein = conversion(type);
    // Sums of up to 121 products in extended precision; the matrix is exact to two roundings.
    const auto row_sum = static_cast<double>(form->to_bernstein.cwiseAbs().rowwise().sum().maxCoeff());
    form->conversion_error =
        (form->size + 4) * static_cast<double>(std::numeric_limits<long double>::epsilon()) * row_sum;
    entry = std::move(form);
    return *entry;
}

void FacetForm::bisect(const Edge& edge, const Eigen::Vector3d* whole, Eigen::Vector3d* near_a,
                       Eigen::Vector3d* near_b) const {
    const double* in = whole->data();
    double *out_a = near_a->data(), *out_b = near_b->data();
    const int p = type.order;
    if (type.shape == Shape::line) return cut_line(p, whole, near_a, near_b);
    if (type.shape == Shape::triangle) return BernsteinSimplex::get(2, p).bisect(edge.a, edge.b, 3, in, out_a, out_b);
    const BernsteinSimplex& along = BernsteinSimplex::get(1, p);
    if (edge.b - edge.a == 2) return along.bisect(0, 1, 3 * (p + 1), in, out_a, out_b);
    for (int row = 0; row <= p; ++row) {
        const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(3) * row * (p + 1);
        along.bisect(0, 1, 3, in + first, out_a + first, out_b + first);
    }
}

FacetParameter corner_parameter(const FacetForm& form, int corner) {
    if (form.type.shape == Shape::quadrilateral)
        return {corner / 2 * facet_parameter_one, corner % 2 * facet_parameter_one};
    return {corner == 1 ? facet_parameter_one : 0, corner == 2 ? facet_parameter_one : 0};
}

void FacetPiece::find_box() {
    box.low = box.high = control.front();
    for (const Eigen::Vector3d& point : control) {
        box.low = box.low.cwiseMin(point);
        box.high = box.high.cwiseMax(point);
    }
    box.low.array() -= error;
    box.high.array() += error;
}

int FacetPieces::take() {
    if (used_ == static_cast<int>(pieces_.size())) pieces_.emplace_back();
    pieces_[static_cast<std::size_t>(used_)].first_child = -1;
    return used_++;
}

int FacetPieces::add(int facet, const FacetForm& form, const Eigen::Vector3d* control, double error) {
    const int index = take();
    FacetPiece& piece = pieces_[static_cast<std::size_t>(index)];
    piece.facet = facet;
    piece.error = error;
    piece.control.assign(control, control + form.size);
    for (int corner = 0; corner < form.corner_count(); ++corner) piece.corners[corner] = corner_parameter(form, corner);
    piece.find_box();
    return index;
}

const FacetForm::Edge& FacetPieces::longest_edge(const FacetForm& form, const FacetPiece& piece) {
    const FacetForm::Edge* found = form.edges.data();
    double longest = -1.0;
    for (const FacetForm::Edge& edge : form.edges) {
        double length = 0.0;
        for (std::size_t i = 1; i < edge.positions.size(); ++i)
            length += (piece.control[edge.positions[i]] - piece.control[edge.positions[i - 1]]).norm();
        if (length > longest * (1 + 1e-9)) {
            longest = length;
            found = &edge;
        }
    }
    return *found;
}

bool FacetPieces::is_divisible(const FacetForm& form, int index) const {
    const FacetPiece& piece = (*this)[index];
    if (!(piece.box.diagonal() > 128 * piece.error)) return false;
    const FacetForm::Edge& edge = longest_edge(form, piece);
    if (form.type.shape == Shape::line) return piece.corners[1][0] - piece.corners[0][0] >= 16;
    for (int d = 0; d < 2; ++d)
        if ((piece.corners[edge.a][d] + piece.corners[edge.b][d]) % 2 != 0) return false;
    return true;
}

int FacetPieces::divide(const FacetForm& form, int index) {
    if ((*this)[index].first_child >= 0) return (*this)[index].first_child;
    const int first = take(), second = take();
    FacetPiece& whole = pieces_[static_cast<std::size_t>(index)];
    FacetPiece &near_a = pieces_[static_cast<std::size_t>(first)], &near_b = pieces_[static_cast<std::size_t>(second)];
    whole.first_child = first;
    const FacetForm::Edge& edge = longest_edge(form, whole);
    for (FacetPiece* half : {&near_a, &near_b}) {
        half->facet = whole.facet;
        half->corners = whole.corners;
        half->control.resize(static_cast<std::size_t>(form.size));
    }
    const auto cut = [&](int a, int b) {
        FacetParameter middle{};
        for (int d = 0; d < 2; ++d) middle[d] = (whole.corners[a][d] + whole.corners[b][d]) / 2;
        if (form.type.shape == Shape::line)
            middle[0] = whole.corners[a][0] + line_cut * (whole.corners[b][0] - whole.corners[a][0]) / 16;
        near_a.corners[b] = near_b.corners[a] = middle;
    };
    cut(edge.a, edge.b);
    if (form.type.shape == Shape::quadrilateral) {
        const FacetForm::Edge& opposite = form.edges[static_cast<std::size_t>(&edge - form.edges.data()) ^ 1U];
        cut(opposite.a, opposite.b);
    }
    form.bisect(edge, whole.control.data(), near_a.control.data(), near_b.control.data());
    // Every round of de Casteljau's algorithm adds at most half an ulp of the largest coordinate, or three.
    const double largest = std::max(whole.box.low.cwiseAbs().maxCoeff(), whole.box.high.cwiseAbs().maxCoeff());
    near_a.error = near_b.error = whole.error + 4 * form.type.order * unit_roundoff * largest;
    near_a.find_box();
    near_b.find_box();
    return first;
}

}  // namespace curvewright
