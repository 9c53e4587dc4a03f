#include "ui/scene/upload_mapper.h"

#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

namespace curvewright {

vtkStandardNewMacro(UploadMapper);

void UploadMapper::upload(vtkRenderer* renderer, vtkActor* actor) {
    CurrentInput = GetInput();
    if (!CurrentInput || CurrentInput->GetNumberOfPoints() == 0 || !renderer->GetRenderWindow()) return;
    UpdateBufferObjects(renderer, actor);
}

}  // namespace curvewright
