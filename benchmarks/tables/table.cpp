#include "benchmarks/tables/table.h"

#include <algorithm>
#include <cmath>

namespace curvewright::benchmarks {
namespace {

std::string shown(const Cell& cell) {
    return cell.shown.empty() ? "–" : cell.shown;
}

/// Characters, not bytes, of a text in UTF-8.
std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// Numbers stand at the right, texts at the left.
std::vector<bool> columns_of_text(const Table& table) {
    std::vector<bool> is_text(table.columns.size(), false);
    for (const auto& row : table.rows)
        for (std::size_t c = 0; c < row.size(); ++c)
            if (!row[c].exact.empty() && row[c].exact.find_first_not_of("0123456789+-.e") != std::string::npos)
                is_text[c] = true;
    return is_text;
}

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + '"';
}

}  // namespace

Cell::Cell(double number) : exact(fmt::format("{:.6g}", number)) {
    if (!std::isfinite(number) || number == 0.0) {
        shown = exact;
        return;
    }
    const int digits = 2 - static_cast<int>(std::floor(std::log10(std::abs(number))));
    shown = digits > 7 ? fmt::format("{:.2e}", number) : fmt::format("{:.{}f}", number, std::max(0, digits));
}

std::string Cell::with_separators(long long number) {
    std::string digits = fmt::format("{}", number);
    for (auto at = static_cast<int>(digits.size()) - 3; at > (number < 0 ? 1 : 0); at -= 3)
        digits.insert(static_cast<std::size_t>(at), ",");
    return digits;
}

Cell formatted(double number, const char* format) {
    Cell cell(number);
    cell.shown = fmt::format(fmt::runtime(format), number);
    return cell;
}

std::string as_text(const Table& table) {
    const std::vector<bool> is_text = columns_of_text(table);
    std::vector<std::size_t> widths;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        widths.push_back(width(table.columns[c]));
        for (const auto& row : table.rows) widths[c] = std::max(widths[c], width(shown(row[c])));
    }
    std::string text = table.title + "\n";
    const auto add_line = [&](const auto& text_of) {
        std::string line;
        for (std::size_t c = 0; c < widths.size(); ++c) {
            const std::string cell = text_of(c);
            const std::string padding(widths[c] - width(cell), ' ');
            line += (c == 0 ? "" : "  ") + (is_text[c] ? cell + padding : padding + cell);
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    };
    add_line([&](std::size_t c) { return table.columns[c]; });
    add_line([&](std::size_t c) { return std::string(widths[c], '-'); });
    for (const auto& row : table.rows) add_line([&](std::size_t c) { return shown(row[c]); });
    return text;
}

std::string as_markdown(const Table& table) {
    const std::vector<bool> is_text = columns_of_text(table);
    std::string text = "## " + table.title + "\n\n";
    if (!table.note.empty()) text += table.note + "\n\n";
    text += "|";
    for (const std::string& column : table.columns) text += " " + column + " |";
    text += "\n|";
    for (const bool left : is_text) text += left ? " --- |" : " ---: |";
    text += "\n";
    for (const auto& row : table.rows) {
        text += "|";
        for (const Cell& cell : row) text += " " + shown(cell) + " |";
        text += "\n";
    }
    return text;
}

std::string as_csv(const Table& table) {
    std::string text;
    const auto add_line = [&](const auto& cells, const auto& text_of) {
        std::string separator;
        for (const auto& cell : cells) {
            text += separator + quoted(text_of(cell));
            separator = ",";
        }
        text += "\n";
    };
    add_line(table.columns, [](const std::string& column) { return column; });
    for (const auto& row : table.rows) add_line(row, [](const Cell& cell) { return cell.exact; });
    return text;
}

}  // namespace curvewright::benchmarks
