#include "core/mesh/winding.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace curvewright {

WindingFinder::WindingFinder(Index element_count)
    : parent_(static_cast<std::size_t>(element_count)),
      is_against_parent_(parent_.size(), 0),
      is_one_sided_(parent_.size(), 0) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
}

WindingFinder::Place WindingFinder::place(Index element) {
    bool is_against = false;
    Index root = element;
    for (; parent_[root] != root; root = parent_[root]) is_against ^= is_against_parent_[root] != 0;
    // All on the way hang on the root from now on.
    bool rest = is_against;
    for (Index at = element; parent_[at] != at;) {
        const bool own = is_against_parent_[at] != 0;
        is_against_parent_[at] = rest;
        rest ^= own;
        at = std::exchange(parent_[at], root);
    }
    return {root, is_against};
}

void WindingFinder::meet(Index a, Index b, bool are_alike) {
    const Place one = place(a), other = place(b);
    const bool is_contradiction = one.root == other.root && (one.is_against != other.is_against) == are_alike;
    if (one.root == other.root) {
        if (is_contradiction) is_one_sided_[one.root] = 1;
        return;
    }
    const Index root = std::min(one.root, other.root), child = std::max(one.root, other.root);
    parent_[child] = root;
    is_against_parent_[child] = (one.is_against != other.is_against) == are_alike;
    is_one_sided_[root] |= is_one_sided_[child];
}

Winding WindingFinder::find() {
    // The root of a set is its first element, so that the classes are told by whether they run against that one.
    Winding winding;
    winding.part_of_element.resize(parent_.size());
    std::vector<std::array<Index, 2>> sizes;
    std::vector<char> is_against(parent_.size());
    for (std::size_t i = 0; i < parent_.size(); ++i) {
        const auto element = static_cast<Index>(i);
        const Place its = place(element);
        if (its.root == element) {
            winding.part_of_element[i] = winding.part_count++;
            winding.is_part_one_sided.push_back(is_one_sided_[i]);
            winding.one_sided_count += is_one_sided_[i];
            sizes.push_back({0, 0});
        } else {
            winding.part_of_element[i] = winding.part_of_element[its.root];
        }
        is_against[i] = its.is_against;
        ++sizes[winding.part_of_element[i]][its.is_against];
    }
    winding.is_reversed.assign(parent_.size(), 0);
    for (std::size_t i = 0; i < parent_.size(); ++i) {
        const Index part = winding.part_of_element[i];
        if (winding.is_part_one_sided[part]) continue;
        const auto [with, against] = sizes[part];
        if ((against <= with) != (is_against[i] != 0)) continue;
        winding.is_reversed[i] = 1;
        ++winding.reversed_count;
    }
    if (winding.reversed_count == 0) winding.is_reversed.clear();
    if (winding.one_sided_count == 0) winding.is_part_one_sided.clear();
    return winding;
}

}  // namespace curvewright
