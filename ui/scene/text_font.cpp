#include "ui/scene/text_font.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <vtkTextProperty.h>

namespace curvewright {

TextFont find_text_font() {
    for (const char* folder : {"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
                               "/usr/share/fonts/TTF", "/usr/share/fonts/dejavu"}) {
        const std::filesystem::path regular = std::filesystem::path(folder) / "DejaVuSans.ttf",
                                    bold = std::filesystem::path(folder) / "DejaVuSans-Bold.ttf";
        std::error_code error;
        if (std::filesystem::is_regular_file(regular, error) && std::filesystem::is_regular_file(bold, error))
            return {regular.string(), bold.string()};
    }
    return {};
}

void use_font(vtkTextProperty& style, const TextFont& font, double pixels, bool is_bold, int dpi) {
    const std::string& file = is_bold ? font.bold : font.regular;
    if (file.empty()) {
        style.SetFontFamilyToArial();
        style.SetBold(is_bold);
    } else {
        constexpr double width = 0.9;  // DejaVu's letters are wider by that
        pixels *= width;
        style.SetFontFamily(VTK_FONT_FILE);
        style.SetFontFile(file.c_str());
        style.SetBold(false);
    }
    style.SetFontSize(std::max(1, static_cast<int>(std::lround(pixels * 72.0 / std::max(1, dpi)))));
}

}  // namespace curvewright
