#include "ui/scene/node_actor.h"

#include <algorithm>
#include <cmath>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkOpenGLPolyDataMapper.h>
#include <vtkOpenGLVertexBufferObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>
#include <vtkUniforms.h>
#include <vtkUnsignedCharArray.h>

namespace curvewright {
namespace {

constexpr double corner_diameter = 8.0, other_diameter = 5.5;

constexpr const char* vertex_code = R"(
//VTK::PositionVC::Impl
  gl_Position.z -= 0.002 * gl_Position.w;
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

NodeActors::NodeActors() {
    for (Set& set : sets_) set_up(set);
    set_colors({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {0.0, 0.0, 0.0});
}

NodeActors::~NodeActors() = default;

void NodeActors::set_up(Set& set) {
    set.mapper->SetInputData(set.data);
    set.mapper->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
    set.actor->SetMapper(set.mapper);
    set.actor->GetProperty()->LightingOff();
    set.actor->ForceOpaqueOn();
    set.actor->UseBoundsOff();
    set.actor->PickableOff();
    set.actor->VisibilityOff();
    vtkShaderProperty* shader = set.actor->GetShaderProperty();
    shader->AddVertexShaderReplacement("//VTK::PositionVC::Impl", true, vertex_code, false);
    shader->AddFragmentShaderReplacement("//VTK::Light::Impl", true, fragment_code, false);
    shader->GetFragmentCustomUniforms()->SetUniformf("nodeDiameter", 1.0f);
    shader->GetFragmentCustomUniforms()->SetUniformf("nodeRimWidth", 1.0f);
}

void NodeActors::set_nodes(const CurvedMesh& mesh, const Tessellation& tessellation, const WorldFrame& frame) {
    const MeshTopology& topology = mesh.topology();
    std::vector<bool> is_corner(static_cast<std::size_t>(topology.node_count()), false);
    for (Index element = 0; element < topology.element_count(); ++element) {
        const auto nodes = topology.element_nodes(element);
        const int corners = corner_count(topology.element_type(element).shape);
        for (int i = 0; i < corners; ++i) is_corner[nodes[i]] = true;
    }
    std::vector<float> points[2];
    for (auto& flags : is_boundary_) flags.clear();
    for (Index node : tessellation.nodes()) {
        const int set = is_corner[node] ? 0 : 1;
        for (int d = 0; d < 3; ++d)
            points[set].push_back(static_cast<float>(mesh.coordinates()(node, d) - tessellation.origin()[d]));
        is_boundary_[set].push_back(topology.is_boundary_node(node));
    }
    for (int set = 0; set < 2; ++set) {
        const auto count = static_cast<vtkIdType>(points[set].size() / 3);
        vtkNew<vtkFloatArray> array;
        array->SetNumberOfComponents(3);
        array->SetNumberOfTuples(count);
        std::copy(points[set].begin(), points[set].end(), array->GetPointer(0));
        vtkNew<vtkPoints> positions;
        positions->SetData(array);
        vtkNew<vtkCellArray> vertices;
        for (vtkIdType i = 0; i < count; ++i) vertices->InsertNextCell(1, &i);
        sets_[set].data->Initialize();
        sets_[set].data->SetPoints(positions);
        sets_[set].data->SetVerts(vertices);
        frame.place(sets_[set].actor, tessellation.origin());
    }
    color_points();
    set_visible(is_visible_);
}

void NodeActors::color_points() {
    for (int set = 0; set < 2; ++set) {
        vtkNew<vtkUnsignedCharArray> colors;
        colors->SetNumberOfComponents(3);
        for (bool is_boundary : is_boundary_[set]) {
            const Color& color = is_boundary ? boundary_ : interior_;
            for (double channel : color)
                colors->InsertNextValue(static_cast<unsigned char>(std::lround(255.0 * std::clamp(channel, 0.0, 1.0))));
        }
        sets_[set].data->GetPointData()->SetScalars(colors);
        sets_[set].data->Modified();
    }
}

void NodeActors::set_colors(const Color& boundary, const Color& interior, const Color& rim) {
    boundary_ = boundary;
    interior_ = interior;
    const float rgb[3] = {static_cast<float>(rim[0]), static_cast<float>(rim[1]), static_cast<float>(rim[2])};
    for (Set& set : sets_) set.actor->GetShaderProperty()->GetFragmentCustomUniforms()->SetUniform3f("nodeRim", rgb);
    color_points();
}

void NodeActors::set_visible(bool is_visible) {
    is_visible_ = is_visible;
    for (int set = 0; set < 2; ++set) sets_[set].actor->SetVisibility(is_visible && !is_boundary_[set].empty());
}

void NodeActors::update(const ViewMetrics& view, double spacing, double distance) {
    // Small elements get small points: they must not hide what they are on.
    const double room = spacing * view.pixels_per_unit(distance) / view.pixel_ratio;
    const double shrink = std::clamp(room / 45.0, 0.4, 1.0);
    for (int set = 0; set < 2; ++set) {
        const double diameter = (set == 0 ? corner_diameter : other_diameter) * shrink * view.pixel_ratio;
        sets_[set].actor->GetProperty()->SetPointSize(static_cast<float>(diameter));
        vtkUniforms* uniforms = sets_[set].actor->GetShaderProperty()->GetFragmentCustomUniforms();
        uniforms->SetUniformf("nodeDiameter", static_cast<float>(diameter));
        uniforms->SetUniformf("nodeRimWidth", static_cast<float>(std::max(0.8, 0.13 * diameter)));
    }
}

}  // namespace curvewright
