#include "core/mesh/node_sources.h"

#include <cmath>

namespace curvewright {

void NodeSources::add_copy(Index old_node) {
    nodes.push_back(old_node);
    weights.push_back(1.0);
    offsets.push_back(nodes.size());
}

FieldArray carried_over(const FieldArray& field, const NodeSources& sources) {
    FieldArray result = field;
    const auto width = static_cast<std::size_t>(field.components);
    result.values.assign(sources.size() * width, 0.0);
    for (std::size_t node = 0; node < sources.size(); ++node) {
        const std::size_t begin = sources.offsets[node], end = sources.offsets[node + 1];
        double* row = result.values.data() + node * width;
        std::size_t heaviest = begin;
        for (std::size_t k = begin + 1; k < end; ++k) {
            const double weight = std::abs(sources.weights[k]), most = std::abs(sources.weights[heaviest]);
            const bool ties = std::abs(weight - most) <= 1e-12;
            if (ties ? sources.nodes[k] < sources.nodes[heaviest] : weight > most) heaviest = k;
        }
        const bool is_copied = field.is_integer || end == begin + 1;
        for (std::size_t k = is_copied ? heaviest : begin; k < (is_copied ? heaviest + 1 : end); ++k) {
            const double* old = field.values.data() + static_cast<std::size_t>(sources.nodes[k]) * width;
            const double weight = is_copied ? 1.0 : sources.weights[k];
            for (std::size_t c = 0; c < width; ++c) row[c] += weight * old[c];
        }
    }
    return result;
}

std::vector<FieldArray> carried_over(const std::vector<FieldArray>& fields, const NodeSources& sources) {
    std::vector<FieldArray> result;
    for (const FieldArray& field : fields)
        result.push_back(field.place == FieldArray::Place::nodes ? carried_over(field, sources) : field);
    return result;
}

}  // namespace curvewright
