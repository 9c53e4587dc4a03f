#pragma once

#include <string>

#include <vtkSmartPointer.h>

#include "ui/palette/quality_colors.h"
#include "ui/scene/text_font.h"

class vtkRenderer;
class vtkTextActor;

namespace curvewright {

enum class TextAnchor { left, right, center };

/// A line of text at a display position (device pixels). The anchor is the left, right or middle of its middle line.
class OverlayText {
  public:
    explicit OverlayText(vtkRenderer* renderer);

    void set_font(const TextFont& font) { font_ = font; }
    void show(const std::string& text, double x, double y, double pixels, const Color& color,
              TextAnchor anchor = TextAnchor::left, bool is_bold = false);
    void hide();

  private:
    vtkRenderer* renderer_;
    vtkSmartPointer<vtkTextActor> actor_;
    TextFont font_;
};

/// Three significant digits, with a true minus sign.
std::string format_value(double value);

}  // namespace curvewright
