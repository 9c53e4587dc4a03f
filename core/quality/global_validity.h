#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"

namespace curvewright {

/// An answer that may not be known.
enum class GlobalValidity { yes, no, undecided };
/// "yes", "no", "undecided".
const char* to_string(GlobalValidity answer);

/// Two facets; the same one twice for a facet that crosses itself.
struct FacetPair {
    Facet a, b;
};

struct GlobalValidityOptions {
    /// Pairs of facets that are listed, at most; all of them are counted.
    std::size_t most_listed = 100;
    /// Cuts of facets that all pairs together may take, beyond a few hundred for each, before the rest is undecided.
    std::int64_t most_cuts = 2'000'000;
};

/// What is proved about the boundary of a mesh, whatever is inside it.
struct BoundaryEmbedding {
    /// yes: no two facets cross, and the boundary winds once around all that it has inside; so it bounds a region once.
    /// no: no mesh with this boundary and elements of J > 0 is free of overlaps.
    GlobalValidity answer = GlobalValidity::undecided;
    std::string reason;  ///< one sentence
    /// Facets that are proved to cross, or that lie on each other with both elements on the same side, in the order of
    /// the mesh's boundary facets.
    std::vector<FacetPair> crossings;
    Index crossing_count = 0;
    /// Facets that touch each other, or for which the cuts that are allowed were not enough.
    std::vector<FacetPair> unsettled;
    Index unsettled_count = 0;
    /// Facets between the same corners that are of different order and do not lie on each other: neighbours that do not
    /// match.
    std::vector<FacetPair> unmatched;
    Index unmatched_count = 0;
};

/// Whether a mesh is more than a set of valid elements: its map into space is injective but for common facets.
struct GlobalValidityReport {
    GlobalValidity answer = GlobalValidity::undecided;
    std::string reason;                                     ///< one sentence: of the part that decides
    GlobalValidity elements = GlobalValidity::undecided;    ///< every J > 0
    GlobalValidity conformity = GlobalValidity::undecided;  ///< facets match, with elements on both sides
    std::vector<FacetPair> conflicts;                       ///< facets that do not match
    Index conflict_count = 0;
    BoundaryEmbedding boundary;
};

/// Whether the boundary crosses itself, and what it winds around. signs: of J of valid elements
/// (QualityReport::orientation_sign). The same for every number of threads. Throws Unsupported unless the mesh is flat
/// (z constant) or solid, and Cancelled. Method: docs/METHODS.md, "Valid as a mesh".
BoundaryEmbedding assess_boundary_embedding(const CurvedMesh& mesh, const OrientationSigns& signs,
                                            const GlobalValidityOptions& options = {}, const TaskContext& context = {});

/// Whether all nodes of the boundary are bit for bit where they were: what was found about the boundary still holds.
bool has_same_boundary(const MeshTopology& topology, const Coordinates& a, const Coordinates& b);

/// Whether the mesh is valid as a whole: (i) every J > 0, (ii) facets conform with elements on opposite sides, (iii)
/// the boundary is embedded, with winding number 1 inside. Together they imply that no two elements overlap. quality:
/// of the mesh at these coordinates. known: what was found about its boundary (see has_same_boundary); null: to be
/// found. Elements that are numbered the other way round than their neighbours are judged as if they were renumbered.
/// Throws InvalidInput for a report of another mesh, Unsupported and Cancelled.
GlobalValidityReport assess_global_validity(const CurvedMesh& mesh, const QualityReport& quality,
                                            const GlobalValidityOptions& options = {}, const TaskContext& context = {},
                                            const BoundaryEmbedding* known = nullptr);

/// "facet 2 of element 17 and facet 0 of element 99"; "facet 2 of element 17" for a pair of the same.
std::string describe(const MeshTopology& topology, const FacetPair& pair);
/// Middle of a facet's corners.
Eigen::RowVector3d facet_center(const CurvedMesh& mesh, Facet facet);

}  // namespace curvewright
