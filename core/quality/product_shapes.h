#pragma once

#include <array>
#include <memory>

#include <Eigen/Core>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// Worst mean ratios (see assess_shape) of quadrilaterals, hexahedra and prisms of one type. Each is the product of a
/// base (line, quadrilateral, triangle) and a line, and so are its samples: derivatives are computed along the base
/// for every layer of nodes, then along the line ("sum factorization": Orszag, "Spectral methods for problems in
/// complex geometries", J. Comput. Phys. 37, 1980). Not for several threads at once.
template <int Dim>
class ProductShapes {
  public:
    /// ideal: nodes × 3. The mesh and the ideal have to outlive this.
    ProductShapes(ElementType type, const MeshTopology& topology, const Coordinates& x, const Coordinates& ideal);
    ~ProductShapes();

    double worst(Index element);

  private:
    class Tangents;

    const MeshTopology& topology_;
    const Coordinates &x_, &ideal_;
    std::unique_ptr<Tangents> of_element_, of_ideal_;
    Eigen::ArrayXXd determinants_;  ///< of the ideal: samples of the base × samples of the line
};

extern template class ProductShapes<2>;
extern template class ProductShapes<3>;

}  // namespace curvewright
