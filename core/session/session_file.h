#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/session/action.h"

namespace curvewright {

// A session is text: one JSON object per line, in the order in which things were done.

/// One line, without its end. Numbers are written so that they read back as the same.
std::string to_json_line(const Action& action);

/// The action of a line. Throws InvalidInput("FILE:LINE: …") for what is no such object, an unknown action, method or
/// choice, a missing or wrong value.
Action parse_action(std::string_view line, const std::string& file = "session", long line_number = 0);

/// A whole session; empty lines are passed over. Throws InvalidInput that names the file and the line.
std::vector<Action> parse_session(std::string_view text, const std::string& file);
/// The same of a file. Throws InvalidInput that names it.
std::vector<Action> read_session(const std::filesystem::path& file);
/// Whether a .json file is a session, by its first line (deformations are JSON as well). False if it cannot be read.
bool is_session_file(const std::filesystem::path& file);
/// Appears complete or not at all. Throws InvalidInput that names the file.
void write_session(const std::filesystem::path& file, const std::vector<Action>& actions);

/// The command line that does the last action of a session again, for a shell: a command of its own where there is
/// one, else a replay of what leads to it. input, output: the mesh that the action starts from, and where to put the
/// result.
std::string command_line(const Action& action, const std::string& input, const std::string& output);

/// The same for several actions, the first of which opens the mesh: a command of their own for one step after it, else
/// a replay.
std::string command_line(const std::vector<Action>& actions, const std::string& output);

}  // namespace curvewright
