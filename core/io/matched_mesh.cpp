#include "core/io/matched_mesh.h"

#include <fmt/format.h>

#include "core/mesh/coincident_nodes.h"
#include "core/mesh/conformity.h"

namespace curvewright {
namespace {

std::string counted_nodes(Index count) {
    return fmt::format("{} {}", count, count == 1 ? "node" : "nodes");
}

void merge(ReadResult& read, const CoincidentNodes& nodes) {
    MergedMesh merged = merge_nodes(read.mesh, nodes);
    read.fields = merged_fields(read.fields, merged, read.notes);
    read.mesh = std::move(merged.mesh);
}

/// No two elements share a node: they are connected wherever that collapses none of them.
void connect_separate_elements(ReadResult& read, const CoincidentNodes& found) {
    const CoincidentNodes nodes = without_collapsing(read.mesh.topology(), found);
    const Index left = found.surplus() - nodes.surplus();
    if (nodes.surplus() > 0) {
        read.notes.push_back(fmt::format(
            "Every element has nodes of its own; {} at the places of others (within {:g} of the mesh's size) "
            "{} merged with them.",
            counted_nodes(nodes.surplus()), cautious_coincidence.tolerance, nodes.surplus() == 1 ? "was" : "were"));
        merge(read, nodes);
    }
    if (left > 0)
        read.notes.push_back(
            fmt::format("{} at the places of others stayed as {}, because an element has several nodes there.",
                        counted_nodes(left), left == 1 ? "it is" : "they are"));
}

}  // namespace

void match_nodes(ReadResult& read, std::optional<double> tolerance, const TaskContext& context) {
    if (tolerance) {
        const CoincidentNodes found = find_coincident_nodes(read.mesh, {*tolerance}, context);
        const Index count = found.surplus();
        if (count > 0) merge(read, found);
        read.notes.push_back(count > 0 ? fmt::format("{} within {:g} of the mesh's size of others {} merged with them.",
                                                     counted_nodes(count), *tolerance, count == 1 ? "was" : "were")
                                       : fmt::format("No nodes lie within {:g} of the mesh's size of others, so none "
                                                     "were merged.",
                                                     *tolerance));
    } else if (const CoincidentNodes found = find_coincident_nodes(read.mesh, cautious_coincidence, context);
               !found.groups.empty()) {
        if (has_separate_elements(read.mesh.topology()))
            connect_separate_elements(read, found);
        else
            read.notes.push_back(
                fmt::format("{} at the places of others, so that the mesh is not connected there; --merge-nodes {:g} "
                            "merges them.",
                            found.surplus() == 1 ? "1 node lies" : fmt::format("{} nodes lie", found.surplus()),
                            cautious_coincidence.tolerance));
    }
    const Nonconformity nonconformity = find_nonconformity(read.mesh, context);
    if (!nonconformity.conforms())
        read.notes.push_back(describe(nonconformity, read.mesh.topology()) +
                             "; the mesh can be looked at, but commands that move nodes refuse it.");
    if (!nonconformity.touching.empty()) {
        const HangingNode& first = nonconformity.touching.front();
        const MeshTopology& topology = read.mesh.topology();
        read.notes.push_back(
            fmt::format("Bodies touch without having a node in common: node {} lies on element {} of another body (the "
                        "first of {}); each moves by itself.",
                        topology.node_tag(first.node).value, topology.element_tag(first.facet.element).value,
                        nonconformity.touching.size()));
    }
}

ReadResult read_matched_mesh(const std::filesystem::path& file, std::optional<double> tolerance,
                             const TaskContext& context) {
    ReadResult read = read_mesh(file, context);
    match_nodes(read, tolerance, context);
    return read;
}

}  // namespace curvewright
