#include "core/io/animation_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"

namespace curvewright {
namespace {

/// A frame in the encoder's form.
struct Picture : WebPPicture {
    Picture() {
        if (!WebPPictureInit(this)) throw Unsupported("The library for WebP is of another version than its headers.");
        use_argb = 1;
    }
    ~Picture() { WebPPictureFree(this); }
    Picture(const Picture&) = delete;
    Picture& operator=(const Picture&) = delete;
};

[[noreturn]] void fail_to_write(const std::filesystem::path& file) {
    throw InvalidInput(
        file.string(), 0,
        fmt::format("the file cannot be written ({}).", errno == 0 ? "unknown reason" : std::strerror(errno)));
}

}  // namespace

struct AnimationFile::Encoder {
    explicit Encoder(const std::filesystem::path& path) : file(path), target(path) {}
    ~Encoder() { WebPAnimEncoderDelete(encoder); }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    std::filesystem::path file;
    AtomicFile target;
    WebPAnimEncoder* encoder = nullptr;
    WebPConfig config{};

    [[noreturn]] void fail() const {
        throw Unsupported(fmt::format("The film cannot be encoded as WebP ({}).", WebPAnimEncoderGetError(encoder)));
    }
};

AnimationFile::AnimationFile(const std::filesystem::path& file, const AnimationOptions& options) : options_(options) {
    if (options.width < 1 || options.height < 1 || options.width > max_side || options.height > max_side)
        throw Unsupported(fmt::format("A WebP of {}×{} pixels cannot be made; 1×1 to {}×{} can.", options.width,
                                      options.height, max_side, max_side));
    if (!(options.frames_per_second > 0. && options.frames_per_second <= max_rate))
        throw Unsupported(fmt::format("{} frames per second cannot be shown; more than 0 and at most {} can.",
                                      options.frames_per_second, max_rate));
    // What cannot be written is told before the work.
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw InvalidInput(file.string(), 0, "the file cannot be written (there is a folder of that name).");
    encoder_ = std::make_unique<Encoder>(file);
    errno = 0;
    if (!std::ofstream(encoder_->target.path(), std::ios::binary)) fail_to_write(file);

    WebPAnimEncoderOptions animation;
    WebPConfig& config = encoder_->config;
    bool is_good = WebPAnimEncoderOptionsInit(&animation) && WebPConfigInit(&config);
    if (options.is_lossless) {
        constexpr int effort = 3;  // of 0 to 9; more takes much longer and gains little
        is_good = is_good && WebPConfigLosslessPreset(&config, effort);
    } else {
        config.quality = static_cast<float>(std::clamp(options.quality, 0., 100.));
        config.use_sharp_yuv = 1;  // thin lines keep their colour
    }
    config.exact = 1;
    config.thread_level = 1;
    is_good = is_good && WebPValidateConfig(&config);
    if (is_good) encoder_->encoder = WebPAnimEncoderNew(options.width, options.height, &animation);
    if (!encoder_->encoder) throw Unsupported("The film cannot be encoded as WebP (the encoder does not start).");
}

AnimationFile::~AnimationFile() = default;

void AnimationFile::add(std::span<const std::uint8_t> rgba, const TaskContext& context) {
    context.check();
    const auto width = static_cast<std::size_t>(options_.width), height = static_cast<std::size_t>(options_.height);
    if (rgba.size() != width * height * 4)
        throw InvalidInput(
            fmt::format("A frame of {} bytes was given; {} were expected.", rgba.size(), width * height * 4));
    Picture picture;
    picture.width = options_.width;
    picture.height = options_.height;
    if (!WebPPictureImportRGBA(&picture, rgba.data(), options_.width * 4))
        throw Unsupported("The film cannot be encoded as WebP (there is not enough memory).");
    const auto time = static_cast<int>(std::lround(1000. * frames_ / options_.frames_per_second));
    if (!WebPAnimEncoderAdd(encoder_->encoder, &picture, time, &encoder_->config)) encoder_->fail();
    ++frames_;
}

std::uintmax_t AnimationFile::finish(const TaskContext& context) {
    context.check();
    const auto end = static_cast<int>(std::lround(1000. * frames_ / options_.frames_per_second));
    if (!WebPAnimEncoderAdd(encoder_->encoder, nullptr, end, nullptr)) encoder_->fail();
    WebPData data;
    WebPDataInit(&data);
    if (!WebPAnimEncoderAssemble(encoder_->encoder, &data)) encoder_->fail();
    errno = 0;
    std::ofstream stream(encoder_->target.path(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(data.bytes), static_cast<std::streamsize>(data.size));
    stream.close();
    const std::uintmax_t size = data.size;
    WebPDataClear(&data);
    if (!stream) fail_to_write(encoder_->file);
    context.check();
    encoder_->target.commit();
    return size;
}

bool AnimationFile::is_animation(const std::filesystem::path& path) {
    std::string suffix = path.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return suffix == ".webp";
}

}  // namespace curvewright
