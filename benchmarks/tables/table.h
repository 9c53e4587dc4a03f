#pragma once

#include <concepts>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace curvewright::benchmarks {

/// What a table shows, and the same in full for the CSV file. Empty = not measured.
struct Cell {
    std::string shown, exact;

    Cell() = default;
    Cell(const std::string& text) : shown(text), exact(text) {}
    Cell(const char* text) : shown(text), exact(text) {}
    Cell(std::integral auto number) : shown(with_separators(number)), exact(fmt::format("{}", number)) {}
    /// Three significant digits.
    Cell(double number);

  private:
    static std::string with_separators(long long number);
};

/// A number with the given format, e.g. "{:.1e}".
Cell formatted(double number, const char* format);

struct Table {
    std::string name;  ///< of the CSV file, without suffix
    std::string title;
    std::string note;  ///< what the columns mean and how it was measured; Markdown, may be empty
    std::vector<std::string> columns;
    std::vector<std::vector<Cell>> rows;

    void add(std::vector<Cell> row) { rows.push_back(std::move(row)); }
};

std::string as_text(const Table& table);
std::string as_markdown(const Table& table);
std::string as_csv(const Table& table);

}  // namespace curvewright::benchmarks
