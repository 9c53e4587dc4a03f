#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/io/atomic_file.h"
#include "core/report/report_html.h"

namespace curvewright {

/// Names of the files of a report.
constexpr const char* report_html_name = "report.html";
/// The same numbers for programs.
constexpr const char* report_json_name = "report.json";

/// Throws InvalidInput, one sentence, if a report cannot be put into that folder: something else of that name, no
/// folder to make it in, not writable. others: files that will be written as well and must not be in its way. To be
/// called before the work.
void check_report_folder(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& others = {});

/// The two files of a report, which become visible with commit(). Without it nothing is left, and a folder that was
/// made for them goes again.
class ReportFiles {
  public:
    /// Throws like check_report_folder, and InvalidInput if the files cannot be written completely.
    ReportFiles(const std::filesystem::path& folder, const RunReport& report, const ReportPictures& pictures,
                const ReportColors& colors);
    ~ReportFiles();
    ReportFiles(const ReportFiles&) = delete;
    ReportFiles& operator=(const ReportFiles&) = delete;

    void commit();

  private:
    std::filesystem::path folder_;
    bool is_made_ = false, is_committed_ = false;
    std::vector<std::unique_ptr<AtomicFile>> files_;
};

}  // namespace curvewright
