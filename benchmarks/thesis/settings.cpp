#include "benchmarks/thesis/settings.h"

#include <algorithm>

#include <fmt/format.h>

#include "benchmarks/thesis/published.h"
#include "core/base/error.h"

namespace curvewright::benchmarks {
namespace {

bool is_meant(const std::string& wish, const TableId& table) {
    return wish == table.number || wish == table.text() || wish == table.file_name() ||
           wish == table.kind.substr(0, 1) + table.number;
}

}  // namespace

const std::vector<TableId>& all_tables() {
    static const std::vector<TableId> tables = [] {
        std::vector<TableId> all{{"figure", "2.1"}, {"table", "2.1"},  {"table", "2.2"},
                                 {"figure", "2.2"}, {"figure", "2.3"}, {"table", "2.3"},
                                 {"table", "2.4"},  {"table", "2.5"},  {"table", "3.1"}};
        for (const auto& example : published::unsigned_examples()) all.push_back({"figure", example.figure});
        all.push_back({"table", "4.1"});
        all.push_back({"figure", "4.2"});
        for (const auto& example : published::signed_examples()) all.push_back({"figure", example.figure});
        return all;
    }();
    return tables;
}

bool Settings::wants(const std::string& kind, const std::string& number) const {
    return only.empty() || std::any_of(only.begin(), only.end(), [&](const auto& wish) {
               return is_meant(wish, {kind, number});
           });
}

bool Settings::wants_any(const std::vector<TableId>& tables) const {
    return std::any_of(tables.begin(), tables.end(),
                       [&](const TableId& table) { return wants(table.kind, table.number); });
}

void check_selection(const Settings& settings) {
    for (const std::string& wish : settings.only) {
        const auto& tables = all_tables();
        if (std::any_of(tables.begin(), tables.end(), [&](const auto& table) { return is_meant(wish, table); }))
            continue;
        std::string known;
        for (const TableId& table : tables) known += (known.empty() ? "" : ", ") + table.text();
        throw InvalidInput(fmt::format("There is no '{}'; there are {}.", wish, known));
    }
}

}  // namespace curvewright::benchmarks
