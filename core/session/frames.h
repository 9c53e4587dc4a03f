#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/deform/deformation.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"
#include "core/warp/warp.h"

namespace curvewright {

/// One picture of a film: the mesh somewhere on its way, certified there.
struct Frame {
    CurvedMesh mesh;
    std::optional<QualityReport> quality;  ///< none: its elements cannot be assessed
    std::string caption;                   ///< what happens, one line
    std::vector<Index> highlighted = {};   ///< elements that it happens to
};

/// The pictures of a film, made one after another on whatever thread asks for them. A motion between states is one; the
/// steps of an untangling can be another.
class FrameSource {
  public:
    virtual ~FrameSource() = default;
    virtual int count() const = 0;
    /// pre: 0 <= index < count(). Throws Cancelled and what computing the frame throws.
    virtual Frame make(int index, const TaskContext& context) = 0;
    /// What there is to say about the frames made so far, one sentence; "" = nothing.
    virtual std::string remark() const { return {}; }
};

/// A part of a motion, from one state to the next.
struct MotionLeg {
    std::string caption;
    Coordinates start, end;  ///< nodes × 3
    /// What moves the boundary, if the states between are to be true warps (or, without them, boundaries that move
    /// alone): the deformation in part, of the mesh as it was at `start`. None: every node goes straight.
    std::shared_ptr<const Deformation> deformation;
    /// How the interior follows a deformation. None: it stays.
    std::optional<WarpOptions> warp;
};

/// The way of a mesh through its states, each part of it in the same time. The first frame is the first state and the
/// last frame the last one, bit by bit.
class MotionFrames : public FrameSource {
  public:
    /// mesh: whose topology and order of numbering the frames have. orientation_sign: what J is judged with; none =
    /// that of the mesh. count: of frames, at least 2. pre: at least one leg, coordinates of the mesh's nodes.
    MotionFrames(CurvedMesh mesh, std::optional<OrientationSigns> orientation_sign, std::vector<MotionLeg> legs, int count);
    ~MotionFrames() override;

    int count() const override { return count_; }
    Frame make(int index, const TaskContext& context) override;
    std::string remark() const override;
    /// The same without the certificate.
    Coordinates positions(int index, const TaskContext& context);
    /// The legs whose deformation does not lead to their end, because its file has changed or because there was more to
    /// it than this: their nodes go straight. Known of those that frames were made of.
    const std::vector<std::string>& straightened() const { return straightened_; }
    /// A leg that is given without its deformation because that cannot be had any more.
    void add_straightened(const std::string& caption) { straightened_.push_back(caption); }

  private:
    struct Mover;

    Mover& mover_of(std::size_t leg, const TaskContext& context);

    CurvedMesh mesh_;
    std::optional<OrientationSigns> orientation_sign_;
    std::vector<MotionLeg> legs_;
    int count_ = 2;
    std::vector<std::string> straightened_;
    std::size_t moved_leg_ = 0;
    std::unique_ptr<Mover> mover_;  ///< of moved_leg_
};

/// Where a frame of a film that goes there and back without a stop is found on the way there. index: from 0 to
/// 2 (count - 1); the frame after the last one is the first one again.
int there_and_back(int index, int count);

}  // namespace curvewright
