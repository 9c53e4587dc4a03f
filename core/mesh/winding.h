#pragma once

#include <vector>

#include "core/base/ids.h"

namespace curvewright {

/// How the elements of a mesh are numbered against each other: a combinatorial fact that no coordinate changes.
///
/// A part of the mesh consists of elements that meet in whole facets. Two of them that meet in a facet, which no third
/// one has, run alike if they number it in opposite senses. Where that leads to no contradiction, a part falls into two
/// classes; those of the smaller one are *reversed*. If the classes are of one size, the one without the part's first
/// element is. A part that contradicts itself (a Möbius strip) cannot be numbered alike: it is one-sided, and nothing
/// in it is reversed.
struct Winding {
    std::vector<Index> part_of_element;   ///< 0 .. part_count - 1, in the order of their first elements
    std::vector<char> is_reversed;        ///< per element; empty if none is
    std::vector<char> is_part_one_sided;  ///< per part; empty if none is
    Index part_count = 0, reversed_count = 0, one_sided_count = 0;
};

/// Gathers who meets whom, then tells the winding: union-find with the parity to the root of the set.
class WindingFinder {
  public:
    explicit WindingFinder(Index element_count);
    /// Elements a and b meet in a facet. are_alike: they number it in opposite senses.
    void meet(Index a, Index b, bool are_alike);
    Winding find();

  private:
    struct Place {
        Index root;
        bool is_against;  ///< runs against the root
    };
    Place place(Index element);

    std::vector<Index> parent_;
    std::vector<char> is_against_parent_, is_one_sided_;  ///< one-sided: of roots
};

}  // namespace curvewright
