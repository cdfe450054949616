// Multiplying a gap by a positive number changes no run (theory-gaps.md 2.7).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/systems.hpp"
#include "laws/random_systems.hpp"

namespace achilles::test {
namespace {

TEST(ScaledGaps, ChangeNoRunOfTheGallery) {
    for (const std::string& name : all_systems()) {
        const SystemDescription system = load(name)->description();
        for (const double factor : {1e-8, 0.3, 1e8})
            EXPECT_EQ(difference_by_scaling(system, factor), "") << name << ", gaps times " << factor;
    }
}

// One of the systems ends undecided: impacts on a moving wall and a floor alternate and collapse (theory-gaps.md 2.6).
TEST(ScaledGaps, ChangeNoRunOfRandomSystems) {
    int undecided = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        std::mt19937_64 random(seed);
        const double factor = std::pow(10.0, std::uniform_real_distribution(-8.0, 8.0)(random));
        const std::string difference = difference_by_scaling(random_system(seed), factor);
        if (difference == "undecided")
            ++undecided;
        else
            EXPECT_EQ(difference, "") << "seed " << seed << ", gaps times " << factor;
    }
    EXPECT_LE(undecided, 1);
}

}  // namespace
}  // namespace achilles::test
