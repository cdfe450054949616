// bench_truth [COUNT]: certificates against the truth over COUNT random collisions (10000) of every system. Prints how
// many were proved and how many of those are false, which must be none, and the medians of bound over truth
// (farthest: the velocity bound over the largest excursion on the way, which Def. 7 adds up; formula: the velocity
// bound over that of Def. 7's own formula with the values at the restart for its maxima).
#include <fmt/format.h>

#include <cstdlib>

#include "certify/tally.hpp"
#include "core/systems.hpp"

int main(int count, char** arguments) {
    using namespace achilles::test;
    const long trials = count > 1 ? std::atol(arguments[1]) : 10000;
    long violations = 0;
    fmt::print("{}", table_head());
    for (const std::string system : {"ball_on_sine", "double_pendulum", "falling_rod"}) {
        Trials source(load(system), 2009);
        Tallies tallies;
        for (long trial = 0; trial < trials; ++trial) add(tallies, source.next(), source.model());
        fmt::print("{}", table_rows(system, tallies));
        std::fflush(stdout);
        for (const auto& [key, tally] : tallies) violations += tally.violations + tally.unknown;
    }
    return violations == 0 ? 0 : 1;
}
