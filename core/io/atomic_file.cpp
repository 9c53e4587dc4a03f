#include "core/io/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

namespace fs = std::filesystem;

std::string reason() {
    return errno == 0 ? "unknown reason" : std::strerror(errno);
}

/// Temporary files of one process never meet: a counter beside the process's number.
fs::path temporary_name(const fs::path& target) {
    static std::atomic<unsigned> counter = 0;
    const std::string name =
        fmt::format(".{}.{}-{}{}", target.stem().string(), ::getpid(), counter++, target.extension().string());
    return target.parent_path() / name;
}

/// Throws a sentence about files that cannot be opened as such.
void check_readable(const fs::path& file) {
    std::error_code error;
    const auto status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) throw InvalidInput(file.string(), 0, "there is no such file.");
    if (error) throw InvalidInput(file.string(), 0, fmt::format("the file cannot be read ({}).", error.message()));
    if (fs::is_directory(status)) throw InvalidInput(file.string(), 0, "this is a folder; a file was expected.");
}

std::string read_compressed(const fs::path& file) {
    errno = 0;
    const gzFile stream = gzopen(file.c_str(), "rb");
    if (stream == nullptr) throw InvalidInput(file.string(), 0, fmt::format("the file cannot be read ({}).", reason()));
    gzbuffer(stream, 1u << 18);
    std::string text;
    std::size_t used = 0;
    for (int got = 1; got > 0;) {
        text.resize(std::max<std::size_t>(1u << 20, used * 2));
        const std::size_t room = std::min<std::size_t>(text.size() - used, 1u << 30);
        got = gzread(stream, text.data() + used, static_cast<unsigned>(room));
        if (got < 0) {
            int code = 0;
            const std::string message = gzerror(stream, &code);
            gzclose(stream);
            throw InvalidInput(file.string(), 0, fmt::format("the compressed file is damaged ({}).", message));
        }
        used += static_cast<std::size_t>(got);
    }
    text.resize(used);
    if (gzclose(stream) != Z_OK)  // a stream that ends too early is told here only
        throw InvalidInput(file.string(), 0, "the compressed file is damaged (it ends too early).");
    return text;
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)) {
    std::error_code error;
    // A link stays a link: the file that it leads to is replaced.
    if (fs::is_symlink(target_, error)) target_ = fs::weakly_canonical(target_, error);
    // A device or a pipe cannot be replaced by a file: it gets the content when that is complete.
    is_stream_ = fs::exists(target_, error) && fs::is_other(target_, error);
    temporary_ = temporary_name(is_stream_ ? fs::temp_directory_path() / target_.filename() : target_);
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    if (!is_committed_) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
    std::error_code error;
    if (fs::is_directory(target_, error))
        throw InvalidInput(target_.string(), 0, "the file cannot be written (there is a folder of that name).");
    if (is_stream_) {
        errno = 0;
        std::ifstream source(temporary_, std::ios::binary);
        std::ofstream stream(target_, std::ios::binary);
        if (source.peek() != std::ifstream::traits_type::eof()) stream << source.rdbuf();
        stream.close();
        if (!stream) throw InvalidInput(target_.string(), 0, fmt::format("the file cannot be written ({}).", reason()));
        return;  // the destructor removes the temporary file
    }
    fs::rename(temporary_, target_, error);
    if (error)
        throw InvalidInput(target_.string(), 0, fmt::format("the file cannot be written ({}).", error.message()));
    is_committed_ = true;
}

void write_text_file(const fs::path& file, std::string_view text) {
    AtomicFile atomic(file);
    {
        errno = 0;
        std::ofstream stream(atomic.path(), std::ios::binary);
        if (stream) stream.write(text.data(), static_cast<std::streamsize>(text.size()));
        if (stream) stream.close();
        if (!stream) throw InvalidInput(file.string(), 0, fmt::format("the file cannot be written ({}).", reason()));
    }
    atomic.commit();
}

std::string read_text_file(const fs::path& file) {
    check_readable(file);
    if (file.extension() == ".gz") return read_compressed(file);
    errno = 0;
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    const auto size = stream ? static_cast<std::streamoff>(stream.tellg()) : std::streamoff{-1};
    std::string text;
    if (size > 0) {
        text.resize(static_cast<std::size_t>(size));
        stream.seekg(0);
        stream.read(text.data(), size);
    }
    if (size < 0 || !stream)
        throw InvalidInput(file.string(), 0, fmt::format("the file cannot be read ({}).", reason()));
    return text;
}

}  // namespace curvewright
