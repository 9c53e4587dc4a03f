#include "ui/scene/indexed_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <span>
#include <unordered_map>

#include <zlib.h>

namespace curvewright {
namespace {

struct Shade {
    std::array<unsigned char, 3> color{};
    std::uint32_t count = 0;
};

std::uint32_t key_of(const unsigned char* rgb) {
    return static_cast<std::uint32_t>(rgb[0]) << 16 | static_cast<std::uint32_t>(rgb[1]) << 8 | rgb[2];
}

/// Colours that will become one.
struct Box {
    std::size_t begin = 0, end = 0;  ///< of the shades
    std::size_t widest = 0;          ///< channel
    double cost = 0.0;               ///< of making them one
};

Box measured(const std::vector<Shade>& shades, std::size_t begin, std::size_t end) {
    Box box{begin, end};
    double count = 0.0;
    std::array<double, 3> sum{}, squares{};
    for (std::size_t i = begin; i < end; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = shades[i].color[c], weight = shades[i].count;
            sum[c] += weight * value;
            squares[c] += weight * value * value;
            if (c == 0) count += weight;
        }
    double worst = -1.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double spread = squares[c] - sum[c] * sum[c] / count;
        box.cost += spread;
        if (spread > worst) {
            worst = spread;
            box.widest = c;
        }
    }
    if (end - begin < 2) box.cost = 0.0;
    return box;
}

/// Where the shades of a box, sorted along its widest channel, are parted: at their mean, so that a colour of a large
/// area does not take all of its half for itself.
std::size_t parting(std::vector<Shade>& shades, const Box& box) {
    const auto first = shades.begin() + static_cast<std::ptrdiff_t>(box.begin),
               last = shades.begin() + static_cast<std::ptrdiff_t>(box.end);
    const std::size_t c = box.widest;
    std::sort(first, last, [c](const Shade& a, const Shade& b) {
        return a.color[c] != b.color[c] ? a.color[c] < b.color[c] : a.color < b.color;
    });
    double sum = 0.0, count = 0.0;
    for (auto shade = first; shade != last; ++shade) {
        sum += static_cast<double>(shade->count) * shade->color[c];
        count += shade->count;
    }
    const auto middle =
        std::find_if(first, last, [c, mean = sum / count](const Shade& shade) { return shade.color[c] > mean; });
    const auto at = static_cast<std::size_t>(middle - shades.begin());
    return std::clamp(at, box.begin + 1, box.end - 1);
}

/// The mean, or what most of it is already.
std::array<unsigned char, 3> color_of(std::span<const Shade> shades) {
    const auto most = std::max_element(shades.begin(), shades.end(),
                                       [](const Shade& a, const Shade& b) { return a.count < b.count; });
    double count = 0.0;
    std::array<double, 3> sum{};
    for (const Shade& shade : shades) {
        count += shade.count;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(shade.count) * shade.color[c];
    }
    if (most->count > 0.5 * count) return most->color;
    std::array<unsigned char, 3> mean{};
    for (std::size_t c = 0; c < 3; ++c) mean[c] = static_cast<unsigned char>(std::lround(sum[c] / count));
    return mean;
}

void add_number(std::string& bytes, std::uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xFFu);
}

void add_chunk(std::string& png, const char* type, const std::string& content) {
    add_number(png, static_cast<std::uint32_t>(content.size()));
    const std::string named = type + content;
    png += named;
    add_number(png, static_cast<std::uint32_t>(
                        crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()))));
}

}  // namespace

IndexedPicture reduce_colors(const PicturePixels& picture, int colors) {
    std::unordered_map<std::uint32_t, std::uint32_t> counts;
    for (std::size_t i = 0; i + 2 < picture.bytes.size(); i += 3) ++counts[key_of(&picture.bytes[i])];
    std::vector<Shade> shades;
    shades.reserve(counts.size());
    for (const auto& [key, count] : counts)
        shades.push_back({{static_cast<unsigned char>(key >> 16), static_cast<unsigned char>(key >> 8 & 0xFFu),
                           static_cast<unsigned char>(key & 0xFFu)},
                          count});
    std::sort(shades.begin(), shades.end(), [](const Shade& a, const Shade& b) { return a.color < b.color; });

    std::vector<Box> boxes{measured(shades, 0, shades.size())};
    while (boxes.size() < static_cast<std::size_t>(colors)) {
        const auto worst =
            std::max_element(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.cost < b.cost; });
        if (worst->cost <= 0.0) break;
        const Box box = *worst;
        const std::size_t at = parting(shades, box);
        *worst = measured(shades, box.begin, at);
        boxes.push_back(measured(shades, at, box.end));
    }

    IndexedPicture result{picture.width, picture.height, {}, {}};
    std::unordered_map<std::uint32_t, unsigned char> number_of;
    for (const Box& box : boxes) {
        const auto number = static_cast<unsigned char>(result.palette.size());
        const std::span<const Shade> its(shades.data() + box.begin, box.end - box.begin);
        result.palette.push_back(color_of(its));
        for (const Shade& shade : its) number_of[key_of(shade.color.data())] = number;
    }
    const auto width = static_cast<std::size_t>(picture.width);
    result.indices.reserve(picture.bytes.size() / 3);
    for (auto y = static_cast<std::size_t>(picture.height); y-- > 0;)
        for (std::size_t x = 0; x < width; ++x)
            result.indices.push_back(number_of.at(key_of(&picture.bytes[3 * (y * width + x)])));
    return result;
}

std::string to_png(const IndexedPicture& picture) {
    const auto width = static_cast<std::size_t>(picture.width);
    std::string rows;
    rows.reserve(picture.indices.size() + static_cast<std::size_t>(picture.height));
    for (std::size_t at = 0; at < picture.indices.size(); at += width) {
        rows += '\0';  // no filter: neighbouring numbers mean nothing to each other
        rows.append(reinterpret_cast<const char*>(picture.indices.data() + at), width);
    }
    uLongf size = compressBound(static_cast<uLong>(rows.size()));
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                  static_cast<uLong>(rows.size()), Z_BEST_COMPRESSION) != Z_OK)
        throw std::bad_alloc();
    packed.resize(size);

    std::string header;
    add_number(header, static_cast<std::uint32_t>(picture.width));
    add_number(header, static_cast<std::uint32_t>(picture.height));
    header += {8, 3, 0, 0, 0};  // 8 bits per pixel, with a palette
    std::string palette;
    for (const auto& color : picture.palette) palette.append(reinterpret_cast<const char*>(color.data()), 3);
    std::string png = "\x89PNG\r\n\x1a\n";
    add_chunk(png, "IHDR", header);
    add_chunk(png, "PLTE", palette);
    add_chunk(png, "IDAT", packed);
    add_chunk(png, "IEND", {});
    return png;
}

}  // namespace curvewright
