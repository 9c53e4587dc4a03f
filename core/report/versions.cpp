#include "core/report/versions.h"

#include <fmt/format.h>
#include <Eigen/Core>

namespace curvewright {

std::vector<std::pair<std::string, std::string>> program_versions() {
    return {{"Curvewright", CURVEWRIGHT_VERSION},
            {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
            {"VTK", CURVEWRIGHT_VTK_VERSION},
            {"compiler", CURVEWRIGHT_COMPILER}};
}

}  // namespace curvewright
