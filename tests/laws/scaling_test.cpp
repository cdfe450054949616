// Multiplying a gap by a positive number changes no run (theory-gaps.md 2.7). With friction the slip is multiplied by
// the same number, and its sign is arbitrary (theory-friction.md 1 and 5).
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
            // Which of two alternating impacts is the last before a collapse is decided by roundings of its time.
            if (name != "slider_crank_clearance" || factor == 0.3) {
                EXPECT_EQ(difference_by_scaling(system, factor), "") << name << ", gaps times " << factor;
            }
    }
}

TEST(ScaledGaps, ReversedSlipsChangeNoRunOfTheGallery) {
    int rough = 0;
    for (const std::string& name : all_systems()) {
        const auto model = load(name);
        if (!model->has_friction()) continue;
        ++rough;
        for (const double factor : {1.0, 0.3})
            EXPECT_EQ(difference_by_scaling(model->description(), factor, -1), "") << name << ", times " << factor;
    }
    EXPECT_EQ(rough, 14);
}

// The sliding speed in a coefficient is then that of the unscaled slip.
TEST(ScaledGaps, ScaleTheSlipWithACoefficientThatVaries) {
    const std::string text = R"toml(
title = "A block with a coefficient that falls with the slip"
[[coordinate]]
name = "x"
rate = 2.0
[[coordinate]]
name = "y"
start = 0.4
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "y"
[[constraint]]
name = "floor"
gap = "y - sin(x)/5"
slip = "x' + cos(x)/5*y'"
friction = "0.1 + 0.3*exp(-2*slip)"
restitution = 0.4
[run]
end_time = 6.0
)toml";
    for (const double factor : {1e-3, 0.3, 1e3})
        for (const int sign : {1, -1})
            EXPECT_EQ(difference_by_scaling(parse_system(text, "block.toml"), factor, sign), "") << factor << sign;
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
