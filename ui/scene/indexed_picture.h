#pragma once

#include <array>
#include <string>
#include <vector>

#include "ui/scene/picture_pixels.h"

namespace curvewright {

/// A picture whose pixels are numbers of colours.
struct IndexedPicture {
    int width = 0, height = 0;
    std::vector<std::array<unsigned char, 3>> palette;  ///< red, green, blue; 256 at most
    std::vector<unsigned char> indices;                 ///< rows from the top
};

/// At most `colors` (2 to 256) colours, by median cut: colours of large areas stay exactly what they are, those between
/// (of smooth borders) are merged with similar ones. A picture that has no more is not changed. pre: no alpha.
IndexedPicture reduce_colors(const PicturePixels& picture, int colors);

/// The bytes of a PNG file.
std::string to_png(const IndexedPicture& picture);

}  // namespace curvewright
