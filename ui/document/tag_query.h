#pragma once

#include <QString>

#include "core/edit/selection.h"
#include "core/mesh/mesh_topology.h"

namespace curvewright {

/// Nodes and elements that somebody names by their tags.
struct TagQuery {
    IndexSet nodes, elements;
    /// What cannot be had, as one sentence; "" = all is there. What else was named is found all the same.
    QString problem;
};

/// Reads "12, 40-52, n7, e3-9": tags and ranges of tags, of nodes unless an "e" stands before them, separated by commas
/// or blanks. A range takes the tags that exist in it and is only missed if there are none.
TagQuery find_tags(const MeshTopology& topology, const QString& text);

}  // namespace curvewright
