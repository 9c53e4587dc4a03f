#include "ui/jobs/reporting.h"

#include <QCoreApplication>
#include <QDir>
#include <QFileInfo>

#include "core/base/sha256.h"
#include "core/io/matched_mesh.h"
#include "core/report/report_files.h"
#include "core/session/session_file.h"
#include "ui/jobs/in_window.h"
#include "ui/jobs/mesh_state.h"

namespace curvewright {
namespace {

QString tr(const char* text) {
    return QCoreApplication::translate("curvewright::MeshJobs", text);
}

std::string file_name(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

/// A line of a session without the folders of whoever wrote it.
std::string line_of(Action action) {
    if (auto* deform = std::get_if<DeformAction>(&action)) deform->deformation = file_name(deform->deformation);
    if (auto* warp = std::get_if<WarpAction>(&action)) warp->deformation = file_name(warp->deformation);
    return to_json_line(action);
}

/// What is known of the file that the mesh came from, as it is now.
ReportInput describe_input(const std::string& path, const CurvedMesh& opened, std::vector<std::string> steps,
                           const TaskContext& context) {
    ReportInput input{file_name(path), {}, {}, std::move(steps)};
    try {
        const std::string hash = sha256_of_file(path);
        const CurvedMesh now = read_matched_mesh(path, {}, context).mesh;
        const bool is_same =
            now.topology().node_count() == opened.topology().node_count() && now.coordinates() == opened.coordinates();
        if (is_same)
            input.sha256 = hash;
        else
            input.note = "The file is not as it was opened any more.";
    } catch (const InvalidInput&) {
        input.note = "The file cannot be read any more.";
    } catch (const Unsupported&) {
        input.note = "The file is not as it was opened any more.";
    }
    return input;
}

UntangleOptions made_cancellable(UntangleOptions options) {
    if (auto* guaranteed = std::get_if<GuaranteedOptions>(&options)) guaranteed->keeps_best_on_cancel = false;
    return options;
}

}  // namespace

std::optional<int> last_untangling(const MeshDocument& document) {
    if (!document.has_mesh()) return std::nullopt;
    for (int step = document.history()->index() - 1; step >= 0; --step)
        if (std::holds_alternative<UntangleAction>(document.step_action(step)) && document.state_at(step).quality)
            return step;
    return std::nullopt;
}

QString free_report_folder(const QString& chosen, const QString& mesh_name) {
    const auto has_report = [](const QString& folder) {
        const QDir dir(folder);
        return dir.exists(QLatin1String(report_html_name)) || dir.exists(QLatin1String(report_json_name));
    };
    if (!has_report(chosen)) return chosen;
    const QString stem = QFileInfo(mesh_name).baseName() + QStringLiteral("-report");
    QString folder = QDir(chosen).filePath(stem);
    for (int number = 2; QFileInfo::exists(folder); ++number)
        folder = QDir(chosen).filePath(QStringLiteral("%1-%2").arg(stem).arg(number));
    return folder;
}

JobRunner::Work report_work(QObject* window, const MeshDocument& document, int step, ReportRequest request) {
    const MeshState start = document.state_at(step), end = document.state_at(step + 1);
    const auto opened = document.state_at(0).mesh;
    const UntangleOptions options = made_cancellable(std::get<UntangleAction>(document.step_action(step)).options);
    const std::string path = std::get<OpenAction>(document.session().front()).mesh;
    std::vector<std::string> steps;
    for (int i = 0; i < step; ++i) steps.push_back(line_of(document.step_action(i)));
    return [=, request = std::move(request)](const TaskContext& context) -> JobRunner::Finish {
        const std::filesystem::path folder = to_path(request.folder);
        check_report_folder(folder);
        const TaskContext silent{context.stop, {}};
        const ReportInput input = describe_input(path, *opened, steps, silent);
        ConvergenceLog log;
        const UntangleRun run = run_untangling(*start.mesh, options, &log, context);
        context.check();

        ReportedStates states{start.mesh, end.mesh, start.quality, end.quality};
        QString remark;
        if (run.coordinates != end.mesh->coordinates()) {
            const MeshState again = make_state(start.mesh->with_coordinates(run.coordinates), context, &start);
            states.after = again.mesh;
            states.quality_after = again.quality;
            remark =
                tr("The untangling was made again for it and came out a little differently from the mesh in the "
                   "history.");
        }
        RunReport report = collect_report({input,
                                           *states.before,
                                           *states.quality_before,
                                           *states.after,
                                           *states.quality_after,
                                           options,
                                           {},
                                           run,
                                           log,
                                           run.timings},
                                          context);
        if (!remark.isEmpty())
            report.remarks.push_back(
                "The untangling was made again for this report, and came out a little differently from the mesh that "
                "it is about.");
        const auto draw = [&](const PictureWish& wish) {
            return call_in_window<std::string>(
                window, [draw = request.draw, states, wish] { return draw(states, wish); }, context.stop);
        };
        const ReportPictures pictures = draw_pictures(report, draw, context);
        if (!pictures.note.empty()) {
            if (!remark.isEmpty()) remark += QLatin1Char(' ');
            remark += tr("It has no pictures: %1").arg(QString::fromStdString(pictures.note));
        }
        ReportFiles files(folder, report, pictures, request.colors);
        context.check();
        files.commit();
        return [then = request.then, html = QDir(request.folder).filePath(QLatin1String(report_html_name)), remark] {
            if (then) then(html, remark);
        };
    };
}

}  // namespace curvewright
