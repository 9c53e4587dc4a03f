#include "core/io/msh_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>

#include <fmt/format.h>

#include "core/io/msh_io.h"

namespace curvewright {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// Where the values of a tag belong: a row of values or of lower_values.
struct Row {
    bool is_lower = false;
    std::size_t at = 0;
};

/// Places of the cells below the elements' dimension, whose tags no element has.
std::unordered_map<std::int64_t, std::size_t> find_lower_cells(const MeshTopology& topology) {
    std::unordered_map<std::int64_t, std::size_t> places;
    std::size_t next = 0;
    for (const ElementBlock& block : topology.blocks()) {
        const int dim = dimension(block.type.shape);
        if (dim > 0 && dim == topology.dimension()) continue;
        for (const ElementTag tag : block.tags) {
            if (!topology.find_element(tag)) places.try_emplace(tag.value, next);
            ++next;
        }
    }
    return places;
}

const char* section_name(FieldArray::Place place) {
    return place == FieldArray::Place::nodes ? "$NodeData" : "$ElementData";
}

}  // namespace

void MshData::read(MshScanner& in, FieldArray::Place place, const TaskContext& context) {
    Section section;
    section.head.place = place;
    section.line = in.line();
    const std::size_t strings = in.count("string tags of the data", 2);
    for (std::size_t i = 0; i < strings; ++i) {
        const std::string_view text = in.quoted(i == 0 ? "the name of the data" : "a string tag");
        if (i == 0) section.head.name = text;
    }
    if (section.head.name.empty()) section.head.name = place == FieldArray::Place::nodes ? "node data" : "element data";
    const std::size_t reals = in.count("real tags of the data");
    for (std::size_t i = 0; i < reals; ++i) {
        const double value = in.any_real("a real tag");
        if (i == 0) section.head.time = value;
    }
    const std::size_t integers = in.count("integer tags of the data");
    if (integers < 3)
        in.fail(
            fmt::format("the data have {} integer tags; three (time step, components, number of values) were "
                        "expected.",
                        integers));
    section.head.time_step = in.integer<int>("the time step");
    section.head.components = in.integer<int>("the number of components");
    if (section.head.components < 1 || section.head.components > 9)
        in.fail(fmt::format("the data have {} components; 1 to 9 were expected.", section.head.components));
    const auto width = static_cast<std::size_t>(section.head.components);
    const std::size_t count = in.count("values", 2 * (width + 1));
    for (std::size_t i = 3; i < integers; ++i) in.integer<long long>("an integer tag");  // the partition
    section.tags.reserve(count);
    section.values.reserve(count * width);
    for (std::size_t i = 0; i < count; ++i) {
        section.tags.push_back(
            in.integer<std::int64_t>(place == FieldArray::Place::nodes ? "a node tag" : "an element tag"));
        for (std::size_t c = 0; c < width; ++c) section.values.push_back(in.any_real("a value"));
        if (i % 4096 == 0) context.check();
    }
    sections_.push_back(std::move(section));
}

std::vector<FieldArray> MshData::attach(const MeshTopology& topology, std::vector<std::string>& notes) {
    std::map<std::pair<FieldArray::Place, std::string>, std::set<int>> steps;
    for (const Section& section : sections_)
        steps[{section.head.place, section.head.name}].insert(section.head.time_step);
    const auto lower = sections_.empty() ? std::unordered_map<std::int64_t, std::size_t>() : find_lower_cells(topology);
    std::size_t cells = 0;
    for (const ElementBlock& block : topology.blocks()) cells += block.tags.size();
    const std::size_t lower_count = cells - static_cast<std::size_t>(topology.element_count());

    std::vector<FieldArray> fields;
    for (Section& section : sections_) {
        FieldArray field = std::move(section.head);
        const bool is_on_nodes = field.place == FieldArray::Place::nodes;
        if (steps.at({field.place, field.name}).size() > 1)
            field.name = fmt::format("{}, step {}", field.name, field.time_step);
        const auto width = static_cast<std::size_t>(field.components);
        std::vector<Row> rows;  // of the tags that the mesh has
        std::vector<std::size_t> sources;
        for (std::size_t i = 0; i < section.tags.size(); ++i) {
            const auto index =
                is_on_nodes ? topology.find_node({section.tags[i]}) : topology.find_element({section.tags[i]});
            const auto below = is_on_nodes ? lower.end() : lower.find(section.tags[i]);
            if (!index && below == lower.end()) continue;
            rows.push_back(index ? Row{false, static_cast<std::size_t>(*index)} : Row{true, below->second});
            sources.push_back(i);
        }
        if (const std::size_t unknown = section.tags.size() - rows.size(); unknown > 0)
            notes.push_back(fmt::format(
                "Line {}: {} \"{}\" has values of {} {} that the mesh does not have; they were "
                "passed over.",
                section.line, section_name(field.place), field.name, unknown, is_on_nodes ? "nodes" : "elements"));
        const auto has_value = [width](const FieldArray& of, const Row& row) {
            const std::vector<double>& values = row.is_lower ? of.lower_values : of.values;
            const auto begin = values.begin() + static_cast<std::ptrdiff_t>(std::min(row.at * width, values.size()));
            return begin != values.end() && std::any_of(begin, begin + static_cast<std::ptrdiff_t>(width),
                                                        [](double value) { return !std::isnan(value); });
        };
        const auto partner = std::find_if(fields.begin(), fields.end(), [&](const FieldArray& other) {
            return other.place == field.place && other.name == field.name && other.components == field.components &&
                   std::none_of(rows.begin(), rows.end(), [&](const Row& row) { return has_value(other, row); });
        });
        const auto place = static_cast<std::size_t>(partner - fields.begin());
        if (partner == fields.end()) {
            const Index count = is_on_nodes ? topology.node_count() : topology.element_count();
            field.values.assign(static_cast<std::size_t>(count) * width, missing);
            fields.push_back(std::move(field));
        }
        FieldArray& target = fields[place];
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].is_lower && target.lower_values.empty())
                target.lower_values.assign(lower_count * width, missing);
            std::vector<double>& to = rows[i].is_lower ? target.lower_values : target.values;
            std::copy_n(section.values.begin() + static_cast<std::ptrdiff_t>(sources[i] * width), width,
                        to.begin() + static_cast<std::ptrdiff_t>(rows[i].at * width));
        }
    }
    sections_.clear();
    if (const int renamed = make_names_unique(fields); renamed > 0)
        notes.push_back(fmt::format("{} arrays have the name of another one and were given a number.", renamed));
    return fields;
}

// ---------------------------------------------------------------------------------------------------- writing

namespace {

/// One section. columns: which of the array's components stand in the file; -1 = 0.
void add_section(std::string& text, const FieldArray& field, const std::string& name, const std::vector<int>& columns,
                 const MeshTopology& topology) {
    const bool is_on_nodes = field.place == FieldArray::Place::nodes;
    const auto width = static_cast<std::size_t>(field.components);
    std::string rows;
    std::size_t count = 0;
    const auto add_row = [&](std::int64_t tag, const std::vector<double>& values, std::size_t at) {
        const auto value = [&](int column) {
            return column < 0 ? 0.0 : values[at * width + static_cast<std::size_t>(column)];
        };
        if (std::all_of(columns.begin(), columns.end(), [&](int c) { return c < 0 || std::isnan(value(c)); })) return;
        fmt::format_to(std::back_inserter(rows), "{}", tag);
        for (const int column : columns) fmt::format_to(std::back_inserter(rows), " {}", value(column));
        rows += '\n';
        ++count;
    };
    if (is_on_nodes) {
        for (Index node = 0; node < topology.node_count(); ++node)
            add_row(topology.node_tag(node).value, field.values, static_cast<std::size_t>(node));
    } else {
        for (Index element = 0; element < topology.element_count(); ++element)
            add_row(topology.element_tag(element).value, field.values, static_cast<std::size_t>(element));
        if (!field.lower_values.empty()) {
            const auto lower = find_lower_cells(topology);
            std::vector<std::pair<std::size_t, std::int64_t>> in_order;
            for (const auto& [tag, at] : lower) in_order.emplace_back(at, tag);
            std::sort(in_order.begin(), in_order.end());
            for (const auto& [at, tag] : in_order) add_row(tag, field.lower_values, at);
        }
    }
    const std::string_view section = std::string_view(section_name(field.place)).substr(1);
    fmt::format_to(std::back_inserter(text), "${}\n1\n\"{}\"\n1\n{}\n3\n{}\n{}\n{}\n{}$End{}\n", section, name,
                   field.time, field.time_step, columns.size(), count, rows, section);
}

}  // namespace

std::string msh_data_text(const CurvedMesh& mesh, const std::vector<FieldArray>& fields,
                          std::vector<std::string>& notes) {
    std::string text;
    for (const FieldArray& field : fields) {
        std::string name = field.name;
        std::replace(name.begin(), name.end(), '"', '\'');
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
        std::vector<int> columns;
        for (int c = 0; c < field.components; ++c) columns.push_back(c);
        if (field.components == 2) columns.push_back(-1);
        if (columns.size() == 1 || columns.size() == 3 || columns.size() == 9) {
            add_section(text, field, name, columns, mesh.topology());
            continue;
        }
        notes.push_back(
            fmt::format("The array {} has {} components, for which MSH has no place; each was written as an "
                        "array of its own.",
                        field.name, field.components));
        for (int c = 0; c < field.components; ++c)
            add_section(text, field, fmt::format("{} {}", name, c + 1), {c}, mesh.topology());
    }
    return text;
}

}  // namespace curvewright
