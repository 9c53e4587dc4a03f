#include "core/basis/node_ordering.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <stdexcept>

namespace curvewright {
namespace {

using Points = std::vector<LatticePoint>;

LatticePoint operator+(LatticePoint a, LatticePoint b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
LatticePoint operator-(LatticePoint a, LatticePoint b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
LatticePoint operator*(LatticePoint a, int factor) {
    return {a[0] * factor, a[1] * factor, a[2] * factor};
}
LatticePoint operator/(LatticePoint a, int divisor) {
    return {a[0] / divisor, a[1] / divisor, a[2] / divisor};
}

/// The interior points of the lattice line a -> b that has `order` steps.
void append_edge(Points& out, LatticePoint a, LatticePoint b, int order) {
    for (int k = 1; k < order; ++k) out.push_back(a + (b - a) * k / order);
}

/// Corners, edges, interior (recursively) of the lattice triangle a, b, c with `order` steps per side.
void append_triangle(Points& out, LatticePoint a, LatticePoint b, LatticePoint c, int order) {
    if (order < 0) return;
    if (order == 0) {
        out.push_back(a);
        return;
    }
    for (const auto& corner : {a, b, c}) out.push_back(corner);
    append_edge(out, a, b, order);
    append_edge(out, b, c, order);
    append_edge(out, c, a, order);
    const LatticePoint u = (b - a) / order, v = (c - a) / order;
    append_triangle(out, a + u + v, b - u * 2 + v, c + u - v * 2, order - 3);
}

/// The interior points of a triangular face.
void append_triangle_interior(Points& out, LatticePoint a, LatticePoint b, LatticePoint c, int order) {
    const LatticePoint u = (b - a) / order, v = (c - a) / order;
    append_triangle(out, a + u + v, b - u * 2 + v, c + u - v * 2, order - 3);
}

/// Gmsh's recursive quadrilateral: corners, edges, interior.
void append_quadrilateral_recursive(Points& out, LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d,
                                    int order) {
    if (order < 0) return;
    if (order == 0) {
        out.push_back(a);
        return;
    }
    for (const auto& corner : {a, b, c, d}) out.push_back(corner);
    append_edge(out, a, b, order);
    append_edge(out, b, c, order);
    append_edge(out, c, d, order);
    append_edge(out, d, a, order);
    const LatticePoint u = (b - a) / order, v = (d - a) / order;
    append_quadrilateral_recursive(out, a + u + v, b - u + v, c - u - v, d + u - v, order - 2);
}

void append_quadrilateral_interior_recursive(Points& out, LatticePoint a, LatticePoint b, LatticePoint c,
                                             LatticePoint d, int order) {
    const LatticePoint u = (b - a) / order, v = (d - a) / order;
    append_quadrilateral_recursive(out, a + u + v, b - u + v, c - u - v, d + u - v, order - 2);
}

/// VTK's interior of a quadrilateral face: rows along u, then v.
void append_grid_interior(Points& out, LatticePoint origin, LatticePoint u, LatticePoint v, int order) {
    for (int j = 1; j < order; ++j)
        for (int i = 1; i < order; ++i) out.push_back(origin + u * i + v * j);
}

void append_tetrahedron(Points& out, const std::array<LatticePoint, 4>& v, int order,
                        const std::vector<std::array<int, 2>>& edges, const std::vector<std::array<int, 3>>& faces) {
    if (order < 0) return;
    if (order == 0) {
        out.push_back(v[0]);
        return;
    }
    for (const auto& corner : v) out.push_back(corner);
    for (const auto& [a, b] : edges) append_edge(out, v[a], v[b], order);
    for (const auto& [a, b, c] : faces) append_triangle_interior(out, v[a], v[b], v[c], order);
    std::array<LatticePoint, 4> inner;
    for (int i = 0; i < 4; ++i) {
        inner[i] = v[i];
        for (int j = 0; j < 4; ++j)
            if (j != i) inner[i] = inner[i] + (v[j] - v[i]) / order;
    }
    append_tetrahedron(out, inner, order - 4, edges, faces);
}

Points vtk_hexahedron(int p) {
    const std::array<LatticePoint, 8> v = {
        {{0, 0, 0}, {p, 0, 0}, {p, p, 0}, {0, p, 0}, {0, 0, p}, {p, 0, p}, {p, p, p}, {0, p, p}}};
    Points out(v.begin(), v.end());
    for (const auto& [a, b] : std::vector<std::array<int, 2>>{
             {0, 1}, {1, 2}, {3, 2}, {0, 3}, {4, 5}, {5, 6}, {7, 6}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}})
        append_edge(out, v[a], v[b], p);
    const LatticePoint x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    append_grid_interior(out, {0, 0, 0}, y, z, p);
    append_grid_interior(out, {p, 0, 0}, y, z, p);
    append_grid_interior(out, {0, 0, 0}, x, z, p);
    append_grid_interior(out, {0, p, 0}, x, z, p);
    append_grid_interior(out, {0, 0, 0}, x, y, p);
    append_grid_interior(out, {0, 0, p}, x, y, p);
    for (int k = 1; k < p; ++k) append_grid_interior(out, {0, 0, k}, x, y, p);
    return out;
}

/// Interior of VTK's triangle in a prism: rows of constant j (not the recursion of a triangle cell).
void append_prism_triangle_interior(Points& out, int k, int p) {
    for (int j = 1; j < p; ++j)
        for (int i = 1; i + j < p; ++i) out.push_back({i, j, k});
}

Points vtk_prism(int p) {
    const std::array<LatticePoint, 6> v = {{{0, 0, 0}, {p, 0, 0}, {0, p, 0}, {0, 0, p}, {p, 0, p}, {0, p, p}}};
    Points out(v.begin(), v.end());
    for (const auto& [a, b] :
         std::vector<std::array<int, 2>>{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}})
        append_edge(out, v[a], v[b], p);
    append_prism_triangle_interior(out, 0, p);
    append_prism_triangle_interior(out, p, p);
    append_grid_interior(out, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, p);
    append_grid_interior(out, {p, 0, 0}, {-1, 1, 0}, {0, 0, 1}, p);
    append_grid_interior(out, {0, p, 0}, {0, -1, 0}, {0, 0, 1}, p);
    for (int k = 1; k < p; ++k) append_prism_triangle_interior(out, k, p);
    return out;
}

void append_gmsh_hexahedron(Points& out, LatticePoint origin, int p) {
    if (p < 0) return;
    if (p == 0) {
        out.push_back(origin);
        return;
    }
    std::array<LatticePoint, 8> v = {
        {{0, 0, 0}, {p, 0, 0}, {p, p, 0}, {0, p, 0}, {0, 0, p}, {p, 0, p}, {p, p, p}, {0, p, p}}};
    for (auto& corner : v) corner = corner + origin;
    out.insert(out.end(), v.begin(), v.end());
    for (const auto& [a, b] : std::vector<std::array<int, 2>>{
             {0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}})
        append_edge(out, v[a], v[b], p);
    for (const auto& [a, b, c, d] : std::vector<std::array<int, 4>>{
             {0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}})
        append_quadrilateral_interior_recursive(out, v[a], v[b], v[c], v[d], p);
    append_gmsh_hexahedron(out, origin + LatticePoint{1, 1, 1}, p - 2);
}

Points gmsh_prism(int p) {
    const std::array<LatticePoint, 6> v = {{{0, 0, 0}, {p, 0, 0}, {0, p, 0}, {0, 0, p}, {p, 0, p}, {0, p, p}}};
    Points out(v.begin(), v.end());
    for (const auto& [a, b] :
         std::vector<std::array<int, 2>>{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}})
        append_edge(out, v[a], v[b], p);
    append_triangle_interior(out, v[0], v[2], v[1], p);
    append_triangle_interior(out, v[3], v[4], v[5], p);
    for (const auto& [a, b, c, d] : std::vector<std::array<int, 4>>{{0, 1, 4, 3}, {0, 3, 5, 2}, {1, 2, 5, 4}})
        append_quadrilateral_interior_recursive(out, v[a], v[b], v[c], v[d], p);
    // Interior: the triangle lattice of order p - 3, repeated along the line lattice of order p - 2 (corners first).
    Points triangle;
    append_triangle(triangle, {1, 1, 0}, {p - 2, 1, 0}, {1, p - 2, 0}, p - 3);
    std::vector<int> levels;
    if (p >= 2) levels.push_back(1);
    if (p >= 3) levels.push_back(p - 1);
    for (int k = 2; k < p - 1; ++k) levels.push_back(k);
    for (const auto& point : triangle)
        for (int k : levels) out.push_back({point[0], point[1], k});
    return out;
}

void append_gmsh_pyramid(Points& out, LatticePoint origin, int p) {
    if (p < 0) return;
    if (p == 0) {
        out.push_back(origin);
        return;
    }
    std::array<LatticePoint, 5> v = {{{0, 0, 0}, {p, 0, 0}, {p, p, 0}, {0, p, 0}, {0, 0, p}}};
    for (auto& corner : v) corner = corner + origin;
    out.insert(out.end(), v.begin(), v.end());
    for (const auto& [a, b] :
         std::vector<std::array<int, 2>>{{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}})
        append_edge(out, v[a], v[b], p);
    for (const auto& [a, b, c] : std::vector<std::array<int, 3>>{{0, 1, 4}, {3, 0, 4}, {1, 2, 4}, {2, 3, 4}})
        append_triangle_interior(out, v[a], v[b], v[c], p);
    append_quadrilateral_interior_recursive(out, v[0], v[3], v[2], v[1], p);
    append_gmsh_pyramid(out, origin + LatticePoint{1, 1, 1}, p - 3);
}

}  // namespace

std::vector<LatticePoint> vtk_node_order(ElementType type) {
    const int p = type.order;
    Points out;
    switch (type.shape) {
        case Shape::quadrilateral: {
            const std::array<LatticePoint, 4> v = {{{0, 0, 0}, {p, 0, 0}, {p, p, 0}, {0, p, 0}}};
            out.assign(v.begin(), v.end());
            append_edge(out, v[0], v[1], p);
            append_edge(out, v[1], v[2], p);
            append_edge(out, v[3], v[2], p);
            append_edge(out, v[0], v[3], p);
            append_grid_interior(out, v[0], {1, 0, 0}, {0, 1, 0}, p);
            return out;
        }
        case Shape::tetrahedron:
            append_tetrahedron(out, {{{0, 0, 0}, {p, 0, 0}, {0, p, 0}, {0, 0, p}}}, p,
                               {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
                               {{0, 1, 3}, {2, 3, 1}, {0, 3, 2}, {0, 2, 1}});
            return out;
        case Shape::hexahedron:
            return vtk_hexahedron(p);
        case Shape::prism:
            return vtk_prism(p);
        default:
            return gmsh_node_order(type);  // vertex, line, triangle: the two agree
    }
}

std::vector<LatticePoint> gmsh_node_order(ElementType type) {
    const int p = type.order;
    Points out;
    switch (type.shape) {
        case Shape::vertex:
            return {{0, 0, 0}};
        case Shape::line:
            out = {{0, 0, 0}, {p, 0, 0}};
            append_edge(out, out[0], out[1], p);
            return out;
        case Shape::triangle:
            append_triangle(out, {0, 0, 0}, {p, 0, 0}, {0, p, 0}, p);
            return out;
        case Shape::quadrilateral:
            append_quadrilateral_recursive(out, {0, 0, 0}, {p, 0, 0}, {p, p, 0}, {0, p, 0}, p);
            return out;
        case Shape::tetrahedron:
            append_tetrahedron(out, {{{0, 0, 0}, {p, 0, 0}, {0, p, 0}, {0, 0, p}}}, p,
                               {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}},
                               {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {3, 1, 2}});
            return out;
        case Shape::hexahedron:
            append_gmsh_hexahedron(out, {0, 0, 0}, p);
            return out;
        case Shape::prism:
            return gmsh_prism(p);
        case Shape::pyramid:
            append_gmsh_pyramid(out, {0, 0, 0}, p);
            return out;
    }
    return out;
}

const std::vector<int>& gmsh_permutation(ElementType type) {
    static std::mutex mutex;
    static std::map<ElementType, std::vector<int>> cache;
    const std::lock_guard lock(mutex);
    auto [entry, is_new] = cache.try_emplace(type);
    if (is_new) {
        const auto ours = vtk_node_order(type);
        const auto gmsh = gmsh_node_order(type);
        for (const auto& point : ours) {
            const auto found = std::find(gmsh.begin(), gmsh.end(), point);
            if (found == gmsh.end()) throw std::logic_error("no Gmsh node for a lattice point of a " + name(type));
            entry->second.push_back(static_cast<int>(found - gmsh.begin()));
        }
    }
    return entry->second;
}

}  // namespace curvewright
