#include "tests/fuzz/mutations.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <vector>

namespace curvewright::fuzz {
namespace {

/// Random numbers that do not depend on the standard library.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}
    std::size_t below(std::size_t count) { return count == 0 ? 0 : static_cast<std::size_t>(engine_() % count); }

  private:
    std::mt19937_64 engine_;
};

/// Another number in place of one of a text.
void change_number(std::string& bytes, Dice& dice) {
    constexpr std::array values = {"0",
                                   "-1",
                                   "1",
                                   "2",
                                   "3",
                                   "255",
                                   "65536",
                                   "2147483647",
                                   "2147483648",
                                   "4294967295",
                                   "-2147483648",
                                   "9223372036854775807",
                                   "1e308",
                                   "1e-320",
                                   "nan",
                                   "-inf",
                                   "99999999999999999999",
                                   "0.5",
                                   "1000000",
                                   "\"\""};
    const std::size_t begin = bytes.find_first_of("0123456789", dice.below(bytes.size()));
    if (begin == bytes.npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", begin), bytes.size());
    bytes.replace(begin, end - begin, values[dice.below(values.size())]);
}

/// The same in binary, of either byte order.
void change_integer(std::string& bytes, Dice& dice) {
    constexpr std::array<std::uint64_t, 9> values = {
        0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x10000000, 0x7fffffffffffffff, 0xffffffffffffffff, 0x1000};
    const std::size_t size = dice.below(2) == 0 ? 4 : 8;
    if (bytes.size() < size) return;
    const std::uint64_t value = values[dice.below(values.size())];
    std::array<char, 8> raw;
    std::memcpy(raw.data(), &value, raw.size());
    if (dice.below(2) == 0) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    std::copy_n(raw.begin(), size, bytes.begin() + static_cast<std::ptrdiff_t>(dice.below(bytes.size() - size + 1)));
}

/// Two lines change places.
void swap_lines(std::string& bytes, Dice& dice) {
    std::vector<std::string> lines(1);
    for (const char c : bytes) {
        lines.back() += c;
        if (c == '\n') lines.emplace_back();
    }
    std::swap(lines[dice.below(lines.size())], lines[dice.below(lines.size())]);
    bytes.clear();
    for (const std::string& line : lines) bytes += line;
}

void change(std::string& bytes, Dice& dice) {
    const std::size_t at = dice.below(bytes.size());
    const std::size_t length = std::min(dice.below(dice.below(4) == 0 ? 400 : 20) + 1, bytes.size() - at);
    switch (dice.below(10)) {
        case 0:
            if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << dice.below(8)));
            return;
        case 1:
            if (!bytes.empty()) bytes[at] = static_cast<char>(dice.below(256));
            return;
        case 2:
        case 3:
        case 4:
            return change_number(bytes, dice);
        case 5:
            return change_integer(bytes, dice);
        case 6:
            bytes.erase(at, length);
            return;
        case 7:
            bytes.insert(dice.below(bytes.size() + 1), bytes.substr(at, length));
            return;
        case 8:
            return swap_lines(bytes, dice);
        default:
            if (dice.below(4) == 0) bytes.resize(at);
            return;
    }
}

}  // namespace

std::string mutated(std::string bytes, std::uint64_t number) {
    Dice dice(number);
    for (std::size_t left = 1 + dice.below(4); left > 0; --left) change(bytes, dice);
    return bytes;
}

}  // namespace curvewright::fuzz
