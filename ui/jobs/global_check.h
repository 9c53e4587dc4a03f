#pragma once

#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <QObject>
#include <QString>
#include <QTimer>

#include "core/quality/global_validity.h"
#include "ui/document/mesh_document.h"
#include "ui/document/notice.h"

namespace curvewright {

/// Finds out in the background whether the present state of a document is valid as a whole: whether its elements
/// overlap nowhere. Begins a moment after a state has come, and is given up when another one comes. What is known of
/// states stays known as long as they are in the history. All members are for the window's thread.
class GlobalCheck : public QObject {
    Q_OBJECT

  public:
    explicit GlobalCheck(MeshDocument& document, QObject* parent = nullptr);
    ~GlobalCheck() override;

    /// Of the present state; null = not known (yet).
    std::shared_ptr<const GlobalValidityReport> report() const;
    /// A check is running or about to.
    bool is_pending() const { return timer_.isActive() || is_running_ || (is_held_ && is_due_); }
    /// In [0, 1], while it runs.
    double progress() const { return progress_; }
    /// While true no check runs: a job or a hand needs the processors. Begins anew afterwards.
    void hold(bool is_held);

  signals:
    /// report(), is_pending() or progress() has changed.
    void changed();
    /// A report that was not known before, of the present state.
    void found();

  private:
    struct Known {
        std::weak_ptr<const CurvedMesh> mesh;
        std::shared_ptr<const GlobalValidityReport> report;
    };

    void follow_document();
    void start();
    void stop();

    MeshDocument& document_;
    QTimer timer_;
    std::jthread thread_;
    std::vector<Known> known_;
    int request_ = 0;  ///< answers to older ones are late and dropped
    bool is_running_ = false, is_held_ = false, is_due_ = false;
    double progress_ = 0.0;
};

/// Elements that have one of the facets, ascending.
std::vector<Index> elements_of(const std::vector<FacetPair>& pairs);
/// "✓ valid as a mesh", "✕ the boundary crosses itself": short, for the side panel.
QString global_text(const GlobalValidityReport& report);
/// What stays told of it; none if there is nothing but good news, or if it is told already that elements are tangled.
std::optional<Notice> global_notice(const GlobalValidityReport& report);

}  // namespace curvewright
