#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <vtkSmartPointer.h>

class vtkUnstructuredGrid;

namespace curvewright {

// How the program that reads VTK files hands a grid to the one that asked for it. Numbers are those of the machine,
// every part begins at a multiple of 8 bytes, so that arrays can be used where they lie:
//
//   head    "CWGRID1\n"; 64-bit: size of all, numbers of cell types, offsets and connectivity entries
//   points  one array
//   cells   types (1 byte each), offsets (8), connectivity (8)
//   arrays  of points, of cells, of the grid: their number (64-bit), then each
//   array   32-bit: type, components, attribute, length of the name; 64-bit: tuples, bytes of data; name; data

/// The first eight bytes. The digit is the version: it changes with the layout.
constexpr char vtk_answer_magic[] = "CWGRID1\n";

/// Writes the grid to the file open as `descriptor`, which is empty. False if it cannot be written (errno tells why).
bool write_vtk_answer(vtkUnstructuredGrid& grid, int descriptor);

/// The grid that was written. Its arrays lie in `bytes`, which must outlive it and begin at a multiple of 8. Every
/// length is checked before it is believed; whether cells refer to points that exist is for mesh_of_grid. Throws
/// InvalidInput with what is wrong, without a file's name.
vtkSmartPointer<vtkUnstructuredGrid> grid_of_vtk_answer(std::span<std::byte> bytes);

}  // namespace curvewright
