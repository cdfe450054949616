// Proofs of mechanisms typed as bodies: they reach as far, are as narrow, and cost as much as those of energies typed by
// hand.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include "core/enclose/truth.hpp"
#include "core/systems.hpp"
#include "enclose/enclosure.hpp"

namespace achilles::test {
namespace {

// Those with the same coordinates in both files.
const char* const typed_twice[] = {"ball_on_sine",   "box_dropped_flat", "double_pendulum", "falling_rod",
                                   "newtons_cradle", "kneed_leg",        "triple_pendulum"};

std::shared_ptr<const Model> model_in(const std::string& folder, const std::string& name) {
    return std::make_shared<const Model>(read_system(source_file("tests/reference/" + folder + "/" + name + ".toml")));
}

// The program of the free motion is what most of a proof evaluates.
TEST(ProofsOfMechanisms, AreAsWideAndAsFastAsThoseOfTypedEnergies) {
    constexpr std::size_t count = std::size(typed_twice);
    std::array<Enclosure, 2 * count> proofs;
    std::array<std::size_t, 2 * count> sizes;
    tbb::parallel_for(std::size_t{0}, 2 * count, [&](std::size_t i) {
        const std::string name = typed_twice[i / 2];
        const auto model = model_in(i % 2 == 0 ? "hand_typed" : "mechanisms", name);
        EnclosureProblem claim = problem_from_decimals(model_in("hand_typed", name)->default_run());
        const achilles::Run own = model->default_run();  // parameters in its own order
        claim.parameters = problem_from_decimals(own).parameters;
        claim.run.parameters = own.parameters;
        sizes[i] = model->motion({}).program.size();
        proofs[i] = prove(model, claim);
    });
    for (std::size_t i = 0; i < count; ++i) {
        const Enclosure &by_hand = proofs[2 * i], &by_bodies = proofs[2 * i + 1];
        EXPECT_EQ(by_bodies.outcome.kind, by_hand.outcome.kind) << typed_twice[i] << ": " << by_bodies.outcome.message;
        EXPECT_NEAR(by_bodies.proved_until, by_hand.proved_until, 0.1 * by_hand.proved_until) << typed_twice[i];
        EXPECT_LE(static_cast<double>(sizes[2 * i + 1]), 1.05 * static_cast<double>(sizes[2 * i])) << typed_twice[i];
        EXPECT_LE(10 * by_bodies.statistics.steps, 11 * by_hand.statistics.steps) << typed_twice[i];
        if (!by_hand.end || !by_bodies.end) continue;
        EXPECT_LE(widest(by_bodies.end->q), 1.2 * widest(by_hand.end->q)) << typed_twice[i];
    }
}

}  // namespace
}  // namespace achilles::test
