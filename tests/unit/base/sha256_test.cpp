#include "core/base/sha256.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

TEST(Sha256, HasTheKnownValues) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, TakesItsBytesInPieces) {
    std::string text;
    for (int i = 0; i < 300; ++i) text += static_cast<char>(i * 7);
    for (std::size_t size = 0; size <= text.size(); size += 1) {
        const std::string part = text.substr(0, size);
        Sha256 hash;
        for (std::size_t at = 0; at < part.size(); at += 13) hash.add(std::string_view(part).substr(at, 13));
        ASSERT_EQ(hash.digest(), sha256(part)) << size;
    }
}

TEST(Sha256, OfAFile) {
    const auto file = std::filesystem::temp_directory_path() / "curvewright_sha256_test.bin";
    std::ofstream(file, std::ios::binary) << std::string(3000001, 'x');
    EXPECT_EQ(sha256_of_file(file), sha256(std::string(3000001, 'x')));
    std::filesystem::remove(file);
    EXPECT_THROW(sha256_of_file(file), InvalidInput);
    EXPECT_THROW(sha256_of_file(file.parent_path()), InvalidInput);
}

}  // namespace
}  // namespace curvewright
