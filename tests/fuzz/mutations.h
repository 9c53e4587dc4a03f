#pragma once

#include <cstdint>
#include <string>

namespace curvewright::fuzz {

/// The bytes with one to four kinds of damage: bits, bytes, numbers (of text and binary), pieces cut, doubled, swapped,
/// the end gone. The same for the same number on every machine.
std::string mutated(std::string bytes, std::uint64_t number);

}  // namespace curvewright::fuzz
