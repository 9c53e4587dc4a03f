#pragma once

#include "benchmarks/tables/report.h"
#include "benchmarks/untangle_tables/gmsh_peer.h"
#include "benchmarks/untangle_tables/settings.h"

namespace curvewright::benchmarks {

/// The guaranteed method on the cases of the literature, against Gmsh's optimizers.
void measure_guaranteed(const Settings& settings, const GmshPeer& peer, Report& report);
/// Signed angles: beta chosen automatically against the best beta for all edges.
void measure_signed_angles(const Settings& settings, Report& report);
/// Unsigned angles: the literal method and the default.
void measure_unsigned_angles(const Settings& settings, Report& report);
/// Tetrahedra: samples and CAD shapes, boundary fixed and sliding.
void measure_tetrahedra(const Settings& settings, const GmshPeer& peer, Report& report);
/// What a change of unit and origin does.
void measure_invariance(const Settings& settings, Report& report);
/// Elements certified per second.
void measure_certification(const Settings& settings, Report& report);

}  // namespace curvewright::benchmarks
