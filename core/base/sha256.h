#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace curvewright {

/// SHA-256 (FIPS 180-4) of bytes that come in pieces.
class Sha256 {
  public:
    void add(std::span<const std::byte> bytes);
    void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
    /// 64 hexadecimal digits, lower case. To be called once, at the end.
    std::string digest();

  private:
    void process(const std::uint8_t* block);

    std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<std::uint8_t, 64> rest_{};
    std::size_t rest_size_ = 0;
    std::uint64_t length_ = 0;  ///< bytes
};

/// Of a text: 64 hexadecimal digits, lower case.
std::string sha256(std::string_view text);
/// Of the bytes of a file as they are (a compressed one is not unpacked). Throws InvalidInput that names the file.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace curvewright
