// bench_gaps [ROUNDS]: the cost of forces, time dependence and open gaps, relative to the ball on the sine without
// them. Also the gain by batches of eight with forces and time. Medians of ROUNDS (41) interleaved rounds, in processor
// time.
//
// With functions that are not defined everywhere, such as sqrt, every step is a scalar step. So with a drag of
// -c x' sqrt(...) batches have no gain.
//
// Every ball below moves as the plain one to within 1e-9: the additional terms are too small, the walls too far away.
#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bench/measure.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "simulate/batch.hpp"

namespace achilles::bench {
namespace {

struct Ball {
    std::string name, potential = "m*g*y", force_x = {}, force_y = {};
    std::vector<std::string> walls = {};  // gaps that never close
};

std::shared_ptr<const Model> model_of(const Ball& ball) {
    const auto force = [](const std::string& text) {
        return text.empty() ? "" : fmt::format("force = \"{}\"\n", text);
    };
    std::string text = fmt::format(
        "title = \"Ball\"\n"
        "[[coordinate]]\nname = \"x\"\nstart = 0.0\nrate = 1.5\n{}"
        "[[coordinate]]\nname = \"y\"\nstart = 2.0\nrate = 0.0\n{}"
        "[[parameter]]\nname = \"m\"\nvalue = 1.0\n[[parameter]]\nname = \"g\"\nvalue = 1.0\n"
        "[lagrangian]\nkinetic = \"m*(x'^2 + y'^2)/2\"\npotential = \"{}\"\n"
        "[[constraint]]\nname = \"ground\"\ngap = \"y - sin(x)\"\nrestitution = 0.5\n",
        force(ball.force_x), force(ball.force_y), ball.potential);
    for (std::size_t i = 0; i < ball.walls.size(); ++i)
        text += fmt::format("[[constraint]]\nname = \"wall{}\"\ngap = \"{}\"\nrestitution = 0.5\n", i, ball.walls[i]);
    return std::make_shared<const Model>(parse_system(text + "[run]\nend_time = 20.0\n", "ball.toml"));
}

Run run_of(const Model& model) {
    Run run = model.default_run();
    run.options.tolerance = 1e-9;
    run.options.truncation.eps_q = run.options.truncation.eps_v = 1e-8;
    return run;
}

std::vector<std::string> walls(std::size_t count, const std::string& shape) {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(fmt::format("{} + {}", shape, 1000 + i));
    return all;
}

struct Contestant {
    std::string name;
    std::shared_ptr<const Model> model;
    std::vector<double> times = {};
    long steps = 0;
};

void measure_additions(int rounds) {
    const std::vector<Ball> balls{{"plain"},
                                  {"gravity as a force", "0", "", "-m*g"},
                                  {"and drag", "0", "-1e-12*x'*sqrt(x'^2 + y'^2 + 1)", "-m*g"},
                                  {"and time", "0", "1e-12*cos(3*t)", "-m*g"},
                                  {"one flat wall", "m*g*y", "", "", walls(1, "x")},
                                  {"4 flat walls", "m*g*y", "", "", walls(4, "x")},
                                  {"15 flat walls", "m*g*y", "", "", walls(15, "x")},
                                  {"one wavy wall", "m*g*y", "", "", walls(1, "y - sin(2*x)")},
                                  {"4 wavy walls", "m*g*y", "", "", walls(4, "y - sin(2*x)")},
                                  {"15 wavy walls", "m*g*y", "", "", walls(15, "y - sin(2*x)")}};
    std::vector<Contestant> all;
    for (const Ball& ball : balls) {
        all.push_back({ball.name, model_of(ball)});
        all.back().steps = simulate(all.back().model, run_of(*all.back().model)).statistics.steps;
    }
    constexpr int repeats = 50;
    for (int round = 0; round < rounds; ++round)
        for (Contestant& one : all) {
            const Run run = run_of(*one.model);
            one.times.push_back(seconds([&] {
                                    for (int i = 0; i < repeats; ++i)
                                        simulate(one.model, run, nullptr, Recording::final_state);
                                }) /
                                repeats);
        }
    fmt::print("a run to t = 20 at tolerance 1e-9, medians of {} rounds\n", rounds);
    for (const Contestant& one : all) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < one.times.size(); ++i) ratios.push_back(one.times[i] / all.front().times[i]);
        fmt::print("  {:<20} {:7.1f} us   {:3} steps   {:5.2f} times the plain one\n", one.name,
                   1e6 * median(one.times), one.steps, median(ratios));
    }
}

// Random starts, in single runs and in batches of eight.
void measure_eight(int rounds) {
    constexpr std::size_t count = 400;
    fmt::print("{} balls from random starts\n", count);
    for (const Ball& ball : {Ball{"plain"}, Ball{"damped", "m*g*y", "-0.1*x'", "-0.1*y'"},
                             Ball{"wind in gusts", "m*g*y", "0.2*cos(3*t)", ""}}) {
        const auto model = model_of(ball);
        const auto start = [&](std::size_t i) {
            std::mt19937_64 random(i);
            Run run = run_of(*model);
            run.q[0] = 6.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 3.0;
            run.v[0] = 4.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 2.0;
            return run;
        };
        const auto nothing = [](std::size_t, RunResult&&) {};
        std::vector<double> ratios;
        for (int round = 0; round < rounds; ++round) {
            const double single =
                seconds([&] { simulate_many(model, count, start, nothing, 1, Recording::final_state); });
            ratios.push_back(single / seconds([&] { simulate_ends(model, count, start, nothing, 1); }));
        }
        fmt::print("  {:<20} eight at a time {:.2f} times as fast as one by one\n", ball.name, median(ratios));
    }
}

}  // namespace
}  // namespace achilles::bench

int main(int count, char** arguments) {
    const int rounds = count > 1 ? std::atoi(arguments[1]) : 41;
    if (rounds < 1) return fmt::print(stderr, "usage: bench_gaps [ROUNDS]\n"), 2;
    achilles::bench::measure_additions(rounds);
    achilles::bench::measure_eight(std::max(1, rounds / 4));
}
