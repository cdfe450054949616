// What becomes of a proof of every system's own run, the numbers as they are written.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <map>

#include "core/systems.hpp"
#include "enclose/enclosure.hpp"
#include "system/input_error.hpp"

namespace achilles::test {

// A system of one gap that is not named here is proved to its end time; one of several is refused. bench_enclose has the widths.
TEST(Gallery, IsProvedUndecidedOrRefused) {
    const std::map<std::string, double> undecided_after{{"triple_pendulum", 2.0}};  // of 5 s
    const std::vector<std::string> names = all_systems(), of_one_gap = systems_of_one_gap();
    std::vector<std::string> outcomes(names.size());
    tbb::parallel_for(std::size_t{0}, names.size(), [&](std::size_t i) {
        const auto model = load(names[i]);
        try {
            const Enclosure proof = prove(model, claim_as_written(model->default_run()));
            const auto known = undecided_after.find(names[i]);
            const bool far = known != undecided_after.end() && proof.proved_until > known->second;
            outcomes[i] = proof.end ? "proved" : far ? "undecided" : proof.outcome.message;
        } catch (const InputError& refusal) {
            outcomes[i] = refusal.message;
        }
    });
    int proved = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool is_one = std::find(of_one_gap.begin(), of_one_gap.end(), names[i]) != of_one_gap.end();
        EXPECT_EQ(outcomes[i], !is_one
                                   ? "prove does not cover this system: it has several gaps, and a proof follows one"
                               : undecided_after.contains(names[i]) ? "undecided"
                                                                    : "proved")
            << names[i];
        proved += outcomes[i] == "proved" ? 1 : 0;
    }
    EXPECT_GE(proved, 19);
}

}  // namespace achilles::test
