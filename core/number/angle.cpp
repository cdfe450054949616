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

// The entry of the cache for an angle, which may hold another one.
CachedAngle& entry_of(double angle) {
    static thread_local constinit std::array<CachedAngle, 8> memory{};
    return memory[std::bit_cast<std::uint64_t>(angle) * 0x9E3779B97F4A7C15u >> 61];
}

bool holds(const CachedAngle& known, double angle) {
    return std::bit_cast<std::uint64_t>(known.angle) == std::bit_cast<std::uint64_t>(angle);
}

}  // namespace

SineCosine sine_and_cosine(double angle) {
    CachedAngle& known = entry_of(angle);
    return holds(known, angle) ? known.value : compute_and_cache(angle, known);
}

double sine(double angle) {
    const CachedAngle& known = entry_of(angle);
    return holds(known, angle) ? known.value.sine : std::sin(angle);
}

}  // namespace achilles
