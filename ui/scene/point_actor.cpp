#include "ui/scene/point_actor.h"

#include <algorithm>
#include <cmath>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkOpenGLVertexBufferObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>
#include <vtkUniforms.h>
#include <vtkUnsignedCharArray.h>

#include "ui/scene/cut_uniform.h"

namespace curvewright {
namespace {

constexpr const char* vertex_code = R"(
//VTK::PositionVC::Impl
  gl_Position.z = nodeOnTop != 0 ? -0.985 * gl_Position.w + 0.004 * gl_Position.z : gl_Position.z - 0.002 * gl_Position.w;
  if (dot(nodeCut, vec4(vertexMC.xyz, 1.0)) > 0.0) gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
)";

// A disc with a rim, both with smooth borders.
constexpr const char* fragment_code = R"(
//VTK::Light::Impl
  {
    float radius = length(gl_PointCoord - vec2(0.5)) * nodeDiameter;
    float outer = clamp(0.5 * nodeDiameter - radius, 0.0, 1.0);
    float inner = clamp(0.5 * nodeDiameter - nodeRimWidth - radius, 0.0, 1.0);
    if (outer < 0.004) discard;
    gl_FragData[0].rgb = mix(nodeRim, gl_FragData[0].rgb, inner);
    gl_FragData[0].a *= outer;
  }
)";

}  // namespace

PointActor::PointActor() {
    mapper_->SetInputData(data_);
    mapper_->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
    actor_->SetMapper(mapper_);
    actor_->GetProperty()->LightingOff();
    actor_->ForceOpaqueOn();
    actor_->UseBoundsOff();
    actor_->PickableOff();
    actor_->VisibilityOff();
    vtkShaderProperty* shader = actor_->GetShaderProperty();
    shader->AddVertexShaderReplacement("//VTK::PositionVC::Impl", true, vertex_code, false);
    shader->AddFragmentShaderReplacement("//VTK::Light::Impl", true, fragment_code, false);
    shader->GetVertexCustomUniforms()->SetUniformi("nodeOnTop", 0);
    set_cut({}, Eigen::RowVector3d::Zero(), 1.0);
    set_diameter(1.0);
    set_rim({0.0, 0.0, 0.0});
}

PointActor::~PointActor() = default;

void PointActor::set_points(const std::vector<float>& points, const Eigen::RowVector3d& origin,
                            const WorldFrame& frame) {
    const auto count = static_cast<vtkIdType>(points.size() / 3);
    vtkNew<vtkFloatArray> array;
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(count);
    std::copy(points.begin(), points.end(), array->GetPointer(0));
    vtkNew<vtkPoints> positions;
    positions->SetData(array);
    vtkNew<vtkCellArray> vertices;
    for (vtkIdType i = 0; i < count; ++i) vertices->InsertNextCell(1, &i);
    data_->Initialize();
    data_->SetPoints(positions);
    data_->SetVerts(vertices);
    frame.place(actor_, origin);
}

void PointActor::set_colors(const std::vector<Color>& colors) {
    vtkNew<vtkUnsignedCharArray> bytes;
    bytes->SetNumberOfComponents(3);
    bytes->SetNumberOfTuples(static_cast<vtkIdType>(colors.size()));
    unsigned char* at = bytes->GetPointer(0);
    for (const Color& color : colors)
        for (double channel : color)
            *at++ = static_cast<unsigned char>(std::lround(255.0 * std::clamp(channel, 0.0, 1.0)));
    data_->GetPointData()->SetScalars(bytes);
    data_->Modified();
}

void PointActor::set_rim(const Color& rim) {
    const float rgb[3] = {static_cast<float>(rim[0]), static_cast<float>(rim[1]), static_cast<float>(rim[2])};
    actor_->GetShaderProperty()->GetFragmentCustomUniforms()->SetUniform3f("nodeRim", rgb);
}

void PointActor::set_cut(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin, double mesh_size) {
    const std::array<float, 4> cut = cut_coefficients(plane, origin, mesh_size);
    actor_->GetShaderProperty()->GetVertexCustomUniforms()->SetUniform4f("nodeCut", cut.data());
}

void PointActor::set_on_top() {
    actor_->GetShaderProperty()->GetVertexCustomUniforms()->SetUniformi("nodeOnTop", 1);
}

bool PointActor::is_empty() const {
    return data_->GetNumberOfPoints() == 0;
}

void PointActor::set_diameter(double diameter) {
    actor_->GetProperty()->SetPointSize(static_cast<float>(diameter));
    vtkUniforms* uniforms = actor_->GetShaderProperty()->GetFragmentCustomUniforms();
    uniforms->SetUniformf("nodeDiameter", static_cast<float>(diameter));
    uniforms->SetUniformf("nodeRimWidth", static_cast<float>(std::max(0.8, 0.13 * diameter)));
}

}  // namespace curvewright
