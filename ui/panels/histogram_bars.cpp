#include "ui/panels/histogram_bars.h"

#include <algorithm>

#include "core/quality/quality_sum.h"

namespace curvewright {
Index HistogramBars::highest() const {
    Index result = tangled.count();
    for (const Bar& bar : bars) result = std::max(result, bar.count());
    return result;
}

IndexSet HistogramBars::elements_in(int first, int last) const {
    IndexSet elements;
    for (std::size_t i = 0; i < bar_of_element.size(); ++i)
        if (bar_of_element[i] >= first && bar_of_element[i] <= last) elements.push_back(static_cast<Index>(i));
    return elements;
}

void HistogramBars::mark(const IndexSet& selected) {
    tangled.selected = 0;
    for (Bar& bar : bars) bar.selected = 0;
    for (const Index element : selected)
        if (const auto i = static_cast<std::size_t>(element); i < bar_of_element.size() && bar_of_element[i] != no_bar)
            ++at(bar_of_element[i]).selected;
}

HistogramBars make_bars(std::span<const ElementQuality> elements) {
    HistogramBars result;
    result.bar_of_element.reserve(elements.size());
    for (const ElementQuality& quality : elements) {
        if (quality.validity == Validity::not_assessed) {
            result.bar_of_element.push_back(HistogramBars::no_bar);
            continue;
        }
        int bar = HistogramBars::tangled_bar;
        if (quality.validity != Validity::invalid) {
            const double position = quality.scaled_jacobian * HistogramBars::bins;
            bar = position > 0.0 ? static_cast<int>(std::min(position, HistogramBars::bins - 1.0)) : 0;
        }
        ++(quality.validity == Validity::undecided ? result.at(bar).undecided : result.at(bar).decided);
        result.bar_of_element.push_back(static_cast<std::int8_t>(bar));
    }
    return result;
}

QualitySummary summary_of(std::span<const ElementQuality> elements, std::span<const Index> some) {
    QualitySum sum;
    for (const Index element : some)
        if (const auto i = static_cast<std::size_t>(element); i < elements.size()) sum.add(elements[i]);
    return sum.result();
}

QualitySummary summary_of(std::span<const ElementQuality> elements) {
    QualitySum sum;
    for (const ElementQuality& quality : elements) sum.add(quality);
    return sum.result();
}

}  // namespace curvewright
