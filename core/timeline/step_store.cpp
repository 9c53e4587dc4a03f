#include "core/timeline/step_store.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

constexpr std::size_t least_blocks = 4, cached_blocks = 32;

int open_nameless_file() {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    std::string name = ((error ? std::filesystem::path("/tmp") : folder) / "curvewright-steps-XXXXXX").string();
    const int file = mkstemp(name.data());
    if (file < 0)
        throw InvalidInput(
            fmt::format("The steps need a temporary file, but {} cannot be created: {}.", name, std::strerror(errno)));
    unlink(name.c_str());
    return file;
}

/// Calls transfer(bytes done) until all is done. False: errno says why not.
template <class Transfer>
bool transfer_all(std::size_t size, const Transfer& transfer) {
    for (std::size_t done = 0; done < size;) {
        const ssize_t count = transfer(done);
        if (count < 0 && errno == EINTR) continue;
        if (count == 0) errno = EIO;
        if (count <= 0) return false;
        done += static_cast<std::size_t>(count);
    }
    return true;
}

}  // namespace

StepStore::StepStore(std::size_t memory_limit) : resident_limit_(std::max(least_blocks, memory_limit / block_size)) {}

StepStore::~StepStore() {
    if (file_ >= 0) close(file_);
}

void StepStore::write_oldest_to_file() {
    if (file_ < 0) file_ = open_nameless_file();
    const std::byte* bytes = blocks_[first_resident_].get();
    const auto at = static_cast<off_t>(first_resident_ * block_size);
    const bool is_written = transfer_all(block_size, [&](std::size_t done) {
        return pwrite(file_, bytes + done, block_size - done, at + static_cast<off_t>(done));
    });
    if (!is_written)
        throw InvalidInput(fmt::format("The steps no longer fit into the temporary folder ({} MB so far): {}.",
                                       size_ >> 20, std::strerror(errno)));
    const std::lock_guard lock(mutex_);
    blocks_[first_resident_++].reset();
}

std::uint64_t StepStore::append(std::span<const std::byte> bytes) {
    const std::uint64_t begin = size_;
    const std::size_t needed = (begin + bytes.size() + block_size - 1) / block_size;
    while (blocks_.size() < needed) {
        while (blocks_.size() - first_resident_ >= resident_limit_ &&
               (first_resident_ + 1) * block_size <= begin)  // what is not full yet stays
            write_oldest_to_file();
        auto block = std::make_unique<std::byte[]>(block_size);
        const std::lock_guard lock(mutex_);
        blocks_.push_back(std::move(block));
    }
    for (std::size_t done = 0; done < bytes.size();) {
        const std::uint64_t at = begin + done;
        const std::size_t within = at % block_size, count = std::min(bytes.size() - done, block_size - within);
        std::memcpy(blocks_[at / block_size].get() + within, bytes.data() + done, count);
        done += count;
    }
    size_ = begin + bytes.size();
    return begin;
}

const std::byte* StepStore::block(std::size_t number) const {
    if (blocks_[number]) return blocks_[number].get();
    const auto found = std::find_if(cache_.begin(), cache_.end(), [&](const Cached& c) { return c.number == number; });
    if (found != cache_.end()) {
        cache_.splice(cache_.begin(), cache_, found);
        return cache_.front().bytes.get();
    }
    Block bytes = std::make_unique<std::byte[]>(block_size);
    const auto at = static_cast<off_t>(number * block_size);
    const bool is_read = transfer_all(block_size, [&](std::size_t done) {
        return pread(file_, bytes.get() + done, block_size - done, at + static_cast<off_t>(done));
    });
    if (!is_read)
        throw InvalidInput(fmt::format("The temporary file of the steps cannot be read: {}.", std::strerror(errno)));
    if (cache_.size() >= cached_blocks) cache_.pop_back();
    cache_.push_front({number, std::move(bytes)});
    return cache_.front().bytes.get();
}

void StepStore::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    const std::lock_guard lock(mutex_);
    for (std::size_t done = 0; done < bytes.size();) {
        const std::uint64_t at = offset + done;
        const std::size_t within = at % block_size, count = std::min(bytes.size() - done, block_size - within);
        std::memcpy(bytes.data() + done, block(at / block_size) + within, count);
        done += count;
    }
}

std::size_t StepStore::memory() const {
    const std::lock_guard lock(mutex_);
    return (blocks_.size() - first_resident_ + cache_.size()) * block_size;
}

}  // namespace curvewright
