#include "ui/panels/histogram_bars.h"

#include <algorithm>
#include <limits>

namespace curvewright {
namespace {

/// Sums up what it is given one after another.
class Figures {
  public:
    void add(const ElementQuality& quality) {
        low_ = std::min(low_, quality.scaled_jacobian);
        high_ = std::max(high_, quality.scaled_jacobian);
        total_ += quality.scaled_jacobian;
        if (quality.validity == Validity::valid) ++summary_.valid;
        if (quality.validity == Validity::invalid) ++summary_.invalid;
        if (quality.validity == Validity::undecided) ++summary_.undecided;
    }
    QualitySummary result() {
        const Index count = summary_.elements();
        if (count == 0) return {};
        summary_.min = low_;
        summary_.max = high_;
        summary_.mean = std::clamp(total_ / static_cast<double>(count), low_, high_);
        return summary_;
    }

  private:
    QualitySummary summary_;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -low_, total_ = 0.0;
};

}  // namespace

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
        if (const auto i = static_cast<std::size_t>(element); i < bar_of_element.size())
            ++at(bar_of_element[i]).selected;
}

HistogramBars make_bars(std::span<const ElementQuality> elements) {
    HistogramBars result;
    result.bar_of_element.reserve(elements.size());
    for (const ElementQuality& quality : elements) {
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
    Figures figures;
    for (const Index element : some)
        if (const auto i = static_cast<std::size_t>(element); i < elements.size()) figures.add(elements[i]);
    return figures.result();
}

QualitySummary summary_of(std::span<const ElementQuality> elements) {
    Figures figures;
    for (const ElementQuality& quality : elements) figures.add(quality);
    return figures.result();
}

}  // namespace curvewright
