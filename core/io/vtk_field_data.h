#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkSmartPointer.h>

#include "core/io/provenance.h"
#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// An array with a name and room for its values.
template <class Array>
vtkSmartPointer<Array> new_array(const char* name, int components, vtkIdType tuples) {
    auto array = vtkSmartPointer<Array>::New();
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(tuples);
    return array;
}

/// Values of an integer array with the given name and size; none if there is no such array.
std::optional<std::vector<std::int64_t>> integer_values(vtkFieldData& data, const char* name, int components,
                                                        std::optional<vtkIdType> tuples);

/// Puts what VTK has no place for into arrays of numbers (text as bytes: not every reader knows arrays of strings): the
/// version of these arrays, entities, groups, where nodes lie, periodic links, partitions, and who made the file.
void fill_field_data(vtkFieldData& field, const MeshData& data, const Provenance* provenance);

/// Version of the arrays of a file that this program wrote: 1 had linear prisms in another order than VTK's and the
/// names of groups as strings. None if the file does not say (version 1, or not ours).
std::optional<int> field_data_version(vtkFieldData& field);

/// Takes what fill_field_data wrote (any version) into data, whose node tags are known. What does not fit is left out,
/// of which a note tells.
void read_field_data(vtkFieldData& field, MeshData& data, std::vector<std::string>& notes);

}  // namespace curvewright
