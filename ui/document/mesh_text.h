#pragma once

#include <vector>

#include <QString>
#include <QVector>

#include "core/mesh/curved_mesh.h"
#include "core/quality/quality.h"

namespace curvewright {

/// "P3 · 1,338 triangles"; mixed meshes name every kind.
QString describe_elements(const MeshTopology& topology);
/// "✓ all proved valid", "✕ 8 tangled · 2 undecided": short, for the side panel.
QString describe_validity(const QualitySummary& summary);
/// The same as a sentence, for the status bar: "8 elements are tangled (scaled Jacobian ≤ 0)".
QString validity_sentence(const QualitySummary& summary);

/// A physical group, as a list shows it; or the interfaces inside the domain that are in none.
struct GroupLine {
    QString name;
    int dimension = 0;
    std::vector<Index> nodes;
    /// Elements of the group; for a group of lower dimension, the elements that have a facet on it (of an interface
    /// inside the domain: on either side).
    std::vector<Index> elements;
};
QVector<GroupLine> list_groups(const MeshTopology& topology);

}  // namespace curvewright
