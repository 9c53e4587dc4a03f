#include "ui/scene/mesh_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCullerCollection.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include "core/base/error.h"
#include "core/tessellate/plane_cut.h"
#include "ui/scene/camera_control.h"
#include "ui/scene/element_spacing.h"
#include "ui/scene/interactor_style.h"
#include "ui/scene/legend.h"
#include "ui/scene/mark_actors.h"
#include "ui/scene/node_actor.h"
#include "ui/scene/number_labels.h"
#include "ui/scene/orientation_axes.h"
#include "ui/scene/picking.h"
#include "ui/scene/stroke_actor.h"
#include "ui/scene/surface_actor.h"
#include "ui/scene/tangled_marks.h"

namespace curvewright {
namespace {

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
/// frame costs. Few elements are cut finer, so that they stay smooth when one comes close. has_field: numbers on nodes
/// are to be seen.
TessellationOptions tessellation_options(const MeshTopology& topology, double element_size, bool has_field) {
    TessellationOptions options;
    options.element_size = element_size;
    const std::size_t faces = topology.dimension() == 3 ? topology.boundary_facets().size()
                                                        : static_cast<std::size_t>(topology.element_count());
    options.min_subdivisions = faces <= 8000 ? 4 : faces <= 40000 ? 2 : 1;
    if (has_field) {
        const int whole = 2 * topology.order();
        options.field_subdivisions = std::max(2, faces <= 2000 ? whole : faces <= 8000 ? (whole + 1) / 2 : 2);
    }
    return options;
}

/// The plane that a clip plane stands for; none if it hides nothing.
std::optional<CuttingPlane> find_plane(const CurvedMesh& mesh, const std::optional<ClipPlane>& clip) {
    if (!clip || clip->position >= 1.0 || mesh.topology().dimension() < 3) return std::nullopt;
    const Eigen::RowVector3d normal(clip->normal[0], clip->normal[1], clip->normal[2]);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (Index element = 0; element < mesh.topology().element_count(); ++element)
        for (Index node : mesh.topology().element_nodes(element)) {
            const double along = mesh.coordinates().row(node).dot(normal);
            low = std::min(low, along);
            high = std::max(high, along);
        }
    // All is hidden, what bulges over the nodes as well.
    if (clip->position <= 0.0) return CuttingPlane{normal, low - (high - low)};
    return CuttingPlane{normal, low + clip->position * (high - low)};
}

/// One flag per element; empty = all are visible.
std::vector<bool> find_visible(const CurvedMesh& mesh, const std::optional<ClipPlane>& clip) {
    if (!clip || clip->style != ClipStyle::whole_elements) return {};
    const std::optional<CuttingPlane> plane = find_plane(mesh, clip);
    if (!plane) return {};
    std::vector<bool> visible(static_cast<std::size_t>(mesh.topology().element_count()));
    for (Index element = 0; element < mesh.topology().element_count(); ++element)
        visible[static_cast<std::size_t>(element)] = plane->distance(mesh.element_center(element)) <= 0.0;
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
    std::unique_ptr<PlaneCut> section;                     ///< none: nothing is cut
    double typical_spacing = 0.0;                          ///< world
    int fineness_part = 0;                                 ///< of the pieces, looked at last in a motion
    std::chrono::steady_clock::time_point next_section{};  ///< of a motion

    CameraControl camera{renderer};
    SurfaceActor surface, section_surface;
    SurfacePainter painter;
    StrokeActor edges, boundary, section_edges;
    TangledMarks marks{add_base_actors()};
    NodeActors nodes;
    StrokeActor highlight_halo, highlight;
    MarkActors edit_marks{add_top_actors()};
    NumberLabels numbers{renderer};
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
        for (vtkActor* actor :
             {surface.actor(), section_surface.actor(), edges.actor(), boundary.actor(), section_edges.actor()})
            renderer->AddActor(actor);
        return renderer;
    }
    vtkRenderer* add_top_actors() {
        for (vtkActor* actor : {nodes.others(), nodes.corners(), highlight_halo.actor(), highlight.actor()})
            renderer->AddActor(actor);
        return renderer;
    }

    bool is_flat() const { return !mesh || mesh->topology().dimension() < 3; }

    void paint() {
        painter.paint(surface, *tessellation, *mesh, quality ? &*quality : nullptr);
        if (section) painter.paint_section(section_surface, *section);
        update_legend();
    }

    void update_legend() {
        const Coloring& coloring = painter.coloring();
        const bool has_bar = painter.has_values() && coloring.source != Coloring::Source::plain;
        legend.set_content({coloring.title, coloring.detail, painter.scale(),
                            coloring.source == Coloring::Source::scaled_jacobian, has_bar, painter.has_missing()});
    }

    void apply_options() {
        const Color& background = options.background;
        camera.set_orthographic(options.is_orthographic);
        renderer->SetBackground(background[0], background[1], background[2]);
        for (StrokeActor* lines : {&edges, &section_edges})
            lines->set_style(
                {.color = options.edge_color, .opacity = 0.75, .width = 1.1, .depth_bias = 4e-4, .fades = true});
        boundary.set_style({.color = options.edge_color, .width = 1.6, .depth_bias = 5e-4});
        edges.actor()->SetVisibility(options.show_edges && tessellation);
        section_edges.actor()->SetVisibility(options.show_edges && section && !section->line_elements().empty());
        boundary.actor()->SetVisibility(tessellation && is_flat());
        highlight_halo.set_style({.color = background, .width = 6.5, .cap = 1.0, .is_on_top = true});
        // Nearer than the halo of every other side of the element.
        highlight.set_style(
            {.color = options.accent, .width = 3.0, .cap = 1.0, .depth_bias = 0.011, .is_on_top = true});
        nodes.set_colors(options.edge_color, background, options.edge_color);
        nodes.set_visible(options.show_nodes);
        legend.set_colors(background, options.foreground);
        legend.set_visible(options.show_legend);
        legend.set_font(options.font);
        axes.set_colors(background, options.foreground);
        edit_marks.set_colors(background, options.accent, options.foreground);
        numbers.set_colors(background, options.foreground, options.accent);
        numbers.set_font(options.font);
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
            tessellation = std::make_unique<Tessellation>(
                *mesh, visible, tessellation_options(mesh->topology(), options.element_size, painter.is_on_nodes()));
        surface.set_lit(!is_flat());
        surface.set_surface(*tessellation, !moves);
        section.reset();  // of another state; draw_cut() makes it anew
        paint();
        frame.place(surface.actor(), tessellation->origin());
        const std::vector<float> spacing = line_spacing(*mesh, *tessellation);
        typical_spacing = median(spacing) / frame.size;
        edges.set_lines(select_lines(*tessellation, spacing, false), 1.0 / frame.size);
        boundary.set_lines(select_lines(*tessellation, spacing, true), 1.0 / frame.size);
        frame.place(edges.actor(), tessellation->origin());
        frame.place(boundary.actor(), tessellation->origin());
        nodes.set_nodes(*mesh, *tessellation, frame);
        draw_cut();
    }

    /// What a clip plane that goes through the elements changes, and all that depends on it.
    void draw_cut() {
        const bool is_cut = options.clip && options.clip->style == ClipStyle::cut;
        const std::optional<CuttingPlane> plane = is_cut ? find_plane(*mesh, options.clip) : std::nullopt;
        section.reset();
        if (plane) find_section(*plane);
        draw_section();
        set_cut_of_marks();
        if (quality)
            marks.set_mesh(*mesh, *quality, visible, *tessellation, section.get(), frame);
        else
            marks.clear();
        draw_highlight();
        set_camera_content();
        set_numbers();
        apply_options();
    }

    void find_section(const CuttingPlane& plane) {
        PlaneCutOptions its;
        const TessellationOptions drawn =
            tessellation_options(mesh->topology(), options.element_size, painter.is_on_nodes());
        its.min_subdivisions = std::max(2, drawn.min_subdivisions);
        its.element_size = options.element_size;
        section = std::make_unique<PlaneCut>(*mesh, plane, visible, its);
    }

    std::optional<CuttingPlane> cutting_plane() const {
        return section ? std::optional(section->plane()) : std::nullopt;
    }

    /// The section, and what its plane leaves of surface, edges and nodes.
    void draw_section() {
        const std::optional<CuttingPlane> plane = cutting_plane();
        surface.set_cut(plane, tessellation->origin(), frame.size);
        edges.set_cut(plane, tessellation->origin(), frame.size);
        nodes.set_cut(plane, tessellation->origin(), frame.size);
        if (!section) {
            section_surface.clear();
            section_edges.clear();
            return;
        }
        section_surface.set_lit(true);
        painter.paint_section(section_surface, *section);
        frame.place(section_surface.actor(), section->origin());
        Polylines lines;
        std::vector<Index> elements;
        lines.add_section(*section, section->origin(), [&](std::size_t line) {
            if (section->line_is_first()[line]) elements.push_back(section->line_elements()[line]);
            return section->line_is_first()[line] != 0;
        });
        lines.spacing = line_spacing(*mesh, elements);
        section_edges.set_lines(lines, 1.0 / frame.size);
        section_edges.actor()->SetVisibility(options.show_edges && !elements.empty());
        frame.place(section_edges.actor(), section->origin());
    }

    /// Numbers of what is drawn.
    void set_numbers() {
        std::vector<NumberLabel> labels;
        if (tessellation && options.show_element_numbers)
            for (const FaceMiddle& middle : face_middles(drawn()))
                labels.push_back({NumberKind::element, mesh->topology().element_tag(middle.element).value,
                                  middle.element, frame.to_world(middle.at)});
        if (tessellation && options.show_node_numbers)
            for (const Index node : tessellation->nodes()) {
                const Eigen::RowVector3d at = mesh->coordinates().row(node);
                if (section && section->plane().distance(at) > 0.0) continue;
                labels.push_back({NumberKind::node, mesh->topology().node_tag(node).value, node, frame.to_world(at)});
            }
        numbers.set_labels(std::move(labels));
    }

    void set_cut_of_marks() { edit_marks.set_cut(cutting_plane(), frame); }

    DrawnSurface drawn() const { return {*tessellation, section.get()}; }

    /// A frame of a motion: see MeshScene::show_frame.
    void draw_frame(bool has_moved, bool has_new_quality) {
        // Telling whether a side bends too much for its chords costs as much as moving all of them: a part per frame.
        constexpr int parts = 12;
        fineness_part = (fineness_part + 1) % parts;
        if (has_moved && !tessellation->is_fine_enough(mesh->coordinates(), fineness_part, parts)) {
            draw_mesh(false);
            return;
        }
        if (has_moved) tessellation->move(mesh->coordinates());
        // Lines between very small elements are many and hardly seen: not while things move.
        constexpr double seen_spacing = 6.0;  // units of the pixel ratio
        constexpr std::size_t many_lines = 20000;
        const bool are_too_many =
            tessellation->line_elements().size() > many_lines &&
            typical_spacing * view().pixels_per_unit(camera.distance()) < seen_spacing * options.pixel_ratio;
        edges.actor()->SetVisibility(options.show_edges && !are_too_many);
        if (has_moved) surface.set_surface(*tessellation, false);
        const bool is_quality = painter.coloring().source == Coloring::Source::scaled_jacobian;
        if ((has_moved && painter.follows_motion()) || (has_new_quality && is_quality)) paint();
        if (has_moved && !are_too_many) edges.move_lines(select_points(*tessellation, false));
        if (has_moved) boundary.move_lines(select_points(*tessellation, true));
        if (has_moved && options.show_nodes) nodes.set_nodes(*mesh, *tessellation, frame);
        // The section follows in every frame if that is quick, else in a part of the time, and with every new report.
        const auto now = std::chrono::steady_clock::now();
        if (section && (has_new_quality || now >= next_section)) {
            find_section(CuttingPlane(section->plane()));
            draw_section();
            const auto end = std::chrono::steady_clock::now();
            constexpr auto quick = std::chrono::milliseconds(25);
            next_section = end - now <= quick ? end : end + 2 * (end - now);
        }
        if (quality && has_new_quality) marks.set_mesh(*mesh, *quality, visible, *tessellation, section.get(), frame);
        if (has_moved && !highlighted.empty()) draw_highlight();
        if (has_moved) set_numbers();
    }

    void set_camera_content() {
        std::vector<float> points;
        const Eigen::RowVector3d offset = frame.to_world(tessellation->origin());
        const auto add = [&](const std::vector<float>& source, const Eigen::RowVector3d& its_offset, bool is_cut) {
            for (std::size_t i = 0; i + 2 < source.size(); i += 3) {
                const Eigen::RowVector3d at(source[i], source[i + 1], source[i + 2]);
                if (is_cut && section->plane().distance(at + tessellation->origin()) > 0.0) continue;
                for (Eigen::Index d = 0; d < 3; ++d)
                    points.push_back(static_cast<float>(at[d] / frame.size + its_offset[d]));
            }
        };
        for (const auto* source : {&tessellation->surface_points(), &tessellation->edge_points()})
            add(*source, offset, section != nullptr);
        if (section) add(section->points(), frame.to_world(section->origin()), false);
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
            if (section)
                lines.add_section(*section, origin, [&](std::size_t line) {
                    return flags[static_cast<std::size_t>(section->line_elements()[line])];
                });
        }
        for (StrokeActor* stroke : {&highlight_halo, &highlight}) {
            stroke->set_cut(cutting_plane(), origin, frame.size);
            stroke->set_lines(lines, 1.0 / frame.size);
            frame.place(stroke->actor(), origin);
        }
    }

    void clear() {
        tessellation.reset();
        section.reset();
        legend.set_content({});
        visible.clear();
        for (SurfaceActor* its : {&surface, &section_surface}) its->clear();
        for (StrokeActor* stroke : {&edges, &boundary, &section_edges, &highlight_halo, &highlight}) stroke->clear();
        nodes.set_visible(false);
        marks.clear();
        set_numbers();
        edit_marks.set_marks({}, frame);
        camera.set_content({});
    }

    void prepare_frame() {
        const double ratio = options.pixel_ratio;
        axes.set_visible(mesh && !is_flat());
        camera.set_right_margin(legend.width(ratio));
        camera.prepare_frame();
        const ViewMetrics view = camera.metrics(ratio);
        for (SurfaceActor* its : {&surface, &section_surface}) its->update(view);
        for (StrokeActor* stroke : {&edges, &boundary, &section_edges, &highlight_halo, &highlight})
            stroke->update(view);
        const double focal_distance = view.is_parallel ? 1.0 : camera.distance();
        nodes.update(view, typical_spacing, focal_distance);
        marks.update(view);
        edit_marks.update(view);
        const std::optional<DrawnSurface> hiding = tessellation && !is_flat() ? std::optional(drawn()) : std::nullopt;
        numbers.update(view, hiding ? &*hiding : nullptr, frame, {legend.width(ratio), axes.size(ratio)});
        legend.update(view);
        axes.update(view);
    }

    ViewMetrics view() const { return camera.metrics(options.pixel_ratio); }

    std::optional<Pick> pick(double x, double y) const {
        if (!tessellation) return std::nullopt;
        return pick_surface(drawn(), frame, camera.metrics(options.pixel_ratio), x, y, [this](Index element) {
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
    // Quality that follows a moment later comes with the positions that are shown already.
    const bool has_moved =
        positions.rows() != parts.mesh->coordinates().rows() || positions != parts.mesh->coordinates();
    if (has_moved) parts.mesh = parts.mesh->with_coordinates(positions);
    if (quality) {
        if (quality->elements.size() != static_cast<std::size_t>(parts.mesh->topology().element_count()))
            throw InvalidInput("The quality report of a frame belongs to a mesh with another number of elements.");
        parts.quality = *quality;
        parts.legend.set_summary(quality->summary);
    }
    parts.draw_frame(has_moved, quality != nullptr);
}

void MeshScene::set_options(const SceneOptions& options) {
    Parts& parts = *parts_;
    const SceneOptions before_options = parts.options;
    const std::optional<ClipPlane>& before = before_options.clip;
    parts.options = options;
    const bool is_size_changed = before_options.element_size != options.element_size;
    const bool is_clip_changed = before != options.clip;
    const auto hides_whole = [](const std::optional<ClipPlane>& clip) {
        return clip && clip->style == ClipStyle::whole_elements;
    };
    if (parts.mesh && (is_size_changed || before_options.only_elements != options.only_elements ||
                       (is_clip_changed && (hides_whole(before) || hides_whole(options.clip)))))
        parts.draw_mesh(!is_size_changed);
    else if (parts.mesh && is_clip_changed)
        parts.draw_cut();  // the surface is the same, only cut elsewhere
    else {
        if (before_options.show_node_numbers != options.show_node_numbers ||
            before_options.show_element_numbers != options.show_element_numbers)
            parts.set_numbers();
        parts.apply_options();
    }
}

void MeshScene::set_coloring(const Coloring& coloring) {
    Parts& parts = *parts_;
    const bool was_on_nodes = parts.painter.is_on_nodes();
    parts.painter.set_coloring(coloring);
    if (!parts.mesh) return;
    // Numbers on nodes need finer pieces.
    if (parts.painter.is_on_nodes() != was_on_nodes)
        parts.draw_mesh(false);
    else
        parts.paint();
}

const Coloring& MeshScene::coloring() const {
    return parts_->painter.coloring();
}

const ColorScale& MeshScene::shown_scale() const {
    return parts_->painter.scale();
}

double MeshScene::legend_width() const {
    return parts_->mesh ? parts_->legend.width(parts_->options.pixel_ratio) : 0.0;
}

bool MeshScene::is_on_legend(double x, double y) const {
    return parts_->mesh && parts_->legend.contains(x, y);
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
    if (parts.section && parts.section->sides()[static_cast<std::size_t>(element)] == PlaneCut::Side::cut)
        facing = parts.section->plane().normal;
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
    if (const PlaneCut* section = parts_->section.get();
        section && element >= 0 && element < Index(section->sides().size())) {
        const PlaneCut::Side side = section->sides()[static_cast<std::size_t>(element)];
        if (side != PlaneCut::Side::kept) return side == PlaneCut::Side::cut;
    }
    const std::vector<Index>& drawn = parts_->tessellation->triangle_elements();
    return std::find(drawn.begin(), drawn.end(), element) != drawn.end();
}

std::optional<Index> MeshScene::pick_element(double x, double y) const {
    const std::optional<Pick> pick = parts_->pick(x, y);
    return pick ? std::optional(pick->element) : std::nullopt;
}

void MeshScene::set_marks(const Marks& marks) {
    parts_->edit_marks.set_marks(marks, parts_->frame);
    parts_->set_cut_of_marks();
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
    return pick_drawn_node(*parts_->mesh, parts_->drawn(), parts_->frame, parts_->view(), x, y, radius, !is_flat(),
                           accepts);
}

std::vector<Index> MeshScene::nodes_inside(const std::vector<std::array<double, 2>>& polygon, bool see_through) const {
    if (!parts_->tessellation) return {};
    return pick_nodes_inside(*parts_->mesh, parts_->drawn(), parts_->frame, parts_->view(), polygon,
                             !is_flat() && !see_through);
}

std::vector<Index> MeshScene::elements_inside(const std::vector<std::array<double, 2>>& polygon,
                                              bool see_through) const {
    if (!parts_->tessellation) return {};
    return pick_elements_inside(parts_->drawn(), parts_->frame, parts_->view(), polygon, !is_flat() && !see_through);
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

std::vector<MeshScene::ShownNumber> MeshScene::shown_numbers() const {
    std::vector<ShownNumber> shown;
    for (const NumberLabels::Placed& label : parts_->numbers.placed())
        shown.push_back({label.kind == NumberKind::element, label.number, label.box});
    return shown;
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
