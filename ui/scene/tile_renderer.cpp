#include "ui/scene/tile_renderer.h"

#include <vtkObjectFactory.h>

namespace curvewright {

vtkStandardNewMacro(TileRenderer);

}  // namespace curvewright
