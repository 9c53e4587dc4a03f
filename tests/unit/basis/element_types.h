#pragma once

#include <vector>

#include "core/basis/element_type.h"

namespace curvewright {

inline const std::vector<Shape> all_shapes = {Shape::vertex,        Shape::line,        Shape::triangle,
                                              Shape::quadrilateral, Shape::tetrahedron, Shape::hexahedron,
                                              Shape::prism,         Shape::pyramid};

/// Every element type of orders lowest to highest (a vertex once).
inline std::vector<ElementType> all_types(int highest = max_order, int lowest = 1) {
    std::vector<ElementType> types;
    for (const Shape shape : all_shapes)
        for (int order = lowest; order <= (shape == Shape::vertex ? 1 : highest); ++order)
            types.push_back({shape, order});
    return types;
}

}  // namespace curvewright
