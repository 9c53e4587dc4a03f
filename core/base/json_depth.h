#pragma once

#include <cstddef>
#include <string_view>

namespace curvewright {

/// No file of ours nests its JSON deeper than this.
constexpr std::size_t deepest_json = 64;

/// Whether lists and objects of a JSON text stand in each other more than `most` deep. A parser takes a hundred bytes
/// for every bracket of such a text, and what walks through its result takes a stack for it: files from elsewhere are
/// looked at before they are parsed. Text that is no JSON may give either answer.
inline bool is_json_too_deep(std::string_view text, std::size_t most = deepest_json) {
    std::size_t depth = 0;
    bool is_in_text = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (is_in_text) {
            if (c == '\\') ++i;
            if (c == '"') is_in_text = false;
        } else if (c == '"') {
            is_in_text = true;
        } else if (c == '[' || c == '{') {
            if (++depth > most) return true;
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
    return false;
}

}  // namespace curvewright
