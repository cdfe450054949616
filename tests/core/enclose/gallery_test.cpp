// Results of proofs of every gallery system's default run, with its numbers as typed.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <map>

#include "core/systems.hpp"
#include "enclose/enclosure.hpp"

namespace achilles::test {

// Systems that are not listed are proved to their end time. bench_enclose measures the widths.
TEST(Gallery, IsProvedOrUndecided) {
    const std::map<std::string, double> undecided_after{
        {"triple_pendulum", 2.5},           // of 5 s
        {"kneed_leg", 1.5},                 // of 3 s
        {"newtons_cradle", 5.0},            // of 12 s
        {"box_dropped_flat", 0.3},          // both edges impact at once
        {"table_on_legs", -1.0},            // starts on all four legs
        {"seesaw", 0.4},                    // of 4 s: an impact opens a held contact
        {"slider_crank_clearance", 0.002},  // proofs end at a collapse
        {"three_balls", 0.12},
        {"wavy_ramp", 3.0},  // of 5.2 s: impacts on waves stretch every uncertainty
    };
    const std::vector<std::string> names = systems_without_friction();
    std::vector<std::string> outcomes(names.size());
    tbb::parallel_for(std::size_t{0}, names.size(), [&](std::size_t i) {
        const auto model = load(names[i]);
        const Enclosure proof = prove(model, problem_from_decimals(model->default_run()));
        const auto known = undecided_after.find(names[i]);
        const bool far = known != undecided_after.end() && proof.proved_until > known->second;
        outcomes[i] = proof.end ? "proved" : far ? "undecided" : proof.outcome.message;
    });
    for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_EQ(outcomes[i], undecided_after.contains(names[i]) ? "undecided" : "proved") << names[i];
    EXPECT_GE(names.size(), 30u);
}

}  // namespace achilles::test
