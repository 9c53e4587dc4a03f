#pragma once

#include <string>

namespace curvewright {

/// Who made a file, of what and how: written into it, so that it can be made again.
struct Provenance {
    std::string program = "Curvewright";
    std::string version;
    std::string command;       ///< what was asked for, as a command line; without what the result does not depend on
    std::string input;         ///< name of the mesh that was read; "" = none
    std::string input_sha256;  ///< of its bytes; "" = unknown
};

/// One line per thing that is known ("Command: ..."), each with its end; control characters become blanks.
std::string provenance_text(const Provenance& provenance);

}  // namespace curvewright
