#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/ids.h"

namespace curvewright {

/// Numbers that a file attaches to the nodes or elements of a mesh: a pressure, a velocity, the number of a partition.
/// They stand beside the mesh, in its order of nodes and elements, and nothing here changes them.
struct FieldArray {
    enum class Place { nodes, elements };

    std::string name;
    Place place = Place::nodes;
    int components = 1;
    /// (nodes or elements) × components, row-major; NaN where the file has no value.
    std::vector<double> values;
    /// On elements: the same of the cells of lower dimension, in the order of the blocks; empty = they have none.
    std::vector<double> lower_values;
    bool is_integer = false;  ///< the file has integers
    // What MSH says besides.
    double time = 0.0;
    int time_step = 0;

    std::size_t size() const { return values.size() / static_cast<std::size_t>(components); }
};

/// Smallest and largest of the values that are numbers; none if there is no number.
std::optional<std::pair<double, double>> finite_range(std::span<const double> values);

/// One number per row: a component (from 0), or the length of the row (component -1; of rows of one number that number
/// itself). pre: components >= 1.
std::vector<double> scalar_values(std::span<const double> rows, int components, int component);

/// Gives arrays of one place that share a name names of their own ("p", "p (2)", ...). Returns how many got another.
int make_names_unique(std::vector<FieldArray>& fields);

}  // namespace curvewright
