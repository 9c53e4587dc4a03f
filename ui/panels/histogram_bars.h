#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/edit/selection.h"
#include "core/quality/quality.h"

namespace curvewright {

/// Elements counted by their scaled Jacobian: an alarm bar "≤ 0" of the tangled ones, then equal bins over [0, 1].
struct HistogramBars {
    static constexpr int bins = 25;
    static constexpr int tangled_bar = -1, no_bar = -2;
    struct Bar {
        Index decided = 0, undecided = 0;
        Index selected = 0;  ///< among both
        Index count() const { return decided + undecided; }
    };
    Bar tangled;
    std::vector<Bar> bars = std::vector<Bar>(bins);
    std::vector<std::int8_t> bar_of_element;  ///< tangled_bar, a bin, or no_bar if it was not assessed

    /// pre: tangled_bar <= index < bins
    Bar& at(int index) { return index < 0 ? tangled : bars[static_cast<std::size_t>(index)]; }
    const Bar& at(int index) const { return index < 0 ? tangled : bars[static_cast<std::size_t>(index)]; }
    static double lower(int bin) { return static_cast<double>(bin) / bins; }
    /// Largest count of any bar.
    Index highest() const;
    /// Elements of all bars from one to another.
    IndexSet elements_in(int first, int last) const;
    /// Counts the selected elements of every bar anew. Those that there are not are passed over.
    void mark(const IndexSet& selected);
};
HistogramBars make_bars(std::span<const ElementQuality> elements);

/// Figures of some of the elements; those that there are not are passed over. All zero if there are none.
QualitySummary summary_of(std::span<const ElementQuality> elements, std::span<const Index> some);
/// Figures of all.
QualitySummary summary_of(std::span<const ElementQuality> elements);

}  // namespace curvewright
