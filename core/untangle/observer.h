#pragma once

#include <array>
#include <variant>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// Why an untangling ended.
enum class StopReason {
    converged,    ///< the nodes moved less than the tolerance in a pass
    pass_limit,   ///< max_passes were made
    no_progress,  ///< the last pass lowered the certified quality and was taken back
};
const char* to_string(StopReason reason);

/// The steps of an untangling, in the order in which they happen. Positions are (x, y) or (x, y, z) in mesh units.
namespace untangle_event {

struct Started {
    const CurvedMesh* mesh = nullptr;  ///< valid during the call
};
struct PassBegan {
    int pass = 0;  ///< from 1
};
/// One node (signed angles) is about to be optimised.
struct PatchBegan {
    Index node = 0;
    std::vector<Index> elements;
    std::array<double, 3> position{};
};
/// One iteration of the Nelder-Mead method.
struct SimplexStep {
    int iteration = 0;
    std::array<std::array<double, 2>, 3> simplex{};  ///< best vertex first
    std::array<double, 3> objective{};               ///< per vertex
    double displacement_term = 0.0;                  ///< (1 - beta) |x - x_I| at the best vertex
    double angle_term = 0.0;                         ///< beta sum exp(-10 alpha_i) at the best vertex
    std::array<double, 4> angles{};                  ///< signed, radians, at the best vertex
};
struct PatchEnded {
    Index node = 0;
    int iterations = 0;
    double objective_before = 0.0, objective_after = 0.0;
    std::array<double, 3> position{};
    double min_scaled_jacobian_before = 0.0, min_scaled_jacobian_after = 0.0;  ///< over the patch, certified
};
/// Face nodes were moved (signed angles, second pass).
struct FaceNodesMoved {
    std::vector<Index> nodes;
    std::vector<std::array<double, 3>> positions;
};
struct PassEnded {
    int pass = 0;
    double relative_change = 0.0;  ///< |X_k - X_{k-1}|_F / |X_k|_F
    double min_scaled_jacobian = 0.0;
    Index invalid = 0, undecided = 0;
    const Coordinates* coordinates = nullptr;  ///< valid during the call
};
struct Finished {
    StopReason reason = StopReason::converged;
    int passes = 0;
};

}  // namespace untangle_event

using UntangleEvent = std::variant<untangle_event::Started, untangle_event::PassBegan, untangle_event::PatchBegan,
                                   untangle_event::SimplexStep, untangle_event::PatchEnded,
                                   untangle_event::FaceNodesMoved, untangle_event::PassEnded, untangle_event::Finished>;

/// Is told of every step, on the thread that untangles. The method builds events only if an observer is there.
class UntangleObserver {
  public:
    virtual ~UntangleObserver() = default;
    virtual void on_event(const UntangleEvent& event) = 0;
};

}  // namespace curvewright
