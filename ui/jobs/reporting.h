#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <QObject>
#include <QString>

#include "core/report/report_charts.h"
#include "core/report/report_pictures.h"
#include "ui/document/mesh_document.h"
#include "ui/jobs/job_runner.h"

namespace curvewright {

/// The two meshes that a report is about, with their quality.
struct ReportedStates {
    std::shared_ptr<const CurvedMesh> before, after;
    std::shared_ptr<const QualityReport> quality_before, quality_after;
};

struct ReportRequest {
    QString folder;  ///< is made if it is not there
    ReportColors colors;
    /// Draws a picture: the bytes of a PNG file. Called on the window's thread, once per turn of its event loop, with
    /// the same states every time. Throws Unsupported if it cannot.
    std::function<std::string(const ReportedStates&, const PictureWish&)> draw;
    /// The report is there. remark: "" or a sentence. Called on the window's thread.
    std::function<void(const QString& html_path, const QString& remark)> then;
};

/// The step of the history (0 = the first after opening) that is the last untangling that was done and can be done
/// again; those that were stopped cannot.
std::optional<int> last_untangling(const MeshDocument& document);

/// A folder for a report of the document: the one that was chosen, or a new one in it if there is a report already.
QString free_report_folder(const QString& chosen, const QString& mesh_name);

/// The work of a job: does that step again with somebody who listens, collects, draws and writes. window: an object of
/// the window's thread.
JobRunner::Work report_work(QObject* window, const MeshDocument& document, int step, ReportRequest request);

}  // namespace curvewright
