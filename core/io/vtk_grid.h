#pragma once

#include <string>

#include "core/io/mesh_io.h"

class vtkUnstructuredGrid;

namespace curvewright {

/// Fills an empty grid with all cells of all dimensions, their tags, and (as field data named "Curvewright...") what is
/// needed to restore the rest (see vtk_field_data.h). Cells of order 1 become VTK's linear cells, others Lagrange
/// cells. is_legacy_text: the file will be legacy VTK text, in which VTK cannot read NaN back: ScaledJacobian of the
/// cells of lower dimension, which have none, is then 1, of elements that were not assessed 0, and missing values of
/// arrays are 0, of which notes tell. Throws Unsupported for pyramids above order 1 and InvalidInput if the options do
/// not fit the mesh.
void fill_grid(vtkUnstructuredGrid& grid, const CurvedMesh& mesh, const WriteOptions& options, bool is_legacy_text,
               std::vector<std::string>& notes);

/// How the Lagrange hexahedra of a file are numbered: as VTK 9 does, or as earlier versions did (VTU before 2.1).
enum class HexahedronOrder { vtk9, vtk8 };

/// The mesh that a grid holds. Without this program's arrays, nodes and elements are numbered from 1 and there are no
/// groups. Throws InvalidInput and Unsupported that name the file.
ReadResult mesh_of_grid(vtkUnstructuredGrid& grid, const std::string& file, MeshFormat format,
                        HexahedronOrder order = HexahedronOrder::vtk9);

}  // namespace curvewright
