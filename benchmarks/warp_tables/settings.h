#pragma once

#include <filesystem>

#include "core/base/ids.h"

namespace curvewright::benchmarks {

struct Settings {
    std::filesystem::path families;  ///< where sample_meshes/families/generate.sh put its meshes
    std::filesystem::path samples;   ///< the folder sample_meshes
    bool is_quick = false;           ///< small levels only, less than a minute
    int threads = 2;
    /// Most interior nodes of a 3D mesh for which the reference solver is run; ten times as many in 2D, where the
    /// factors fill far less.
    Index reference_limit = 40000;

    double load_before = 0.0;  ///< processes that wanted a processor in the minute before the run

    bool runs_reference(int dimension, Index interior_nodes) const {
        return interior_nodes <= (dimension == 2 ? 10 * reference_limit : reference_limit);
    }
    int last_level(int dimension) const { return dimension == 2 ? (is_quick ? 4 : 8) : (is_quick ? 3 : 7); }
    int million_level() const { return is_quick ? 6 : 9; }  ///< of the circle family
};

}  // namespace curvewright::benchmarks
