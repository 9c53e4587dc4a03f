#include "ui/scene/mesh_scene.h"

#include <algorithm>
#include <utility>

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCullerCollection.h>
#include <vtkPropCollection.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include "core/base/error.h"
#include "ui/scene/camera_control.h"
#include "ui/scene/interactor_style.h"
#include "ui/scene/legend.h"
#include "ui/scene/mark_actors.h"
#include "ui/scene/mesh_drawing.h"
#include "ui/scene/number_labels.h"
#include "ui/scene/orientation_axes.h"
#include "ui/scene/picking.h"
#include "ui/scene/scene_preparation.h"
#include "ui/scene/tile_renderer.h"

namespace curvewright {
namespace {

void check_quality(const CurvedMesh* mesh, const QualityReport* quality) {
    if (mesh && quality && quality->elements.size() != static_cast<std::size_t>(mesh->topology().element_count()))
        throw InvalidInput("The quality report to be drawn belongs to a mesh with another number of elements.");
}

/// Puts other actors where those of a drawing are: props are drawn in the order of the list.
void replace_actors(vtkRenderer* renderer, const std::vector<vtkActor*>& before, const std::vector<vtkActor*>& now) {
    std::vector<vtkSmartPointer<vtkActor>> above;
    bool is_above = false;
    vtkPropCollection* props = renderer->GetViewProps();
    for (int i = 0; i < props->GetNumberOfItems(); ++i) {
        auto* actor = vtkActor::SafeDownCast(props->GetItemAsObject(i));
        if (is_above && actor) above.emplace_back(actor);
        is_above = is_above || actor == before.back();
    }
    for (vtkActor* actor : before) renderer->RemoveActor(actor);
    for (const auto& actor : above) renderer->RemoveActor(actor);
    for (vtkActor* actor : now) renderer->AddActor(actor);
    for (const auto& actor : above) renderer->AddActor(actor);
}

}  // namespace

struct MeshScene::Parts {
    vtkNew<TileRenderer> renderer;
    std::unique_ptr<MeshDrawing> drawing = std::make_unique<MeshDrawing>();  ///< never null

    CameraControl camera{renderer};
    MarkActors edit_marks{add_drawing()};
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
    vtkRenderer* add_drawing() {
        for (vtkActor* actor : drawing->actors()) renderer->AddActor(actor);
        return renderer;
    }

    /// Another drawing with the same options; made if there is a mesh.
    void replace_drawing(std::unique_ptr<MeshDrawing> other) {
        replace_actors(renderer, drawing->actors(), other->actors());
        drawing = std::move(other);
    }

    const SceneOptions& options() const { return drawing->options; }
    bool has_mesh() const { return drawing->has_mesh(); }
    const WorldFrame& frame() const { return drawing->frame(); }

    void update_legend() {
        const SurfacePainter& painter = drawing->painter;
        const Coloring& coloring = painter.coloring();
        const bool has_bar = painter.has_values() && coloring.source != Coloring::Source::plain;
        legend.set_content({coloring.title, coloring.detail, painter.scale(),
                            coloring.source == Coloring::Source::scaled_jacobian, has_bar, painter.has_missing()});
    }

    void apply_options() {
        const SceneOptions& its = options();
        camera.set_orthographic(its.is_orthographic);
        renderer->SetBackground(its.background[0], its.background[1], its.background[2]);
        drawing->apply_styles();
        legend.set_colors(its.background, its.foreground);
        legend.set_visible(its.show_legend);
        legend.set_font(its.font);
        axes.set_colors(its.background, its.foreground);
        edit_marks.set_colors(its.background, its.accent, its.foreground);
        edit_marks.set_font(its.font);
        numbers.set_colors(its.background, its.foreground, its.accent);
        numbers.set_font(its.font);
    }

    void set_cut_of_marks() { edit_marks.set_cut(drawing->cutting_plane(), frame()); }

    /// What depends on a drawing that has been made anew.
    void follow_drawing(std::vector<float> content, std::vector<NumberLabel> labels) {
        update_legend();
        set_cut_of_marks();
        camera.set_content(std::move(content));
        numbers.set_labels(std::move(labels));
        apply_options();
    }
    void follow_drawing() { follow_drawing(drawing->camera_content(), drawing->number_labels()); }

    void look(ViewDirection direction) {
        camera.set_right_margin(legend.width(options().pixel_ratio));
        camera.look(direction);
    }

    void look_from(const Eigen::RowVector3d& to_eye) {
        camera.set_right_margin(legend.width(options().pixel_ratio));
        camera.look_from(to_eye);
    }

    void prepare_frame() {
        if (renderer->has_more_parts()) return;  // was prepared with the first
        const double ratio = options().pixel_ratio;
        axes.set_visible(has_mesh() && !drawing->is_flat());
        camera.set_right_margin(legend.width(ratio));
        camera.prepare_frame();
        ViewMetrics view = camera.metrics(ratio);
        view.tile_shift = renderer->first_x() + renderer->first_y();
        drawing->update(view, view.is_parallel ? 1.0 : camera.distance());
        edit_marks.update(view);
        const std::optional<DrawnSurface> hiding =
            has_mesh() && !drawing->is_flat() ? std::optional(drawing->drawn()) : std::nullopt;
        numbers.update(view, hiding ? &*hiding : nullptr, frame(), {legend.width(ratio), axes.size(ratio)});
        legend.update(view);
        axes.update(view);
    }

    ViewMetrics view() const { return camera.metrics(options().pixel_ratio); }

    std::optional<Pick> pick(double x, double y) const { return drawing->pick(view(), x, y); }
};

MeshScene::MeshScene() : parts_(std::make_unique<Parts>()) {}

MeshScene::~MeshScene() = default;

vtkRenderer* MeshScene::renderer() const {
    return parts_->renderer;
}

void MeshScene::set_first_pixel(int x, int y) {
    parts_->renderer->set_first_pixel(x, y);
}

void MeshScene::begin_parts() {
    parts_->renderer->begin_parts(most_points_of_part);
}

void MeshScene::end_parts() {
    parts_->renderer->end_parts();
}

bool MeshScene::has_more_parts() const {
    return parts_->renderer->has_more_parts();
}

void MeshScene::set_mesh(const CurvedMesh* mesh, const QualityReport* quality) {
    Parts& parts = *parts_;
    check_quality(mesh, quality);
    const std::unique_ptr<MeshDrawing>& before = parts.drawing;
    const bool has_same_topology =
        mesh && before->has_mesh() && mesh->shared_topology() == before->mesh().shared_topology();
    SceneContent content;
    if (mesh) content.mesh = std::make_shared<const CurvedMesh>(*mesh);
    if (mesh && quality) content.quality = std::make_shared<const QualityReport>(*quality);
    content.options = before->options;
    content.coloring = before->painter.coloring();
    if (has_same_topology) {
        // Moved in place: what the graphics have of it stays.
        content.highlighted = before->highlighted;
        parts.legend.set_summary(quality ? std::optional(quality->summary) : std::nullopt);
        parts.drawing->set_state(std::move(content.mesh), std::move(content.quality));
        parts.drawing->make(true);
        parts.follow_drawing();
        return;
    }
    ScenePreparation preparation = prepare(std::move(content));
    preparation.run();
    show(std::move(preparation));
}

ScenePreparation MeshScene::prepare(SceneContent content) const {
    check_quality(content.mesh.get(), content.quality.get());
    return ScenePreparation(std::move(content), *parts_->drawing);
}

bool MeshScene::upload_next(ScenePreparation& preparation) {
    const std::vector<vtkActor*> actors = preparation.drawing_->actors();
    while (preparation.uploaded_ < actors.size()) {
        vtkActor* actor = actors[preparation.uploaded_++];
        if (!actor->GetVisibility()) continue;
        static_cast<UploadMapper*>(actor->GetMapper())->upload(parts_->renderer, actor);
        return true;
    }
    return false;
}

void MeshScene::show(ScenePreparation preparation) {
    Parts& parts = *parts_;
    MeshDrawing& now = *preparation.drawing_;
    const bool has_same_topology =
        now.has_mesh() && parts.has_mesh() && now.mesh().shared_topology() == parts.drawing->mesh().shared_topology();
    parts.legend.set_summary(now.quality() ? std::optional(now.quality()->summary) : std::nullopt);
    parts.replace_drawing(std::move(preparation.drawing_));
    if (!now.has_mesh()) {
        parts.legend.set_content({});
        parts.edit_marks.set_marks({}, parts.frame());
        parts.numbers.set_labels({});
        parts.camera.set_content({});
        parts.apply_options();
        return;
    }
    parts.follow_drawing(std::move(preparation.content_), std::move(preparation.labels_));
    if (has_same_topology) return;
    parts.camera.set_flat(parts.drawing->is_flat());
    parts.look(ViewDirection::isometric);
}

void MeshScene::show_frame(const Coordinates& positions, const QualityReport* quality) {
    Parts& parts = *parts_;
    if (!parts.has_mesh()) return;
    std::shared_ptr<const QualityReport> its;
    if (quality) {
        if (quality->elements.size() != static_cast<std::size_t>(parts.drawing->mesh().topology().element_count()))
            throw InvalidInput("The quality report of a frame belongs to a mesh with another number of elements.");
        its = std::make_shared<const QualityReport>(*quality);
        parts.legend.set_summary(quality->summary);
    }
    const bool is_new =
        !parts.drawing->move(positions, std::move(its), parts.view().pixels_per_unit(parts.camera.distance()));
    if (is_new) {
        parts.follow_drawing();
        return;
    }
    parts.update_legend();
    const SceneOptions& options = parts.options();
    if (options.show_node_numbers || options.show_element_numbers)
        parts.numbers.set_labels(parts.drawing->number_labels());
}

void MeshScene::set_options(const SceneOptions& options) {
    Parts& parts = *parts_;
    MeshDrawing& drawing = *parts.drawing;
    const SceneOptions before = std::exchange(drawing.options, options);
    switch (parts.has_mesh() ? redrawing(before, options) : Redrawing::nothing) {
        case Redrawing::all:
            drawing.make(has_same_pieces(before, options));
            parts.follow_drawing();
            return;
        case Redrawing::cut:
            drawing.make_cut();
            parts.follow_drawing();
            return;
        case Redrawing::numbers:
            parts.numbers.set_labels(drawing.number_labels());
            break;
        case Redrawing::nothing:
            break;
    }
    parts.apply_options();
}

void MeshScene::set_coloring(const Coloring& coloring) {
    Parts& parts = *parts_;
    SurfacePainter& painter = parts.drawing->painter;
    const bool was_on_nodes = painter.is_on_nodes();
    painter.set_coloring(coloring);
    if (!parts.has_mesh()) return;
    // Numbers on nodes need finer pieces.
    if (painter.is_on_nodes() != was_on_nodes) {
        parts.drawing->make(false);
        parts.follow_drawing();
    } else {
        parts.drawing->paint();
        parts.update_legend();
    }
}

const Coloring& MeshScene::coloring() const {
    return parts_->drawing->painter.coloring();
}

const ColorScale& MeshScene::shown_scale() const {
    return parts_->drawing->painter.scale();
}

double MeshScene::legend_width() const {
    return parts_->has_mesh() ? parts_->legend.width(parts_->options().pixel_ratio) : 0.0;
}

bool MeshScene::is_on_legend(double x, double y) const {
    return parts_->has_mesh() && parts_->legend.contains(x, y);
}

const SceneOptions& MeshScene::options() const {
    return parts_->options();
}

void MeshScene::set_highlighted_elements(const std::vector<Index>& elements) {
    parts_->drawing->highlighted = elements;
    parts_->drawing->make_highlight();
}

const std::vector<Index>& MeshScene::highlighted_elements() const {
    return parts_->drawing->highlighted;
}

void MeshScene::look(ViewDirection direction) {
    parts_->look(direction);
}

void MeshScene::look_from(const Eigen::RowVector3d& to_eye) {
    parts_->look_from(to_eye);
}

void MeshScene::focus_element(Index element) {
    const Parts& parts = *parts_;
    if (!parts.has_mesh() || element < 0 || element >= parts.drawing->mesh().topology().element_count()) return;
    const Eigen::MatrixX3d x = parts.drawing->mesh().element_coordinates(element);
    const Eigen::RowVector3d center = 0.5 * (x.colwise().minCoeff() + x.colwise().maxCoeff());
    const double radius = (x.rowwise() - center).rowwise().norm().maxCoeff();
    Eigen::RowVector3d facing = Eigen::RowVector3d::Zero();
    const Tessellation& drawn = parts.drawing->tessellation();
    for (std::size_t triangle = 0; triangle < drawn.triangle_elements().size(); ++triangle) {
        if (drawn.triangle_elements()[triangle] != element) continue;
        const float* normal = drawn.surface_normals().data() + 3 * drawn.triangles()[3 * triangle];
        facing += Eigen::RowVector3d(normal[0], normal[1], normal[2]);
    }
    if (const PlaneCut* section = parts.drawing->section();
        section && section->sides()[static_cast<std::size_t>(element)] == PlaneCut::Side::cut)
        facing = section->plane().normal;
    parts_->camera.focus(parts.frame().to_world(center), radius / parts.frame().size, facing);
}

void MeshScene::focus_ball(const Eigen::RowVector3d& center, double radius) {
    if (!parts_->has_mesh()) return;
    // focus() leaves room for the surroundings of an element: a ball that is to fill the view counts for less.
    constexpr double filling = 0.25;
    const double size = radius > 0.0 ? radius / parts_->frame().size : 0.05;
    parts_->camera.focus(parts_->frame().to_world(center), filling * size, Eigen::RowVector3d::Zero());
}

bool MeshScene::draws_element(Index element) const {
    if (!parts_->has_mesh()) return false;
    if (const PlaneCut* section = parts_->drawing->section();
        section && element >= 0 && element < Index(section->sides().size())) {
        const PlaneCut::Side side = section->sides()[static_cast<std::size_t>(element)];
        if (side != PlaneCut::Side::kept) return side == PlaneCut::Side::cut;
    }
    const std::vector<Index>& drawn = parts_->drawing->tessellation().triangle_elements();
    return std::find(drawn.begin(), drawn.end(), element) != drawn.end();
}

std::optional<Index> MeshScene::pick_element(double x, double y) const {
    const std::optional<Pick> pick = parts_->pick(x, y);
    return pick ? std::optional(pick->element) : std::nullopt;
}

void MeshScene::set_marks(const Marks& marks) {
    parts_->edit_marks.set_marks(marks, parts_->frame());
    parts_->set_cut_of_marks();
}

bool MeshScene::is_flat() const {
    return parts_->drawing->is_flat();
}

Eigen::Vector4d MeshScene::project(const Eigen::RowVector3d& point) const {
    return parts_->view().project(parts_->frame().to_world(point));
}

Eigen::RowVector3d MeshScene::unproject(double x, double y, const Eigen::RowVector3d& at_depth_of) const {
    const double depth = project(at_depth_of)[2];
    Eigen::RowVector3d point = parts_->frame().to_mesh(parts_->camera.unproject(x, y, depth).transpose());
    if (is_flat()) point[2] = at_depth_of[2];
    return point;
}

double MeshScene::units_per_pixel(const Eigen::RowVector3d& at) const {
    const double divisor = project(at)[3];
    return parts_->frame().size / std::max(parts_->view().pixels_per_unit(divisor), 1e-12);
}

Eigen::Matrix3d MeshScene::view_axes() const {
    return parts_->camera.axes();
}

std::optional<Index> MeshScene::pick_node(double x, double y, double radius,
                                          const std::function<bool(Index)>& accepts) const {
    if (!parts_->has_mesh()) return std::nullopt;
    return pick_drawn_node(parts_->drawing->mesh(), parts_->drawing->drawn(), parts_->frame(), parts_->view(), x, y,
                           radius, !is_flat(), accepts);
}

std::vector<Index> MeshScene::nodes_inside(const std::vector<std::array<double, 2>>& polygon, bool see_through) const {
    if (!parts_->has_mesh()) return {};
    return pick_nodes_inside(parts_->drawing->mesh(), parts_->drawing->drawn(), parts_->frame(), parts_->view(),
                             polygon, !is_flat() && !see_through);
}

std::vector<Index> MeshScene::elements_inside(const std::vector<std::array<double, 2>>& polygon,
                                              bool see_through) const {
    if (!parts_->has_mesh()) return {};
    return pick_elements_inside(parts_->drawing->drawn(), parts_->frame(), parts_->view(), polygon,
                                !is_flat() && !see_through);
}

CameraState MeshScene::camera_state() const {
    return parts_->camera.state();
}

void MeshScene::set_camera_state(const CameraState& state) {
    parts_->camera.set_state(state);
}

const WorldFrame& MeshScene::world_frame() const {
    return parts_->frame();
}

void MeshScene::copy_view(const MeshScene& other, bool is_exact) {
    if (!parts_->has_mesh() || !other.parts_->has_mesh()) return;
    parts_->camera.copy_view(other.parts_->camera, other.parts_->frame(), parts_->frame(), is_exact);
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
