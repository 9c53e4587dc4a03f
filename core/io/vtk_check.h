#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>

#include "core/io/msh_scanner.h"

namespace curvewright {

/// Walks through the cells of a legacy VTK file and throws InvalidInput where they are cut off or inconsistent: VTK's
/// own reader believes their counts and crashes.
class LegacyVtkCheck {
  public:
    LegacyVtkCheck(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

    void run() {
        MshScanner header = scanner_at(0);
        header.word("the header");  // "# vtk DataFile Version 4.2", a title, "ASCII" or "BINARY"
        for (int i = 0; i < 3; ++i) header.word("the header");
        const bool is_new = header.real("the version of the format") >= 5.0;
        header.rest_of_line();
        const std::size_t title_end = text_.find('\n', header.position() + 1);
        if (title_end == text_.npos) header.fail("the file ends within its header.");
        MshScanner mode = scanner_at(title_end);
        is_text_ = mode.word("ASCII or BINARY") == "ASCII";

        if (is_text_) check_head(mode);
        const std::size_t points = find_keyword("POINTS", mode.position());
        MshScanner point_line = scanner_at(points);
        point_line.word("POINTS");
        const std::size_t points_count = point_line.count("points", is_text_ ? 6 : 3), numbers = 3 * points_count;
        if (is_text_) {
            point_line.word("the type of the points");
            for (std::size_t i = 0; i < numbers; ++i) point_line.real("a coordinate");
        }
        const std::size_t cells = find_keyword("CELLS", point_line.position());
        MshScanner in = scanner_at(cells);
        in.word("CELLS");
        const std::size_t first = in.count("cells", 1), second = in.count("cells' points", 1);
        in.rest_of_line();
        if (is_new)
            check_offsets(in, first, second);
        else
            check_lists(in, first, second);
        if (in.peek() != "CELL_TYPES" && in.peek() != "METADATA") in.fail("CELL_TYPES was expected behind the cells.");
        if (is_text_ && in.peek() == "CELL_TYPES") {
            in.word("CELL_TYPES");
            const std::size_t types = in.count("cell types");
            if (types + (is_new ? 1 : 0) != first) in.fail("the cell types are not as many as the cells.");
            for (std::size_t i = 0; i < types; ++i) in.integer<int>("a cell type");
            check_arrays(in, points_count, types);
        }
    }

  private:
    MshScanner scanner_at(std::size_t position) const {
        MshScanner scanner(text_, file_);
        scanner.move_to(position);
        return scanner;
    }
    std::size_t find_keyword(const std::string& keyword, std::size_t from) const {
        const std::size_t found = text_.find("\n" + keyword + " ", from > 0 ? from - 1 : 0);
        if (found == text_.npos) throw InvalidInput(file_, 0, "the file ends before its " + keyword + ".");
        return found + 1;
    }
    /// Text files: field data stand before the points.
    static void check_head(MshScanner& in) {
        if (in.word("DATASET") != "DATASET" || in.word("UNSTRUCTURED_GRID") != "UNSTRUCTURED_GRID")
            in.fail("DATASET UNSTRUCTURED_GRID was expected.");
        if (in.peek() != "FIELD") {
            if (in.peek() != "POINTS") in.fail("POINTS or FIELD was expected.");
            return;
        }
        check_field(in, std::nullopt);
    }
    /// FIELD NAME COUNT, then arrays; of points or cells, with as many rows as these.
    static void check_field(MshScanner& in, std::optional<std::size_t> rows) {
        in.word("FIELD");
        in.word("the name of the field data");
        const std::size_t arrays = in.count("arrays", 8);
        for (std::size_t array = 0; array < arrays; ++array) {
            in.word("the name of an array");
            const std::size_t components = in.count("components"), tuples = in.count("tuples", 1);
            if (rows && tuples != *rows) in.fail(fmt::format("an array has {} rows; {} were expected.", tuples, *rows));
            const std::string_view type = read_type(in);
            in.rest_of_line();
            check_numbers(in, components, tuples, type == "string");
        }
    }
    static std::string_view read_type(MshScanner& in) {
        const std::string_view type = in.word("the type of an array");
        if (std::find(array_types.begin(), array_types.end(), type) == array_types.end())
            in.fail("the type of an array was expected.");
        return type;
    }
    static void check_numbers(MshScanner& in, std::size_t components, std::size_t tuples, bool is_string = false) {
        if (components != 0 && tuples > in.remaining() / components) in.fail("the array is longer than the file.");
        for (std::size_t i = 0; i < components * tuples; ++i) {
            if (is_string)
                in.next_line();
            else
                in.real("a number of an array");
        }
        if (in.peek() == "METADATA") in.skip_to_blank_line();
    }
    /// Text files: what stands behind the cells, as far as it is known.
    static void check_arrays(MshScanner& in, std::size_t points, std::size_t cells) {
        std::optional<std::size_t> rows;
        while (!in.at_end()) {
            const std::string_view keyword = in.peek();
            const auto known = std::find_if(attributes.begin(), attributes.end(),
                                            [&](const Attribute& attribute) { return attribute.keyword == keyword; });
            if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
                in.word(keyword);
                const std::size_t expected = keyword == "POINT_DATA" ? points : cells;
                rows = in.count("rows of the data", 1);
                if (*rows != expected)
                    in.fail(fmt::format("the data are announced for {} {}, but there are {}.", *rows,
                                        keyword == "POINT_DATA" ? "points" : "cells", expected));
            } else if (rows && keyword == "FIELD") {
                check_field(in, rows);
            } else if (rows && known != attributes.end()) {
                in.word(keyword);
                in.word("the name of an array");
                read_type(in);
                std::size_t components = known->components;
                if (keyword == "SCALARS") {
                    MshScanner line = in;  // the number of components may stand there, or not
                    const std::string_view rest = line.rest_of_line();
                    if (rest.find_first_not_of(" \t") != rest.npos) components = in.count("components", 1);
                    if (in.peek() == "LOOKUP_TABLE") {
                        in.word("LOOKUP_TABLE");
                        in.word("the name of a table");
                    }
                }
                check_numbers(in, components, *rows);
            } else {
                return;  // VTK knows more than this, and what of it is seldom seen
            }
        }
    }
    /// The next integer: a word, or big-endian bytes.
    template <class Integer>
    long long next(MshScanner& in) const {
        if (is_text_) return in.integer<long long>("a number of the cells");
        if (in.remaining() <= sizeof(Integer)) in.fail("the file ends within its cells.");
        std::array<char, sizeof(Integer)> bytes;
        std::memcpy(bytes.data(), text_.data() + in.position() + 1, bytes.size());  // behind the line's end
        if constexpr (std::endian::native == std::endian::little) std::reverse(bytes.begin(), bytes.end());
        in.move_to(in.position() + bytes.size());
        return std::bit_cast<Integer>(bytes);
    }
    /// Versions before 5: each cell's number of points, then the points.
    void check_lists(MshScanner& in, std::size_t cells, std::size_t size) const {
        std::size_t left = size;
        for (std::size_t cell = 0; cell < cells; ++cell) {
            const long long count = left > 0 ? next<std::int32_t>(in) : -1;
            if (count < 0 || static_cast<unsigned long long>(count) > left - 1)
                in.fail(fmt::format("the points of cell {} do not fit the announced {} numbers.", cell, size));
            for (long long i = 0; i < count; ++i) next<std::int32_t>(in);
            left -= static_cast<std::size_t>(count) + 1;
        }
        if (left != 0) in.fail(fmt::format("the cells hold {} numbers less than announced.", left));
        leave_data(in);
    }
    /// Version 5: all offsets, then all points.
    void check_offsets(MshScanner& in, std::size_t offsets, std::size_t points) const {
        for (const auto& [name, count] : {std::pair{"OFFSETS", offsets}, std::pair{"CONNECTIVITY", points}}) {
            if (in.word(name) != name) in.fail(fmt::format("{} was expected.", name));
            const bool is_wide = in.word("a type of integers") == "vtktypeint64";
            in.rest_of_line();
            long long previous = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const long long value = is_wide ? next<std::int64_t>(in) : next<std::int32_t>(in);
                const bool is_offset = std::string_view(name) == "OFFSETS";
                if (is_offset && (value < previous || value > static_cast<long long>(points)))
                    in.fail(fmt::format("the offset {} of a cell is out of range.", value));
                previous = value;
            }
            leave_data(in);
        }
    }
    /// In binary files the data begin one byte behind the scanner.
    void leave_data(MshScanner& in) const {
        if (!is_text_ && in.remaining() > 0) in.move_to(in.position() + 1);
    }

    static constexpr std::array<std::string_view, 15> array_types = {
        "bit", "char",         "signed_char", "unsigned_char", "short", "unsigned_short", "vtkIdType",   "string",
        "int", "unsigned_int", "long",        "unsigned_long", "float", "double",         "vtktypeint64"};

    struct Attribute {
        std::string_view keyword;
        std::size_t components;
    };
    static constexpr std::array<Attribute, 5> attributes = {
        {{"SCALARS", 1}, {"VECTORS", 3}, {"NORMALS", 3}, {"TENSORS", 9}, {"TENSORS6", 6}}};

    std::string_view text_;
    std::string file_;
    bool is_text_ = true;
};

/// Checks what VTK's XML reader takes on trust about the arrays of a file, and crashes on: their types and where they
/// stand. Throws InvalidInput.
inline void check_xml_arrays(std::string_view text, const std::string& file) {
    constexpr std::array<std::string_view, 12> types = {"Int8",  "UInt8",  "Int16",   "UInt16",  "Int32",  "UInt32",
                                                        "Int64", "UInt64", "Float32", "Float64", "String", "Bit"};
    text = text.substr(0, text.find("<AppendedData"));
    for (std::size_t begin = text.find("Array "); begin != text.npos; begin = text.find("Array ", begin + 1)) {
        const std::string_view before = text.substr(0, begin);
        if (!before.ends_with("<") && !before.ends_with("<Data")) continue;
        // Up to the next tag at most: no text makes this look through all of it again and again.
        const std::string_view tag = text.substr(begin, text.find_first_of("<>", begin) - begin);
        const auto attribute = [&](const char* name) -> std::string_view {
            const std::string opening = fmt::format(" {}=\"", name);
            const std::size_t found = tag.find(opening);
            if (found == tag.npos) return {};
            const std::string_view rest = tag.substr(found + opening.size());
            return rest.substr(0, rest.find('"'));
        };
        const std::string_view type = attribute("type"), offset = attribute("offset");
        const std::string_view components = attribute("NumberOfComponents");
        if (std::find(types.begin(), types.end(), type) == types.end())
            throw InvalidInput(file, 0, fmt::format("an array has the unknown type \"{}\".", type.substr(0, 40)));
        const bool has_few = components.size() <= 4 && std::all_of(components.begin(), components.end(),
                                                                   [](char c) { return c >= '0' && c <= '9'; });
        if (!has_few)
            throw InvalidInput(file, 0,
                               fmt::format("an array has \"{}\" components; a number below 10000 was expected.",
                                           components.substr(0, 40)));
        if (!std::all_of(offset.begin(), offset.end(), [](char c) { return c >= '0' && c <= '9'; }))
            throw InvalidInput(
                file, 0, fmt::format("an array has the offset \"{}\"; a number was expected.", offset.substr(0, 40)));
    }
}

}  // namespace curvewright
