// Eight numbers side by side, one of each of eight runs, as data.
#pragma once

#include <cstddef>

namespace achilles {

struct alignas(64) Eight {
    static constexpr std::size_t count = 8;
    double lane[count] = {};

    double& operator[](std::size_t i) { return lane[i]; }
    double operator[](std::size_t i) const { return lane[i]; }
};

// Of eight angles, to within an ulp of 1.
void sine_and_cosine_of_lanes(const Eight* angle, Eight* sine, Eight* cosine);

}  // namespace achilles
