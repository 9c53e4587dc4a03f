#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/provenance.h"
#include "core/mesh/curved_mesh.h"
#include "core/mesh/field_array.h"
#include "core/quality/quality.h"

namespace curvewright {

/// MSH 2.2, MSH 4.1, VTK XML, legacy VTK.
enum class MeshFormat { msh2, msh4, vtu, vtk };
/// "msh2", "msh4", "vtu", "vtk".
const char* to_string(MeshFormat format);

/// What a mesh file holds.
struct ReadResult {
    CurvedMesh mesh;
    MeshFormat format = MeshFormat::msh4;
    /// Things the reader passed over or repaired, one sentence each ("Section $Parametrizations was skipped.").
    std::vector<std::string> notes;
    /// The file's arrays of numbers on nodes and elements, with names of their own among those of one place. Not this
    /// program's own of a file that it wrote, but for Displacement.
    std::vector<FieldArray> fields;
};

/// Reads a mesh; the suffix tells the format: .msh (4.1, 4.0 and 2.2 ASCII, by its header), .msh.gz (the same,
/// compressed), .vtu, .vtk.
/// Throws InvalidInput that names file, line (text formats), what is wrong and what was expected; Unsupported for
/// binary MSH, serendipity elements, and the like. Polls context.stop.
ReadResult read_mesh(const std::filesystem::path& file, const TaskContext& context = {});

/// How a mesh is written, and what with it.
struct WriteOptions {
    /// Not given: the suffix tells; .msh is 4.1.
    std::optional<MeshFormat> format;
    /// VTU and VTK only: compressed binary instead of ASCII. (VTU is binary by default: 17 digits cost nothing there.)
    std::optional<bool> binary;
    /// VTU and VTK: cell arrays ScaledJacobian and Validity (0 invalid, 1 valid, 2 undecided, 3 not assessed).
    const QualityReport* quality = nullptr;
    /// VTU and VTK: point array Displacement = coordinates - reference. Same size as the mesh's coordinates.
    const Coordinates* reference = nullptr;
    /// Arrays of the nodes and elements of this mesh, written along. An array with the name of one of the above is left
    /// out.
    const std::vector<FieldArray>* fields = nullptr;
    /// Who makes the file; MSH: a section $Comments, VTU and VTK: bytes among the field data.
    const Provenance* provenance = nullptr;
};

/// Writes a mesh with all its cells, tags, groups and entities: to a temporary file beside the target, which takes its
/// name only when it is complete. Throws InvalidInput if the file cannot be written or the suffix is unknown;
/// Unsupported if the format cannot hold the mesh. Returns what the format could not hold of the arrays, one sentence
/// each.
std::vector<std::string> write_mesh(const std::filesystem::path& file, const CurvedMesh& mesh,
                                    const WriteOptions& options = {});

/// Names the program that reads VTK files (curvewright-vtk-reader) for this process: VTK's own readers crash on damaged
/// files, so they run in a process of their own. Without a name it is looked for beside the running program, in
/// ../libexec/curvewright from there, and where the library was installed; without the program VTU and VTK files cannot
/// be read. An installed library's curvewright.h names it already. An empty path goes back to looking. May be called on
/// any thread.
void set_vtk_reader(const std::filesystem::path& program);

/// Format that a file name means; none if the suffix is unknown.
std::optional<MeshFormat> format_of_suffix(const std::filesystem::path& file);

}  // namespace curvewright
