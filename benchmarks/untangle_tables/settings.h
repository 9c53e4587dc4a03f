#pragma once

#include <filesystem>
#include <string>

namespace curvewright::benchmarks {

struct Settings {
    std::filesystem::path samples;  ///< the folder sample_meshes
    std::filesystem::path cad;      ///< where sample_meshes/cad/generate.py put its meshes
    std::string python;             ///< an interpreter with Gmsh's module; empty = leave the peer out
    bool is_quick = false;          ///< few cases, less than a minute
    int threads = 2;
    double peer_limit = 60.0;  ///< seconds after which a run of the peer is given up
    double load_before = 0.0;  ///< processes that wanted a processor in the minute before the run
};

}  // namespace curvewright::benchmarks
