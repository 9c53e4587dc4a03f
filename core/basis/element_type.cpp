#include "core/basis/element_type.h"

namespace curvewright {

int dimension(Shape shape) {
    switch (shape) {
        case Shape::vertex:
            return 0;
        case Shape::line:
            return 1;
        case Shape::triangle:
        case Shape::quadrilateral:
            return 2;
        default:
            return 3;
    }
}

int corner_count(Shape shape) {
    switch (shape) {
        case Shape::vertex:
            return 1;
        case Shape::line:
            return 2;
        case Shape::triangle:
            return 3;
        case Shape::quadrilateral:
        case Shape::tetrahedron:
            return 4;
        case Shape::pyramid:
            return 5;
        case Shape::prism:
            return 6;
        case Shape::hexahedron:
            return 8;
    }
    return 0;
}

int node_count(ElementType type) {
    const int p = type.order;
    switch (type.shape) {
        case Shape::vertex:
            return 1;
        case Shape::line:
            return p + 1;
        case Shape::triangle:
            return (p + 1) * (p + 2) / 2;
        case Shape::quadrilateral:
            return (p + 1) * (p + 1);
        case Shape::tetrahedron:
            return (p + 1) * (p + 2) * (p + 3) / 6;
        case Shape::hexahedron:
            return (p + 1) * (p + 1) * (p + 1);
        case Shape::prism:
            return (p + 1) * (p + 1) * (p + 2) / 2;
        case Shape::pyramid:
            return (p + 1) * (p + 2) * (2 * p + 3) / 6;
    }
    return 0;
}

bool is_simplex(Shape shape) {
    return shape == Shape::vertex || shape == Shape::line || shape == Shape::triangle || shape == Shape::tetrahedron;
}

std::vector<int> simplex_factors(Shape shape) {
    switch (shape) {
        case Shape::line:
            return {1};
        case Shape::triangle:
            return {2};
        case Shape::quadrilateral:
            return {1, 1};
        case Shape::tetrahedron:
            return {3};
        case Shape::hexahedron:
            return {1, 1, 1};
        case Shape::prism:
            return {2, 1};
        case Shape::vertex:
        case Shape::pyramid:
            break;
    }
    return {};
}

Shape simplex(int dimension) {
    return dimension == 1 ? Shape::line : dimension == 2 ? Shape::triangle : Shape::tetrahedron;
}

std::string name(Shape shape) {
    switch (shape) {
        case Shape::vertex:
            return "vertex";
        case Shape::line:
            return "line";
        case Shape::triangle:
            return "triangle";
        case Shape::quadrilateral:
            return "quadrilateral";
        case Shape::tetrahedron:
            return "tetrahedron";
        case Shape::hexahedron:
            return "hexahedron";
        case Shape::prism:
            return "prism";
        case Shape::pyramid:
            return "pyramid";
    }
    return "element";
}

std::string counted_name(Shape shape, long count) {
    std::string word = name(shape);
    if (count != 1) {
        if (shape == Shape::vertex)
            word = "vertices";
        else if (shape == Shape::tetrahedron)
            word = "tetrahedra";
        else if (shape == Shape::hexahedron)
            word = "hexahedra";
        else
            word += "s";
    }
    return std::to_string(count) + " " + word;
}

std::string name(ElementType type) {
    return "P" + std::to_string(type.order) + " " + name(type.shape);
}

}  // namespace curvewright
