#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <webp/demux.h>

namespace curvewright::testing {

/// An animated WebP as somebody else's program reads it. Not valid: no frames.
struct DecodedAnimation {
    int width = 0, height = 0;
    unsigned loops = 1;                             ///< 0 = for ever
    std::vector<std::vector<std::uint8_t>> frames;  ///< height × width × 4, rows from the top
    std::vector<int> ends;                          ///< of every frame, milliseconds from the start

    explicit DecodedAnimation(const std::string& bytes) {
        const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
        WebPAnimDecoderOptions options;
        WebPAnimDecoderOptionsInit(&options);
        options.color_mode = MODE_RGBA;
        WebPAnimDecoder* decoder = WebPAnimDecoderNew(&data, &options);
        WebPAnimInfo info;
        if (decoder && WebPAnimDecoderGetInfo(decoder, &info)) {
            width = static_cast<int>(info.canvas_width);
            height = static_cast<int>(info.canvas_height);
            loops = info.loop_count;
            std::uint8_t* pixels = nullptr;
            int end = 0;
            while (WebPAnimDecoderHasMoreFrames(decoder) && WebPAnimDecoderGetNext(decoder, &pixels, &end)) {
                frames.emplace_back(pixels, pixels + std::size_t(4) * info.canvas_width * info.canvas_height);
                ends.push_back(end);
            }
        }
        WebPAnimDecoderDelete(decoder);
    }

    std::array<int, 4> pixel(std::size_t frame, int x, int y) const {
        const std::uint8_t* at = &frames[frame][4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                                     static_cast<std::size_t>(x))];
        return {at[0], at[1], at[2], at[3]};
    }
    /// Mean difference of two pictures per byte.
    static double difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
        if (a.size() != b.size() || a.empty()) return 255.;
        double sum = 0.;
        for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] > b[i] ? a[i] - b[i] : b[i] - a[i];
        return sum / static_cast<double>(a.size());
    }
};

}  // namespace curvewright::testing
