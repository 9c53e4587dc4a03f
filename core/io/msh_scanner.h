#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "core/base/error.h"

namespace curvewright {

/// Reads words and numbers of a text that lies in memory; every complaint names file and line.
class MshScanner {
  public:
    MshScanner(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

    const std::string& file() const { return file_; }
    std::size_t position() const { return position_; }
    /// Where the last word begins.
    std::size_t word_begin() const { return word_begin_; }
    void move_to(std::size_t position) { position_ = std::min(position, text_.size()); }
    /// Bytes that have not been read yet.
    std::size_t remaining() const { return text_.size() - position_; }
    /// Line of a position (of the last word by default), counted from 1.
    long line(std::size_t position) const {
        return 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(position), '\n');
    }
    long line() const { return line(word_begin_); }
    [[noreturn]] void fail(const std::string& message) const { throw InvalidInput(file_, line(), message); }

    bool at_end() {
        skip_space();
        return position_ == text_.size();
    }
    /// The next word without reading it; empty at the end.
    std::string_view peek() {
        skip_space();
        std::size_t end = position_;
        while (end < text_.size() && !is_space(text_[end])) ++end;
        return text_.substr(position_, end - position_);
    }
    std::string_view word(std::string_view what) {
        const std::string_view result = peek();
        word_begin_ = std::min(position_, text_.empty() ? 0 : text_.size() - 1);
        if (result.empty()) fail(fmt::format("the file ends where {} was expected.", what));
        position_ += result.size();
        return result;
    }
    /// What is left of the present line, without its end.
    std::string_view rest_of_line() {
        const std::size_t end = std::min(text_.find('\n', position_), text_.size());
        std::string_view rest = text_.substr(position_, end - position_);
        position_ = end;
        if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
        return rest;
    }

    /// Goes to the beginning of the next line and over that line.
    void next_line() {
        if (position_ < text_.size() && text_[position_] == '\n') ++position_;
        rest_of_line();
    }
    /// Goes behind the next line that is blank.
    void skip_to_blank_line() { position_ = std::min(text_.find("\n\n", position_), text_.size()); }

    template <class T>
    T integer(std::string_view what) {
        static_assert(std::is_integral_v<T>);
        const std::string_view text = word(what);
        T value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size())
            fail(fmt::format("\"{}\" stands where {} was expected.", shown(text), what));
        return value;
    }
    /// A finite number.
    double real(std::string_view what) { return number(what, true); }
    /// A number, or nan or inf.
    double any_real(std::string_view what) { return number(what, false); }
    /// What stands between quotation marks in one line.
    std::string_view quoted(std::string_view what) {
        skip_space();
        word_begin_ = std::min(position_, text_.empty() ? 0 : text_.size() - 1);
        const std::string_view rest = text_.substr(position_, text_.find('\n', position_) - position_);
        const std::size_t close = rest.find('"', 1);
        if (!rest.starts_with('"') || close == rest.npos)
            fail(fmt::format("\"{}\" stands where {} in quotation marks was expected.", shown(rest), what));
        position_ += close + 1;
        return rest.substr(1, close - 1);
    }
    /// A number of things that follow, each of at least `bytes_each` bytes: what cannot be in the file is refused
    /// before anybody makes room for it.
    std::size_t count(std::string_view what, std::size_t bytes_each = 2) {
        const auto value = integer<long long>(fmt::format("the number of {}", what));
        if (value < 0) fail(fmt::format("the number of {} is {}; it cannot be negative.", what, value));
        // The last thing may end with the file, without a blank.
        if (static_cast<unsigned long long>(value) > (remaining() + 1) / bytes_each)
            fail(fmt::format("{} {} are announced, but the file ends before them.", value, what));
        return static_cast<std::size_t>(value);
    }
    /// Reads "$EndNAME".
    void end_section(std::string_view name) {
        const std::string_view text = word(fmt::format("$End{}", name));
        if (text.substr(0, 4) != "$End" || text.substr(4) != name)
            fail(fmt::format("\"{}\" stands where $End{} was expected.", shown(text), name));
    }
    /// Goes behind the line "$EndNAME".
    void skip_section(std::string_view name) {
        const std::size_t begin = word_begin_;
        const std::string end = fmt::format("\n$End{}", name);
        std::size_t found = position_ > 0 ? position_ - 1 : 0;
        for (found = text_.find(end, found); found != text_.npos; found = text_.find(end, found + 1)) {
            const std::size_t behind = found + end.size();
            if (behind < text_.size() && !is_space(text_[behind])) continue;
            position_ = behind;
            return;
        }
        throw InvalidInput(file_, line(begin), fmt::format("section ${0} has no $End{0}.", name));
    }

  private:
    double number(std::string_view what, bool is_finite) {
        std::string_view text = word(what);
        const std::string_view whole = text;
        if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool underflow = error == std::errc::result_out_of_range && text.find("-", 1) != text.npos;
        if (underflow) value = 0.0;
        if ((error != std::errc() && !underflow) || end != text.data() + text.size() ||
            (is_finite && !std::isfinite(value)))
            fail(fmt::format("\"{}\" stands where {} (a {}number) was expected.", shown(whole), what,
                             is_finite ? "finite " : ""));
        return value;
    }
    static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
    void skip_space() {
        while (position_ < text_.size() && is_space(text_[position_])) ++position_;
    }
    /// A word for a message: short, and without what a terminal would not print.
    static std::string shown(std::string_view text) {
        std::string result;
        for (const char c : text.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
        return text.size() > 40 ? result + "..." : result;
    }

    std::string_view text_;
    std::string file_;
    std::size_t position_ = 0;
    std::size_t word_begin_ = 0;  ///< where the last word begins
};

}  // namespace curvewright
