#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/orientation_signs.h"

namespace curvewright {

/// Measures of how elements are distorted against their ideal, sampled at points of the reference element:
/// T = J W^-1 with J the Jacobian of the element map and W that of the ideal element at the same point, D = det T.
///
/// Energy of an element: mean over its samples of
///     (1 - theta) |T|_F^2 / (dim chi(D)^(2/dim)) + theta (D^2 + 1) / (2 chi(D)),   chi(D) = (D + sqrt(eps^2 + D^2)) /
///     2
/// (Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov, "Foldover-free maps in 50 lines of code", ACM Trans. Graph.
/// 40, 2021). It is 1 for an element that is its ideal moved, and finite for tangled elements as long as eps > 0.
///
/// Evenness of an element: soft minimum over soft maximum of its det J, a smooth stand-in for min J / max J.
struct DistortionOptions {
    double theta = 0.1;
    double eps = 1e-3;           ///< of chi
    double sharpness = 0.0;      ///< of the soft minima; 0 = no term for the evenness
    double energy_weight = 1.0;  ///< of the sum of the elements' energies
    double least_weight = 1.0;   ///< of the least evenness (soft minimum over the elements), if sharpness > 0
    double mean_weight = 0.0;    ///< of the sum of the elements' evenness, if sharpness > 0
    /// Above 1: instead of the energies' sum, the logarithm of the mean of this power of what is averaged in them, over
    /// the power: a smooth stand-in for the logarithm of the largest. Not together with the evenness.
    double power = 1.0;
    double reference = 1.0;  ///< value that is divided by before taking the power, so that nothing overflows
};

/// A part of a mesh whose free nodes are moved while everything else stays.
struct FreePatch {
    std::vector<Index> elements;
    std::vector<Index> nodes;  ///< free, ascending; all elements of each are in the patch
};

/// Objective of a patch as a function of the positions of its free nodes. The variables are these positions in units of
/// the patch's size, relative to its centre, so that the result does not depend on the unit of length or the origin.
class PatchObjective {
  public:
    /// x: positions, nodes × 3; read for the patch's elements only. ideal: nodes × 3; the ideal of an element is the
    /// straight-sided element on its corners there (multilinear, if it is no simplex), or, where that does not have
    /// volume of the element's sign everywhere, a regular element of the patch's mean volume. Triangles, quadrilaterals,
    /// tetrahedra, hexahedra and prisms; throws Unsupported for others.
    PatchObjective(const MeshTopology& topology, const Coordinates& x, const Coordinates& ideal,
                   const OrientationSigns& signs, FreePatch patch);
    ~PatchObjective();
    PatchObjective(PatchObjective&&) noexcept;

    const FreePatch& patch() const;
    /// Origin and unit of the variables, in the mesh's unit of length.
    const Eigen::RowVector3d& center() const;
    double size() const;
    /// Positions of the free nodes in x as variables, and back. variables: (free nodes · dimension)
    Eigen::VectorXd variables(const Coordinates& x) const;
    void store(const Eigen::VectorXd& variables, Coordinates& x) const;

    /// Value and gradient. Multi-threaded, same result for every number of threads. Also updates least_determinant().
    double evaluate(const Eigen::VectorXd& variables, const DistortionOptions& options, Eigen::VectorXd& gradient);
    /// Least D over all samples at the last evaluation.
    double least_determinant() const;
    /// Adds a sample at a point (reference coordinates) of the patch's i-th element.
    void add_sample(std::size_t element, const std::array<double, 3>& point);

    class Implementation;

  private:
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace curvewright
