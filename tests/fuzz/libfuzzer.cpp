// libFuzzer's entry: one program for all targets, so that one is built. CURVEWRIGHT_FUZZ_TARGET says which.

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/targets.h"

namespace {

using namespace curvewright::fuzz;
const Target* target = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    const char* name = std::getenv("CURVEWRIGHT_FUZZ_TARGET");
    target = find_target(name != nullptr ? name : "");
    if (target != nullptr) return 0;
    std::fputs("CURVEWRIGHT_FUZZ_TARGET must be one of", stderr);
    for (const Target& known : targets()) std::fprintf(stderr, " %s", known.name);
    std::fputs(".\n", stderr);
    std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    target->run({reinterpret_cast<const char*>(data), size});
    return 0;
}
