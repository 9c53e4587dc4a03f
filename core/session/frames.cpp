#include "core/session/frames.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"

namespace curvewright {

/// Makes the states within one leg.
struct MotionFrames::Mover {
    CurvedMesh start;
    const MotionLeg& leg;
    std::unique_ptr<const Warper> warper;
    bool is_straight = true;

    Mover(const CurvedMesh& mesh, const MotionLeg& its_leg, const TaskContext& context)
        : start(mesh.with_coordinates(its_leg.start)), leg(its_leg) {
        if (!leg.deformation) return;
        if (leg.warp) {
            WarpOptions options = *leg.warp;
            options.prescribed_nodes = prescribed_interior_nodes(start, *leg.deformation);
            warper = std::make_unique<const Warper>(start, options, context);
        }
        is_straight = false;
        const auto box = bounding_box(start);
        const double size = (box.row(1) - box.row(0)).norm();
        is_straight = (at(1.0, context) - leg.end).cwiseAbs().maxCoeff() > 1e-8 * size;
    }

    Coordinates at(double fraction, const TaskContext& context) const {
        if (is_straight) return leg.start + fraction * (leg.end - leg.start);
        Coordinates boundary = apply_deformation(start, *leg.deformation, fraction);
        return warper ? warper->move(boundary, context).coordinates : boundary;
    }
};

MotionFrames::MotionFrames(CurvedMesh mesh, std::optional<OrientationSigns> orientation_sign, std::vector<MotionLeg> legs,
                           int count)
    : mesh_(std::move(mesh)), orientation_sign_(orientation_sign), legs_(std::move(legs)), count_(count) {
    if (count < 2)
        throw InvalidInput(fmt::format("A film of {} frames has no motion; at least 2 were expected.", count));
    if (legs_.empty()) throw InvalidInput("A film needs a motion; there is only one state.");
    for (const MotionLeg& leg : legs_)
        if (leg.start.rows() != mesh_.coordinates().rows() || leg.end.rows() != mesh_.coordinates().rows())
            throw InvalidInput("A state of the film has another number of nodes than the mesh.");
}

MotionFrames::~MotionFrames() = default;

MotionFrames::Mover& MotionFrames::mover_of(std::size_t leg, const TaskContext& context) {
    if (!mover_ || moved_leg_ != leg) {
        mover_.reset();
        try {
            mover_ = std::make_unique<Mover>(mesh_, legs_[leg], context);
        } catch (const Cancelled&) {
            throw;
        } catch (const Error&) {
            // A deformation that does not fit the mesh (any more).
            MotionLeg& its = legs_[leg];
            its.deformation.reset();
            mover_ = std::make_unique<Mover>(mesh_, its, context);
            straightened_.push_back(its.caption);
        }
        if (legs_[leg].deformation && mover_->is_straight) {
            legs_[leg].deformation.reset();
            straightened_.push_back(legs_[leg].caption);
        }
        moved_leg_ = leg;
    }
    return *mover_;
}

Coordinates MotionFrames::positions(int index, const TaskContext& context) {
    if (index <= 0) return legs_.front().start;
    if (index >= count_ - 1) return legs_.back().end;
    // Whole numbers decide which leg it is, so that states at the ends of legs are met exactly.
    const auto whole = static_cast<long long>(index) * static_cast<long long>(legs_.size());
    const auto leg = static_cast<std::size_t>(whole / (count_ - 1));
    const long long rest = whole % (count_ - 1);
    if (rest == 0) return legs_[leg].start;
    return mover_of(leg, context).at(static_cast<double>(rest) / (count_ - 1), context);
}

Frame MotionFrames::make(int index, const TaskContext& context) {
    Frame frame{mesh_.with_coordinates(positions(index, context)), {}, {}};
    const double way = static_cast<double>(index) * static_cast<double>(legs_.size()) / (count_ - 1);
    const auto leg = std::min(legs_.size() - 1, static_cast<std::size_t>(way));
    const int percent = static_cast<int>(std::lround(100.0 * (way - static_cast<double>(leg))));
    frame.caption = fmt::format("{}: {} %", legs_[leg].caption, percent);
    QualityOptions options;
    options.orientation_sign = orientation_sign_;
    try {
        frame.quality = assess_quality(frame.mesh, options, context);
    } catch (const Unsupported&) {
        // Drawn without.
    }
    return frame;
}

std::string MotionFrames::remark() const {
    if (straightened_.empty()) return {};
    return fmt::format(
        "In \"{}\"{} the nodes go straight from one state to the next: the deformation does not lead there.",
        straightened_.front(), straightened_.size() > 1 ? fmt::format(" and {} more", straightened_.size() - 1) : "");
}

int there_and_back(int index, int count) {
    return index < count ? index : 2 * (count - 1) - index;
}

}  // namespace curvewright
