// bench_truth [COUNT [SYSTEM]]: tests certificates against 34-digit references, for COUNT random collisions (10000) of
// every system or of this one. Also for all certificates of as many random runs of the systems with forces, time and
// several contacts; a COUNT of 1200 gives more than 20000 certificates in all. Prints how many were proved and how many
// of those are false, which must be none. Other columns: - medians of bound over reference value; - farthest: the
// velocity bound over the largest |v - v*| up to the Zeno point, which Def. 7 bounds by a sum; - formula: the velocity
// bound over Def. 7's formula with the values at the restart for its maxima; - uniform: the bound for all times over
// the largest distance at 30 instants of the first flights, median and minimum; NaN   if no certificate claims one; -
// estimates, worst: the number of Zeno times that simulate() estimated, and the largest error over the half-width of
// its   interval.
#include <fmt/format.h>

#include <cstdlib>

#include "certify/tally.hpp"
#include "core/systems.hpp"

namespace {

using namespace achilles::test;

// Runs the trials of a system, prints its row and counts violations.
class Count {
 public:
    void add_trials(const std::string& system, Trials source, long trials) {
        Tallies tallies;
        long collisions = 0, with_held = 0;
        for (long trial = 0; trial < trials; ++trial) {
            const Trial one = source.next();
            collisions += one.certified.empty() ? 0 : 1;
            with_held += one.certified.empty() || one.mode.is_free() ? 0 : 1;
            add(tallies, one, source.model());
        }
        print(system, tallies);
        fmt::print("{:<24}{} of {} collisions certified, {} of them while another contact is held\n", "", collisions,
                   trials, with_held);
    }
    void add_runs(const std::string& system, Trials source, long runs) {
        Tallies tallies;
        long points = 0, with_held = 0;
        for (long run = 0; run < runs; ++run)
            for (const Trial& one : source.next_run()) {
                ++points;
                with_held += one.mode.is_free() ? 0 : 1;
                add(tallies, one, source.model());
            }
        print(system + " runs", tallies);
        fmt::print("{:<24}{} Zeno points of {} runs, {} of them while another contact is held\n", "", points, runs,
                   with_held);
    }

    long violations = 0, certificates = 0, uniform = 0;

 private:
    void print(const std::string& system, const Tallies& tallies) {
        fmt::print("{}", table_rows(system, tallies));
        std::fflush(stdout);
        for (const auto& [key, tally] : tallies) {
            violations += tally.violations + tally.unknown;
            certificates += tally.certificates;
            uniform += static_cast<long>(tally.ratios[Tally::uniform].size());
        }
    }
};

}  // namespace

int main(int count, char** arguments) {
    const long trials = count > 1 ? std::atol(arguments[1]) : 10000;
    const std::string only = count > 2 ? arguments[2] : "";
    Count all;
    fmt::print("{}", table_head());
    for (const std::string system : {"ball_on_sine", "double_pendulum", "falling_rod"})
        if (only.empty() || only == system) all.add_trials(system, Trials(load(system), 2009), trials);
    for (const std::string system : reference_systems)
        if (only.empty() || only == system) {
            const Trials source(with_one_restitution(*load(system)), 2009, Trials::Vary::everything);
            all.add_trials(system, source, trials);
            all.add_runs(system, source, trials);
        }
    fmt::print("{} certificates, of which {} claim a bound at all times; {} false or unknown\n", all.certificates,
               all.uniform, all.violations);
    return all.violations == 0 ? 0 : 1;
}
