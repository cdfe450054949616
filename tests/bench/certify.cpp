// bench_certify: the cost of certificates relative to their run, as medians of interleaved repetitions in one process.
// "All" repeats every request of the run, with newly built conditions. Its share is relative to the rest of the run.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/certificates.hpp"
#include "bench/measure.hpp"
#include "model/read_system.hpp"

namespace {

using namespace achilles;
using namespace achilles::bench;

void measure(const std::string& system, Conditions kind) {
    const auto model = std::make_shared<const Model>(
        read_system(fmt::format("{}/assets/systems/{}.toml", ACHILLES_SOURCE_DIR, system)));
    Run run = model->default_run();
    run.options.truncation.conditions = kind;
    const Trajectory trajectory = simulate(model, run);
    const std::vector<Collision> all = collisions(trajectory);
    const auto conditions = truncation_conditions(*model, run);
    std::vector<double> whole, asked, one;
    const Collision& last = all.back();
    for (int repetition = 0; repetition < 201; ++repetition) {
        whole.push_back(seconds([&] { simulate(model, run); }));
        asked.push_back(seconds([&] { ask_again(*model, run, all); }));
        one.push_back(seconds([&] { conditions->prove_any(last); }));
    }
    fmt::print(
        "{:<16} {:<6} run {:8.1f} us   one certificate {:6.1f} us   all {} questions {:7.1f} us, {:5.1f} % of the "
        "rest\n",
        system, to_text(kind), 1e6 * median(whole), 1e6 * median(one), all.size(), 1e6 * median(asked),
        100.0 * median(asked) / (median(whole) - median(asked)));
}

}  // namespace

int main() {
    for (const char* system : {"ball_on_sine", "double_pendulum", "triple_pendulum"})
        for (const Conditions kind : {Conditions::paper, Conditions::sharp}) measure(system, kind);
}
