// Doubles that have lost digits: below 2^-1022 in size, and not zero.
#pragma once

#include <bit>
#include <cstdint>

namespace achilles {

// By the bits: where denormals are taken for zero, a comparison would see none.
inline bool is_subnormal(double x) {
    constexpr std::uint64_t exponent = 0x7FF0000000000000u, fraction = 0x000FFFFFFFFFFFFFu;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    return (bits & exponent) == 0 && (bits & fraction) != 0;
}

}  // namespace achilles
