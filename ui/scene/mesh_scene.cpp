#include "ui/scene/mesh_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCullerCollection.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include "core/base/error.h"
#include "ui/scene/camera_control.h"
#include "ui/scene/element_spacing.h"
#include "ui/scene/interactor_style.h"
#include "ui/scene/legend.h"
#include "ui/scene/mark_actors.h"
#include "ui/scene/node_actor.h"
#include "ui/scene/orientation_axes.h"
#include "ui/scene/picking.h"
#include "ui/scene/stroke_actor.h"
#include "ui/scene/surface_actor.h"
#include "ui/scene/tangled_marks.h"

namespace curvewright {
namespace {

constexpr Color neutral_color{0.80, 0.84, 0.88};

/// The lines of a tessellation that are (or are not) on the boundary of a flat mesh.
Polylines select_lines(const Tessellation& tessellation, const std::vector<float>& spacing, bool on_boundary) {
    Polylines lines;
    const auto& offsets = tessellation.line_offsets();
    for (std::size_t line = 0; line + 1 < offsets.size(); ++line) {
        if ((tessellation.line_is_boundary()[line] != 0) != on_boundary) continue;
        const auto begin = tessellation.edge_points().begin();
        lines.points.insert(lines.points.end(), begin + 3 * offsets[line], begin + 3 * offsets[line + 1]);
        lines.offsets.push_back(static_cast<Index>(lines.points.size() / 3));
        lines.spacing.push_back(spacing[line]);
    }
    return lines;
}

/// Their points alone, in the same order.
std::vector<float> select_points(const Tessellation& tessellation, bool on_boundary) {
    std::vector<float> points;
    points.reserve(tessellation.edge_points().size());
    const auto& offsets = tessellation.line_offsets();
    const auto begin = tessellation.edge_points().begin();
    for (std::size_t line = 0; line + 1 < offsets.size(); ++line)
        if ((tessellation.line_is_boundary()[line] != 0) == on_boundary)
            points.insert(points.end(), begin + 3 * offsets[line], begin + 3 * offsets[line + 1]);
    return points;
}

/// Where elements are many they are small on the screen, and the chord tolerance alone is enough: pieces are what a
/// frame costs. Few elements are cut finer, so that they stay smooth when one comes close.
TessellationOptions tessellation_options(const MeshTopology& topology, double element_size) {
    TessellationOptions options;
    options.element_size = element_size;
    const std::size_t faces = topology.dimension() == 3 ? topology.boundary_facets().size()
                                                        : static_cast<std::size_t>(topology.element_count());
    options.min_subdivisions = faces <= 8000 ? 4 : faces <= 40000 ? 2 : 1;
    return options;
}

/// One flag per element; empty = all are visible.
std::vector<bool> find_visible(const CurvedMesh& mesh, const std::optional<ClipPlane>& clip) {
    if (!clip || clip->position >= 1.0 || mesh.topology().dimension() < 3) return {};
    const Eigen::Vector3d normal(clip->normal[0], clip->normal[1], clip->normal[2]);
    double low = 0.0, high = 0.0;
    bool is_first = true;
    std::vector<double> centers;
    for (Index element = 0; element < mesh.topology().element_count(); ++element) {
        for (Index node : mesh.topology().element_nodes(element)) {
            const double along = mesh.coordinates().row(node).dot(normal);
            low = is_first ? along : std::min(low, along);
            high = is_first ? along : std::max(high, along);
            is_first = false;
        }
        centers.push_back(mesh.element_center(element).dot(normal));
    }
    const double limit = low + clip->position * (high - low);
    std::vector<bool> visible(centers.size());
    for (std::size_t i = 0; i < centers.size(); ++i) visible[i] = clip->position > 0.0 && centers[i] <= limit;
    return visible;
}

}  // namespace

struct MeshScene::Parts {
    vtkNew<vtkRenderer> renderer;
    SceneOptions options;
    std::optional<CurvedMesh> mesh;
    std::optional<QualityReport> quality;
    std::vector<Index> highlighted;

    WorldFrame frame;
    std::vector<bool> visible;
    std::unique_ptr<Tessellation> tessellation;
    double typical_spacing = 0.0;                                 ///< world
    std::chrono::steady_clock::time_point next_fineness_check{};  ///< of a motion

    CameraControl camera{renderer};
    SurfaceActor surface;
    StrokeActor edges, boundary;
    TangledMarks marks{add_base_actors()};
    NodeActors nodes;
    StrokeActor highlight_halo, highlight;
    MarkActors edit_marks{add_top_actors()};
    Legend legend{renderer};
    OrientationAxes axes{renderer};
    vtkNew<vtkCallbackCommand> frame_observer;
    vtkSmartPointer<SceneInteractorStyle> style;

    Parts() {
        // Our actors have no bounds (ribbons and rings live on the screen); there is nothing to cull.
        renderer->GetCullers()->RemoveAllItems();
        frame_observer->SetClientData(this);
        frame_observer->SetCallback(
            [](vtkObject*, unsigned long, void* self, void*) { static_cast<Parts*>(self)->prepare_frame(); });
        renderer->AddObserver(vtkCommand::StartEvent, frame_observer);
        apply_options();
    }
    ~Parts() {
        if (style) style->connect(nullptr, {});
        renderer->RemoveObserver(frame_observer);
    }

    // Members are drawn in the order in which they are added: what lies above comes later.
    vtkRenderer* add_base_actors() {
        for (vtkActor* actor : {surface.actor(), edges.actor(), boundary.actor()}) renderer->AddActor(actor);
        return renderer;
    }
    vtkRenderer* add_top_actors() {
        for (vtkActor* actor : {nodes.others(), nodes.corners(), highlight_halo.actor(), highlight.actor()})
            renderer->AddActor(actor);
        return renderer;
    }

    bool is_flat() const { return !mesh || mesh->topology().dimension() < 3; }

    Color color_of(Index element) const {
        if (!quality) return neutral_color;
        const ElementQuality& its = quality->elements[element];
        return quality_color(its.scaled_jacobian, its.validity);
    }

    void apply_options() {
        const Color& background = options.background;
        renderer->SetBackground(background[0], background[1], background[2]);
        edges.set_style(
            {.color = options.edge_color, .opacity = 0.75, .width = 1.1, .depth_bias = 4e-4, .fades = true});
        boundary.set_style({.color = options.edge_color, .width = 1.6, .depth_bias = 5e-4});
        edges.actor()->SetVisibility(options.show_edges && tessellation);
        boundary.actor()->SetVisibility(tessellation && is_flat());
        highlight_halo.set_style({.color = background, .width = 6.5, .cap = 1.0, .is_on_top = true});
        // Nearer than the halo of every other side of the element.
        highlight.set_style(
            {.color = options.accent, .width = 3.0, .cap = 1.0, .depth_bias = 0.011, .is_on_top = true});
        nodes.set_colors(options.edge_color, background, options.edge_color);
        nodes.set_visible(options.show_nodes);
        legend.set_colors(background, options.foreground);
        legend.set_visible(options.show_legend);
        axes.set_colors(background, options.foreground);
        edit_marks.set_colors(background, options.accent, options.foreground);
    }

    /// Makes the drawing of the mesh anew, or moves it if nothing but positions has changed.
    void draw_mesh(bool may_move) {
        std::vector<bool> now_visible = find_visible(*mesh, options.clip);
        if (options.only_elements) {
            const std::vector<bool> cut = std::exchange(now_visible, {});
            now_visible.assign(static_cast<std::size_t>(mesh->topology().element_count()), false);
            for (const Index element : *options.only_elements)
                if (element >= 0 && element < mesh->topology().element_count())
                    now_visible[static_cast<std::size_t>(element)] =
                        cut.empty() || cut[static_cast<std::size_t>(element)];
        }
        const bool moves =
            may_move && tessellation && now_visible == visible && tessellation->is_fine_enough(mesh->coordinates());
        visible = std::move(now_visible);
        if (moves)
            tessellation->move(mesh->coordinates());
        else
            tessellation = std::make_unique<Tessellation>(*mesh, visible,
                                                          tessellation_options(mesh->topology(), options.element_size));
        surface.set_lit(!is_flat());
        surface.set_surface(*tessellation, !moves);
        surface.set_colors(*tessellation, [this](Index element) { return color_of(element); });
        frame.place(surface.actor(), tessellation->origin());
        const std::vector<float> spacing = line_spacing(*mesh, *tessellation);
        typical_spacing = median(spacing) / frame.size;
        edges.set_lines(select_lines(*tessellation, spacing, false), 1.0 / frame.size);
        boundary.set_lines(select_lines(*tessellation, spacing, true), 1.0 / frame.size);
        frame.place(edges.actor(), tessellation->origin());
        frame.place(boundary.actor(), tessellation->origin());
        nodes.set_nodes(*mesh, *tessellation, frame);
        if (quality)
            marks.set_mesh(*mesh, *quality, visible, *tessellation, frame);
        else
            marks.clear();
        draw_highlight();
        set_camera_content();
        apply_options();
    }

    /// A frame of a motion: see MeshScene::show_frame.
    void draw_frame(bool has_new_quality) {
        // Telling whether a side bends too much for its chords costs as much as moving all of them: a tenth of the
        // time.
        const auto now = std::chrono::steady_clock::now();
        if (now >= next_fineness_check) {
            const bool is_fine = tessellation->is_fine_enough(mesh->coordinates());
            const auto end = std::chrono::steady_clock::now();
            next_fineness_check = end + 9 * (end - now);
            if (!is_fine) {
                draw_mesh(false);
                return;
            }
        }
        tessellation->move(mesh->coordinates());
        // Lines between very small elements are many and hardly seen: not while things move.
        constexpr double seen_spacing = 6.0;  // units of the pixel ratio
        constexpr std::size_t many_lines = 20000;
        const bool are_too_many =
            tessellation->line_elements().size() > many_lines &&
            typical_spacing * view().pixels_per_unit(camera.distance()) < seen_spacing * options.pixel_ratio;
        edges.actor()->SetVisibility(options.show_edges && !are_too_many);
        surface.set_surface(*tessellation, false);
        if (has_new_quality) surface.set_colors(*tessellation, [this](Index element) { return color_of(element); });
        if (!are_too_many) edges.move_lines(select_points(*tessellation, false));
        boundary.move_lines(select_points(*tessellation, true));
        if (options.show_nodes) nodes.set_nodes(*mesh, *tessellation, frame);
        if (quality && has_new_quality) marks.set_mesh(*mesh, *quality, visible, *tessellation, frame);
        if (!highlighted.empty()) draw_highlight();
    }

    void set_camera_content() {
        std::vector<float> points;
        const Eigen::RowVector3d offset = frame.to_world(tessellation->origin());
        for (const auto* source : {&tessellation->surface_points(), &tessellation->edge_points()})
            for (std::size_t i = 0; i < source->size(); ++i)
                points.push_back(
                    static_cast<float>((*source)[i] / frame.size + offset[static_cast<Eigen::Index>(i % 3)]));
        camera.set_content(std::move(points));
    }

    void draw_highlight() {
        Polylines lines;
        Eigen::RowVector3d origin = frame.origin;
        std::vector<bool> flags(mesh ? static_cast<std::size_t>(mesh->topology().element_count()) : 0, false);
        bool has_any = false;
        for (Index element : highlighted)
            if (element >= 0 && static_cast<std::size_t>(element) < flags.size()) flags[element] = has_any = true;
        if (has_any) {
            // Every element on its own, so that the sides between two of them are drawn as well.
            const Tessellation outline(*mesh, flags);
            lines.points = outline.edge_points();
            lines.offsets = outline.line_offsets();
            origin = outline.origin();
        }
        for (StrokeActor* stroke : {&highlight_halo, &highlight}) {
            stroke->set_lines(lines, 1.0 / frame.size);
            frame.place(stroke->actor(), origin);
        }
    }

    void clear() {
        tessellation.reset();
        visible.clear();
        surface.clear();
        for (StrokeActor* stroke : {&edges, &boundary, &highlight_halo, &highlight}) stroke->clear();
        nodes.set_visible(false);
        marks.clear();
        edit_marks.set_marks({}, frame);
        camera.set_content({});
    }

    void prepare_frame() {
        const double ratio = options.pixel_ratio;
        axes.set_visible(mesh && !is_flat());
        camera.set_right_margin(legend.width(ratio));
        camera.prepare_frame();
        const ViewMetrics view = camera.metrics(ratio);
        surface.update(view);
        for (StrokeActor* stroke : {&edges, &boundary, &highlight_halo, &highlight}) stroke->update(view);
        const double focal_distance = view.is_parallel ? 1.0 : camera.distance();
        nodes.update(view, typical_spacing, focal_distance);
        marks.update(view);
        edit_marks.update(view);
        legend.update(view);
        axes.update(view);
    }

    ViewMetrics view() const { return camera.metrics(options.pixel_ratio); }

    std::optional<Pick> pick(double x, double y) const {
        if (!tessellation) return std::nullopt;
        return pick_surface(*tessellation, frame, camera.metrics(options.pixel_ratio), x, y, [this](Index element) {
            return quality && quality->elements[element].validity == Validity::invalid ? 1 : 0;
        });
    }
};

MeshScene::MeshScene() : parts_(std::make_unique<Parts>()) {}

MeshScene::~MeshScene() = default;

vtkRenderer* MeshScene::renderer() const {
    return parts_->renderer;
}

void MeshScene::set_mesh(const CurvedMesh* mesh, const QualityReport* quality) {
    Parts& parts = *parts_;
    if (mesh && quality && quality->elements.size() != static_cast<std::size_t>(mesh->topology().element_count()))
        throw InvalidInput("The quality report to be drawn belongs to a mesh with another number of elements.");
    const bool has_same_topology = mesh && parts.mesh && mesh->shared_topology() == parts.mesh->shared_topology();
    parts.mesh.reset();
    parts.quality.reset();
    if (mesh) parts.mesh = *mesh;
    if (mesh && quality) parts.quality = *quality;
    parts.legend.set_summary(parts.quality ? std::optional(parts.quality->summary) : std::nullopt);
    if (!mesh) {
        parts.highlighted.clear();
        parts.clear();
        return;
    }
    if (!has_same_topology) {
        const auto box = bounding_box(*mesh);
        const double diagonal = (box.row(1) - box.row(0)).norm();
        parts.frame = {0.5 * (box.row(0) + box.row(1)), diagonal > 0.0 ? diagonal : 1.0};
        parts.highlighted.clear();
    }
    parts.draw_mesh(has_same_topology);
    if (!has_same_topology) {
        parts.camera.set_flat(parts.is_flat());
        look(ViewDirection::isometric);
    }
}

void MeshScene::show_frame(const Coordinates& positions, const QualityReport* quality) {
    Parts& parts = *parts_;
    if (!parts.mesh) return;
    parts.mesh = parts.mesh->with_coordinates(positions);
    if (quality) {
        if (quality->elements.size() != static_cast<std::size_t>(parts.mesh->topology().element_count()))
            throw InvalidInput("The quality report of a frame belongs to a mesh with another number of elements.");
        parts.quality = *quality;
        parts.legend.set_summary(quality->summary);
    }
    parts.draw_frame(quality != nullptr);
}

void MeshScene::set_options(const SceneOptions& options) {
    Parts& parts = *parts_;
    const SceneOptions before_options = parts.options;
    const std::optional<ClipPlane>& before = before_options.clip;
    parts.options = options;
    const bool is_size_changed = before_options.element_size != options.element_size;
    const bool is_clip_changed =
        is_size_changed || before_options.only_elements != options.only_elements ||
        before.has_value() != options.clip.has_value() ||
        (before && (before->normal != options.clip->normal || before->position != options.clip->position));
    if (parts.mesh && is_clip_changed)
        parts.draw_mesh(!is_size_changed);
    else
        parts.apply_options();
}

const SceneOptions& MeshScene::options() const {
    return parts_->options;
}

void MeshScene::set_highlighted_elements(const std::vector<Index>& elements) {
    parts_->highlighted = elements;
    parts_->draw_highlight();
}

void MeshScene::look(ViewDirection direction) {
    parts_->camera.set_right_margin(parts_->legend.width(parts_->options.pixel_ratio));
    parts_->camera.look(direction);
}

void MeshScene::focus_element(Index element) {
    const Parts& parts = *parts_;
    if (!parts.mesh || element < 0 || element >= parts.mesh->topology().element_count()) return;
    const Eigen::MatrixX3d x = parts.mesh->element_coordinates(element);
    const Eigen::RowVector3d center = 0.5 * (x.colwise().minCoeff() + x.colwise().maxCoeff());
    const double radius = (x.rowwise() - center).rowwise().norm().maxCoeff();
    Eigen::RowVector3d facing = Eigen::RowVector3d::Zero();
    const Tessellation& drawn = *parts.tessellation;
    for (std::size_t triangle = 0; triangle < drawn.triangle_elements().size(); ++triangle) {
        if (drawn.triangle_elements()[triangle] != element) continue;
        const float* normal = drawn.surface_normals().data() + 3 * drawn.triangles()[3 * triangle];
        facing += Eigen::RowVector3d(normal[0], normal[1], normal[2]);
    }
    parts_->camera.focus(parts.frame.to_world(center), radius / parts.frame.size, facing);
}

void MeshScene::focus_ball(const Eigen::RowVector3d& center, double radius) {
    if (!parts_->mesh) return;
    // focus() leaves room for the surroundings of an element: a ball that is to fill the view counts for less.
    constexpr double filling = 0.25;
    const double size = radius > 0.0 ? radius / parts_->frame.size : 0.05;
    parts_->camera.focus(parts_->frame.to_world(center), filling * size, Eigen::RowVector3d::Zero());
}

bool MeshScene::draws_element(Index element) const {
    if (!parts_->tessellation) return false;
    const std::vector<Index>& drawn = parts_->tessellation->triangle_elements();
    return std::find(drawn.begin(), drawn.end(), element) != drawn.end();
}

std::optional<Index> MeshScene::pick_element(double x, double y) const {
    const std::optional<Pick> pick = parts_->pick(x, y);
    return pick ? std::optional(pick->element) : std::nullopt;
}

void MeshScene::set_marks(const Marks& marks) {
    parts_->edit_marks.set_marks(marks, parts_->frame);
}

bool MeshScene::is_flat() const {
    return parts_->is_flat();
}

Eigen::Vector4d MeshScene::project(const Eigen::RowVector3d& point) const {
    return parts_->view().project(parts_->frame.to_world(point));
}

Eigen::RowVector3d MeshScene::unproject(double x, double y, const Eigen::RowVector3d& at_depth_of) const {
    const double depth = project(at_depth_of)[2];
    Eigen::RowVector3d point = parts_->frame.to_mesh(parts_->camera.unproject(x, y, depth).transpose());
    if (is_flat()) point[2] = at_depth_of[2];
    return point;
}

double MeshScene::units_per_pixel(const Eigen::RowVector3d& at) const {
    const double divisor = project(at)[3];
    return parts_->frame.size / std::max(parts_->view().pixels_per_unit(divisor), 1e-12);
}

Eigen::Matrix3d MeshScene::view_axes() const {
    return parts_->camera.axes();
}

std::optional<Index> MeshScene::pick_node(double x, double y, double radius,
                                          const std::function<bool(Index)>& accepts) const {
    if (!parts_->tessellation) return std::nullopt;
    return pick_drawn_node(*parts_->mesh, *parts_->tessellation, parts_->frame, parts_->view(), x, y, radius,
                           !is_flat(), accepts);
}

std::vector<Index> MeshScene::nodes_inside(const std::vector<std::array<double, 2>>& polygon, bool see_through) const {
    if (!parts_->tessellation) return {};
    return pick_nodes_inside(*parts_->mesh, *parts_->tessellation, parts_->frame, parts_->view(), polygon,
                             !is_flat() && !see_through);
}

std::vector<Index> MeshScene::elements_inside(const std::vector<std::array<double, 2>>& polygon,
                                              bool see_through) const {
    if (!parts_->tessellation) return {};
    return pick_elements_inside(*parts_->tessellation, parts_->frame, parts_->view(), polygon,
                                !is_flat() && !see_through);
}

CameraState MeshScene::camera_state() const {
    return parts_->camera.state();
}

void MeshScene::set_camera_state(const CameraState& state) {
    parts_->camera.set_state(state);
}

const WorldFrame& MeshScene::world_frame() const {
    return parts_->frame;
}

void MeshScene::copy_view(const MeshScene& other, bool is_exact) {
    if (!parts_->mesh || !other.parts_->mesh) return;
    parts_->camera.copy_view(other.parts_->camera, other.parts_->frame, parts_->frame, is_exact);
}

void MeshScene::attach_interactor(vtkRenderWindowInteractor* interactor) {
    Parts& parts = *parts_;
    if (parts.style) parts.style->connect(nullptr, {});
    parts.style = vtkSmartPointer<SceneInteractorStyle>::New();
    parts.style->connect(&parts.camera, [&parts](double x, double y) -> std::optional<double> {
        const std::optional<Pick> pick = parts.pick(x, y);
        return pick ? std::optional(pick->depth) : std::nullopt;
    });
    interactor->SetInteractorStyle(parts.style);
}

}  // namespace curvewright
