#include "core/timeline/step_store.h"

#include <cstdlib>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

std::vector<std::byte> noise(std::size_t size, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::byte> bytes(size);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    return bytes;
}

TEST(StepStore, GivesBackWhatWasWrittenWhereverItLies) {
    StepStore store(0);
    const std::size_t sizes[] = {
        1, 0, 100, StepStore::block_size, 3 * StepStore::block_size + 5, 17, 20 * StepStore::block_size, 33};
    std::vector<std::uint64_t> offsets;
    for (std::size_t i = 0; i < std::size(sizes); ++i)
        offsets.push_back(store.append(noise(sizes[i], static_cast<unsigned>(i))));
    for (int round = 0; round < 3; ++round)
        for (std::size_t i = std::size(sizes); i-- > 0;) {
            std::vector<std::byte> bytes(sizes[i]);
            store.read(offsets[i], bytes);
            EXPECT_EQ(bytes, noise(sizes[i], static_cast<unsigned>(i))) << i;
        }
}

TEST(StepStore, HoldsNoMoreThanItsLimitInMemory) {
    constexpr std::size_t limit = 8 * StepStore::block_size;
    StepStore store(limit);
    const auto bytes = noise(1000, 1);
    for (int i = 0; i < 20000; ++i) store.append(bytes);
    EXPECT_EQ(store.size(), 20'000'000u);
    EXPECT_LE(store.memory(), limit + StepStore::block_size);
    std::vector<std::byte> one(1000);
    for (std::uint64_t at = 0; at + 1000 < store.size(); at += 50'000) {
        store.read(at, one);
        EXPECT_EQ(one, bytes);
    }
    EXPECT_LE(store.memory(), limit + 40 * StepStore::block_size);
}

TEST(StepStore, SaysSoWhenThereIsNoPlaceForItsFile) {
    const char* before = std::getenv("TMPDIR");
    const std::string kept = before ? before : "";
    setenv("TMPDIR", "/proc", 1);
    StepStore store(0);
    std::string message;
    try {
        for (int i = 0; i < 20; ++i) store.append(noise(StepStore::block_size, 1));
    } catch (const InvalidInput& error) {
        message = error.what();
    }
    before ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
    EXPECT_NE(message.find("temporary file"), std::string::npos) << message;
    EXPECT_NE(message.find("/proc"), std::string::npos) << message;
    // What was written before can still be read.
    std::vector<std::byte> first(StepStore::block_size);
    store.read(0, first);
    EXPECT_EQ(first, noise(StepStore::block_size, 1));
}

}  // namespace
}  // namespace curvewright
