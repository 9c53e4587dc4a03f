#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/timeline/recorder.h"
#include "core/untangle/untangle_options.h"
#include "tests/support/mesh_factory.h"

namespace curvewright::testing {

/// A short run of every method and of the variants that report other events.
struct Run {
    std::string name;
    CurvedMesh mesh;
    UntangleOptions options;
};

inline std::vector<Run> runs() {
    const CurvedMesh cubic = bulged_square_mesh(4, 3, 0.12), quartic = bulged_square_mesh(3, 4, 0.15);
    std::vector<Run> all;
    SignedAngleOptions given;
    given.max_passes = 3;
    all.push_back({"signed", cubic, given});
    SignedAngleOptions rejecting = given;
    rejecting.reject_worse_pass = true;
    rejecting.beta = 0.001;
    all.push_back({"signed, rejecting", cubic, rejecting});
    SignedAngleOptions automatic;
    automatic.beta_choice = BetaChoice::automatic;
    automatic.max_passes = 3;
    all.push_back({"signed, automatic", quartic, automatic});
    UnsignedAngleOptions unsigned_angles;
    unsigned_angles.max_passes = 3;
    all.push_back({"unsigned", cubic, unsigned_angles});
    all.push_back({"unsigned, literal", cubic, UnsignedAngleOptions::literal()});
    all.push_back({"guaranteed", cubic, GuaranteedOptions{}});
    std::mt19937 random(3);
    all.push_back({"guaranteed, solid", shaken(cube_mesh(2, 2), 0.09, random), GuaranteedOptions{}});
    return all;
}

inline Coordinates untangle(const Run& run, UntangleObserver* observer) {
    if (const auto* options = std::get_if<GuaranteedOptions>(&run.options))
        return untangle_guaranteed(run.mesh, *options, observer).coordinates;
    if (const auto* options = std::get_if<SignedAngleOptions>(&run.options))
        return untangle_signed_angles(run.mesh, *options, observer).coordinates;
    return untangle_unsigned_angles(run.mesh, std::get<UnsignedAngleOptions>(run.options), observer).coordinates;
}

inline std::shared_ptr<const Recording> record(const Run& run, std::size_t memory_limit = std::size_t{64} << 20) {
    Recorder recorder({memory_limit});
    untangle(run, &recorder);
    return recorder.finish();
}

}  // namespace curvewright::testing
