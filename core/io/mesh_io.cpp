#include "core/io/mesh_io.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"
#include "core/io/msh_io.h"
#include "core/io/vtk_io.h"

namespace curvewright {
namespace {

constexpr const char* known_suffixes = ".msh, .msh.gz, .vtu or .vtk";

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool is_compressed(const std::filesystem::path& file) {
    return lower(file.extension().string()) == ".gz";
}

[[noreturn]] void throw_unknown_suffix(const std::filesystem::path& file, const char* expected) {
    const std::string suffix = file.extension().string();
    throw InvalidInput(file.string(), 0,
                       suffix.empty() ? fmt::format("the name has no suffix; {} was expected.", expected)
                                      : fmt::format("unknown suffix \"{}\"; {} was expected.", suffix, expected));
}

}  // namespace

const char* to_string(MeshFormat format) {
    switch (format) {
        case MeshFormat::msh2:
            return "msh2";
        case MeshFormat::msh4:
            return "msh4";
        case MeshFormat::vtu:
            return "vtu";
        case MeshFormat::vtk:
            return "vtk";
    }
    return "";
}

std::optional<MeshFormat> format_of_suffix(const std::filesystem::path& file) {
    const std::string suffix = lower(file.extension().string());
    if (suffix == ".gz" && lower(file.stem().extension().string()) == ".msh") return MeshFormat::msh4;
    if (suffix == ".msh") return MeshFormat::msh4;
    if (suffix == ".vtu") return MeshFormat::vtu;
    if (suffix == ".vtk") return MeshFormat::vtk;
    return std::nullopt;
}

ReadResult read_mesh(const std::filesystem::path& file, const TaskContext& context) {
    context.report("reading", 0.0);
    const auto format = format_of_suffix(file);
    if (!format) {
        // A wrong name is told as such rather than as a wrong suffix.
        std::error_code ignored;
        if (!std::filesystem::exists(file, ignored) || std::filesystem::is_directory(file, ignored))
            read_text_file(file);
        throw_unknown_suffix(file, known_suffixes);
    }
    std::string text = read_text_file(file);
    context.check();
    if (text.empty()) throw InvalidInput(file.string(), 0, "the file is empty; a mesh was expected.");
    if (*format == MeshFormat::msh4) return read_msh(text, file.string(), context);
    return read_vtk(std::move(text), file.string(), *format, context);
}

namespace {

void check_fields(const std::vector<FieldArray>& fields, const MeshTopology& topology) {
    Index cells = 0;
    for (const ElementBlock& block : topology.blocks()) cells += block.size();
    for (const FieldArray& field : fields) {
        const bool is_on_nodes = field.place == FieldArray::Place::nodes;
        const auto width = static_cast<std::size_t>(std::max(field.components, 1));
        const auto count = static_cast<std::size_t>(is_on_nodes ? topology.node_count() : topology.element_count());
        const auto lower = static_cast<std::size_t>(cells - topology.element_count());
        if (field.components < 1 || field.values.size() != count * width ||
            (!field.lower_values.empty() && field.lower_values.size() != lower * width))
            throw InvalidInput(fmt::format("The array {} does not have one row for each of the {} {} of the mesh.",
                                           field.name, count, is_on_nodes ? "nodes" : "elements"));
    }
}

/// The arrays without those that the options give anew.
std::vector<FieldArray> kept_fields(const WriteOptions& options) {
    std::vector<FieldArray> kept;
    if (options.fields == nullptr) return kept;
    for (const FieldArray& field : *options.fields) {
        const bool is_on_nodes = field.place == FieldArray::Place::nodes;
        const bool is_quality = !is_on_nodes && (field.name == "ScaledJacobian" || field.name == "Validity");
        if (options.quality != nullptr && is_quality) continue;
        if (options.reference != nullptr && is_on_nodes && field.name == "Displacement") continue;
        kept.push_back(field);
    }
    return kept;
}

}  // namespace

std::vector<std::string> write_mesh(const std::filesystem::path& file, const CurvedMesh& mesh,
                                    const WriteOptions& options) {
    std::vector<std::string> notes;
    const std::vector<FieldArray> fields = kept_fields(options);
    check_fields(fields, mesh.topology());
    if (is_compressed(file))
        throw InvalidInput(file.string(), 0, "compressed files can be read but not written; leave out \".gz\".");
    const auto format = options.format ? options.format : format_of_suffix(file);
    if (!format) throw_unknown_suffix(file, ".msh, .vtu or .vtk");
    const bool is_msh = *format == MeshFormat::msh2 || *format == MeshFormat::msh4;
    if (is_msh && options.binary.value_or(false))
        throw Unsupported(fmt::format("{}: binary MSH cannot be written; MSH is written as text.", file.string()));
    std::string text;
    if (is_msh) {
        try {
            text =
                *format == MeshFormat::msh2 ? msh2_text(mesh, options.provenance) : msh4_text(mesh, options.provenance);
            text += msh_data_text(mesh, fields, notes);
        } catch (const Unsupported& error) {
            throw Unsupported(fmt::format("{}: {}", file.string(), error.what()));
        }
    } else {
        WriteOptions with_kept = options;
        with_kept.fields = &fields;
        text = vtk_text(file.string(), mesh, *format, with_kept, notes);
    }
    write_text_file(file, text);
    return notes;
}

}  // namespace curvewright
