#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace curvewright {

/// Bytes that are written once, one after the other, and read anywhere. The last ones are in memory, as many as the
/// limit allows; earlier ones are in a temporary file that has no name and goes with the store. One thread at a time
/// appends; any number may read what was appended before.
class StepStore {
  public:
    static constexpr std::size_t block_size = std::size_t{1} << 18;

    /// memory_limit: bytes, at least a few blocks are kept whatever it says.
    explicit StepStore(std::size_t memory_limit);
    ~StepStore();
    StepStore(const StepStore&) = delete;
    StepStore& operator=(const StepStore&) = delete;

    /// Where the bytes begin. Throws InvalidInput if the temporary file cannot be written; the store is then as it was.
    std::uint64_t append(std::span<const std::byte> bytes);
    /// pre: [offset, offset + size) was appended. Throws InvalidInput if the temporary file cannot be read.
    void read(std::uint64_t offset, std::span<std::byte> bytes) const;

    std::uint64_t size() const { return size_; }
    /// Bytes held in memory, those read again from the file included.
    std::size_t memory() const;

  private:
    using Block = std::unique_ptr<std::byte[]>;
    struct Cached {
        std::size_t number = 0;
        Block bytes;
    };

    void write_oldest_to_file();
    /// The block in memory. Called with the mutex locked.
    const std::byte* block(std::size_t number) const;

    const std::size_t resident_limit_;
    std::vector<Block> blocks_;  ///< null: in the file, at its number × block_size
    std::size_t first_resident_ = 0;
    std::uint64_t size_ = 0;
    int file_ = -1;
    mutable std::mutex mutex_;
    mutable std::list<Cached> cache_;  ///< of the file's blocks, the last one that was read first
};

}  // namespace curvewright
