#pragma once

/// \file
/// All of the library in one header: reading and writing meshes, certified quality, boundary deformations, warping,
/// untangling. Needs Eigen; neither VTK nor Qt.
///
///     #include <curvewright/curvewright.h>
///     using namespace curvewright;
///
///     const CurvedMesh mesh = read_mesh("part.msh").mesh;
///     const Deformation deformation = read_deformation("part.json");
///     const WarpResult warped = warp(mesh, apply_deformation(mesh, deformation));
///     const CurvedMesh result = mesh.with_coordinates(warped.coordinates);
///     const QualityReport report = assess_quality(result);
///     if (report.summary.valid == report.summary.elements()) write_mesh("part.vtu", result);
///
/// Functions throw curvewright::Error, whose what() is one sentence. Those that can take long have a TaskContext as
/// their last parameter, for progress and cancellation. examples/ has complete programs.

/// \namespace curvewright
/// The library. Coordinates are in the mesh's unit of length; indices begin at 0, tags are the file's.

#include "core/base/error.h"
#include "core/base/ids.h"
#include "core/base/parallel.h"
#include "core/base/task.h"
#include "core/basis/element_type.h"
#include "core/deform/deformation.h"
#include "core/io/deformation_file.h"
#include "core/io/mesh_io.h"
#include "core/io/node_list_file.h"
#include "core/mesh/curved_mesh.h"
#include "core/mesh/elevate.h"
#include "core/mesh/mesh_topology.h"
#include "core/quality/quality.h"
#include "core/session/replay.h"
#include "core/session/session_file.h"
#include "core/untangle/guaranteed.h"
#include "core/untangle/improve.h"
#include "core/untangle/observer.h"
#include "core/untangle/signed_angles.h"
#include "core/untangle/unsigned_angles.h"
#include "core/warp/incremental.h"
#include "core/warp/response.h"
#include "core/warp/straight_start.h"
#include "core/warp/warp.h"

#ifdef CURVEWRIGHT_VTK_READER
namespace curvewright::detail {
/// The target Curvewright::core knows where the library's program that reads VTK files lies.
inline const bool is_vtk_reader_named = (set_vtk_reader(CURVEWRIGHT_VTK_READER), true);
}  // namespace curvewright::detail
#endif
