#include "ui/scene/picture_pixels.h"

#include <algorithm>
#include <cstddef>

namespace curvewright {

PicturePixels average(const unsigned char* rgb, int width, int height, int factor) {
    PicturePixels picture{width / factor, height / factor, 3, {}};
    picture.bytes.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) * 3);
    unsigned char* to = picture.bytes.data();
    const int count = factor * factor;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            for (int c = 0; c < 3; ++c) {
                int sum = count / 2;
                for (int dy = 0; dy < factor; ++dy)
                    for (int dx = 0; dx < factor; ++dx)
                        sum += rgb[3 * (static_cast<std::size_t>(y * factor + dy) * static_cast<std::size_t>(width) +
                                        static_cast<std::size_t>(x * factor + dx)) +
                                   static_cast<std::size_t>(c)];
                *to++ = static_cast<unsigned char>(sum / count);
            }
    return picture;
}

PicturePixels without_ground(const unsigned char* on_black, const unsigned char* on_white, int width, int height,
                             int factor) {
    PicturePixels picture{width / factor, height / factor, 4, {}};
    picture.bytes.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) * 4);
    unsigned char* to = picture.bytes.data();
    const int count = factor * factor;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            int alpha = 0;  // 3 · 255 · count = opaque
            int color[3] = {0, 0, 0};
            for (int dy = 0; dy < factor; ++dy)
                for (int dx = 0; dx < factor; ++dx) {
                    const std::size_t at =
                        3 * (static_cast<std::size_t>(y * factor + dy) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x * factor + dx));
                    int ground = 0;
                    for (std::size_t c = 0; c < 3; ++c) {
                        ground += std::max(0, on_white[at + c] - on_black[at + c]);
                        color[c] += on_black[at + c];
                    }
                    alpha += 3 * 255 - ground;
                }
            // A colour on black is alpha times itself.
            for (const int sum : color)
                *to++ = static_cast<unsigned char>(alpha == 0 ? 0 : std::min(255, (3 * 255 * sum + alpha / 2) / alpha));
            *to++ = static_cast<unsigned char>((alpha + 3 * count / 2) / (3 * count));
        }
    return picture;
}

std::vector<unsigned char> rgba_from_top(const PicturePixels& picture) {
    const auto width = static_cast<std::size_t>(picture.width), height = static_cast<std::size_t>(picture.height),
               channels = static_cast<std::size_t>(picture.channels);
    std::vector<unsigned char> rgba(width * height * 4);
    for (std::size_t row = 0; row < height; ++row)
        for (std::size_t column = 0; column < width; ++column) {
            const unsigned char* from = &picture.bytes[((height - 1 - row) * width + column) * channels];
            unsigned char* to = &rgba[(row * width + column) * 4];
            for (std::size_t k = 0; k < 3; ++k) to[k] = from[k];
            to[3] = channels == 4 ? from[3] : 255;
        }
    return rgba;
}

}  // namespace curvewright
