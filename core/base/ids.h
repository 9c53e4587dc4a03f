#pragma once

#include <compare>
#include <cstdint>
#include <functional>

namespace curvewright {

/// Position of a node or an element in the arrays of a mesh, counted from 0.
using Index = std::int32_t;

/// A number that a mesh file gives to something. It is never a position in an array: the type keeps the two apart.
template <class Kind>
struct Tag {
    std::int64_t value = 0;
    friend auto operator<=>(const Tag&, const Tag&) = default;
};

/// The number of a node in a file.
using NodeTag = Tag<struct NodeKind>;
/// The number of an element in a file.
using ElementTag = Tag<struct ElementKind>;

}  // namespace curvewright

/// \cond
template <class Kind>
struct std::hash<curvewright::Tag<Kind>> {
    std::size_t operator()(const curvewright::Tag<Kind>& tag) const noexcept {
        return std::hash<std::int64_t>{}(tag.value);
    }
};
/// \endcond
