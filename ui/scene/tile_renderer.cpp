#include "ui/scene/tile_renderer.h"

#include <utility>
#include <vector>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkDataSet.h>
#include <vtkMapper.h>
#include <vtkObjectFactory.h>

namespace curvewright {

vtkStandardNewMacro(TileRenderer);

namespace {

vtkIdType point_count(vtkActor* actor) {
    vtkMapper* mapper = actor->GetMapper();
    vtkDataSet* data = mapper ? mapper->GetInputAsDataSet() : nullptr;
    return data ? data->GetNumberOfPoints() : 0;
}

}  // namespace

void TileRenderer::begin_parts(vtkIdType most_points) {
    end_parts();
    most_points_of_part_ = most_points;
    is_in_parts_ = true;
}

void TileRenderer::end_parts() {
    is_in_parts_ = false;
    first_of_part_ = 0;
    SetErase(1);
}

void TileRenderer::DeviceRender() {
    if (!has_more_parts()) {
        vtkOpenGLRenderer::DeviceRender();
        return;
    }
    vtkCamera* const now = std::exchange(ActiveCamera, first_camera_);
    vtkOpenGLRenderer::DeviceRender();
    ActiveCamera = now;
}

int TileRenderer::UpdateGeometry(vtkFrameBufferObjectBase* buffer) {
    if (!is_in_parts_) return vtkOpenGLRenderer::UpdateGeometry(buffer);
    // Of what is on the mesh so much that it is quickly handed over; what lies flat on the picture comes last.
    std::vector<vtkProp*> part, flat;
    vtkIdType points = 0;
    int actor_number = 0, next = 0;
    for (int i = 0; i < PropArrayCount; ++i) {
        auto* actor = vtkActor::SafeDownCast(PropArray[i]);
        if (!actor) {
            flat.push_back(PropArray[i]);
            continue;
        }
        const int number = actor_number++;
        if (number < first_of_part_ || next > 0) continue;
        const vtkIdType its = point_count(actor);
        if (!part.empty() && points + its > most_points_of_part_) {
            next = number;
            continue;
        }
        points += its;
        part.push_back(actor);
    }
    if (next == 0) part.insert(part.end(), flat.begin(), flat.end());
    vtkProp** const all = PropArray;
    const int count = PropArrayCount;
    PropArray = part.data();
    PropArrayCount = static_cast<int>(part.size());
    const int drawn = vtkOpenGLRenderer::UpdateGeometry(buffer);
    PropArray = all;
    PropArrayCount = count;
    first_of_part_ = next;
    if (next == 0) {
        end_parts();
    } else if (GetErase()) {
        SetErase(0);
        first_camera_.TakeReference(MakeCamera());
        first_camera_->DeepCopy(ActiveCamera);
    }
    return drawn;
}

}  // namespace curvewright
