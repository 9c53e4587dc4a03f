#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// The plane normal · x = offset. What lies beyond it (normal · x > offset) is cut away.
struct CuttingPlane {
    Eigen::RowVector3d normal{1.0, 0.0, 0.0};  ///< unit
    double offset = 0.0;                       ///< in the mesh's unit of length

    double distance(const Eigen::RowVector3d& point) const { return normal.dot(point) - offset; }
};

/// How finely a section is drawn.
struct PlaneCutOptions {
    /// Largest distance between the section of a curved face and its chords, relative to the diagonal of the mesh's
    /// bounding box.
    double chord_tolerance = 2e-4;
    /// Bounds of the number of pieces per side of an element that is not an affine image of its reference element; the
    /// section of an affine one is exact with one piece.
    int min_subdivisions = 4, max_subdivisions = 12;
    /// Size of the elements about the mean of their corners, as in TessellationOptions.
    double element_size = 1.0;
};

/// The section of a solid mesh by a plane: the cut elements' insides as triangles in the plane, and the curves in which
/// their faces meet it. Every element is divided on its reference lattice into tetrahedra; where the plane crosses a
/// side of one of these, the point moves along that side (in the reference element) until its image lies on the plane.
/// So all points lie in the plane and in the curved element, and on shared faces neighbours agree up to the chords.
/// A node or a face in the plane counts as beyond it: the section there is the face of the element on this side.
/// Points are single precision, relative to origin().
class PlaneCut {
  public:
    enum class Side : std::uint8_t { kept, cut, removed };

    /// visible: one flag per element; empty = all. Any 3D shapes and orders; elements of other dimensions are not cut.
    /// Throws InvalidInput if the number of flags is wrong or the plane's normal is not a unit vector.
    PlaneCut(const CurvedMesh& mesh, const CuttingPlane& plane, const std::vector<bool>& visible = {},
             const PlaneCutOptions& options = {});

    const CuttingPlane& plane() const { return plane_; }
    /// Subtracted from all points: the centre of the mesh's bounding box.
    const Eigen::RowVector3d& origin() const { return origin_; }

    /// Per element: where it is. Elements that are not visible count as removed.
    const std::vector<Side>& sides() const { return sides_; }

    // The inside. Each element has points of its own; the triangles of an element stand together and turn
    // counter-clockwise seen from beyond the plane (where the element is not tangled).
    const std::vector<float>& points() const { return points_; }                        ///< 3 per point
    const std::vector<Index>& triangles() const { return triangles_; }                  ///< 3 per triangle: points
    const std::vector<Index>& triangle_elements() const { return triangle_elements_; }  ///< per triangle, ascending

    /// Values at the points, by the shape functions of their elements. values: nodes × components, row-major. Throws
    /// InvalidInput if there are not as many.
    std::vector<double> evaluate(const std::vector<double>& values, int components) const;

    // The curves of the faces, of every cut element.
    const std::vector<float>& line_points() const { return line_points_; }  ///< 3 per point
    /// Polyline k is the points line_offsets()[k] .. line_offsets()[k+1] - 1.
    const std::vector<Index>& line_offsets() const { return line_offsets_; }
    const std::vector<Index>& line_elements() const { return line_elements_; }  ///< per polyline, ascending
    /// Per polyline: 0 if it is the curve of a face that an element before has as well, else 1.
    const std::vector<std::uint8_t>& line_is_first() const { return line_is_first_; }

  private:
    std::shared_ptr<const MeshTopology> topology_;
    CuttingPlane plane_;
    Eigen::RowVector3d origin_ = Eigen::RowVector3d::Zero();
    std::vector<Side> sides_;
    std::vector<float> points_, line_points_;
    std::vector<Index> point_elements_;
    std::vector<double> point_shapes_;  ///< per point the shape functions of its element's nodes
    std::vector<Index> triangles_, triangle_elements_, line_offsets_{0}, line_elements_;
    std::vector<std::uint8_t> line_is_first_;
};

}  // namespace curvewright
