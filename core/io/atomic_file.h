#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace curvewright {

/// A file that appears complete or not at all: the writer fills path() (in the target's folder, same suffix), commit()
/// renames it to the target. Without commit() the destructor removes it. Symbolic links are followed; a target that is no
/// regular file (a device, a pipe) gets the content copied instead.
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::filesystem::path& path() const { return temporary_; }
    /// Throws InvalidInput that names the target if it cannot be put in place.
    void commit();

  private:
    std::filesystem::path target_, temporary_;
    bool is_committed_ = false, is_stream_ = false;
};

/// Writes text through an AtomicFile. Throws InvalidInput that names the file.
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// Reads a whole file (through zlib if it ends in .gz). Throws InvalidInput that names the file.
std::string read_text_file(const std::filesystem::path& file);

}  // namespace curvewright
