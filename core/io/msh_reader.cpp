#include <algorithm>
#include <limits>
#include <optional>
#include <unordered_map>

#include "core/basis/node_ordering.h"
#include "core/io/mesh_entities.h"
#include "core/io/msh2_elements.h"
#include "core/io/msh_data.h"
#include "core/io/msh_io.h"
#include "core/io/msh_links.h"
#include "core/io/msh_scanner.h"
#include "core/io/msh_types.h"

namespace curvewright {
namespace {

/// Node tags to positions: a table where the tags are dense, as they nearly always are.
class NodeFinder {
  public:
    /// Position of a tag that occurs twice, if there is one.
    std::optional<std::size_t> build(const std::vector<NodeTag>& tags) {
        std::int64_t highest = 0;
        for (const NodeTag tag : tags) highest = std::max(highest, tag.value);
        const bool is_dense = highest < static_cast<std::int64_t>(8 * tags.size() + 1024);
        if (is_dense) table_.assign(static_cast<std::size_t>(highest) + 1, -1);
        for (std::size_t i = 0; i < tags.size(); ++i) {
            if (find(tags[i].value) >= 0) return i;
            if (is_dense)
                table_[static_cast<std::size_t>(tags[i].value)] = static_cast<Index>(i);
            else
                map_.emplace(tags[i].value, static_cast<Index>(i));
        }
        return std::nullopt;
    }
    Index find(std::int64_t tag) const {
        if (tag >= 0 && tag < static_cast<std::int64_t>(table_.size())) return table_[static_cast<std::size_t>(tag)];
        const auto found = map_.find(tag);
        return found == map_.end() ? -1 : found->second;
    }

  private:
    std::vector<Index> table_;
    std::unordered_map<std::int64_t, Index> map_;
};

class MshReader {
  public:
    MshReader(std::string_view text, const std::string& file, const TaskContext& context)
        : in_(text, file), context_(context) {}

    ReadResult read() {
        if (in_.at_end()) throw InvalidInput(in_.file(), 0, "the file is empty.");
        while (!in_.at_end()) read_section();
        if (version_ == 0.0)
            throw InvalidInput(in_.file(), 0, "the file has no $MeshFormat section; is it an MSH file?");
        if (!has_nodes_) throw InvalidInput(in_.file(), 0, "the file ends without a $Nodes section.");
        if (!has_elements_) throw InvalidInput(in_.file(), 0, "the file ends without an $Elements section.");
        if (has_negative_groups_)
            notes_.push_back("Negative tags of physical groups (reversed orientation) were read as positive.");
        const Coordinates coordinates =
            Eigen::Map<const Coordinates>(xyz_.data(), static_cast<Eigen::Index>(data_.node_tags.size()), 3);
        periodic_.attach(
            data_, [this](std::int64_t tag) { return finder_.find(tag); }, notes_);
        complete_entities(data_, coordinates);
        complete_groups(data_);
        context_.report("reading", 1.0);
        CurvedMesh mesh = assemble_mesh(std::move(data_), coordinates, in_.file());
        std::vector<FieldArray> fields = arrays_.attach(mesh.topology(), notes_);
        return {std::move(mesh), version_ < 3.0 ? MeshFormat::msh2 : MeshFormat::msh4, std::move(notes_),
                std::move(fields)};
    }

  private:
    void read_section();
    void read_format();
    void read_physical_names();
    void read_entities(bool is_partitioned);
    Entity read_entity(int dim, bool is_partitioned);
    void read_nodes_4();
    void read_nodes_2(bool is_parametric);
    void read_node(std::int64_t tag, std::size_t offset, NodeEntity entity);
    void finish_nodes();
    void read_elements_4();
    void read_elements_2();
    /// Looks the nodes up, in this program's order, and puts them into nodes_.
    void read_element_nodes(ElementType type, std::int64_t element);
    ElementType read_element_type(const std::string& whose);
    int read_physical_tag();
    void poll() {
        if (++polls_ % 4096 != 0) return;
        const auto done = static_cast<double>(in_.position());
        context_.report("reading", done / (done + static_cast<double>(in_.remaining())));
    }

    MshScanner in_;
    MshData arrays_;
    MshPeriodic periodic_;
    const TaskContext& context_;
    double version_ = 0.0;
    bool has_nodes_ = false, has_elements_ = false, has_entities_ = false, has_negative_groups_ = false;
    MeshData data_;
    std::vector<double> xyz_;                ///< three per node
    std::vector<std::size_t> node_offsets_;  ///< where each node stands in the text, for messages
    std::vector<NodeEntity> node_entities_;
    NodeFinder finder_;
    std::vector<Index> raw_nodes_, nodes_;  ///< of one element: in the file's order, in ours
    std::vector<std::string> notes_;
    long polls_ = 0;
};

void MshReader::read_section() {
    const std::string first(in_.word("a section"));
    if (first.front() != '$') {
        if (version_ == 0.0) in_.fail("the file does not begin with $MeshFormat; is it an MSH file?");
        notes_.push_back(fmt::format("Line {}, which stands outside of all sections, was skipped.", in_.line()));
        in_.rest_of_line();
        return;
    }
    const std::string name = first.substr(1);
    if (name == "NOD" || name == "NOE" || name == "ELM")
        throw Unsupported(
            fmt::format("{}: this is a file of MSH version 1; versions 2.2, 4.0 and 4.1 are supported "
                        "(\"gmsh FILE -save -format msh41 -o NEW.msh\" converts it).",
                        in_.file()));
    if (name.starts_with("End")) in_.fail(fmt::format("{} closes a section that was not opened.", first));
    if (version_ == 0.0 && name != "MeshFormat" && name != "Comments")
        in_.fail(fmt::format("{} stands before $MeshFormat.", first));
    const bool is_4 = version_ >= 4.0;
    if (name == "MeshFormat")
        read_format();
    else if (name == "PhysicalNames")
        read_physical_names();
    else if (is_4 && name == "Entities")
        read_entities(false);
    else if (is_4 && name == "PartitionedEntities")
        read_entities(true);
    else if (name == "Nodes" && is_4)
        read_nodes_4();
    else if (name == "Nodes" || (name == "ParametricNodes" && !is_4))
        read_nodes_2(name != "Nodes");
    else if (name == "Elements" && is_4)
        read_elements_4();
    else if (name == "Elements")
        read_elements_2();
    else if (name == "Periodic")
        periodic_.read(in_, version_, context_);
    else if (is_4 && name == "GhostElements")
        read_ghost_elements(in_, data_.partitioning, context_);
    else if (name == "NodeData" || name == "ElementData")
        arrays_.read(in_, name == "NodeData" ? FieldArray::Place::nodes : FieldArray::Place::elements, context_);
    else {
        in_.skip_section(name);
        if (name != "Comments") notes_.push_back(fmt::format("Section ${} was skipped.", name));
        return;
    }
    in_.end_section(name);
}

void MshReader::read_format() {
    if (version_ != 0.0) in_.fail("a second $MeshFormat section stands here.");
    const double version = in_.real("the version of the format");
    const bool is_known = (version >= 2.0 && version < 3.0) || version == 4.0 || version == 4.1;
    if (!is_known)
        throw Unsupported(fmt::format("{}:{}: MSH version {} is not supported; 2.2, 4.0 and 4.1 are.", in_.file(),
                                      in_.line(), version));
    const int type = in_.integer<int>("the file type (0 for ASCII)");
    if (type != 0)
        throw Unsupported(
            fmt::format("{}: this is a binary MSH file; only ASCII is supported (\"gmsh FILE -save "
                        "-format msh41 -setnumber Mesh.Binary 0 -o NEW.msh\" converts it).",
                        in_.file()));
    in_.integer<int>("the size of numbers (8)");
    version_ = version;
}

void MshReader::read_physical_names() {
    const std::size_t count = in_.count("physical names", 5);
    for (std::size_t i = 0; i < count; ++i) {
        PhysicalGroup group;
        group.dimension = in_.integer<int>("the dimension of a physical group");
        if (group.dimension < 0 || group.dimension > 3)
            in_.fail(fmt::format("a physical group has dimension {}; 0 to 3 were expected.", group.dimension));
        group.tag = read_physical_tag();
        const long line = in_.line();
        const std::string_view rest = in_.rest_of_line();
        const std::size_t open = rest.find('"'), close = rest.rfind('"');
        if (open == rest.npos || close == open)
            throw InvalidInput(in_.file(), line, "the name of a physical group in quotation marks was expected.");
        group.name = rest.substr(open + 1, close - open - 1);
        const auto is_same = [&](const PhysicalGroup& other) {
            return other.dimension == group.dimension && other.tag == group.tag;
        };
        if (std::any_of(data_.groups.begin(), data_.groups.end(), is_same))
            notes_.push_back(
                fmt::format("Line {}: physical group {} of dimension {} has a second name, \"{}\", which "
                            "was passed over.",
                            line, group.tag, group.dimension, group.name));
        else
            data_.groups.push_back(std::move(group));
    }
}

int MshReader::read_physical_tag() {
    const int tag = in_.integer<int>("the tag of a physical group");
    if (tag == std::numeric_limits<int>::min()) in_.fail(fmt::format("the physical tag {} is out of range.", tag));
    if (tag < 0) has_negative_groups_ = true;
    return std::abs(tag);
}

Entity MshReader::read_entity(int dim, bool is_partitioned) {
    Entity entity;
    entity.dimension = dim;
    entity.tag = in_.integer<int>("the tag of an entity");
    if (is_partitioned) read_entity_parent(in_, entity);
    const bool is_position = dim == 0 && version_ > 4.0;
    for (int d = 0; d < (is_position ? 3 : 6); ++d)
        entity.bounding_box[d] = in_.real(is_position ? "a coordinate of a point" : "a bound of an entity's box");
    if (is_position) std::copy_n(entity.bounding_box.begin(), 3, entity.bounding_box.begin() + 3);
    const std::size_t physicals = in_.count("physical tags of the entity");
    for (std::size_t i = 0; i < physicals; ++i) {
        const int tag = read_physical_tag();
        auto& tags = entity.physical_tags;
        if (tag != 0 && std::find(tags.begin(), tags.end(), tag) == tags.end()) tags.push_back(tag);
    }
    if (dim == 0) return entity;
    const std::size_t bounding = in_.count("bounding entities");
    for (std::size_t i = 0; i < bounding; ++i)
        entity.bounding_entities.push_back(in_.integer<int>("the tag of a bounding entity"));
    return entity;
}

void MshReader::read_entities(bool is_partitioned) {
    if (is_partitioned) {
        read_partition_head(in_, data_.partitioning);
    } else if (has_entities_) {
        in_.fail("a second $Entities section stands here.");
    } else {
        has_entities_ = true;
    }
    std::map<EntityKey, std::size_t> places;
    for (std::size_t i = 0; i < data_.entities.size(); ++i)
        places.emplace(EntityKey(data_.entities[i].dimension, data_.entities[i].tag), i);
    std::array<std::size_t, 4> counts{};
    for (auto& count : counts) count = in_.count("entities", 10);
    for (int dim = 0; dim < 4; ++dim)
        for (std::size_t i = 0; i < counts[dim]; ++i) {
            Entity entity = read_entity(dim, is_partitioned);
            const auto [place, is_new] = places.try_emplace({dim, entity.tag}, data_.entities.size());
            if (is_new)
                data_.entities.push_back(std::move(entity));
            else if (is_partitioned && !data_.entities[place->second].is_partition())
                data_.entities[place->second] = std::move(entity);
            else
                in_.fail(fmt::format("entity {} of dimension {} occurs twice.", entity.tag, dim));
        }
}

void MshReader::read_node(std::int64_t tag, std::size_t offset, NodeEntity entity) {
    if (tag < 0) in_.fail(fmt::format("a node has the tag {}; tags are positive.", tag));
    data_.node_tags.push_back({tag});
    node_offsets_.push_back(offset);
    node_entities_.push_back(entity.tag == 0 ? NodeEntity{} : entity);
    poll();
}

void MshReader::finish_nodes() {
    const auto twin = finder_.build(data_.node_tags);
    if (twin)
        throw InvalidInput(
            in_.file(), in_.line(node_offsets_[*twin]),
            fmt::format("node {} occurs twice; node tags must be unique.", data_.node_tags[*twin].value));
    node_offsets_ = {};
    const bool is_classified = std::any_of(node_entities_.begin(), node_entities_.end(),
                                           [](const NodeEntity& entity) { return entity.dimension >= 0; });
    if (is_classified) data_.node_entities = std::move(node_entities_);
    has_nodes_ = true;
}

void MshReader::read_nodes_4() {
    if (has_nodes_) in_.fail("a second $Nodes section stands here.");
    const std::size_t blocks = in_.count("node blocks", 7);
    const std::size_t total = in_.count("nodes", 7);
    if (version_ > 4.0)
        for (const char* what : {"the lowest node tag", "the highest node tag"}) in_.integer<long long>(what);
    data_.node_tags.reserve(total);
    for (std::size_t block = 0; block < blocks; ++block) {
        NodeEntity entity;
        const char *dim_name = "the dimension of an entity", *tag_name = "the tag of an entity";
        if (version_ == 4.0) entity.tag = in_.integer<int>(tag_name);
        entity.dimension = in_.integer<int>(dim_name);
        if (entity.dimension < 0 || entity.dimension > 3)
            in_.fail(fmt::format("a block of nodes has dimension {}; 0 to 3 were expected.", entity.dimension));
        if (version_ > 4.0) entity.tag = in_.integer<int>(tag_name);
        const int parametric = in_.integer<int>("0 or 1 (parametric coordinates)");
        if (parametric != 0 && parametric != 1)
            in_.fail(fmt::format("{} stands where 0 or 1 was expected.", parametric));
        const std::size_t count = in_.count("nodes of the block", 7);
        const std::size_t first = data_.node_tags.size();
        if (count > total - first)
            in_.fail(fmt::format("the blocks hold more nodes than the {} that were announced.", total));
        const auto read_position = [&] {
            for (int d = 0; d < 3; ++d) xyz_.push_back(in_.real("a coordinate"));
            for (int d = 0; parametric == 1 && d < entity.dimension; ++d) in_.real("a parametric coordinate");
        };
        for (std::size_t i = 0; i < count; ++i) {
            const auto tag = in_.integer<std::int64_t>("a node tag");
            read_node(tag, in_.word_begin(), entity);
            if (version_ == 4.0) read_position();
        }
        for (std::size_t i = 0; version_ > 4.0 && i < count; ++i) read_position();
    }
    if (data_.node_tags.size() != total)
        in_.fail(fmt::format("the blocks hold {} nodes, but {} were announced.", data_.node_tags.size(), total));
    finish_nodes();
}

void MshReader::read_nodes_2(bool is_parametric) {
    if (has_nodes_) in_.fail("a second section of nodes stands here.");
    const std::size_t count = in_.count("nodes", 7);
    data_.node_tags.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto tag = in_.integer<std::int64_t>("a node tag");
        const std::size_t offset = in_.word_begin();
        for (int d = 0; d < 3; ++d) xyz_.push_back(in_.real("a coordinate"));
        NodeEntity entity;
        if (is_parametric) {
            entity.dimension = in_.integer<int>("the dimension of an entity");
            if (entity.dimension < 0 || entity.dimension > 3)
                in_.fail(fmt::format("a node has dimension {}; 0 to 3 were expected.", entity.dimension));
            entity.tag = in_.integer<int>("the tag of an entity");
            in_.rest_of_line();
        }
        read_node(tag, offset, entity);
    }
    finish_nodes();
}

ElementType MshReader::read_element_type(const std::string& whose) {
    const auto number = in_.integer<long long>("the type of an element");
    const auto type = element_of_msh_type(number);
    if (!type)
        throw Unsupported(
            fmt::format("{}:{}: {} of Gmsh type {}, which is not supported; full Lagrange elements are "
                        "(Mesh.SecondOrderIncomplete = 0 makes Gmsh write them).",
                        in_.file(), in_.line(), whose, number));
    return *type;
}

void MshReader::read_element_nodes(ElementType type, std::int64_t element) {
    const auto& permutation = gmsh_permutation(type);
    raw_nodes_.clear();
    for (std::size_t i = 0; i < permutation.size(); ++i) {
        const auto tag = in_.integer<std::int64_t>("a node of an element");
        raw_nodes_.push_back(finder_.find(tag));
        if (raw_nodes_.back() < 0)
            in_.fail(fmt::format("element {} refers to node {}, which does not exist.", element, tag));
    }
    nodes_.clear();
    for (const int place : permutation) nodes_.push_back(raw_nodes_[static_cast<std::size_t>(place)]);
    poll();
}

void MshReader::read_elements_4() {
    if (!has_nodes_) in_.fail("$Elements stands before $Nodes.");
    if (has_elements_) in_.fail("a second $Elements section stands here.");
    const std::size_t blocks = in_.count("element blocks", 8);
    const std::size_t total = in_.count("elements", 4);
    if (version_ > 4.0)
        for (const char* what : {"the lowest element tag", "the highest element tag"}) in_.integer<long long>(what);
    std::array<std::unordered_map<std::int64_t, bool>, 4> seen;
    std::size_t read = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
        const char *dim_name = "the dimension of an entity", *tag_name = "the tag of an entity";
        const int first = in_.integer<int>(version_ > 4.0 ? dim_name : tag_name);
        const int second = in_.integer<int>(version_ > 4.0 ? tag_name : dim_name);
        const int dim = version_ > 4.0 ? first : second, entity_tag = version_ > 4.0 ? second : first;
        const ElementType type =
            read_element_type(fmt::format("the elements on entity {} of dimension {} are", entity_tag, dim));
        if (dim != dimension(type.shape))
            in_.fail(fmt::format("a {} cannot lie on an entity of dimension {}.", name(type.shape), dim));
        const auto per_element = static_cast<std::size_t>(node_count(type));
        const std::size_t count = in_.count("elements of the block", 2 * (per_element + 1));
        if (count > total - read)
            in_.fail(fmt::format("the blocks hold more elements than the {} that were announced.", total));
        read += count;
        if (count == 0) continue;
        ElementBlock& target = block_for(data_.blocks, type, entity_tag);
        if (target.tags.empty()) {
            target.tags.reserve(count);
            target.nodes.reserve(count * per_element);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const auto tag = in_.integer<std::int64_t>("an element tag");
            if (tag < 0) in_.fail(fmt::format("an element has the tag {}; tags are positive.", tag));
            if (!seen[static_cast<std::size_t>(dim)].emplace(tag, true).second)
                in_.fail(fmt::format("element {} occurs twice; element tags must be unique.", tag));
            read_element_nodes(type, tag);
            target.tags.push_back({tag});
            target.nodes.insert(target.nodes.end(), nodes_.begin(), nodes_.end());
        }
    }
    if (read != total) in_.fail(fmt::format("the blocks hold {} elements, but {} were announced.", read, total));
    has_elements_ = true;
}

void MshReader::read_elements_2() {
    if (!has_nodes_) in_.fail("$Elements stands before $Nodes.");
    if (has_elements_) in_.fail("a second $Elements section stands here.");
    Msh2Elements elements;
    const std::size_t total = in_.count("elements", 6);
    for (std::size_t i = 0; i < total; ++i) {
        const auto tag = in_.integer<std::int64_t>("an element tag");
        if (tag < 0) in_.fail(fmt::format("an element has the tag {}; tags are positive.", tag));
        const ElementType type = read_element_type(fmt::format("element {} is", tag));
        const std::size_t tags = in_.count("tags of the element");
        const int physical = tags > 0 ? read_physical_tag() : 0;
        const int elementary = tags > 1 ? in_.integer<int>("the tag of an elementary entity") : 0;
        std::vector<int> partitions = read_element_partitions(in_, tags > 2 ? tags - 2 : 0);
        read_element_nodes(type, tag);
        for (const int partition : partitions) data_.partitioning.count = std::max(data_.partitioning.count, partition);
        if (!partitions.empty())
            data_.partitioning.element_partitions.push_back({dimension(type.shape), {tag}, std::move(partitions)});
        if (elements.add(type, {tag}, physical, elementary, nodes_) == Msh2Elements::Outcome::conflict)
            in_.fail(fmt::format("element {} occurs twice; element tags must be unique.", tag));
    }
    if (const std::size_t joined = elements.join_copies(); joined > 0)
        notes_.push_back(
            fmt::format("{} copies of elements that belong to several physical groups were joined.", joined));
    if (const std::size_t split = elements.move_to(data_); split > 0)
        notes_.push_back(fmt::format(
            "{} elementary entities, whose elements belong to different physical groups, were split.", split));
    has_elements_ = true;
}

}  // namespace

ReadResult read_msh(std::string_view text, const std::string& file, const TaskContext& context) {
    return MshReader(text, file, context).read();
}

}  // namespace curvewright
