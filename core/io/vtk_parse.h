#pragma once

#include <string>

#include <vtkSmartPointer.h>

class vtkUnstructuredGrid;

namespace curvewright {

/// What VTK's reader made of a file: a grid, or why there is none.
struct VtkParse {
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    std::string failure;  ///< VTK's own words, in one line; "" with a grid
    bool is_out_of_memory = false;
};

/// Reads a VTU (is_xml) or legacy VTK file with VTK's own reader, which believes what damaged files say: it may crash,
/// run on for ever or ask for all memory. So this is called in a process of its own (vtk_process.h), and by nobody
/// else.
VtkParse parse_vtk(const std::string& path, bool is_xml);

}  // namespace curvewright
