#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/global_validity.h"
#include "core/quality/quality.h"
#include "core/quality/shape_quality.h"
#include "core/report/convergence_log.h"
#include "core/report/parameters.h"
#include "core/report/untangle_run.h"

namespace curvewright {

/// Where a run began: a file, and what was done to its mesh before.
struct ReportInput {
    std::string file;                ///< its name, without folders
    std::string sha256;              ///< of its bytes; "" = unknown
    std::string note;                ///< why that is unknown; "" otherwise
    std::vector<std::string> steps;  ///< lines of a session, files named without folders; empty: the mesh of the file
};

/// Counts of the scaled Jacobian: tangled elements apart, the others in equal bins over [0, 1].
struct ReportHistogram {
    static constexpr int bins = 25;
    Index tangled = 0;
    std::vector<Index> valid, undecided;  ///< bins each
    Index highest() const;
};
/// Counts the elements of a mesh.
ReportHistogram make_report_histogram(const QualityReport& report);

/// The quality of a mesh in numbers.
struct ReportQuality {
    QualitySummary scaled_jacobian;
    ShapeSummary shape;
    ReportHistogram histogram;
    GlobalValidity globally_valid = GlobalValidity::undecided;
    std::string global_reason;                           ///< one sentence
    std::vector<std::array<std::int64_t, 2>> crossings;  ///< tags of elements whose facets on the boundary cross
    Index crossing_count = 0;                            ///< all such pairs; some may not be listed
};

/// The elements of a physical group; of a group on the boundary, those that a cell of it is part of.
struct ReportGroup {
    std::string name;
    int dimension = 0;
    QualitySummary before, after;
};

/// An element that a report tells of by itself.
struct ReportElement {
    Index element = 0;
    std::int64_t tag = 0;
    ElementType type;
    std::array<double, 3> center{};  ///< of its corners, in the result
    std::vector<std::string> groups;
    ElementQuality before, after;
};

/// An element that is not proved valid at the end.
struct ReportUnproved {
    std::int64_t tag = 0;
    ElementQuality quality;
    std::string reason;
    bool is_impossible = false;  ///< proved that it cannot become valid with the boundary as it is
    double bound = 0.0;          ///< see UnmendedElement; without a word of the method, the scaled Jacobian
};

/// All that is told about one untangling, but the pictures.
struct RunReport {
    ReportInput input;
    std::string input_coordinates, result_coordinates;  ///< SHA-256 of nodes × 3 doubles, x y z, little endian
    int dimension = 0, order = 1;
    std::vector<std::pair<std::string, Index>> types;  ///< "P3 triangle" and how many
    Index nodes = 0, interior_nodes = 0, boundary_nodes = 0;
    std::array<double, 6> bounding_box{};  ///< of the input: min x, y, z, max x, y, z
    Orientation orientation = Orientation::positive;

    std::string method, method_title, method_description;
    std::vector<ReportParameter> parameters;
    std::string command;  ///< that does it again; "" = there were steps before
    std::string made_by;  ///< the command, with all of its options, that made the report; "" = unknown
    std::vector<std::pair<std::string, std::string>> versions;

    ReportQuality before, after;
    Index mended = 0;   ///< elements that were not valid and are now
    Index spoiled = 0;  ///< elements that were valid and are not any more
    Index moved_interior_nodes = 0, moved_boundary_nodes = 0;
    double largest_move = 0.0;  ///< of a node, mesh units
    std::vector<ReportGroup> groups;
    std::vector<ReportElement> worst_before, worst_after;  ///< the worst first

    StopReason reason = StopReason::converged;
    std::optional<int> passes, rounds;  ///< whichever the method counts
    bool moves_boundary = false;        ///< the rules of the boundary let some of it move
    Index sliding_nodes = 0, free_nodes = 0;
    double largest_boundary_distance = 0.0;

    // A selection of the course, and how much there was.
    std::vector<convergence::Pass> pass_list;
    std::vector<convergence::Patch> patch_list;
    std::vector<convergence::Round> round_list;
    std::size_t pass_count = 0, patch_count = 0, round_count = 0;

    QualityOptions certificate;             ///< tolerance and budget of the bounds
    std::optional<double> proved_least;     ///< proved lower bound of every scaled Jacobian, if all are valid
    std::vector<ReportUnproved> not_valid;  ///< in the order of the mesh
    Index impossible = 0;                   ///< of them: proved that nothing can be done
    std::vector<std::string> remarks;       ///< sentences about this run

    // What differs from run to run.
    std::string written;                                  ///< "2026-01-31 12:00:00 UTC"
    std::vector<std::pair<std::string, double>> timings;  ///< seconds

    Index elements() const { return after.scaled_jacobian.elements(); }
    bool is_all_valid() const { return not_valid.empty(); }
};

/// What a report is made of.
struct ReportSource {
    ReportInput input;
    const CurvedMesh& before;
    const QualityReport& quality_before;
    const CurvedMesh& after;
    const QualityReport& quality_after;
    UntangleOptions options;
    std::string warped_first;  ///< weights of a warp that came before; "" = none
    const UntangleRun& run;
    const ConvergenceLog& log;
    std::vector<std::pair<std::string, double>> timings;
    std::string made_by{};  ///< what was asked for as it was asked for: a command line; "" = unknown
};
/// Makes the report, but for its pictures. Throws Cancelled.
RunReport collect_report(const ReportSource& source, const TaskContext& context = {});

/// The outcome in one sentence or two, for a reader who reads nothing else.
std::string verdict(const RunReport& report);

}  // namespace curvewright
