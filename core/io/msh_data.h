#pragma once

#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/io/msh_scanner.h"
#include "core/mesh/field_array.h"
#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// Gathers the sections $NodeData and $ElementData of an MSH file, wherever they stand, and attaches them to the mesh
/// when it is whole.
class MshData {
  public:
    /// Reads a section up to its $End. Throws InvalidInput with file and line.
    void read(MshScanner& in, FieldArray::Place place, const TaskContext& context);

    /// The arrays in the order of the mesh. Values of nodes and elements that the mesh does not have are passed over,
    /// of which a note tells. Sections of the same name and time step become one array if they speak of different nodes
    /// or elements (files of partitioned meshes have them), and several time steps one array each.
    std::vector<FieldArray> attach(const MeshTopology& topology, std::vector<std::string>& notes);

  private:
    struct Section {
        FieldArray head;  ///< without values
        long line = 0;
        std::vector<std::int64_t> tags;
        std::vector<double> values;  ///< tags × components
    };
    std::vector<Section> sections_;
};

}  // namespace curvewright
