#include <set>

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/output.h"

namespace curvewright::cli {
namespace {

/// Number of cells in a group.
long cells_of_group(const MeshTopology& topology, const PhysicalGroup& group) {
    long count = 0;
    for (const Entity& entity : topology.entities()) {
        if (entity.dimension != group.dimension) continue;
        if (std::find(entity.physical_tags.begin(), entity.physical_tags.end(), group.tag) ==
            entity.physical_tags.end())
            continue;
        for (const ElementBlock& block : topology.blocks())
            if (dimension(block.type.shape) == group.dimension && block.entity_tag == entity.tag) count += block.size();
    }
    return count;
}

int run(const InputOptions& options, Work& work) {
    const std::filesystem::path& file = options.file;
    const ReadResult input = read_input(options, work);
    const CurvedMesh& mesh = input.mesh;
    const MeshTopology& topology = mesh.topology();
    const auto box = bounding_box(mesh);
    const std::string orientation = is_assessable(mesh) ? to_string(find_orientation(mesh)) : "not defined";

    Json types = Json::object(), groups = Json::array();
    for (const ElementBlock& block : topology.blocks()) {
        const std::string key = name(block.type);
        types[key] = types.value(key, 0L) + block.size();
    }
    for (const PhysicalGroup& group : topology.groups()) {
        const auto nodes = topology.find_group_nodes(MeshTopology::display_name(group));
        groups.push_back({{"name", group.name},
                          {"used_as", MeshTopology::display_name(group)},
                          {"dimension", group.dimension},
                          {"tag", group.tag},
                          {"cells", cells_of_group(topology, group)},
                          {"nodes", nodes ? nodes->size() : 0}});
    }
    Json arrays = Json::array();
    for (const FieldArray& field : input.fields) {
        const auto range = finite_range(scalar_values(field.values, field.components, -1));
        arrays.push_back({{"name", field.name},
                          {"on", field.place == FieldArray::Place::nodes ? "nodes" : "elements"},
                          {"components", field.components},
                          {"range", range ? Json{range->first, range->second} : Json()}});
    }
    note_winding(topology, work);
    if (work.is_json()) {
        const Json json = {
            {"mesh", mesh_json(file, mesh)},
            {"format", to_string(input.format)},
            {"cells", types},
            {"groups", groups},
            {"arrays", arrays},
            {"entities", topology.entities().size()},
            {"periodic", topology.data().periodic.size()},
            {"partitions", topology.data().partitioning.count},
            {"orientation", orientation},
            {"reversed", topology.reversed_count()},
            {"bounding_box", {{box(0, 0), box(0, 1), box(0, 2)}, {box(1, 0), box(1, 1), box(1, 2)}}},
        };
        work.print(json);
        return exit_done;
    }
    fmt::print("{} ({})\n", file.string(), to_string(input.format));
    fmt::print("  {}D, order {}: {}\n", topology.dimension(), topology.order(), mesh_line(mesh));
    for (const auto& [type, count] : types.items()) fmt::print("  cells        {} {}\n", count.get<long>(), type);
    fmt::print("  orientation  {}\n", orientation);
    if (topology.reversed_count() > 0) fmt::print("  reversed     {} elements\n", topology.reversed_count());
    fmt::print("  box          [{:.6g}, {:.6g}] x [{:.6g}, {:.6g}] x [{:.6g}, {:.6g}]\n", box(0, 0), box(1, 0),
               box(0, 1), box(1, 1), box(0, 2), box(1, 2));
    for (const Json& group : groups)
        fmt::print("  group        {} (dimension {}, tag {}): {} cells, {} nodes\n",
                   group["used_as"].get<std::string>(), group["dimension"].get<int>(), group["tag"].get<int>(),
                   group["cells"].get<long>(), group["nodes"].get<std::size_t>());
    for (const PeriodicLink& link : topology.data().periodic)
        fmt::print("  periodic     entity {} of dimension {} is a copy of {}: {} nodes\n", link.tag, link.dimension,
                   link.master_tag, link.nodes.size());
    if (const int partitions = topology.data().partitioning.count; partitions > 0)
        fmt::print("  partitions   {}\n", partitions);
    for (const Json& array : arrays)
        fmt::print("  array        {} on {}: {}, {}\n", array["name"].get<std::string>(),
                   array["on"].get<std::string>(),
                   array["components"] == 1 ? "numbers" : fmt::format("vectors of {}", array["components"].get<int>()),
                   array["range"].is_null()
                       ? "no value"
                       : fmt::format("{} {:.6g} to {:.6g}", array["components"] == 1 ? "from" : "of length",
                                     array["range"][0].get<double>(), array["range"][1].get<double>()));
    return exit_done;
}

}  // namespace

void add_info(CLI::App& app, Invocation& invocation) {
    auto* command = add_command(app, invocation, "info", "Type, order, counts, groups, orientation, bounding box");
    auto input = std::make_shared<InputOptions>();
    add_input_option(*command, *input, "MESH");
    set_action(*command, invocation, input, run);
}

}  // namespace curvewright::cli
