#include "core/quality/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/basis/reference_element.h"
#include "core/quality/jacobian_bounds.h"
#include "core/quality/quality_sum.h"

namespace curvewright {

namespace {

/// Certifies elements of one mesh, one after another. One object per thread.
class Certifier {
  public:
    Certifier(const MeshTopology& topology, const Coordinates& positions, const OrientationSigns& signs,
              const QualityOptions& options)
        : topology_(topology), positions_(positions), signs_(signs), options_(options) {}

    ElementQuality operator()(Index element) {
        const ElementType type = topology_.element_type(element);
        const bool is_reversed = topology_.is_reversed(element);
        if (type.shape == Shape::pyramid) return not_assessed(is_reversed);
        if (!bounds_ || type != type_) {
            type_ = type;
            bounds_.emplace(type);
        }
        // A reversed element is judged as if it were renumbered, so that not a bit depends on its numbering.
        const auto nodes = topology_.element_nodes(element);
        const int* const order = is_reversed ? reference_element(type).mirrored.data() : nullptr;
        x_.resize(static_cast<Eigen::Index>(nodes.size()), 3);
        for (std::size_t k = 0; k < nodes.size(); ++k)
            x_.row(static_cast<Eigen::Index>(k)) =
                positions_.row(nodes[order ? static_cast<std::size_t>(order[k]) : k]);
        ElementQuality quality = bounds_->bound(x_, signs_.of_part(element), options_);
        quality.is_reversed = is_reversed;
        if (is_reversed) std::swap(quality.worst_point[0], quality.worst_point[1]);
        return quality;
    }

  private:
    static ElementQuality not_assessed(bool is_reversed) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        ElementQuality quality;
        quality.scaled_jacobian = std::numeric_limits<double>::quiet_NaN();
        quality.min_lower = quality.max_lower = -infinity;
        quality.min_upper = quality.max_upper = infinity;
        quality.validity = Validity::not_assessed;
        quality.is_reversed = is_reversed;
        return quality;
    }

    const MeshTopology& topology_;
    const Coordinates& positions_;
    const OrientationSigns& signs_;
    const QualityOptions& options_;
    std::optional<JacobianBounds> bounds_;
    ElementType type_;
    Eigen::MatrixX3d x_;
};

/// Certifies element_at(0) .. element_at(count - 1) and calls store(i, quality) for each, on several threads.
template <class ElementAt, class Store>
void certify(const MeshTopology& topology, const Coordinates& positions, std::size_t count, const ElementAt& element_at,
             const OrientationSigns& signs, const QualityOptions& options, const TaskContext& context,
             std::string_view phase, const Store& store) {
    if (!(options.tolerance > 0.0))
        throw InvalidInput(
            fmt::format("The tolerance of the scaled Jacobian is {}; it must be positive.", options.tolerance));
    // An element of many nodes is much work (as the square of their number, about): a piece of such is made small.
    int most_nodes = 1;
    for (const ElementBlock& block : topology.data().blocks)
        if (dimension(block.type.shape) == topology.dimension())
            most_nodes = std::max(most_nodes, node_count(block.type));
    const auto grain = static_cast<std::size_t>(std::clamp(100000 / (most_nodes * most_nodes), 4, 256));
    parallel_for(count, grain, context, phase, [&](std::size_t begin, std::size_t end) {
        Certifier certifier(topology, positions, signs, options);
        for (std::size_t i = begin; i < end; ++i) {
            context.check();
            store(i, certifier(element_at(i)));
        }
    });
}

QualitySummary summarize(const std::vector<ElementQuality>& elements) {
    QualitySum sum;
    for (const ElementQuality& quality : elements) sum.add(quality);
    return sum.result();
}

}  // namespace

QualityReport assess_quality(const CurvedMesh& mesh, const QualityOptions& options, const TaskContext& context) {
    QualityReport report;
    report.orientation_sign = orientation_signs(mesh);
    report.orientation = orientation_of(report.orientation_sign);
    if (options.orientation_sign) report.orientation_sign = *options.orientation_sign;
    report.elements.resize(static_cast<std::size_t>(mesh.topology().element_count()));
    certify(
        mesh.topology(), mesh.coordinates(), report.elements.size(),
        [](std::size_t i) { return static_cast<Index>(i); }, report.orientation_sign, options, context,
        "Certifying elements", [&](std::size_t i, const ElementQuality& quality) { report.elements[i] = quality; });
    report.summary = summarize(report.elements);
    return report;
}

std::vector<ElementQuality> certify_elements(const MeshTopology& topology, std::span<const Index> elements,
                                             const Coordinates& positions, const QualityOptions& options,
                                             const TaskContext& context) {
    std::vector<ElementQuality> result(elements.size());
    certify(
        topology, positions, elements.size(), [&](std::size_t i) { return elements[i]; },
        options.orientation_sign.value(), options, context, {},
        [&](std::size_t i, const ElementQuality& quality) { result[i] = quality; });
    return result;
}

void update_quality(QualityReport& report, const MeshTopology& topology, const Coordinates& positions,
                    std::span<const Index> elements, const QualityOptions& options, const TaskContext& context) {
    if (report.elements.size() != static_cast<std::size_t>(topology.element_count()) ||
        positions.rows() != topology.node_count())
        throw InvalidInput(
            fmt::format("A report of {} elements and {} positions do not belong to a mesh of {} elements "
                        "and {} nodes.",
                        report.elements.size(), positions.rows(), topology.element_count(), topology.node_count()));
    certify(
        topology, positions, elements.size(), [&](std::size_t i) { return elements[i]; }, report.orientation_sign,
        options, context, "Certifying elements",
        [&](std::size_t i, const ElementQuality& quality) { report.elements[elements[i]] = quality; });
    report.summary = summarize(report.elements);
}

std::vector<Index> QualityReport::worst(std::size_t count) const {
    std::vector<Index> order(elements.size());
    std::iota(order.begin(), order.end(), Index{0});
    const auto last = std::stable_partition(order.begin(), order.end(), [&](Index element) {
        return elements[element].validity != Validity::not_assessed;
    });
    count = std::min(count, order.size());
    std::partial_sort(order.begin(), order.begin() + std::min(static_cast<std::ptrdiff_t>(count), last - order.begin()),
                      last, [&](Index a, Index b) {
                          const double qa = elements[a].scaled_jacobian, qb = elements[b].scaled_jacobian;
                          return qa != qb ? qa < qb : a < b;
                      });
    order.resize(count);
    return order;
}

int Histogram::bin_of(double value) const {
    const int bins = static_cast<int>(counts.size());
    const double position = (value - lower) / (upper - lower) * bins;
    if (!(position > 0.0)) return 0;
    return position >= bins ? bins - 1 : static_cast<int>(position);
}

Histogram make_histogram(const QualityReport& report, double lower, double upper, int bins) {
    Histogram histogram{lower, upper, std::vector<Index>(static_cast<std::size_t>(bins), 0)};
    for (const ElementQuality& quality : report.elements)
        if (quality.validity != Validity::not_assessed) ++histogram.counts[histogram.bin_of(quality.scaled_jacobian)];
    return histogram;
}

}  // namespace curvewright
