#pragma once

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/warp/equations.h"

namespace curvewright {

/// What the elastic body is made of.
struct ElasticMaterial {
    double poisson_ratio = 0.33;  ///< in (-1, 0.5)
    double stiffening = 0.0;      ///< Young's modulus of an element = (its volume / the largest)^-stiffening
};

/// Stiffness equations of linear elasticity (in 2D: plane strain) on the straight-sided elements that the corners of
/// the mesh span, with the Lagrange basis of the mesh's order; rows = free, columns = all numbers, blocks of the
/// dimension. They are symmetric positive definite in the free unknowns. Integrals are exact on simplices, and on
/// tensor-product elements with straight parallel sides. An element of negative volume counts with its absolute value.
/// Multi-threaded. Throws Unsupported for pyramids, InvalidInput for an element without volume (named) or a Poisson's
/// ratio out of range, Cancelled.
BlockMatrix elastic_equations(const CurvedMesh& mesh, const Numbering& numbering, const ElasticMaterial& material,
                              const TaskContext& context = {});

}  // namespace curvewright
