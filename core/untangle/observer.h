#pragma once

#include <array>
#include <variant>
#include <vector>

#include "core/mesh/curved_mesh.h"

namespace curvewright {

/// Why an untangling ended.
enum class StopReason {
    converged,    ///< the nodes moved less than the tolerance in a pass, or nothing is gained any more
    untangled,    ///< every element is proved valid, which is all that the method is after
    pass_limit,   ///< max_passes were made
    no_progress,  ///< the last pass lowered the certified quality and was taken back
    cancelled,    ///< stopped by the user; the best state so far was kept
};
/// "converged", "untangled", "pass limit", "no progress", "cancelled".
const char* to_string(StopReason reason);

/// The steps of an untangling, in the order in which they happen. Positions are (x, y) or (x, y, z) in mesh units.
namespace untangle_event {

/// Coordinates in the mesh's unit; z is 0 or the plane's in 2D.
using Position = std::array<double, 3>;

/// An untangling begins.
struct Started {
    const CurvedMesh* mesh = nullptr;  ///< valid during the call
};
/// A pass over the mesh begins.
struct PassBegan {
    int pass = 0;  ///< from 1
};
/// Some nodes are about to be moved together: a node or the nodes of an edge and then the face nodes of its triangles
/// (angles), or a patch's free nodes.
struct PatchBegan {
    std::vector<Index> nodes, elements;
    std::vector<Position> positions;  ///< of the nodes
};
/// One iteration of the Nelder-Mead method (signed angles).
struct SimplexStep {
    Index node = 0;
    int iteration = 0;
    std::array<std::array<double, 2>, 3> simplex{};  ///< best vertex first
    std::array<double, 3> objective{};               ///< per vertex
    double displacement_term = 0.0;                  ///< (1 - beta) |x - x_I| at the best vertex
    double angle_term = 0.0;                         ///< beta sum exp(-10 alpha_i) at the best vertex
    std::array<double, 4> angles{};                  ///< signed, radians, at the best vertex
};
/// One iteration of the BFGS method (unsigned angles); iteration 0 is the start.
struct BfgsStep {
    int iteration = 0;
    std::vector<Position> positions;  ///< of the edge's nodes
    double objective = 0.0;           ///< sum of the angles
    double gradient_norm = 0.0;       ///< radians per unit of length
    double step = 0.0;                ///< fraction of the quasi-Newton step that was taken; 0 at the start
    std::array<double, 4> angles{};   ///< unsigned, radians
};
/// One iteration of the L-BFGS method (guaranteed).
struct EnergyStep {
    int round = 0;      ///< minimisations of this patch so far, from 1
    int iteration = 0;  ///< within the round, from 1
    double objective = 0.0;
    double eps = 0.0;                 ///< of the foldover energy
    double sharpness = 0.0;           ///< of the soft minima; 0 while elements are being made valid
    double least_determinant = 0.0;   ///< least D = det J W^-1 over the patch's samples
    std::vector<Position> positions;  ///< of the patch's free nodes
};
/// The elements of a patch were judged (guaranteed).
struct PatchCertified {
    int round = 0;
    Index not_valid = 0;                  ///< elements not proved valid
    double min_scaled_jacobian = 0.0;     ///< over the patch
    Index worst_element = 0;              ///< where it is attained
    std::array<double, 3> worst_point{};  ///< its reference coordinates
};
/// The nodes of the patch stay where they are now.
struct PatchEnded {
    std::vector<Index> nodes;
    std::vector<Position> positions;
    int iterations = 0;
    double beta = 0.0;  ///< the weight that was used (signed angles), else 0
    double objective_before = 0.0, objective_after = 0.0;
    double min_scaled_jacobian_before = 0.0, min_scaled_jacobian_after = 0.0;  ///< over the patch, certified
};
/// Face nodes were moved (signed angles, second pass).
struct FaceNodesMoved {
    std::vector<Index> nodes;
    std::vector<Position> positions;
};
/// Why nodes were put somewhere.
enum class Placement {
    straightened,  ///< within a patch: an edge begins straight instead of as it is
    put_back,      ///< to an earlier, better state, at the end of a pass
};
/// "straightened", "put back".
const char* to_string(Placement placement);
/// Nodes were put somewhere.
struct NodesPlaced {
    Placement placement = Placement::put_back;
    std::vector<Index> nodes;
    std::vector<Position> positions;
};
/// The state after a pass. A method that puts back an earlier, better state does so before the end of its last pass.
struct PassEnded {
    int pass = 0;
    double relative_change = 0.0;  ///< |X_k - X_{k-1}|_F / |X_k|_F
    double min_scaled_jacobian = 0.0;
    Index invalid = 0, undecided = 0;
    const Coordinates* coordinates = nullptr;  ///< valid during the call
};
/// An untangling has ended.
struct Finished {
    StopReason reason = StopReason::converged;
    int passes = 0;
};

}  // namespace untangle_event

/// One step of an untangling.
using UntangleEvent =
    std::variant<untangle_event::Started, untangle_event::PassBegan, untangle_event::PatchBegan,
                 untangle_event::SimplexStep, untangle_event::BfgsStep, untangle_event::EnergyStep,
                 untangle_event::PatchCertified, untangle_event::PatchEnded, untangle_event::FaceNodesMoved,
                 untangle_event::NodesPlaced, untangle_event::PassEnded, untangle_event::Finished>;

/// x: nodes × 3.
inline untangle_event::Position position_of(const Coordinates& x, Index node) {
    return {x(node, 0), x(node, 1), x(node, 2)};
}
/// The nodes whose positions differ, with those of `after`. For the methods.
untangle_event::NodesPlaced placed_nodes(untangle_event::Placement placement, const Coordinates& before,
                                         const Coordinates& after);

/// Is told of every step, on the thread that untangles. The method builds events only if an observer is there.
class UntangleObserver {
  public:
    virtual ~UntangleObserver() = default;
    virtual void on_event(const UntangleEvent& event) = 0;
};

/// What a method tells while it works on a mesh numbered alike, in the numbering of the mesh as it was given.
class GivenNumbering : public UntangleObserver {
  public:
    /// observer: may be null. Both must outlive this object.
    GivenNumbering(const CurvedMesh& given, UntangleObserver* observer) : given_(given), observer_(observer) {}
    void on_event(const UntangleEvent& event) override;
    /// Whom the method is to tell: the observer itself if nothing is reversed.
    UntangleObserver* listener() {
        return observer_ != nullptr && given_.topology().reversed_count() > 0 ? this : observer_;
    }

  private:
    const CurvedMesh& given_;
    UntangleObserver* observer_;
};

}  // namespace curvewright
