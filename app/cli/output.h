#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "app/cli/command.h"
#include "core/base/stopwatch.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"

namespace curvewright::cli {

using Json = nlohmann::ordered_json;

/// Prints one JSON object on standard output. Bytes that are no UTF-8 (in file or group names) become U+FFFD.
void print_json(const Json& json);

/// "mesh": file, dimension, order, elements, nodes, interior_nodes.
Json mesh_json(const std::filesystem::path& file, const CurvedMesh& mesh);
/// "scaled_jacobian": min, mean, max, valid, invalid, undecided.
Json summary_json(const QualitySummary& summary);
/// "worst": at most 10 of element (tag), scaled_jacobian, center.
Json worst_json(const CurvedMesh& mesh, const QualityReport& report);

/// "P3, 30 triangles, 159 nodes (111 interior)".
std::string mesh_line(const CurvedMesh& mesh);
/// "min −0.222, mean 0.634, max 1.000; 28 valid, 2 invalid, 0 undecided" in ASCII.
std::string summary_line(const QualitySummary& summary);

/// Reads a mesh, prints the reader's notes on standard error unless --quiet, and stores the time as "read".
ReadResult read_input(const std::filesystem::path& file, const Invocation& invocation, const TaskContext& context,
                      Json& timings);
/// assess_quality, timed as "certify" (added to what is there).
QualityReport certify(const CurvedMesh& mesh, const TaskContext& context, Json& timings,
                      const QualityOptions& options = {});
/// certify of what became of `original`: judged with its orientation.
QualityReport certify_result(const CurvedMesh& mesh, const QualityReport& original, const TaskContext& context,
                             Json& timings);
/// Whether the quality of the mesh can be assessed at all.
bool is_assessable(const CurvedMesh& mesh);

/// The quality of a mesh, or why there is none.
struct Assessment {
    std::optional<QualityReport> report;
    std::string note;  ///< one sentence; empty if there is a report
};
/// certify for any mesh.
Assessment assess(const CurvedMesh& mesh, const TaskContext& context, Json& timings,
                  const QualityOptions& options = {});
/// assess of what became of `original`: judged with its orientation.
Assessment assess_result(const CurvedMesh& mesh, const Assessment& original, const TaskContext& context, Json& timings);
/// Adds "scaled_jacobian"; where there is no report that is null, and "quality_note" says why.
void add_assessment(Json& json, const Assessment& assessment);

/// The quality that belongs in the output: none for MSH, which has no place for it, and for meshes that are not
/// assessable.
std::optional<QualityReport> certify_for(const OutputOptions& output, const CurvedMesh& mesh,
                                         const TaskContext& context, Json& timings);
/// Throws InvalidInput if the output cannot be: unknown suffix, no such folder, a folder in the file's place. To be
/// called before the work.
void check_output(const OutputOptions& output);
/// Writes the mesh with the arrays of its nodes and elements, timed as "write". quality may be null. Says on standard
/// error, unless --quiet, what the format could not hold.
void write_output(const OutputOptions& output, const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                  const QualityReport* quality, const Coordinates* reference, const Invocation& invocation,
                  Json& timings);
/// What commands do whose result is a mesh and nothing else: certify where it belongs in the file, write, say so.
void write_and_report(const OutputOptions& output, const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                      const Invocation& invocation, const TaskContext& context, Json& timings, const Stopwatch& watch);
/// Adds "total" to the timings.
void finish_timings(Json& timings, const Stopwatch& watch);
/// Sentence on standard error when the mesh is numbered clockwise or mixed; none otherwise or with --quiet.
void warn_about_orientation(const QualityReport& report, const Invocation& invocation);
/// The status that validity decides: exit_done, or exit_not_valid if elements are invalid or undecided.
int validity_status(const QualitySummary& summary);

}  // namespace curvewright::cli
