#include "simulate/batch.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>

#include "simulate/batch_simulator.hpp"

namespace achilles {

namespace {

RunResult attempt(const std::shared_ptr<const Model>& model, const Run& run, Recording keep) {
    try {
        return simulate(model, run, nullptr, keep);
    } catch (const InputError& error) {
        return error;
    }
}

}  // namespace

void simulate_many(const std::shared_ptr<const Model>& model, std::size_t count,
                   const std::function<Run(std::size_t)>& run_of,
                   const std::function<void(std::size_t, RunResult&&)>& take, int threads, Recording keep) {
    const auto work = [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) take(i, attempt(model, run_of(i), keep));
    };
    // A run takes long enough (10 us and more) to be a task of its own, and may take a thousand times longer than its
    // neighbor.
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    arena.execute([&] { tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), work, tbb::auto_partitioner()); });
}

void simulate_ends(const std::shared_ptr<const Model>& model, std::size_t count,
                   const std::function<Run(std::size_t)>& run_of,
                   const std::function<void(std::size_t, RunResult&&)>& take, int threads) {
    std::atomic<std::size_t> next = 0;
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    const auto work = [&](int) {
        try {
            BatchSimulator(model).work({count, next, run_of, take});
        } catch (...) {
            next = count;
            throw;
        }
    };
    arena.execute([&] { tbb::parallel_for(0, arena.max_concurrency(), work, tbb::simple_partitioner()); });
}

FinalStateSimulator::FinalStateSimulator(const std::shared_ptr<const Model>& model)
    : runs_(std::make_unique<BatchSimulator>(model)) {}
FinalStateSimulator::~FinalStateSimulator() = default;

void FinalStateSimulator::simulate(std::size_t count, const std::function<Run(std::size_t)>& run_of,
                                   const std::function<void(std::size_t, RunResult&&)>& take) {
    std::atomic<std::size_t> next = 0;
    runs_->work({count, next, run_of, take});
}

}  // namespace achilles
