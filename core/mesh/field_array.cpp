#include "core/mesh/field_array.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace curvewright {

std::optional<std::pair<double, double>> finite_range(std::span<const double> values) {
    std::optional<std::pair<double, double>> range;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        if (!range) range.emplace(value, value);
        range->first = std::min(range->first, value);
        range->second = std::max(range->second, value);
    }
    return range;
}

std::vector<double> scalar_values(std::span<const double> rows, int components, int component) {
    if (components == 1) return {rows.begin(), rows.end()};
    const auto width = static_cast<std::size_t>(components);
    std::vector<double> scalars(rows.size() / width);
    for (std::size_t i = 0; i < scalars.size(); ++i) {
        const auto row = rows.subspan(i * width, width);
        if (component >= 0) {
            scalars[i] = row[static_cast<std::size_t>(std::min(component, components - 1))];
            continue;
        }
        // hypot of many: neither too large nor too small numbers overflow.
        for (const double value : row) scalars[i] = std::hypot(scalars[i], value);
    }
    return scalars;
}

int make_names_unique(std::vector<FieldArray>& fields) {
    std::set<std::pair<FieldArray::Place, std::string>> used;
    int renamed = 0;
    for (FieldArray& field : fields) {
        const std::string name = field.name;
        for (int next = 2; !used.emplace(field.place, field.name).second; ++next)
            field.name = fmt::format("{} ({})", name, next);
        renamed += field.name != name ? 1 : 0;
    }
    return renamed;
}

}  // namespace curvewright
