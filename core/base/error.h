#pragma once

#include <stdexcept>
#include <string>

namespace curvewright {

/// Root of the exceptions of this library. what() is one sentence for the user; it names the thing it speaks of.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The input is malformed or does not fit: what() names the file (and the line, where there is one), what is wrong and
/// what was expected.
class InvalidInput : public Error {
  public:
    using Error::Error;
    /// "FILE:LINE: MESSAGE"; a line of 0 is left out.
    InvalidInput(const std::string& file, long line, const std::string& message)
        : Error(file + (line > 0 ? ":" + std::to_string(line) : std::string()) + ": " + message) {}
};

/// The input is well formed, but it asks for something that the program cannot do.
class Unsupported : public Error {
  public:
    using Error::Error;
};

/// A linear solver or an optimiser failed in a way that leaves no usable result.
class SolverFailure : public Error {
  public:
    using Error::Error;
};

/// The caller asked to stop; nothing was changed.
class Cancelled : public Error {
  public:
    Cancelled() : Error("Cancelled.") {}
};

}  // namespace curvewright
