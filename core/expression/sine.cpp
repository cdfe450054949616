#include "expression/sine.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace achilles {

SineCosine sine_and_cosine(double angle) {
    struct Known {
        double angle = 0.0;
        SineCosine value;
    };
    static thread_local constinit std::array<Known, 8> memory{};
    const auto bits = std::bit_cast<std::uint64_t>(angle);
    Known& known = memory[bits * 0x9E3779B97F4A7C15u >> 61];
    if (std::bit_cast<std::uint64_t>(known.angle) != bits) known = {angle, {std::sin(angle), std::cos(angle)}};
    return known.value;
}

}  // namespace achilles
