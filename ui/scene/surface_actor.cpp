#include "ui/scene/surface_actor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLookupTable.h>
#include <vtkOpenGLVertexBufferObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>
#include <vtkTypeInt64Array.h>
#include <vtkUniforms.h>
#include <vtkUnsignedCharArray.h>

#include "ui/scene/cut_uniform.h"

namespace curvewright {
namespace {

constexpr const char* vertex_declarations = R"(
out float surfaceBeyondVSOutput;
//VTK::PositionVC::Dec
)";

constexpr const char* bias_code = R"(
//VTK::PositionVC::Impl
  gl_Position.z -= surfaceBias * gl_Position.w;
  surfaceBeyondVSOutput = dot(surfaceCut, vec4(vertexMC.xyz, 1.0));
)";

constexpr const char* fragment_declarations = R"(
in float surfaceBeyondVSOutput;
//VTK::Color::Dec
)";

constexpr const char* cut_code = R"(
  if (surfaceBeyondVSOutput > 0.0) discard;
//VTK::Color::Impl
)";

constexpr const char* hatch_code = R"(
//VTK::Light::Impl
  if (hatchPeriod > 0.0) {
    float position = (gl_FragCoord.x + gl_FragCoord.y + hatchShift) * 0.70710678;
    float beside = abs(mod(position, hatchPeriod) - 0.5 * hatchPeriod);
    float stripe = clamp(0.5 * hatchWidth + 0.5 - beside, 0.0, 1.0);
    gl_FragData[0].rgb = mix(gl_FragData[0].rgb, hatchColor, stripe);
  }
)";

// Surfaces step back by as much as they change their depth within the width of a line, so that lines on them show whole
// on faces seen almost from the side too.
constexpr const char* depth_code = R"(
//VTK::Depth::Impl
  float slope = length(vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)));
  gl_FragDepth = gl_FragCoord.z + min(surfaceStep * slope, 0.004);
)";
constexpr double step_width = 1.6;

constexpr double hatch_period = 6.0, hatch_width = 1.6;

vtkSmartPointer<vtkFloatArray> copy_triples(std::span<const float> values) {
    auto array = vtkSmartPointer<vtkFloatArray>::New();
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(static_cast<vtkIdType>(values.size() / 3));
    std::copy(values.begin(), values.end(), array->GetPointer(0));
    return array;
}

}  // namespace

SurfaceActor::SurfaceActor() {
    mapper_->SetInputData(data_);
    mapper_->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
    actor_->SetMapper(mapper_);
    actor_->ForceOpaqueOn();
    actor_->UseBoundsOff();
    actor_->VisibilityOff();
    vtkShaderProperty* shader = actor_->GetShaderProperty();
    shader->AddVertexShaderReplacement("//VTK::PositionVC::Dec", true, vertex_declarations, false);
    shader->AddVertexShaderReplacement("//VTK::PositionVC::Impl", true, bias_code, false);
    shader->AddFragmentShaderReplacement("//VTK::Color::Dec", true, fragment_declarations, false);
    shader->AddFragmentShaderReplacement("//VTK::Color::Impl", true, cut_code, false);
    shader->AddFragmentShaderReplacement("//VTK::Light::Impl", true, hatch_code, false);
    vtkUniforms* uniforms = shader->GetFragmentCustomUniforms();
    uniforms->SetUniformf("hatchPeriod", 0.0f);
    uniforms->SetUniformf("hatchWidth", 0.0f);
    uniforms->SetUniformf("hatchShift", 0.0f);
    uniforms->SetUniformf("surfaceStep", 0.0f);
    const float black[3] = {0.0f, 0.0f, 0.0f};
    uniforms->SetUniform3f("hatchColor", black);
    set_depth_bias(0.0);
    set_cut({}, Eigen::RowVector3d::Zero(), 1.0);
    is_lit_ = true;
    set_lit(false);
}

SurfaceActor::~SurfaceActor() = default;

void SurfaceActor::set_surface(const Tessellation& tessellation, bool is_new) {
    set_surface(tessellation, {0, tessellation.triangle_elements().size()}, is_new);
}

void SurfaceActor::set_surface(const Tessellation& tessellation, TriangleRange range, bool is_new) {
    const bool is_there = range.begin < range.end;
    actor_->SetVisibility(is_there);
    if (is_new) {
        range_ = range;
        find_points(tessellation);
        data_->Initialize();
        const auto& corners = tessellation.triangles();
        const auto count = static_cast<vtkIdType>(range.end - range.begin);
        auto ids = vtkSmartPointer<vtkTypeInt64Array>::New();
        auto starts = vtkSmartPointer<vtkTypeInt64Array>::New();
        ids->SetNumberOfValues(3 * count);
        for (vtkIdType i = 0; i < 3 * count; ++i)
            ids->SetValue(i, corners[3 * range.begin + static_cast<std::size_t>(i)] - static_cast<Index>(first_point_));
        starts->SetNumberOfValues(count + 1);
        for (vtkIdType i = 0; i <= count; ++i) starts->SetValue(i, 3 * i);
        vtkNew<vtkCellArray> triangles;
        triangles->SetData(starts, ids);
        data_->SetPolys(triangles);
    }
    const auto its = [this](const std::vector<float>& triples) {
        return copy_triples(std::span(triples).subspan(3 * first_point_, 3 * point_count_));
    };
    vtkNew<vtkPoints> points;
    points->SetData(its(tessellation.surface_points()));
    data_->SetPoints(points);
    data_->GetPointData()->SetNormals(is_lit_ ? its(tessellation.surface_normals()) : nullptr);
    data_->Modified();
}

/// Points stand in the order of the triangles, those of a face together.
void SurfaceActor::find_points(const Tessellation& tessellation) {
    first_point_ = point_count_ = 0;
    if (range_.begin >= range_.end) return;
    const auto begin = tessellation.triangles().begin();
    const auto [least, most] = std::minmax_element(begin + static_cast<std::ptrdiff_t>(3 * range_.begin),
                                                   begin + static_cast<std::ptrdiff_t>(3 * range_.end));
    first_point_ = static_cast<std::size_t>(*least);
    point_count_ = static_cast<std::size_t>(*most - *least) + 1;
}

void SurfaceActor::set_colors(const Tessellation& tessellation, const std::function<Color(Index)>& color_of) {
    vtkNew<vtkUnsignedCharArray> colors;
    colors->SetNumberOfComponents(3);
    colors->SetNumberOfTuples(static_cast<vtkIdType>(point_count_));
    unsigned char* const first = colors->GetPointer(0);
    // Every point belongs to one element only, so its triangles agree on the colour.
    const auto& elements = tessellation.triangle_elements();
    Index last = -1;
    std::array<unsigned char, 3> bytes{};
    for (std::size_t triangle = range_.begin; triangle < range_.end; ++triangle) {
        if (elements[triangle] != last) {
            last = elements[triangle];
            const Color color = color_of(last);
            for (std::size_t c = 0; c < 3; ++c)
                bytes[c] = static_cast<unsigned char>(std::lround(255.0 * std::clamp(color[c], 0.0, 1.0)));
        }
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto point = static_cast<std::size_t>(tessellation.triangles()[3 * triangle + corner]);
            std::copy(bytes.begin(), bytes.end(), first + 3 * (point - first_point_));
        }
    }
    mapper_->InterpolateScalarsBeforeMappingOff();
    data_->GetPointData()->SetScalars(colors);
    data_->Modified();
}

std::vector<Index> SurfaceActor::set_section(const PlaneCut& section, const std::function<bool(Index)>& is_wanted,
                                             const std::function<Color(Index)>& color_of) {
    std::vector<float> points, normals;
    std::vector<Index> origins;
    auto ids = vtkSmartPointer<vtkTypeInt64Array>::New();
    vtkNew<vtkUnsignedCharArray> colors;
    colors->SetNumberOfComponents(3);
    // The points of an element stand together and belong to it alone.
    std::vector<Index> copied(section.points().size() / 3, -1);
    const auto& elements = section.triangle_elements();
    for (std::size_t triangle = 0; triangle < elements.size(); ++triangle) {
        if (!is_wanted(elements[triangle])) continue;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Index from = section.triangles()[3 * triangle + corner];
            Index& to = copied[static_cast<std::size_t>(from)];
            if (to < 0) {
                to = static_cast<Index>(points.size() / 3);
                origins.push_back(from);
                const Color color = color_of(elements[triangle]);
                for (std::size_t d = 0; d < 3; ++d) {
                    points.push_back(section.points()[3 * static_cast<std::size_t>(from) + d]);
                    normals.push_back(static_cast<float>(section.plane().normal[static_cast<Eigen::Index>(d)]));
                    colors->InsertNextValue(
                        static_cast<unsigned char>(std::lround(255.0 * std::clamp(color[d], 0.0, 1.0))));
                }
            }
            ids->InsertNextValue(to);
        }
    }
    data_->Initialize();
    actor_->SetVisibility(!points.empty());
    if (points.empty()) return {};
    auto starts = vtkSmartPointer<vtkTypeInt64Array>::New();
    for (vtkIdType i = 0; i <= ids->GetNumberOfValues(); i += 3) starts->InsertNextValue(i);
    vtkNew<vtkCellArray> triangles;
    triangles->SetData(starts, ids);
    vtkNew<vtkPoints> positions;
    positions->SetData(copy_triples(points));
    data_->SetPoints(positions);
    data_->SetPolys(triangles);
    data_->GetPointData()->SetNormals(is_lit_ ? copy_triples(normals) : nullptr);
    mapper_->InterpolateScalarsBeforeMappingOff();
    data_->GetPointData()->SetScalars(colors);
    data_->Modified();
    return origins;
}

void SurfaceActor::set_cut(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin,
                           double mesh_size) {
    const std::array<float, 4> cut = cut_coefficients(plane, origin, mesh_size);
    actor_->GetShaderProperty()->GetVertexCustomUniforms()->SetUniform4f("surfaceCut", cut.data());
}

void SurfaceActor::set_field(std::span<const double> values, const ColorScale& scale) {
    constexpr int table_size = 512;
    vtkNew<vtkLookupTable> table;
    table->SetNumberOfTableValues(table_size);
    table->SetTableRange(0.0, 1.0);
    for (int i = 0; i < table_size; ++i) {
        const double t = (i + 0.5) / table_size;
        const Color color = map_color(scale.map, scale.is_reversed ? 1.0 - t : t);
        table->SetTableValue(i, color[0], color[1], color[2], 1.0);
    }
    const Color none = no_value_color();
    table->SetNanColor(none[0], none[1], none[2], 1.0);
    // Positions in the range instead of the numbers themselves, which single precision may not tell apart.
    vtkNew<vtkFloatArray> positions;
    positions->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
    constexpr double farthest = 100.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double position = scale.position(values[i]);
        positions->SetValue(static_cast<vtkIdType>(i),
                            std::isfinite(position) ? static_cast<float>(std::clamp(position, -farthest, farthest))
                                                    : std::numeric_limits<float>::quiet_NaN());
    }
    mapper_->SetLookupTable(table);
    mapper_->UseLookupTableScalarRangeOn();
    mapper_->InterpolateScalarsBeforeMappingOn();
    data_->GetPointData()->SetScalars(positions);
    data_->Modified();
}

void SurfaceActor::clear() {
    data_->Initialize();
    actor_->VisibilityOff();
}

bool SurfaceActor::is_empty() const {
    return data_->GetNumberOfPoints() == 0;
}

void SurfaceActor::set_lit(bool is_lit) {
    if (is_lit == is_lit_) return;
    is_lit_ = is_lit;
    vtkProperty* property = actor_->GetProperty();
    property->SetLighting(is_lit);
    // A face that looks at the eye has exactly the colour of the legend.
    property->SetAmbient(is_lit ? 0.58 : 1.0);
    property->SetDiffuse(is_lit ? 0.42 : 0.0);
    property->SetSpecular(0.0);
    property->SetInterpolationToPhong();
    vtkShaderProperty* shader = actor_->GetShaderProperty();
    shader->ClearFragmentShaderReplacement("//VTK::Depth::Impl", true);
    if (is_lit) shader->AddFragmentShaderReplacement("//VTK::Depth::Impl", true, depth_code, false);
}

void SurfaceActor::set_depth_bias(double bias) {
    actor_->GetShaderProperty()->GetVertexCustomUniforms()->SetUniformf("surfaceBias", static_cast<float>(bias));
}

void SurfaceActor::set_hatch(const Color& color) {
    vtkUniforms* uniforms = actor_->GetShaderProperty()->GetFragmentCustomUniforms();
    const float rgb[3] = {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
    uniforms->SetUniform3f("hatchColor", rgb);
    is_hatched_ = true;
}

void SurfaceActor::update(const ViewMetrics& view) {
    vtkUniforms* uniforms = actor_->GetShaderProperty()->GetFragmentCustomUniforms();
    uniforms->SetUniformf("surfaceStep", static_cast<float>(step_width * view.pixel_ratio));
    if (!is_hatched_) return;
    uniforms->SetUniformf("hatchShift", static_cast<float>(view.tile_shift));
    uniforms->SetUniformf("hatchPeriod", static_cast<float>(hatch_period * view.pixel_ratio));
    uniforms->SetUniformf("hatchWidth", static_cast<float>(hatch_width * view.pixel_ratio));
}

}  // namespace curvewright
