#pragma once

#include <vector>

namespace curvewright {

/// A picture in memory: rows from the bottom, 3 (red, green, blue) or 4 (and alpha, not premultiplied) bytes per pixel.
struct PicturePixels {
    int width = 0, height = 0, channels = 3;
    std::vector<unsigned char> bytes;
};

/// Rows from the top, 4 bytes per pixel.
std::vector<unsigned char> rgba_from_top(const PicturePixels& picture);

/// Means of blocks of factor × factor pixels. rgb: width × height × 3; width and height are multiples of factor.
PicturePixels average(const unsigned char* rgb, int width, int height, int factor);

/// What was drawn twice, on black and on white, on nothing: the alpha of every pixel follows from how much of the
/// ground comes through, and its colour is that of what covers it, without any ground in it. Laid on black or on white
/// again it is what was drawn, to rounding. Sizes as in average().
PicturePixels without_ground(const unsigned char* on_black, const unsigned char* on_white, int width, int height,
                             int factor);

}  // namespace curvewright
