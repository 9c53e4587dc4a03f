#pragma once

#include <span>
#include <string>
#include <string_view>

namespace curvewright::fuzz {

/// A parser of ours that gets hostile bytes: from libFuzzer, from the mutation program and from a test of the seeds.
struct Target {
    const char* name;  ///< and that of the folder of its seeds in tests/fuzz/corpus
    const char* corpus;
    /// Reads the bytes. True if they were taken, false if they were refused with an Error of ours. Throws whatever else
    /// the parser throws: that is a fault.
    bool (*run)(std::string_view bytes);
};

std::span<const Target> targets();
/// The target of that name; none if there is no such.
const Target* find_target(std::string_view name);

}  // namespace curvewright::fuzz
