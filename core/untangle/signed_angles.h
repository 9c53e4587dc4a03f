#pragma once

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/untangle/observer.h"
#include "core/untangle/untangle_result.h"

namespace curvewright {

struct SignedAngleOptions {
    /// Weight of the angle term against the displacement term, in (0, 1]. Depends on the unit of length (thesis 4.1):
    /// stretched layers want small values.
    double beta = 0.5;
    int max_passes = 50;
    /// |X_k - X_{k-1}|_F / |X_k|_F at which the passes end (thesis, Alg. 6).
    double convergence = 1e-4;
    int simplex_iterations = 400;
    /// Nelder-Mead ends when the spread of the objective and the step are both below this.
    double simplex_tolerance = 1e-4;
    /// Size of the starting simplex, as a fraction of the length of the node's edge.
    double simplex_size = 0.05;
    /// Take back a pass that leaves more invalid elements, or a lower certified minimum, than the state before it, and
    /// stop there. Off = the thesis's method to the letter.
    bool reject_worse_pass = false;
};

/// Untangles curved triangles of order 2 and 3 by signed angles (thesis, chapter 4, Alg. 6): pass 1 moves every
/// high-order node of every interior edge, in mesh order, to the minimum of (4.1) by Nelder-Mead; pass 2 moves every
/// face node to the mean of its triangle's high-order edge nodes. Corners and boundary nodes stay bit for bit where
/// they are. Throws Unsupported for other elements or orders, InvalidInput for options out of range, Cancelled.
UntangleResult untangle_signed_angles(const CurvedMesh& mesh, const SignedAngleOptions& options = {},
                                      UntangleObserver* observer = nullptr, const TaskContext& context = {});

}  // namespace curvewright
