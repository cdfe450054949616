// A condition that must hold for every input. If it fails, the process aborts and libFuzzer keeps the input.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace achilles::fuzz {

inline void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "broken: %s\n", what);
    std::abort();
}

}  // namespace achilles::fuzz
