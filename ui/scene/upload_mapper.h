#pragma once

#include <vtkOpenGLPolyDataMapper.h>

namespace curvewright {

/// A mapper that can hand its data to the graphics before anything is drawn with them.
class UploadMapper : public vtkOpenGLPolyDataMapper {
  public:
    static UploadMapper* New();
    vtkTypeMacro(UploadMapper, vtkOpenGLPolyDataMapper)

        /// pre: the context of the renderer's window is current; the actor is the mapper's, in the renderer or about to
        /// be.
        void upload(vtkRenderer* renderer, vtkActor* actor);

  protected:
    UploadMapper() = default;
};

}  // namespace curvewright
