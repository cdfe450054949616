#include "number/angle.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace achilles {

namespace {

struct CachedAngle {
    double angle = 0.0;
    SineCosine value;
};

// Not inlined, so that a cache hit needs no saved registers.
[[gnu::noinline]] SineCosine compute_and_cache(double angle, CachedAngle& known) {
    known = {angle, {std::sin(angle), std::cos(angle)}};
    return known.value;
}

}  // namespace

SineCosine sine_and_cosine(double angle) {
    static thread_local constinit std::array<CachedAngle, 8> memory{};
    const auto bits = std::bit_cast<std::uint64_t>(angle);
    CachedAngle& known = memory[bits * 0x9E3779B97F4A7C15u >> 61];
    if (std::bit_cast<std::uint64_t>(known.angle) != bits) return compute_and_cache(angle, known);
    return known.value;
}

}  // namespace achilles
