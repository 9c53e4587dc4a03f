#pragma once

#include <string>
#include <utility>
#include <vector>

namespace curvewright {

/// Name and version of this program, of the libraries that its numbers come through, and of the compiler.
std::vector<std::pair<std::string, std::string>> program_versions();

}  // namespace curvewright
