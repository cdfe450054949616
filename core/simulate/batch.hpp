// Runs many simulations of one model on all cores, for maps and sweeps.
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

// Result of one of many runs: its trajectory, or the reason why it could not start (in a map, a start below the floor
// is just one point).
using RunResult = std::variant<Trajectory, InputError>;

// Simulates run_of(i) for 0 <= i < count, recording what `keep` says, and passes the result to take(i, attempt). Uses
// at most `threads` threads (0: one for every core). Runs share only the model, which never changes. No result depends
// on the number of threads or on other runs; only Statistics::seconds does.
//
// run_of and take are called once for every i, from several threads and in any order. They may write to data that
// belongs to i, and must not modify anything shared. A trajectory is destroyed after its take() unless take() keeps it,
// so memory does not grow with count. An exception from run_of or take stops the runs that have not started, and is
// rethrown here (one of them, if there are several). A caller cancels that way.
void simulate_many(const std::shared_ptr<const Model>& model, std::size_t count,
                   const std::function<Run(std::size_t)>& run_of,
                   const std::function<void(std::size_t, RunResult&&)>& take, int threads = 0,
                   Recording keep = Recording::full);

// The same with Recording::final_state, including the sequences of events, for ensembles and maps. Eight runs at a time
// share a vector of the processor as long as their motion is plain. The steps have lower order than those of
// simulate(), so a final state agrees with simulate() within the tolerance, not to the last bit. Results do not depend
// on other runs, threads or the processor. A run that stays undecided is simulated alone. Runs by dopri5, and systems
// with functions that are not defined everywhere, are simulated one by one. Statistics::seconds stays 0.
void simulate_ends(const std::shared_ptr<const Model>& model, std::size_t count,
                   const std::function<Run(std::size_t)>& run_of,
                   const std::function<void(std::size_t, RunResult&&)>& take, int threads = 0);

class BatchSimulator;

// simulate_ends() on the calling thread, for one batch of runs after another; what is compiled for the first batch is
// reused. Use one object per thread. It must not be used again once run_of or take has thrown.
class FinalStateSimulator {
 public:
    explicit FinalStateSimulator(const std::shared_ptr<const Model>& model);
    ~FinalStateSimulator();
    void simulate(std::size_t count, const std::function<Run(std::size_t)>& run_of,
                  const std::function<void(std::size_t, RunResult&&)>& take);

 private:
    std::unique_ptr<BatchSimulator> runs_;
};

// simulate_many() for a list of runs: results[i] = summarize(i, result of runs[i]).
template <class Summarize>
auto simulate_many(const std::shared_ptr<const Model>& model, std::span<const Run> runs, const Summarize& summarize,
                   int threads = 0, Recording keep = Recording::full) {
    using Summary = std::invoke_result_t<const Summarize&, std::size_t, RunResult&&>;
    static_assert(!std::is_same_v<Summary, bool>, "neighbors in a vector<bool> share a byte: return a char");
    std::vector<std::optional<Summary>> places(runs.size());
    simulate_many(
        model, runs.size(), [&](std::size_t i) { return runs[i]; },
        [&](std::size_t i, RunResult&& attempt) { places[i].emplace(summarize(i, std::move(attempt))); }, threads,
        keep);
    std::vector<Summary> results;
    results.reserve(places.size());
    for (std::optional<Summary>& place : places) results.push_back(std::move(*place));
    return results;
}

}  // namespace achilles
