#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace curvewright::testing {

struct ProcessResult {
    int status = -1;  ///< exit status; 128 + signal if it was killed
    std::string output, errors;
};

/// Runs a program without a shell and waits for it. DISPLAY is taken away: the command line must not need one.
ProcessResult run_program(const std::vector<std::string>& command);
/// The same, but sends it SIGINT as soon as its standard error holds the text. Gives it up, with SIGKILL, after two
/// minutes.
ProcessResult interrupt_program(const std::vector<std::string>& command, const std::string& text);

/// A folder that is removed with all that is in it.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace curvewright::testing
