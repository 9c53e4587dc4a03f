#include "ui/jobs/global_check.h"

#include <algorithm>

#include <QCoreApplication>

#include "core/base/error.h"
#include "ui/document/number_format.h"

namespace curvewright {
namespace {

/// Milliseconds that a state has to stay before it is looked at: the picture comes first, and undo may go on.
constexpr int pause = 250;

QString tr(const char* text) {
    return QCoreApplication::translate("GlobalCheck", text);
}

}  // namespace

GlobalCheck::GlobalCheck(MeshDocument& document, QObject* parent) : QObject(parent), document_(document) {
    timer_.setSingleShot(true);
    timer_.setInterval(pause);
    connect(&timer_, &QTimer::timeout, this, &GlobalCheck::start);
    connect(&document, &MeshDocument::opened, this, [this] { known_.clear(); });
    connect(&document, &MeshDocument::state_changed, this, &GlobalCheck::follow_document);
}

GlobalCheck::~GlobalCheck() {
    stop();
}

std::shared_ptr<const GlobalValidityReport> GlobalCheck::report() const {
    const auto& mesh = document_.state().mesh;
    for (const Known& known : known_)
        if (mesh && known.mesh.lock() == mesh) return known.report;
    return nullptr;
}

void GlobalCheck::follow_document() {
    stop();
    std::erase_if(known_, [](const Known& known) { return known.mesh.expired(); });
    is_due_ = document_.has_mesh() && document_.state().quality && !report();
    if (is_due_ && !is_held_) timer_.start();
    emit changed();
}

void GlobalCheck::hold(bool is_held) {
    if (is_held_ == is_held) return;
    is_held_ = is_held;
    if (is_held) {
        is_due_ = is_due_ || is_running_;
        stop();
    } else if (is_due_) {
        timer_.start();
    }
    emit changed();
}

void GlobalCheck::stop() {
    timer_.stop();
    ++request_;
    is_running_ = false;
    progress_ = 0.0;
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
}

void GlobalCheck::start() {
    stop();
    is_due_ = false;
    const MeshState state = document_.state();
    if (!state.mesh || !state.quality) return;
    // What a boundary that has not moved is known to be, it still is.
    std::shared_ptr<const GlobalValidityReport> same_boundary;
    for (const Known& known : known_) {
        const auto mesh = known.mesh.lock();
        if (mesh && known.report && mesh->shared_topology() == state.mesh->shared_topology() &&
            has_same_boundary(mesh->topology(), mesh->coordinates(), state.mesh->coordinates()))
            same_boundary = known.report;
    }
    is_running_ = true;
    const int request = request_;
    thread_ = std::jthread([this, request, state, same_boundary](const std::stop_token& stop) {
        const TaskContext context{stop, [this, request, last = -1.0](std::string_view, double fraction) mutable {
                                      // Some steps are enough for people.
                                      if (fraction < last + 0.05) return;
                                      last = fraction;
                                      QMetaObject::invokeMethod(this, [this, request, fraction] {
                                          if (request != request_) return;
                                          progress_ = fraction;
                                          emit changed();
                                      });
                                  }};
        std::shared_ptr<const GlobalValidityReport> report;
        try {
            report = std::make_shared<const GlobalValidityReport>(assess_global_validity(
                *state.mesh, *state.quality, {}, context, same_boundary ? &same_boundary->boundary : nullptr));
        } catch (const Cancelled&) {
            return;
        } catch (const std::exception& problem) {
            // Elements for which there is no such answer.
            GlobalValidityReport unknown;
            unknown.reason = problem.what();
            report = std::make_shared<const GlobalValidityReport>(std::move(unknown));
        }
        if (stop.stop_requested()) return;
        QMetaObject::invokeMethod(this, [this, request, report, mesh = std::weak_ptr(state.mesh)] {
            if (request != request_) return;
            is_running_ = false;
            known_.push_back({mesh, report});
            emit changed();
            emit found();
        });
    });
    emit changed();
}

std::vector<Index> elements_of(const std::vector<FacetPair>& pairs) {
    std::vector<Index> elements;
    for (const FacetPair& pair : pairs) elements.insert(elements.end(), {pair.a.element, pair.b.element});
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    return elements;
}

QString global_text(const GlobalValidityReport& report) {
    switch (report.answer) {
        case GlobalValidity::yes:
            return tr("✓ no overlaps: valid as a mesh");
        case GlobalValidity::undecided:
            return tr("? undecided as a mesh");
        case GlobalValidity::no:
            break;
    }
    if (report.boundary.crossing_count > 0) return tr("✕ the boundary crosses itself");
    if (report.conflict_count > 0) return tr("✕ sides of elements do not match");
    if (report.elements == GlobalValidity::no) return tr("✕ not valid as a mesh");
    return tr("✕ elements overlap");
}

std::optional<Notice> global_notice(const GlobalValidityReport& report) {
    const auto pairs_text = [](Index count) {
        return count == 1 ? tr("1 pair of facets") : tr("%1 pairs of facets").arg(format_count(count));
    };
    const auto make = [](NoticeSeverity severity, const QString& text, const std::vector<FacetPair>& pairs) {
        Notice notice{severity, text, {}, NoticeLife::state, QStringLiteral("global")};
        if (!pairs.empty()) notice.actions.push_back(selecting_elements(elements_of(pairs)));
        return notice;
    };
    if (report.boundary.crossing_count > 0)
        return make(NoticeSeverity::warning,
                    tr("The boundary crosses itself (%1), so that elements overlap: with this boundary no mesh is "
                       "valid as a whole.")
                        .arg(pairs_text(report.boundary.crossing_count)),
                    report.boundary.crossings);
    if (report.conflict_count > 0)
        return make(NoticeSeverity::warning,
                    tr("Sides of neighbouring elements do not match (%1), so that the mesh is not valid as a whole.")
                        .arg(pairs_text(report.conflict_count)),
                    report.conflicts);
    // That elements are tangled is told elsewhere.
    if (report.elements == GlobalValidity::no) return std::nullopt;
    if (report.answer == GlobalValidity::no)
        return make(NoticeSeverity::warning,
                    tr("The mesh is not valid as a whole. %1").arg(QString::fromStdString(report.reason)), {});
    if (report.answer == GlobalValidity::undecided && report.elements == GlobalValidity::yes &&
        report.boundary.unsettled_count > 0)
        return make(NoticeSeverity::information,
                    tr("Whether the mesh is valid as a whole is undecided: %1 touch or come too close to tell.")
                        .arg(pairs_text(report.boundary.unsettled_count)),
                    report.boundary.unsettled);
    return std::nullopt;
}

}  // namespace curvewright
