#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/cli/output.h"
#include "core/report/report_files.h"

namespace curvewright::cli {

/// What `untangle` knows at its end.
struct UntangleFacts {
    const std::filesystem::path& file;
    const CurvedMesh& before;
    const QualityReport& quality_before;
    const CurvedMesh& after;
    const QualityReport& quality_after;
    const UntangleOptions& options;
    const std::string& warped_first;
    const UntangleRun& run;
    const ConvergenceLog& log;
};

/// Makes the report of a run, with pictures where they can be drawn (else a note says so). It becomes visible with
/// commit(). Timed as "report".
std::unique_ptr<ReportFiles> write_report(const std::filesystem::path& folder, const UntangleFacts& facts, Work& work);

}  // namespace curvewright::cli
