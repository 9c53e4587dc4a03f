#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "core/base/task.h"

namespace curvewright {

/// How an animation is written.
struct AnimationOptions {
    int width = 0, height = 0;       ///< pixels, 1 to AnimationFile::max_side
    double frames_per_second = 30.;  ///< at most AnimationFile::max_rate
    bool is_lossless = false;
    double quality = 90.;  ///< 0 (small) to 100 (fine); without effect if lossless
};

/// An animated WebP that is written frame by frame and runs in a loop: all browsers play it where they show pictures.
/// What is kept meanwhile is the compressed film and two frames. Appears complete or not at all.
class AnimationFile {
  public:
    static constexpr int max_side = 16383;
    /// Browsers slow down what is faster than about this.
    static constexpr double max_rate = 60.;

    /// Throws InvalidInput that names the file if it cannot be written to, Unsupported if the options are out of range.
    AnimationFile(const std::filesystem::path& file, const AnimationOptions& options);
    /// Without finish() nothing is left.
    ~AnimationFile();

    /// rgba: height × width × 4, rows from the top, colours not multiplied with alpha. Throws Unsupported, Cancelled.
    void add(std::span<const std::uint8_t> rgba, const TaskContext& context = {});
    int frames() const { return frames_; }
    /// Puts the file in place. pre: at least one frame. Returns its size in bytes. Throws InvalidInput, Cancelled.
    std::uintmax_t finish(const TaskContext& context = {});

    /// Whether a path is that of an animation, by its suffix.
    static bool is_animation(const std::filesystem::path& path);

  private:
    struct Encoder;
    std::unique_ptr<Encoder> encoder_;
    AnimationOptions options_;
    int frames_ = 0;
};

}  // namespace curvewright
