// What the view shows: small meshes are drawn at once; what is drawn of large ones is prepared on a thread of its own,
// handed to the graphics piece by piece, and shown when all of it is there.

#include <exception>

#include <QMetaObject>

#include "ui/jobs/own_turn.h"
#include "ui/main_window/mesh_view_parts.h"

namespace curvewright {
namespace {

constexpr std::size_t most_outlined_at_once = 2000;  ///< elements
constexpr int soon = 500;                            ///< milliseconds that need no explanation

bool is_of_same_mesh(const MeshState& a, const MeshState& b) {
    return a.mesh && b.mesh && a.mesh->shared_topology() == b.mesh->shared_topology();
}

}  // namespace

bool MeshView::is_large() const {
    const auto& mesh = parts_->wanted.mesh;
    return mesh && mesh->topology().node_count() >= least_nodes_prepared;
}

bool MeshView::is_preparing() const {
    const PreparingBehind& preparing = parts_->preparing;
    return preparing.work || preparing.is_outdated;
}

SceneContent MeshView::content() const {
    const Parts& parts = *parts_;
    return {parts.wanted.mesh, parts.wanted.quality, parts.options, parts.coloring, parts.highlighted, {}};
}

void MeshView::show_state(const MeshState& state) {
    Parts& parts = *parts_;
    parts.flight.stop();
    parts.wanted = state;
    parts.preparing.late_frame.reset();
    // The graphics make for the first picture of a mesh what all others take as it is.
    if (!is_of_same_mesh(parts.state, state)) parts.behind.is_slow = true;
    if (is_large()) {
        // Nobody may point at elements of another mesh meanwhile.
        if (!is_of_same_mesh(parts.state, state)) {
            show_nothing();
            request_frame();
        }
        prepare();
        return;
    }
    if (is_preparing()) {
        forget_preparation();
        show_nothing();
    }
    if (!parts.state.mesh) {
        parts.scene.set_options(parts.options);
        parts.scene.set_coloring(parts.coloring);
    }
    parts.scene.set_mesh(state.mesh.get(), state.quality.get());
    parts.state = state;
    request_frame();
}

void MeshView::show_nothing() {
    parts_->scene.set_mesh(nullptr, nullptr);
    parts_->state = {};
}

void MeshView::show_frame(const Coordinates& positions, const QualityReport* quality) {
    Parts& parts = *parts_;
    if (is_preparing()) {
        auto& late = parts.preparing.late_frame;
        if (!late) late.emplace();
        late->positions = positions;
        if (quality) late->quality = std::make_shared<const QualityReport>(*quality);
    }
    parts.scene.show_frame(positions, quality);
    parts.behind.is_restless = true;
    request_frame();
}

void MeshView::set_options(const SceneOptions& options) {
    if (options.is_orthographic != parts_->options.is_orthographic) parts_->flight.stop();
    parts_->options = options;
    scale_to_device();
}

void MeshView::scale_to_device() {
    Parts& parts = *parts_;
    parts.options.pixel_ratio = devicePixelRatioF();
    SceneOptions now = parts.options;
    const SceneOptions& shown = parts.scene.options();
    const bool is_later =
        is_large() && (draws_anew(shown, now) || (is_preparing() && draws_anew(parts.preparing.options, now)));
    if (is_later) {
        prepare();
        now.clip = shown.clip;
        now.element_size = shown.element_size;
        now.only_elements = shown.only_elements;
    }
    parts.scene.set_options(now);
    request_frame();
}

void MeshView::set_coloring(const Coloring& coloring) {
    Parts& parts = *parts_;
    parts.coloring = coloring;
    if (is_large()) {
        SurfacePainter painter;
        painter.set_coloring(coloring);
        painter.find_scale(*parts.wanted.mesh);
        parts.wanted_scale = painter.scale();
        prepare();
    } else {
        parts.scene.set_coloring(coloring);
        request_frame();
    }
}

const ColorScale& MeshView::shown_scale() const {
    return is_preparing() ? parts_->wanted_scale : parts_->scene.shown_scale();
}

void MeshView::set_highlighted_elements(const std::vector<Index>& elements) {
    Parts& parts = *parts_;
    parts.highlighted = elements;
    if (elements == parts.scene.highlighted_elements()) return;
    if (is_large() && elements.size() > most_outlined_at_once) {
        prepare();
    } else {
        parts.scene.set_highlighted_elements(elements);
        request_frame();
    }
}

void MeshView::prepare() {
    PreparingBehind& preparing = parts_->preparing;
    if (!preparing.is_outdated && !preparing.work) preparing.explain.start(soon);
    if (std::exchange(preparing.is_outdated, true)) return;
    // Several changes often come together.
    call_in_own_turn(this, [this] { begin_preparation(); });
}

void MeshView::begin_preparation() {
    Parts& parts = *parts_;
    PreparingBehind& preparing = parts.preparing;
    if (preparing.work || !preparing.is_outdated) return;
    preparing.is_outdated = false;
    preparing.options = parts.options;
    auto work = std::make_shared<PreparationWork>(PreparationWork{parts.scene.prepare(content()), parts.wanted, {}});
    preparing.work = work;
    preparing.thread = std::jthread([this, work] {
        try {
            work->preparation.run();
        } catch (...) {
            work->problem = std::current_exception();
        }
        QMetaObject::invokeMethod(this, [this, work] { take_preparation(work); });
    });
}

void MeshView::take_preparation(const std::shared_ptr<PreparationWork>& work) {
    Parts& parts = *parts_;
    std::erase_if(parts.preparing.left_over, [&work](const auto& entry) { return entry.first == work; });
    if (work != parts.preparing.work || work->is_made) return;
    parts.preparing.thread.join();
    work->is_made = true;
    call_in_own_turn(this, [this] { upload_preparation(); });
}

void MeshView::upload_preparation() {
    Parts& parts = *parts_;
    PreparingBehind& preparing = parts.preparing;
    if (!preparing.work || !preparing.work->is_made) return;
    if (preparing.work->problem || preparing.work->state.mesh != parts.wanted.mesh) {
        // Too late, or too large: what came after it wins.
        const bool has_failed = preparing.work->problem != nullptr;
        forget_preparation();
        if (has_failed)
            emit not_drawn();
        else
            prepare();
        return;
    }
    if (isVisible() && parts.window->GetReadyForRendering() && parts.behind.mode != DrawingMode::at_once) {
        makeCurrent();
        const bool is_more_to_come = parts.scene.upload_next(preparing.work->preparation);
        doneCurrent();
        if (is_more_to_come) {
            call_in_own_turn(this, [this] { upload_preparation(); });
            return;
        }
    }
    show_preparation();
}

void MeshView::show_preparation() {
    Parts& parts = *parts_;
    PreparingBehind& preparing = parts.preparing;
    const bool has_graphics = parts.window->GetReadyForRendering();
    if (has_graphics) makeCurrent();
    parts.state = preparing.work->state;
    parts.scene.show(std::move(preparing.work->preparation));
    if (has_graphics) doneCurrent();
    preparing.work.reset();
    // What has changed since it was begun, and does not need another preparation.
    if (preparing.late_frame) {
        parts.scene.show_frame(preparing.late_frame->positions, preparing.late_frame->quality.get());
        preparing.late_frame.reset();
    }
    // A picture of this mesh takes long: the first one, too.
    parts.behind.is_slow = true;
    scale_to_device();
    set_highlighted_elements(parts.highlighted);
    if (parts.tool) parts.tool->refresh();
    request_frame();
    if (preparing.is_outdated)
        begin_preparation();
    else
        tell_prepared();
    emit content_shown();
}

void MeshView::tell_prepared() {
    PreparingBehind& preparing = parts_->preparing;
    preparing.explain.stop();
    if (std::exchange(preparing.is_told, false)) emit preparing_changed(false);
}

void MeshView::forget_preparation() {
    PreparingBehind& preparing = parts_->preparing;
    if (preparing.thread.joinable()) preparing.left_over.emplace_back(preparing.work, std::move(preparing.thread));
    if (preparing.work && preparing.work->is_made && parts_->window->GetReadyForRendering()) {
        // Some of it may be with the graphics already.
        makeCurrent();
        preparing.work.reset();
        doneCurrent();
    }
    preparing.work.reset();
    preparing.is_outdated = false;
    tell_prepared();
}

void MeshView::stop_preparing() {
    if (!is_preparing()) return;
    forget_preparation();
    emit not_drawn();
}

void MeshView::finish_preparing() {
    Parts& parts = *parts_;
    while (is_preparing()) {
        begin_preparation();
        if (parts.preparing.thread.joinable()) parts.preparing.thread.join();
        if (parts.preparing.work->problem) return forget_preparation();
        if (parts.preparing.work->state.mesh == parts.wanted.mesh)
            show_preparation();
        else
            parts.preparing.work.reset();
    }
}

}  // namespace curvewright
