#include "ui/scene/stroke_actor.h"

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
#include <vtkTypeInt64Array.h>
#include <vtkUniforms.h>
#include <vtkUnsignedCharArray.h>

#include "ui/scene/cut_uniform.h"

namespace curvewright {
namespace {

// across: signed distance from the middle of the line; half: half its width; dots: position in the dot pattern, in
// periods, and the length of a period; all lengths in device pixels.
constexpr const char* vertex_declarations = R"(
in vec3 hereMC;
in vec3 previousMC;
in vec3 nextMC;
in vec3 strokeMC;
out vec4 strokeVSOutput;
out float strokePeriodVSOutput;
out float strokeBeyondVSOutput;
//VTK::PositionVC::Dec
)";

constexpr const char* vertex_code = R"(
//VTK::PositionVC::Impl
  {
    vec2 halfView = 0.5 * vec2(strokeViewWidth, strokeViewHeight);
    vec4 p, a, b;
    if (strokeInPixels != 0) {
      p = vec4(hereMC.xy / halfView - 1.0, 0.0, 1.0);
      a = vec4(previousMC.xy / halfView - 1.0, 0.0, 1.0);
      b = vec4(nextMC.xy / halfView - 1.0, 0.0, 1.0);
    } else {
      p = MCDCMatrix * vec4(hereMC, 1.0);
      a = MCDCMatrix * vec4(previousMC, 1.0);
      b = MCDCMatrix * vec4(nextMC, 1.0);
    }
    vec2 here = p.xy / p.w * halfView;
    vec2 before = here - a.xy / a.w * halfView;
    vec2 after = b.xy / b.w * halfView - here;
    float lengthBefore = length(before), lengthAfter = length(after);
    bool isStart = lengthBefore < 1e-4, isEnd = lengthAfter < 1e-4;
    vec2 t0 = isStart ? vec2(0.0) : before / lengthBefore;
    vec2 t1 = isEnd ? vec2(0.0) : after / lengthAfter;
    vec2 sum = t0 + t1;
    vec2 along = length(sum) > 1e-3 ? normalize(sum) : (isEnd ? vec2(1.0, 0.0) : t1);
    float scale = strokeInPixels != 0 ? 1.0 : (strokeIsParallel != 0 ? strokePixelScale : strokePixelScale / p.w);
    float spacing = strokeMC.z * scale;
    float presence = strokeFades != 0 ? smoothstep(1.0 * strokeRatio, 24.0 * strokeRatio, spacing) : 1.0;
    float halfWidth = 0.5 * strokeWidth * (0.6 + 0.4 * presence);
    float miter = isStart || isEnd ? 1.0 : 1.0 / max(0.5, dot(along, t1));
    float reach = halfWidth + 1.0;
    here += vec2(-along.y, along.x) * strokeMC.x * reach * miter;
    if (isStart) here -= along * halfWidth * strokeCap;
    if (isEnd) here += along * halfWidth * strokeCap;
    float depth = (strokeOnTop != 0 ? -0.98 * p.w + 0.005 * p.z : p.z) - strokeBias * p.w;
    gl_Position = vec4(here / halfView * p.w, depth, p.w);
    float period = strokeDash;
    strokeVSOutput = vec4(strokeMC.x * reach, halfWidth, period > 0.0 ? strokeMC.y * scale / period : 0.0,
                          strokeFades != 0 ? 0.2 + 0.8 * presence : 1.0);
    strokePeriodVSOutput = period;
    strokeBeyondVSOutput = dot(strokeCut, vec4(hereMC, 1.0));
  }
)";

constexpr const char* fragment_declarations = R"(
in vec4 strokeVSOutput;
in float strokePeriodVSOutput;
in float strokeBeyondVSOutput;
//VTK::Color::Dec
)";

// The coverage of a pixel by a straight band, exact for bands along the pixel grid.
constexpr const char* fragment_code = R"(
//VTK::Light::Impl
  {
    if (strokeBeyondVSOutput > 0.0) discard;
    float across = abs(strokeVSOutput.x), halfWidth = strokeVSOutput.y;
    float coverage = clamp(min(halfWidth, across + 0.5) - max(-halfWidth, across - 0.5), 0.0, 1.0);
    if (strokePeriodVSOutput > 0.0) {
      float beside = abs(fract(strokeVSOutput.z) - 0.5) * strokePeriodVSOutput;
      coverage *= clamp(0.3 * strokePeriodVSOutput + 0.5 - beside, 0.0, 1.0);
    }
    coverage *= strokeVSOutput.w;
    if (coverage < 0.004) discard;
    gl_FragData[0].a *= coverage * strokeOpacity;
  }
)";

vtkSmartPointer<vtkFloatArray> make_array(const char* name, int components, vtkIdType tuples) {
    auto array = vtkSmartPointer<vtkFloatArray>::New();
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(tuples);
    return array;
}

}  // namespace

void Polylines::add(const std::vector<std::array<double, 3>>& line) {
    for (const auto& point : line)
        for (double x : point) points.push_back(static_cast<float>(x));
    offsets.push_back(offsets.back() + static_cast<Index>(line.size()));
}

void Polylines::add_section(const PlaneCut& section, const Eigen::RowVector3d& origin,
                            const std::function<bool(std::size_t)>& is_wanted) {
    const Eigen::RowVector3f shift = (section.origin() - origin).cast<float>();
    for (std::size_t line = 0; line < section.line_elements().size(); ++line) {
        if (!is_wanted(line)) continue;
        for (Index i = section.line_offsets()[line]; i < section.line_offsets()[line + 1]; ++i)
            for (Index d = 0; d < 3; ++d)
                points.push_back(section.line_points()[static_cast<std::size_t>(3 * i + d)] + shift[d]);
        offsets.push_back(static_cast<Index>(points.size() / 3));
    }
}

StrokeActor::StrokeActor() {
    mapper_->SetInputData(data_);
    mapper_->SetVBOShiftScaleMethod(vtkOpenGLVertexBufferObject::DISABLE_SHIFT_SCALE);
    mapper_->MapDataArrayToVertexAttribute("hereMC", "here", vtkDataObject::FIELD_ASSOCIATION_POINTS, -1);
    mapper_->MapDataArrayToVertexAttribute("previousMC", "previous", vtkDataObject::FIELD_ASSOCIATION_POINTS, -1);
    mapper_->MapDataArrayToVertexAttribute("nextMC", "next", vtkDataObject::FIELD_ASSOCIATION_POINTS, -1);
    mapper_->MapDataArrayToVertexAttribute("strokeMC", "stroke", vtkDataObject::FIELD_ASSOCIATION_POINTS, -1);
    actor_->SetMapper(mapper_);
    actor_->GetProperty()->LightingOff();
    actor_->ForceOpaqueOn();
    actor_->UseBoundsOff();
    actor_->PickableOff();
    actor_->VisibilityOff();
    vtkShaderProperty* shader = actor_->GetShaderProperty();
    shader->AddVertexShaderReplacement("//VTK::PositionVC::Dec", true, vertex_declarations, false);
    shader->AddVertexShaderReplacement("//VTK::PositionVC::Impl", true, vertex_code, false);
    shader->AddFragmentShaderReplacement("//VTK::Color::Dec", true, fragment_declarations, false);
    shader->AddFragmentShaderReplacement("//VTK::Light::Impl", true, fragment_code, false);
    set_style({});
    set_cut({}, Eigen::RowVector3d::Zero(), 1.0);
    update({});
}

StrokeActor::~StrokeActor() = default;

void StrokeActor::set_lines(const Polylines& lines, double length_unit) {
    const auto point_count = static_cast<vtkIdType>(lines.points.size() / 3);
    actor_->SetVisibility(point_count > 0);
    offsets_ = lines.offsets;
    if (point_count == 0) {
        data_->Initialize();
        return;
    }
    // VTK leaves out triangles whose corners coincide, as those of a ribbon without width do: its points are only
    // numbers of points, the positions go to the shader in an attribute.
    auto number = make_array("number", 3, 2 * point_count), stroke = make_array("stroke", 3, 2 * point_count);
    here_ = make_array("here", 3, 2 * point_count);
    previous_ = make_array("previous", 3, 2 * point_count);
    next_ = make_array("next", 3, 2 * point_count);
    auto ids = vtkSmartPointer<vtkTypeInt64Array>::New();
    auto starts = vtkSmartPointer<vtkTypeInt64Array>::New();
    const vtkIdType triangle_count = 2 * (point_count - lines.count());
    ids->SetNumberOfValues(3 * triangle_count);
    starts->SetNumberOfValues(triangle_count + 1);
    for (vtkIdType i = 0; i <= triangle_count; ++i) starts->SetValue(i, 3 * i);
    vtkSmartPointer<vtkUnsignedCharArray> colors;
    if (!lines.colors.empty()) {
        colors = vtkSmartPointer<vtkUnsignedCharArray>::New();
        colors->SetNumberOfComponents(3);
        colors->SetNumberOfTuples(2 * point_count);
    }

    vtkIdType id = 0;
    for (Index line = 0; line < lines.count(); ++line) {
        const Index first = lines.offsets[line], last = lines.offsets[line + 1] - 1;
        const float* x = lines.points.data();
        double along = 0.0;
        for (Index i = first; i <= last; ++i) {
            if (i > first)
                along += std::hypot(x[3 * i] - x[3 * i - 3], x[3 * i + 1] - x[3 * i - 2], x[3 * i + 2] - x[3 * i - 1]);
            for (int side = 0; side < 2; ++side) {
                const vtkIdType at = 2 * i + side;
                const float numbers[3] = {static_cast<float>(i), static_cast<float>(side), 0.0f};
                number->SetTypedTuple(at, numbers);
                stroke->SetTypedComponent(at, 0, side == 0 ? -1.0f : 1.0f);
                stroke->SetTypedComponent(at, 1, static_cast<float>(along * length_unit));
                stroke->SetTypedComponent(
                    at, 2, lines.spacing.empty() ? 0.0f : static_cast<float>(lines.spacing[line] * length_unit));
                for (int c = 0; colors && c < 3; ++c)
                    colors->SetTypedComponent(at, c,
                                              static_cast<unsigned char>(std::lround(255.0 * lines.colors[line][c])));
            }
            if (i == last) continue;
            for (vtkIdType corner : {2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3})
                ids->SetValue(id++, corner);
        }
    }
    vtkNew<vtkPoints> points;
    points->SetData(number);
    vtkNew<vtkCellArray> triangles;
    triangles->SetData(starts, ids);
    data_->Initialize();
    data_->SetPoints(points);
    data_->SetPolys(triangles);
    data_->GetPointData()->AddArray(here_);
    data_->GetPointData()->AddArray(previous_);
    data_->GetPointData()->AddArray(next_);
    data_->GetPointData()->AddArray(stroke);
    data_->GetPointData()->SetScalars(colors);
    move_lines(lines.points);
}

void StrokeActor::move_lines(const std::vector<float>& points) {
    if (points.empty() || static_cast<Index>(points.size() / 3) != offsets_.back()) return;
    const float* x = points.data();
    float *here = here_->GetPointer(0), *previous = previous_->GetPointer(0), *next = next_->GetPointer(0);
    for (std::size_t line = 0; line + 1 < offsets_.size(); ++line) {
        const Index first = offsets_[line], last = offsets_[line + 1] - 1;
        // A closed line has no ends.
        const bool is_closed = last - first > 2 && std::equal(x + 3 * first, x + 3 * first + 3, x + 3 * last);
        for (Index i = first; i <= last; ++i) {
            const Index before = i > first ? i - 1 : (is_closed ? last - 1 : first);
            const Index after = i < last ? i + 1 : (is_closed ? first + 1 : last);
            for (Index side = 0; side < 2; ++side) {
                std::copy_n(x + 3 * i, 3, here + 6 * i + 3 * side);
                std::copy_n(x + 3 * before, 3, previous + 6 * i + 3 * side);
                std::copy_n(x + 3 * after, 3, next + 6 * i + 3 * side);
            }
        }
    }
    for (vtkFloatArray* array : {here_.Get(), previous_.Get(), next_.Get()}) array->Modified();
    data_->Modified();
}

void StrokeActor::set_cut(const std::optional<CuttingPlane>& plane, const Eigen::RowVector3d& origin,
                          double mesh_size) {
    const std::array<float, 4> cut = cut_coefficients(plane, origin, mesh_size);
    actor_->GetShaderProperty()->GetVertexCustomUniforms()->SetUniform4f("strokeCut", cut.data());
}

void StrokeActor::set_style(const StrokeStyle& style) {
    style_ = style;
    actor_->GetProperty()->SetColor(style.color[0], style.color[1], style.color[2]);
    vtkUniforms* uniforms = actor_->GetShaderProperty()->GetVertexCustomUniforms();
    uniforms->SetUniformf("strokeBias", static_cast<float>(style.depth_bias));
    uniforms->SetUniformf("strokeCap", static_cast<float>(style.cap));
    uniforms->SetUniformi("strokeOnTop", style.is_on_top ? 1 : 0);
    uniforms->SetUniformi("strokeFades", style.fades ? 1 : 0);
    uniforms->SetUniformi("strokeInPixels", style.is_in_pixels ? 1 : 0);
    actor_->GetShaderProperty()->GetFragmentCustomUniforms()->SetUniformf("strokeOpacity",
                                                                          static_cast<float>(style.opacity));
}

void StrokeActor::update(const ViewMetrics& view) {
    vtkUniforms* uniforms = actor_->GetShaderProperty()->GetVertexCustomUniforms();
    uniforms->SetUniformf("strokeViewWidth", static_cast<float>(view.size[0]));
    uniforms->SetUniformf("strokeViewHeight", static_cast<float>(view.size[1]));
    uniforms->SetUniformf("strokePixelScale", static_cast<float>(view.pixel_scale));
    uniforms->SetUniformi("strokeIsParallel", view.is_parallel ? 1 : 0);
    uniforms->SetUniformf("strokeRatio", static_cast<float>(view.pixel_ratio));
    uniforms->SetUniformf("strokeWidth", static_cast<float>(style_.width * view.pixel_ratio));
    uniforms->SetUniformf("strokeDash", static_cast<float>(style_.dash * view.pixel_ratio));
}

}  // namespace curvewright
