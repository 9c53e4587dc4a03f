#include "ui/scene/overlay_text.h"

#include <cmath>

#include <fmt/format.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

namespace curvewright {

OverlayText::OverlayText(vtkRenderer* renderer) : renderer_(renderer), actor_(vtkSmartPointer<vtkTextActor>::New()) {
    actor_->VisibilityOff();
    actor_->PickableOff();
    renderer->AddViewProp(actor_);
}

void OverlayText::show(const std::string& text, double x, double y, double pixels, const Color& color,
                       TextAnchor anchor, bool is_bold) {
    vtkTextProperty* style = actor_->GetTextProperty();
    // Font sizes are points of the window's resolution; ours are pixels.
    const int dpi = renderer_->GetRenderWindow() ? renderer_->GetRenderWindow()->GetDPI() : 72;
    use_font(*style, font_, pixels, is_bold, dpi);
    style->SetColor(color[0], color[1], color[2]);
    style->SetVerticalJustificationToCentered();
    if (anchor == TextAnchor::left) style->SetJustificationToLeft();
    if (anchor == TextAnchor::right) style->SetJustificationToRight();
    if (anchor == TextAnchor::center) style->SetJustificationToCentered();
    actor_->SetInput(text.c_str());
    // Whole pixels keep the glyphs crisp.
    actor_->SetDisplayPosition(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)));
    actor_->VisibilityOn();
}

void OverlayText::hide() {
    actor_->VisibilityOff();
}

std::string format_value(double value) {
    std::string text = fmt::format("{:#.3g}", value);
    for (std::size_t at = text.find('-'); at != std::string::npos; at = text.find('-', at))
        text.replace(at, 1, "\u2212");
    return text;
}

}  // namespace curvewright
