#include "core/io/node_list_file.h"

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/io/atomic_file.h"

namespace curvewright {
namespace {

std::string_view trimmed(std::string_view text) {
    constexpr const char* blank = " \t\r";
    const std::size_t first = text.find_first_not_of(blank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// The column of a line, blanks around it left out; none if there are fewer.
std::optional<std::string_view> column(std::string_view line, std::size_t wanted) {
    for (std::size_t i = 0;; ++i) {
        const std::size_t end = line.find(',');
        if (i == wanted) return trimmed(line.substr(0, end));
        if (end == std::string_view::npos) return std::nullopt;
        line = line.substr(end + 1);
    }
}

std::optional<std::int64_t> whole_number(std::string_view text) {
    std::int64_t value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return value;
}

}  // namespace

std::vector<NodeTag> read_node_list(const std::filesystem::path& file, const MeshTopology& topology) {
    const std::string content = read_text_file(file), name = file.string();
    std::string_view text = content;
    std::vector<NodeTag> tags;
    std::size_t tag_column = 0;
    long number = 0;
    bool is_first = true;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view line = trimmed(text.substr(0, end));
        text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
        ++number;
        if (line.empty()) continue;
        const bool may_be_header = is_first;
        is_first = false;
        const auto word = column(line, tag_column);
        const auto tag = word ? whole_number(*word) : std::nullopt;
        if (tag) {
            if (!topology.find_node(NodeTag{*tag}))
                throw InvalidInput(name, number, fmt::format("the mesh has no node {}.", *tag));
            tags.push_back({*tag});
            continue;
        }
        std::optional<std::size_t> header;
        if (may_be_header)
            for (std::size_t i = 0; const auto title = column(line, i); ++i)
                if (*title == "tag") header = i;
        if (!header)
            throw InvalidInput(name, number,
                               fmt::format("a node's tag, or a header with a column \"tag\" in the first line, was "
                                           "expected, not \"{}\".",
                                           line.substr(0, 40)));
        tag_column = *header;
    }
    if (tags.empty()) throw InvalidInput(name, 0, "the list names no node; one tag per line was expected.");
    return tags;
}

}  // namespace curvewright
