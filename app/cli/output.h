#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/cli/work.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"

namespace curvewright::cli {

/// "mesh": file, dimension, order, elements, nodes, interior_nodes.
Json mesh_json(const std::filesystem::path& file, const CurvedMesh& mesh);
/// "scaled_jacobian": min, mean, max (null if nothing was assessed), valid, invalid, undecided, not_assessed, reversed.
Json summary_json(const QualitySummary& summary);
/// "worst": at most 10 of element (tag), scaled_jacobian, center.
Json worst_json(const CurvedMesh& mesh, const QualityReport& report);

/// "P3, 30 triangles, 159 nodes (111 interior)".
std::string mesh_line(const CurvedMesh& mesh);
/// "min −0.222, mean 0.634, max 1.000; 28 valid, 2 invalid, 0 undecided" in ASCII.
std::string summary_line(const QualitySummary& summary);

/// Reads a mesh, merges its coincident nodes as asked (read_matched_mesh) and notes what there is to say of it. Timed
/// as "read".
ReadResult read_input(const InputOptions& input, Work& work);
/// assess_quality, timed as "certify".
QualityReport certify(const CurvedMesh& mesh, Work& work, const QualityOptions& options = {});
/// certify of what became of `original`: judged with its orientation.
QualityReport certify_result(const CurvedMesh& mesh, const QualityReport& original, Work& work);
/// Whether the quality of the mesh can be assessed at all.
bool is_assessable(const CurvedMesh& mesh);

/// The quality of a mesh, or why there is none.
struct Assessment {
    std::optional<QualityReport> report;
    std::string note;  ///< one sentence; empty if there is a report
};
/// certify for any mesh.
Assessment assess(const CurvedMesh& mesh, Work& work, const QualityOptions& options = {});
/// assess of what became of `original`: judged with its orientation.
Assessment assess_result(const CurvedMesh& mesh, const Assessment& original, Work& work);
/// Adds "scaled_jacobian"; where there is no report that is null, and "quality_note" says why.
void add_assessment(Json& json, const Assessment& assessment);

/// The quality that belongs in the output: none for MSH, which has no place for it, and for meshes that are not
/// assessable.
std::optional<QualityReport> certify_for(const OutputOptions& output, const CurvedMesh& mesh, Work& work);
/// Throws InvalidInput if the output cannot be: unknown suffix, no such folder, a folder in the file's place. To be
/// called before the work.
void check_output(const OutputOptions& output);
/// Writes the mesh with the arrays of its nodes and elements, timed as "write". quality may be null. Notes what the
/// format could not hold.
void write_output(const OutputOptions& output, const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                  const QualityReport* quality, const Coordinates* reference, Work& work);
/// What commands do whose result is a mesh and nothing else: certify where it belongs in the file, write, say so.
/// more: what --json has besides the mesh; an object.
void write_and_report(const OutputOptions& output, const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                      Work& work, const Json& more = Json::object());
/// Notes how many elements are reversed and what is one-sided, if there are such.
void note_winding(const MeshTopology& topology, Work& work);
/// note_winding; notes, too, that the mesh or parts of it are numbered clockwise and what was not assessed.
void note_assessment(const MeshTopology& topology, const QualityReport& report, Work& work);
/// The status that validity decides: exit_done, or exit_not_valid if elements are invalid or undecided.
int validity_status(const QualitySummary& summary);
/// The one of two statuses of a command that got done that says more: not valid before less than asked before done.
int worse_status(int a, int b);

}  // namespace curvewright::cli
