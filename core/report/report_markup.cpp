#include "core/report/report_markup.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace curvewright {
namespace {

constexpr const char* replacement = "\xEF\xBF\xBD";  // U+FFFD

/// Bytes of the character that begins at `at`; 0 if it is none that XML allows.
std::size_t character_length(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) -> std::uint32_t {
        return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
    };
    const std::uint32_t first = byte(0);
    if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
    const std::size_t length = first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
    if (length == 0) return 0;
    std::uint32_t code = first & (0xFFu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if (byte(i) >> 6 != 2) return 0;
        code = code << 6 | (byte(i) & 0x3Fu);
    }
    const std::uint32_t least = length == 2 ? 0x80 : length == 3 ? 0x800 : 0x10000;
    const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
    return code < least || code > 0x10FFFF || is_surrogate || code == 0xFFFE || code == 0xFFFF ? 0 : length;
}

std::string with_signs(const std::string& text) {
    static constexpr const char* raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string result;
    bool is_exponent = false, is_leading = false;
    for (const char c : text) {
        if (c == 'e') {
            result += "×10";
            is_exponent = is_leading = true;
        } else if (c == '-') {
            result += is_exponent ? "⁻" : "−";
        } else if (c == '+' || (is_exponent && is_leading && c == '0')) {
            continue;
        } else if (is_exponent) {
            result += raised[c - '0'];
            is_leading = false;
        } else {
            result += c;
        }
    }
    return result;
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = character_length(text, i);
        if (length == 0) {
            result += replacement;
            ++i;
            continue;
        }
        switch (text[i]) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                result += text.substr(i, length);
        }
        i += length;
    }
    return result;
}

std::string number_text(double value) {
    if (!std::isfinite(value)) return "–";
    if (value == 0.0) return "0";
    const bool has_fraction = std::abs(value) < 999.95;
    return with_signs(has_fraction ? fmt::format("{:#.4g}", value) : fmt::format("{:.4g}", value));
}

std::string short_number_text(double value) {
    if (!std::isfinite(value)) return "–";
    return with_signs(fmt::format("{:.4g}", value));
}

std::string count_text(long long value) {
    std::string digits = std::to_string(value < 0 ? -value : value);
    for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3)
        digits.insert(static_cast<std::size_t>(i), ",");
    return value < 0 ? "−" + digits : digits;
}

std::string seconds_text(double seconds) {
    if (seconds < 0.0005) return "less than 0.001 s";
    return fmt::format("{:.{}f} s", seconds, seconds < 1.0 ? 3 : seconds < 10.0 ? 2 : 1);
}

std::string base64(std::string_view bytes) {
    static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    result.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) result += i + k <= bytes.size() ? letters[word >> (18 - 6 * k) & 63u] : '=';
    }
    return result;
}

}  // namespace curvewright
