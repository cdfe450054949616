// bench_truth [COUNT]: certificates against the truth over COUNT random collisions (10000) of every system; 1200 are
// more than 20000 certificates in all. Prints how many were proved and how many of those are false, which must be none,
// and the medians of bound over truth (farthest: the velocity bound over the largest excursion on the way, which Def. 7
// adds up; formula: the velocity bound over that of Def. 7's own formula with the values at the restart for its
// maxima). uniform: the bound for all times over the largest distance at 30 instants within the first flights, the
// median and the least; not a number where no certificate claims one. estimates, worst: how many Zeno times simulate()
// estimated, and the largest error of one over the half width of its interval.
#include <fmt/format.h>

#include <cstdlib>

#include "certify/tally.hpp"
#include "core/systems.hpp"

int main(int count, char** arguments) {
    using namespace achilles::test;
    const long trials = count > 1 ? std::atol(arguments[1]) : 10000;
    long violations = 0, certificates = 0, uniform = 0;
    fmt::print("{}", table_head());
    for (const std::string system : {"ball_on_sine", "double_pendulum", "falling_rod"}) {
        Trials source(load(system), 2009);
        Tallies tallies;
        for (long trial = 0; trial < trials; ++trial) add(tallies, source.next(), source.model());
        fmt::print("{}", table_rows(system, tallies));
        std::fflush(stdout);
        for (const auto& [key, tally] : tallies) {
            violations += tally.violations + tally.unknown;
            certificates += tally.certificates;
            uniform += static_cast<long>(tally.ratios[Tally::uniform].size());
        }
    }
    fmt::print("{} certificates, of which {} claim a bound at all times; {} false or unknown\n", certificates, uniform,
               violations);
    return violations == 0 ? 0 : 1;
}
