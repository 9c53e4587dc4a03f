#pragma once

namespace curvewright {

/// One function for std::visit, made of one for each alternative.
template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // for Clang before 17

}  // namespace curvewright
