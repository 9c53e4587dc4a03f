#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// How finely curved elements are drawn.
struct TessellationOptions {
    /// Largest distance between a curved side and its chords, relative to the diagonal of the mesh's bounding box.
    double chord_tolerance = 2e-4;
    /// Bounds of the number of chords per side of a curved element; straight elements always get 1.
    int min_subdivisions = 4, max_subdivisions = 24;
    /// At least so many pieces per side of faces above order 1 (and of bilinear ones), straight or not: more than 1
    /// where a field on them is to be seen.
    int field_subdivisions = 1;
    /// Size of the elements about the mean of their corners: below 1 there are gaps between them, and in 3D all of
    /// their faces are drawn.
    double element_size = 1.0;
};

/// Straight pieces that draw a curved mesh: its surface as triangles and its element edges as polylines. In 2D the
/// surface is every element, in 3D the faces that only one of the visible elements has. The connectivity is made once;
/// move() follows new coordinates. Points are single precision, relative to origin().
class Tessellation {
  public:
    /// visible: one flag per element; empty = all. Any shapes and orders; cells below the mesh's dimension are not
    /// drawn.
    explicit Tessellation(const CurvedMesh& mesh, const std::vector<bool>& visible = {},
                          const TessellationOptions& options = {});

    /// Recomputes all points for the same mesh with other coordinates. Throws InvalidInput if their number differs.
    void move(const Coordinates& coordinates);
    /// Whether move() to these coordinates keeps the chord tolerance (no piece would have to be cut finer) and the
    /// precision of the points (the mesh stays near the origin). If not, make a new tessellation.
    bool is_fine_enough(const Coordinates& coordinates) const { return is_fine_enough(coordinates, 0, 1); }
    /// The same for one of several parts of the pieces, part in [0, parts): for callers who spread the question over
    /// several frames.
    bool is_fine_enough(const Coordinates& coordinates, int part, int parts) const;

    /// Subtracted from all points: the centre of the bounding box at construction.
    const Eigen::RowVector3d& origin() const { return origin_; }

    // Surface. Each face has points of its own, so that its colour and normals are its own.
    const std::vector<float>& surface_points() const { return surface_points_; }  ///< 3 per point: x, y, z
    const std::vector<float>& surface_normals() const {
        return surface_normals_;
    }                                                                   ///< 3 per point, unit, outward in 3D
    const std::vector<Index>& triangles() const { return triangles_; }  ///< 3 per triangle: points
    const std::vector<Index>& triangle_elements() const { return triangle_elements_; }  ///< per triangle: its element

    /// A field at the surface points, by the shape functions of the face that each is on. values: nodes of the mesh ×
    /// components, row-major; returns points × components. A face with a node whose value is NaN is NaN all over.
    /// Throws InvalidInput if the numbers do not fit.
    std::vector<double> evaluate(const std::vector<double>& values, int components) const;

    // Edges: every edge of the surface once.
    const std::vector<float>& edge_points() const { return edge_points_; }  ///< 3 per point
    /// Polyline k is the points line_offsets()[k] .. line_offsets()[k+1] - 1.
    const std::vector<Index>& line_offsets() const { return line_offsets_; }
    /// Per polyline: an element that has it.
    const std::vector<Index>& line_elements() const { return line_elements_; }
    /// Per polyline: 1 if it lies on one drawn 2D element only (2D: on the mesh's boundary), else 0.
    const std::vector<std::uint8_t>& line_is_boundary() const { return line_is_boundary_; }
    /// Per polyline: 1 if it is an edge of an interface inside the domain (see MeshTopology::interface_facets), else 0.
    const std::vector<std::uint8_t>& line_is_interface() const { return line_is_interface_; }
    /// Per polyline: 1 where the drawn part of a solid's own surface ends, that is where one face that no other element
    /// of the mesh has meets faces inside it, else 0.
    const std::vector<std::uint8_t>& line_is_rim() const { return line_is_rim_; }

    /// Nodes of the drawn faces, ascending.
    const std::vector<Index>& nodes() const { return nodes_; }

  private:
    struct Patch {
        Index element = 0;
        ElementType type;  ///< of the face or edge
        int subdivisions = 1;
        Index first_node = 0;   ///< in patch_nodes_
        Index first_point = 0;  ///< in the points of its kind
    };

    /// face_is_outer: per face, whether it is on the mesh's own surface; empty: all of them.
    void find_edges(const std::vector<bool>& face_is_outer, const MeshTopology& topology);
    void choose_subdivisions(std::vector<Patch>& patches, const Coordinates& coordinates) const;
    int wanted_subdivisions(const Patch& patch, const Coordinates& coordinates,
                            const std::vector<Patch>& patches) const;
    void lay_out();
    /// nodes × 3 count: positions of the nodes of `count` patches of one type, relative to the origin, side by side.
    bool is_shrunk() const { return options_.element_size < 1.0; }
    Eigen::MatrixXd gather(const std::vector<Patch>& patches, std::size_t first, std::size_t count,
                           const Coordinates& coordinates) const;
    void move_patches(const std::vector<Patch>& patches, const Coordinates& coordinates, std::vector<float>& points,
                      std::vector<float>* normals) const;

    TessellationOptions options_;
    Index node_count_ = 0;
    std::shared_ptr<const MeshTopology> topology_;  ///< of shrunk elements only
    bool is_solid_ = false;
    Eigen::RowVector3d origin_ = Eigen::RowVector3d::Zero();
    double diagonal_ = 0.0;  ///< of the bounding box at construction
    std::vector<Index> patch_nodes_;
    std::vector<Patch> faces_, edges_;
    std::vector<float> surface_points_, surface_normals_, edge_points_;
    std::vector<Index> triangles_, triangle_elements_, line_offsets_, line_elements_, nodes_;
    std::vector<std::uint8_t> line_is_boundary_, line_is_rim_, line_is_interface_;
};

}  // namespace curvewright
