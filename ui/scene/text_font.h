#pragma once

#include <string>

class vtkTextProperty;

namespace curvewright {

/// The font of text over the scene.
struct TextFont {
    std::string regular, bold;  ///< files; empty = the font that VTK brings along
    friend bool operator==(const TextFont&, const TextFont&) = default;
};

/// DejaVu Sans, which is also the window's font on many systems, where distributions put it; VTK's own if it is not
/// there.
TextFont find_text_font();

/// Gives the style the font, with its size in pixels of a screen of `dpi`. Both fonts look as large.
void use_font(vtkTextProperty& style, const TextFont& font, double pixels, bool is_bold, int dpi);

}  // namespace curvewright
