#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/tables/measure.h"
#include "core/base/ids.h"

namespace curvewright::benchmarks {

/// A table of the thesis, or the numbers of one of its figures.
struct TableId {
    std::string kind;    ///< "table" or "figure"
    std::string number;  ///< "2.1"

    std::string text() const { return kind + " " + number; }       ///< "table 2.1"
    std::string file_name() const { return kind + "_" + number; }  ///< "table_2.1"
};
/// All that the program makes, in the order of the thesis.
const std::vector<TableId>& all_tables();

struct Settings {
    std::filesystem::path samples;   ///< the folder sample_meshes
    std::filesystem::path families;  ///< where sample_meshes/families/generate.sh put its meshes
    std::filesystem::path peers;     ///< peers.csv
    std::vector<std::string> only;   ///< "2.1", "table 2.1" or "figure 2.1"; empty = everything
    bool is_quick = false;
    int threads = 2;
    double load_before = 0.0;  ///< processes that wanted a processor in the minute before the run
    /// Most interior nodes of a mesh of the families, 2D and 3D, and of an example for which SparseLU is run; of
    /// examples with more than example_both_limit for convex weights only.
    Index family_lu_limit_2d = 130000, family_lu_limit_3d = 23000, example_lu_limit = 65000;
    Index example_both_limit = 65000;

    Repeats repeats() const { return is_quick ? Repeats{0.5, 0.05} : Repeats{2.0, 0.3}; }
    bool wants(const std::string& kind, const std::string& number) const;
    bool wants_any(const std::vector<TableId>& tables) const;
};

/// Throws InvalidInput that lists what there is if an entry of settings.only is none of them.
void check_selection(const Settings& settings);

}  // namespace curvewright::benchmarks
