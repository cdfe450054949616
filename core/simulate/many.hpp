// Many runs of one model on all cores: what maps and sweeps stand on.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "../system/description.hpp"
#include "simulate.hpp"

namespace achilles {

// What one run of many gave: its trajectory, or why it could not start (a start below the floor is one point of a map,
// not the end of it).
using Attempt = std::variant<Trajectory, InputError>;

// Makes run_of(i), simulates it, keeping what `keep` says, and hands the result to take(i, attempt), for 0 <= i <
// count, on at most `threads` threads (0: one for every core). Runs share the model only, which never changes, so that
// no result depends on the number of threads or on the other runs; only Statistics::seconds does.
//
// run_of and take are called once for every i, from several threads at once and in no order: they may write to a place
// that belongs to i and share nothing else that changes. A trajectory ends with its take() unless that keeps it, so
// memory does not grow with count. What run_of or take throws ends the runs not yet begun and is thrown again here
// (where several throw, one of theirs); that is how a caller cancels.
void simulate_many(const std::shared_ptr<const Model>& model, std::size_t count,
                   const std::function<Run(std::size_t)>& run_of,
                   const std::function<void(std::size_t, Attempt&&)>& take, int threads = 0,
                   Keep keep = Keep::everything);

// The same with Keep::end, the sequences of events included, and eight runs at a time in one vector of the processor, as far
// as their motion is plain: for ensembles and maps, of which the ends are wanted. Steps are of lower order than simulate()
// takes, so an end agrees with that of simulate() within the tolerance, not to the last bit; but no more than there does it
// depend on the other runs, the threads or the processor. What remains undecided so is simulated alone. Runs by dopri5, and
// systems with functions that are not defined everywhere, are simulated one by one. Statistics::seconds stays 0.
void simulate_ends(const std::shared_ptr<const Model>& model, std::size_t count,
                   const std::function<Run(std::size_t)>& run_of,
                   const std::function<void(std::size_t, Attempt&&)>& take, int threads = 0);

class SideBySide;

// simulate_ends() on the thread that asks, for one share of many runs after the other: what is compiled for the first
// serves the others. One per thread; of no further use once run_of or take has thrown.
class EndSimulator {
 public:
    explicit EndSimulator(const std::shared_ptr<const Model>& model);
    ~EndSimulator();
    void simulate(std::size_t count, const std::function<Run(std::size_t)>& run_of,
                  const std::function<void(std::size_t, Attempt&&)>& take);

 private:
    std::unique_ptr<SideBySide> runs_;
};

// simulate_many() for a list of runs, each reduced to what is wanted of it: results[i] = summarize(i, attempt of
// runs[i]).
template <class Summarize>
auto simulate_many(const std::shared_ptr<const Model>& model, std::span<const Run> runs, const Summarize& summarize,
                   int threads = 0, Keep keep = Keep::everything) {
    using Summary = std::invoke_result_t<const Summarize&, std::size_t, Attempt&&>;
    static_assert(!std::is_same_v<Summary, bool>, "neighbors in a vector<bool> share a byte: return a char");
    std::vector<std::optional<Summary>> places(runs.size());
    simulate_many(
        model, runs.size(), [&](std::size_t i) { return runs[i]; },
        [&](std::size_t i, Attempt&& attempt) { places[i].emplace(summarize(i, std::move(attempt))); }, threads, keep);
    std::vector<Summary> results;
    results.reserve(places.size());
    for (std::optional<Summary>& place : places) results.push_back(std::move(*place));
    return results;
}

}  // namespace achilles
