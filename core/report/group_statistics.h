#pragma once

#include <string>
#include <vector>

#include "core/report/run_report.h"

namespace curvewright {

/// One entry per physical group that has elements, those of the mesh's dimension first; "" stands for the elements that
/// are in no group of that dimension, if there are groups.
std::vector<ReportGroup> group_statistics(const MeshTopology& topology, const QualityReport& before,
                                          const QualityReport& after);

/// Names of the groups of the mesh's dimension that an element is in.
std::vector<std::string> groups_of(const MeshTopology& topology, Index element);

}  // namespace curvewright
