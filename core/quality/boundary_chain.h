#pragma once

#include <array>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/facet_form.h"
#include "core/quality/facet_match.h"
#include "core/quality/orientation_signs.h"

namespace curvewright {

/// A facet of the boundary as geometry.
struct ChainFacet {
    Facet facet;
    const FacetForm* form = nullptr;
    int sense = 1;  ///< +1: the normal of d/du × d/dv (2D: to the right of d/du) points out of the element
    std::array<Index, 4> corners{-1, -1, -1, -1};  ///< per corner of the form: its point
    std::array<Index, 4> edges{-1, -1, -1, -1};    ///< 3D, per edge of the form: its curve
    std::array<bool, 4> runs_back{};               ///< per edge: against its curve
    std::size_t first_control = 0;
    double error = 0.0;  ///< of every coordinate of every control point
    Box box;
};

/// The boundary of a mesh as a geometric chain: what is left of the sum of its elements' boundaries when facets that
/// lie on each other with their elements on opposite sides (a closed slit, bodies in contact) have cancelled. Nodes of
/// the boundary that lie on each other up to rounding are one point, edges that do are one curve.
class BoundaryChain {
  public:
    /// signs: of J of valid elements.
    BoundaryChain(const CurvedMesh& mesh, const OrientationSigns& signs, const TaskContext& context);

    int dimension() const { return dimension_; }
    int size() const { return static_cast<int>(facets_.size()); }
    const ChainFacet& operator[](int facet) const { return facets_[static_cast<std::size_t>(facet)]; }
    const Eigen::Vector3d* control(int facet) const { return control_.data() + (*this)[facet].first_control; }
    /// Pairs of facets that lie on each other with their elements on the same side.
    const std::vector<std::array<Facet, 2>>& doubled() const { return doubled_; }
    /// Pairs of facets between the same points that do not lie on each other, of different order.
    const std::vector<std::array<Facet, 2>>& unmatched() const { return unmatched_; }
    /// Per facet the number of its component: joined are facets that are the only two at a point (2D) or a curve (3D).
    const std::vector<int>& components() const { return components_; }
    int component_count() const { return component_count_; }

  private:
    void find_points(const CurvedMesh& mesh);
    void gather(const CurvedMesh& mesh, const OrientationSigns& signs);
    void cancel(const CurvedMesh& mesh);
    void find_curves(const CurvedMesh& mesh);
    void convert(const CurvedMesh& mesh, const TaskContext& context);
    void find_components();
    /// The facet's points, in the order of its cell.
    std::vector<Index> points_of(const CurvedMesh& mesh, Facet facet) const;
    enum class Contact { none, coincident, unmatched };
    Contact compare(const CurvedMesh& mesh, const ChainFacet& a, const ChainFacet& b, int& sense) const;
    /// Whether nodes (points, in the order of cells of these types) describe the same curve or surface up to rounding.
    bool coincide(const CurvedMesh& mesh, ElementType type_a, const std::vector<Index>& a, ElementType type_b,
                  const std::vector<Index>& b, CornerMatch match) const;

    int dimension_ = 0;
    Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
    double tolerance_ = 0.0;
    std::vector<Index> point_;  ///< per node of the boundary the node that stands for its point; -1 elsewhere
    std::vector<ChainFacet> facets_;
    std::vector<Eigen::Vector3d> control_;
    std::vector<std::array<Facet, 2>> doubled_, unmatched_;
    std::vector<int> components_;
    int component_count_ = 0;
};

}  // namespace curvewright
