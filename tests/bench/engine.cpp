// bench_engine [ROUNDS] [BALLS]: the engine beside two programs written by hand, in one run: Boost.Odeint (by_odeint)
// and SUNDIALS ARKODE (by_arkode).
//
// Work and precision, for both problems of the paper's Fig. 4 to t = 20: for each error in the end state, the fastest
// setting of each contestant that meets it, also with a tolerance up to ten times smaller (so that no lucky error
// wins), then medians over ROUNDS (101) interleaved rounds. Settings are the tolerance and when the bouncing is cut: by
// the impact speed for the programs, by the certified bounds eps_q = eps_v for the engine; eps_t stays 1e-6, since the
// motion does not depend on where the Zeno event is put in time.
//
// Ensemble: BALLS (10 000) random balls at tolerance 1e-9, one core; the errors are those of the first 200, against 34
// digits, and "lost" are all that end under the floor, or not at all. The engine makes the runs one by one, as the
// programs do, or eight at a time (simulate_ends).
//
// The engine's time is the whole of simulate(): checks, dense output, events, statistics, certificates; where it says
// "end", and in the ensemble, only the end is kept (Keep::end), as the programs do. What it would be without the
// certificates, which the programs do not have, stands behind it: they are measured by asking the same questions again
// in the same round, in the ensemble by what the runs say of themselves. Times are those of the processor, which is
// named beside every ratio. Ratios are medians of the rounds' ratios to Boost.Odeint: above 1 is faster.
//
// What was tried, and what it gave of the engine's time (ball and pendulum at 1e-9, then at 1e-12):
//   sums, differences and multiples as linear forms instead of rules       pendulum -35 percent
//   fewer products in the equations (bias, f_c, n), whole vectors stored,
//   dense output scaled once, no look at the domain without an edge        -13, -16, -14, -20 percent
//   rules as machine code, inner sums compiled for each number of lanes    -21, -19, -20, -15 percent
//   order 0 and the surface's programs as machine code                     -4, -7, -1, -7 percent
//   one component watched per order instead of all, tables set up once,
//   Newton's method stopped by its own convergence                         -7, -7, -10, -10 percent
//   fewer evaluations per impact                                           0 to -10 percent
//   a whole order as machine code, then all orders up to the first small
//   one: half of the instructions                                          -18, -26 percent at 1e-9
//   ends evaluated where they are asked for, descents told from partial
//   sums instead of Bernstein coefficients, projection in place            -15 percent of the ball's
//   sine and cosine at once, and those of the last angles remembered       -5 percent
//   certificates put off by what the last proof found                      theirs, at 1e-12: -45 percent
//   contact forces told from the series alone, polynomials not filled with
//   zeros first, orders below the least not looked at, inner sums from a
//   cache line on (else none can be read back before all are stored), -O2
//   instead of -O3 (not for the programs, which it makes slower)        -8, -4, -8, -4 percent
//   evaluators made where they are first asked for, one program for the
//   guess of a cut                                                      ball -2 percent
// What gave nothing, or less:
//   vectors of eight instead of four doubles                            none on a Zen 4
//   other weights in the order's cost                                   within 3 percent
//   accelerations carried in registers from one order to the next, code
//   that begins with a cache line, no errno, AVX2 for all of the core   none
//   older rows laid out without a loop, with a jump to where they
//   begin                                                               none (26 orders in a loop: -6 percent)
//   the last terms of inner sums one by one, from registers             +10 percent from order 14 on
//   the newest of the older rows last                                   within 2 percent of 26 orders
//   operands of a rule by when they are known                           +10 percent with cold caches
//   four components in one vector when an end is evaluated              +5 percent
// What is left of the ball's time at 1e-9: two fifths is series, where every order waits for the one before (some 62
// cycles; inner sums that take 2 loads a term come on top of it); the rest is what each of 45 steps takes besides (two
// looks at the surface, the root, the step's length).
//
// Eight runs at a time, of the ensemble's time (one by one, a run takes 29 us; the series of its contact alone 12):
//   plain flights and contacts as vectors, left to the run's own stepper
//   where they are not plain; orders as machine code                            -38 percent
//   Executions used again instead of made anew, lane programs as machine code   -18 percent
//   functions compiled for AVX-512 with all that becomes a part of them (with
//   target_clones alone their comparisons stay scalar), flights of lower order  -18 percent
//   inner sums and accelerations in registers from one order to the next, each
//   factor loaded once                                                          -11 percent
//   contact to where what is left out, not the last term, reaches the tolerance -4 percent
//   steps in contact repeated in the lanes until one of the runs ends them      -5 percent
//   one program for the guess of a cut instead of three; sines by pairs of terms -5 percent
// What gave nothing: rows summed in another order, no vzeroupper between orders, more or fewer runs under way (12 to
// 48), 256-bit vectors instead of 128 without machine code.
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "bench/by_hand.hpp"
#include "bench/certificates.hpp"
#include "bench/measure.hpp"
#include "certify/execution.hpp"
#include "model/read_system.hpp"
#include "simulate/many.hpp"

namespace achilles::bench {
namespace {

Values values_of(const State& state) { return {state.q[0], state.q[1], state.v[0], state.v[1]}; }

struct Setting {
    double tolerance = 0.0, cut = 0.0;
};

struct Contestant {
    std::string name, cut_name;
    std::vector<double> cuts;
    std::function<Values(const Setting&)> run;
    std::function<std::function<void()>(const Setting&)> certificates;  // work to be timed; none for the programs
};

double error_of(const Values& end, const Values& truth) {
    double error = 0.0;
    for (std::size_t i = 0; i < end.size(); ++i) {
        const double difference = std::abs(end[i] - truth[i]);
        if (!(difference <= error)) error = difference;  // NaN stays
    }
    return error;
}

// ---- the contestants ----

Run run_with(const Model& model, Method method, const Setting& setting) {
    Run run = model.default_run();
    run.options.method = method;
    run.options.end_time = 20.0;
    run.options.tolerance = setting.tolerance;
    run.options.truncation.eps_q = run.options.truncation.eps_v = setting.cut;
    return run;
}

Contestant engine(const std::shared_ptr<const Model>& model, Method method, Keep keep) {
    return {"engine " + std::string(to_text(method)) + (keep == Keep::end ? ", end" : ""),
            "eps",
            {1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14},
            [=](const Setting& setting) {
                const Trajectory trajectory = simulate(model, run_with(*model, method, setting), nullptr, keep);
                const bool ended = trajectory.outcome.kind == Outcome::Kind::end_time;
                Values end = values_of(trajectory.end);
                if (!ended) end.fill(std::numeric_limits<double>::quiet_NaN());
                return end;
            },
            [=](const Setting& setting) -> std::function<void()> {
                const Run run = run_with(*model, method, setting);
                return [=, asked = collisions(simulate(model, run))] { ask_again(*model, run, asked); };
            }};
}

Contestant by_hand(const std::string& name, std::shared_ptr<Program> program, const Values& start) {
    return {name,
            "cut",
            {1e-2, 1e-3, 1e-4, 1e-5},
            [=](const Setting& setting) {
                return program->run(start, {setting.tolerance, setting.cut, 20.0}).end;
            },
            {}};
}

// The methods there are: one that gives another's bytes is not there yet.
std::vector<Method> methods(const std::shared_ptr<const Model>& model) {
    const auto end = [&](Method method) {
        return values_of(simulate(model, run_with(*model, method, {1e-9, 1e-9})).end);
    };
    if (end(Method::taylor) == end(Method::dopri5)) return {Method::dopri5};
    return {Method::dopri5, Method::taylor};
}

// ---- work and precision ----

struct Tried {
    Setting setting;
    double error = 0.0, seconds = 0.0;
};

std::vector<Tried> try_all(const Contestant& contestant, const Values& truth) {
    std::vector<Tried> all;
    for (const double cut : contestant.cuts) {
        for (int half_decades = 10; half_decades <= 31; ++half_decades) {
            const Setting setting{std::pow(10.0, -0.5 * half_decades), cut};
            const double error = error_of(contestant.run(setting), truth);
            double fastest = std::numeric_limits<double>::infinity();
            for (int repetition = 0; repetition < 3; ++repetition)
                fastest = std::min(fastest, seconds([&] { contestant.run(setting); }));
            all.push_back({setting, error, fastest});
        }
    }
    return all;
}

// The fastest that meets the error, as do its neighbours of smaller tolerance.
const Tried* fastest(const std::vector<Tried>& all, double error) {
    const Tried* best = nullptr;
    for (const Tried& tried : all) {
        const bool holds = std::all_of(all.begin(), all.end(), [&](const Tried& other) {
            const bool neighbour = other.setting.cut == tried.setting.cut &&
                                   other.setting.tolerance <= 1.01 * tried.setting.tolerance &&
                                   other.setting.tolerance >= 0.099 * tried.setting.tolerance;
            return !neighbour || other.error <= error;
        });
        if (holds && (best == nullptr || tried.seconds < best->seconds)) best = &tried;
    }
    return best;
}

struct Entry {
    const Contestant* contestant = nullptr;
    const Tried* tried = nullptr;
    std::function<void()> certificates;
    std::vector<double> whole, certifying, net;
};

// The processor that a ratio belongs to: it is another one on another.
std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

// The median of the rounds' ratios.
std::string ratio(const std::vector<double>& reference, const std::vector<double>& times) {
    if (reference.empty()) return "     -";
    std::vector<double> ratios;
    for (std::size_t i = 0; i < times.size(); ++i) ratios.push_back(reference[i] / times[i]);
    return fmt::format("{:6.2f}", median(ratios));
}

void print(const Entry& entry, const std::vector<double>& reference) {
    const std::string processor = processor_name();
    fmt::print("  {:<18} tolerance {:7.1e}  {:>3} {:5.0e}  error {:7.1e}  {:8.1f} us", entry.contestant->name,
               entry.tried->setting.tolerance, entry.contestant->cut_name, entry.tried->setting.cut, entry.tried->error,
               1e6 * median(entry.whole));
    fmt::print("  {}", ratio(reference, entry.whole));
    if (entry.certificates)
        fmt::print("   without certificates {:.1f} us {}, these {:.0f} % of that", 1e6 * median(entry.net),
                   ratio(reference, entry.net), 100.0 * median(entry.certifying) / median(entry.net));
    fmt::print("   ({})\n", processor);
}

void compare(const std::vector<Contestant>& contestants, const std::vector<std::vector<Tried>>& tried, double error,
             int rounds) {
    std::vector<Entry> entries;
    fmt::print(" error <= {:g}\n", error);
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const Tried* best = fastest(tried[i], error);
        if (best == nullptr) {
            fmt::print("  {:<18} does not reach it\n", contestants[i].name);
            continue;
        }
        const auto& certificates = contestants[i].certificates;
        entries.push_back({&contestants[i], best, certificates ? certificates(best->setting) : nullptr, {}, {}, {}});
    }
    for (int round = 0; round < rounds; ++round) {
        for (Entry& entry : entries) {
            const double whole = seconds([&] { entry.contestant->run(entry.tried->setting); });
            const double certifying = entry.certificates ? seconds(entry.certificates) : 0.0;
            entry.whole.push_back(whole);
            entry.certifying.push_back(certifying);
            entry.net.push_back(whole - certifying);
        }
    }
    std::vector<double> reference;
    for (const Entry& entry : entries)
        if (entry.contestant->name == "Boost.Odeint") reference = entry.whole;
    for (const Entry& entry : entries) print(entry, reference);
    std::fflush(stdout);
}

template <class Problem>
void work_and_precision(const std::string& asset, const std::string& key, int rounds) {
    const std::string root = ACHILLES_SOURCE_DIR;
    const auto model = std::make_shared<const Model>(read_system(root + "/assets/systems/" + asset + ".toml"));
    std::ifstream file(root + "/tests/reference/fig4.json");
    const auto state = nlohmann::json::parse(file)["problems"][key]["end_state"];
    Values truth;
    for (std::size_t i = 0; i < truth.size(); ++i) truth[i] = std::stod(state[i].get<std::string>());

    const Run run = model->default_run();
    const Values start = values_of({run.q, run.v});
    std::vector<Contestant> contestants;
    for (const Method method : methods(model)) contestants.push_back(engine(model, method, Keep::everything));
    contestants.push_back(engine(model, Method::taylor, Keep::end));
    contestants.push_back(by_hand("Boost.Odeint", by_odeint<Problem>(), start));
    contestants.push_back(by_hand("ARKODE", by_arkode<Problem>(), start));
    std::vector<std::vector<Tried>> tried;
    for (const Contestant& contestant : contestants) tried.push_back(try_all(contestant, truth));
    fmt::print("{} to t = 20, medians of {} rounds\n", asset, rounds);
    for (const double error : {1e-6, 1e-9, 1e-12, 1e-13}) compare(contestants, tried, error, rounds);
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const auto best = std::min_element(tried[i].begin(), tried[i].end(),
                                           [](const Tried& a, const Tried& b) { return a.error < b.error; });
        fmt::print(" least error of {:<18} {:.1e}\n", contestants[i].name, best->error);
    }
}

// ---- ensemble ----

std::vector<Values> starts(int count) {
    std::mt19937_64 random(4);
    const auto uniform = [&](double most) {
        return most * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
    };
    std::vector<Values> result;
    for (int i = 0; i < count; ++i) result.push_back({uniform(3.0), 2.0, uniform(2.0), 0.0});
    return result;
}

struct Ensemble {
    std::string name;
    // Fills in the ends; returns what of the time the certificates took, s.
    std::function<double(std::vector<Values>& ends)> run;
    std::vector<double> whole, net;
    std::vector<Values> ends;
};

// One by one, or eight at a time. The runs say themselves how long their certificates took.
Ensemble ensemble_of(const std::shared_ptr<const Model>& model, Method method, const std::vector<Values>& from,
                     Setting setting, bool side_by_side) {
    const auto run_of = [=, &from](std::size_t i) {
        Run run = run_with(*model, method, setting);
        run.q << from[i][0], from[i][1];
        run.v << from[i][2], from[i][3];
        return run;
    };
    const auto all = [=](std::vector<Values>& ends) {
        double certifying = 0.0;
        const auto take = [&](std::size_t i, Attempt&& attempt) {
            const auto& trajectory = std::get<Trajectory>(attempt);
            certifying += trajectory.statistics.certificate_seconds;
            ends[i] = values_of(trajectory.end);
            if (trajectory.outcome.kind != Outcome::Kind::end_time)
                ends[i].fill(std::numeric_limits<double>::quiet_NaN());
        };
        if (side_by_side) {
            simulate_ends(model, ends.size(), run_of, take, 1);
        } else {
            simulate_many(model, ends.size(), run_of, take, 1, Keep::end);
        }
        return certifying;
    };
    return {fmt::format("engine {}{}", to_text(method), side_by_side ? ", by eight" : ""), all, {}, {}, {}};
}

Ensemble ensemble_of(const std::string& name, std::shared_ptr<Program> program, const std::vector<Values>& from,
                     const Settings& settings) {
    const auto all = [=, &from](std::vector<Values>& ends) {
        for (std::size_t i = 0; i < from.size(); ++i) ends[i] = program->run(from[i], settings).end;
        return 0.0;
    };
    return {name, all, {}, {}, {}};
}

// Ends that are no motion of a ball: under the floor, or not a number, or an outcome other than the end time.
long count_lost(const std::vector<Values>& ends) {
    return std::count_if(ends.begin(), ends.end(), [](const Values& y) { return !(Ball::gap(y) >= -1e-6); });
}

// Where the first balls really end, in 34 digits.
std::vector<Values> truths(const Model& model, const std::vector<Values>& from, std::size_t most) {
    test::TrueRuns runs(model, model.default_run());
    std::vector<Values> ends;
    for (std::size_t i = 0; i < std::min(most, from.size()); ++i) {
        const auto& start = from[i];
        const test::Point end = runs.run({{start[0], start[1]}, {start[2], start[3]}}, 20.0).end;
        ends.push_back({static_cast<double>(end.q[0]), static_cast<double>(end.q[1]), static_cast<double>(end.v[0]),
                        static_cast<double>(end.v[1])});
    }
    return ends;
}

void ensemble(int count, int rounds) {
    const auto model =
        std::make_shared<const Model>(read_system(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_sine.toml"));
    const std::vector<Values> from = starts(count);
    const std::vector<Values> truth = truths(*model, from, 200);
    std::vector<Ensemble> all;
    for (const Method method : methods(model)) all.push_back(ensemble_of(model, method, from, {1e-9, 1e-9}, false));
    all.push_back(ensemble_of(model, Method::taylor, from, {1e-9, 1e-9}, true));
    all.push_back(ensemble_of("Boost.Odeint", by_odeint<Ball>(), from, {1e-9, 1e-3, 20.0}));
    all.push_back(ensemble_of("ARKODE", by_arkode<Ball>(), from, {1e-9, 1e-3, 20.0}));
    for (int round = 0; round < rounds; ++round) {
        for (Ensemble& one : all) {
            one.ends.resize(from.size());
            double certifying = 0.0;
            const double whole = seconds([&] { certifying = one.run(one.ends); });
            one.whole.push_back(whole);
            one.net.push_back(whole - certifying);
        }
    }
    const auto& reference = all[all.size() - 2].whole;
    fmt::print("{} balls, x in [-3, 3], x' in [-2, 2], tolerance 1e-9, one core, medians of {} rounds\n", count,
               rounds);
    for (const Ensemble& one : all) {
        std::vector<double> errors;
        for (std::size_t i = 0; i < truth.size(); ++i) errors.push_back(error_of(one.ends[i], truth[i]));
        for (double& error : errors) error = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
        std::sort(errors.begin(), errors.end());
        fmt::print("  {:<24} {:8.0f} runs/s  {}   error: median {:.1e}, 95 percent below {:.1e}; lost {}", one.name,
                   count / median(one.whole), ratio(reference, one.whole), errors[errors.size() / 2],
                   errors[errors.size() * 95 / 100], count_lost(one.ends));
        if (median(one.net) < median(one.whole))
            fmt::print("   without certificates {:.0f} runs/s {}", count / median(one.net), ratio(reference, one.net));
        fmt::print("   ({})\n", processor_name());
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace achilles::bench

int main(int count, char** arguments) {
    const int rounds = count > 1 ? std::atoi(arguments[1]) : 101, balls = count > 2 ? std::atoi(arguments[2]) : 10000;
    if (rounds < 1 || balls < 1) {
        fmt::print(stderr, "usage: bench_engine [ROUNDS] [BALLS]\n");
        return 2;
    }
    using namespace achilles::bench;
    work_and_precision<Ball>("ball_on_sine", "ball", rounds);
    work_and_precision<Pendulum>("double_pendulum", "double_pendulum", rounds);
    ensemble(balls, 1 + rounds / 20);
}
