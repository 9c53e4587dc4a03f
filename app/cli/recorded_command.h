#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace curvewright::cli {

/// The command as it is recorded in files: its name, positionals and options in the order of its help, quoted for a
/// shell, files without their folders. Without what the result does not depend on (where it goes, how it is told, the
/// number of threads), so that two files with the same content are the same.
std::string recorded_command(const CLI::App& command);

}  // namespace curvewright::cli
