// bench_run SYSTEM [ROUNDS] [OPTION=VALUE...]: the cost of one run: processor time, allocations, steps.
//
// OPTIONs: tolerance, eps (eps_q and eps_v), end (s), method (taylor or dopri5), keep (full or end).
// Instructions by function, without those that read and derive the system:
//     valgrind --tool=callgrind --toggle-collect='repeat*' bench_run SYSTEM ROUNDS
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "bench/measure.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

namespace {

long allocations = 0;

}  // namespace

void* operator new(std::size_t size) {
    ++allocations;
    if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace achilles::bench {

struct Cost {
    std::vector<double> seconds;
    long allocations = 0;
    Trajectory last;
};

[[gnu::noinline]] Cost repeat(const std::shared_ptr<const Model>& model, const Run& run, Recording keep, int rounds) {
    Cost cost;
    for (int round = 0; round < rounds; ++round) {
        const long before = allocations;
        cost.seconds.push_back(seconds([&] { cost.last = simulate(model, run, nullptr, keep); }));
        cost.allocations = allocations - before;
    }
    return cost;
}

}  // namespace achilles::bench

int main(int count, char** arguments) {
    using namespace achilles;
    if (count < 2) {
        fmt::print(stderr, "usage: bench_run SYSTEM [ROUNDS] [tolerance=X] [eps=X] [end=X] [method=X] [keep=end]\n");
        return 2;
    }
    const std::string system = arguments[1];
    const int rounds = count > 2 ? std::atoi(arguments[2]) : 101;
    const auto model = std::make_shared<const Model>(
        read_system(std::string(ACHILLES_SOURCE_DIR) + "/assets/systems/" + system + ".toml"));
    Run run = model->default_run();
    Recording keep = Recording::full;
    for (int i = 3; i < count; ++i) {
        const std::string option = arguments[i], value = option.substr(option.find('=') + 1);
        if (option.starts_with("tolerance=")) run.options.tolerance = std::stod(value);
        if (option.starts_with("eps=")) run.options.truncation.eps_q = run.options.truncation.eps_v = std::stod(value);
        if (option.starts_with("end=")) run.options.end_time = std::stod(value);
        if (option == "method=dopri5") run.options.method = Method::dopri5;
        if (option == "method=taylor") run.options.method = Method::taylor;
        if (option == "keep=end") keep = Recording::final_state;
    }
    simulate(model, run, nullptr, keep);  // derives the modes
    const bench::Cost cost = bench::repeat(model, run, keep, rounds);
    const Statistics& statistics = cost.last.statistics;
    fmt::print("{} {}: median {:.1f} us, fastest {:.1f} us, {} allocations, {} steps, {} impacts, {} evaluations\n",
               system, cost.last.outcome.message, 1e6 * bench::median(cost.seconds),
               1e6 * *std::min_element(cost.seconds.begin(), cost.seconds.end()), cost.allocations, statistics.steps,
               statistics.impacts, statistics.evaluations);
}
