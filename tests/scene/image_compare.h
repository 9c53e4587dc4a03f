#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace curvewright {

struct Image {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;  ///< 3 per pixel

    const unsigned char* pixel(int x, int y) const { return rgb.data() + 3 * (y * width + x); }  ///< y from the bottom
};

/// Where a test may put a picture: a file of this process alone, for tests run beside each other.
std::filesystem::path temporary_picture(const std::string& name);

/// Throws std::runtime_error if the file is not a picture with three channels.
Image read_image(const std::filesystem::path& file);

struct ImageDifference {
    double mean = 0.0;        ///< of all channels, of 255
    double far_pixels = 0.0;  ///< share of pixels with a channel that differs by more than 24
};

/// Pictures of different size differ everywhere.
ImageDifference compare(const Image& a, const Image& b);

/// What a picture may differ from its baseline. Software rendering gives the same bits on one machine; a different Mesa
/// or FreeType moves the grey of borders and glyphs a little, which is below 0.1 on average and in far fewer than 2 of
/// 1000 pixels. A changed colour, line width or label is above both (see the negative control).
inline constexpr double largest_mean = 0.25;
inline constexpr double most_far_pixels = 0.002;
bool is_same(const ImageDifference& difference);

}  // namespace curvewright
