// Work and precision of bench_engine; see engine.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/certificates.hpp"
#include "bench/engine.hpp"
#include "bench/measure.hpp"
#include "model/read_system.hpp"
#include "simulate/simulate.hpp"

namespace achilles::bench {
namespace {

struct Contestant {
    std::string name, cut_name;
    std::vector<double> cuts;
    std::function<Values(const Setting&)> run;
    std::function<std::function<void()>(const Setting&)> certificates;  // work to be timed; empty for the programs
};

// ---- the contestants ----

Contestant engine(const std::shared_ptr<const Model>& model, Method method, Recording keep) {
    return {"engine " + std::string(to_text(method)) + (keep == Recording::final_state ? ", end" : ""),
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

// ---- work and precision ----

struct PrecisionSample {
    Setting setting;
    double error = 0.0, seconds = 0.0;
};

std::vector<PrecisionSample> try_all(const Contestant& contestant, const Values& truth) {
    std::vector<PrecisionSample> all;
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

// The fastest setting with this error, if the settings of slightly smaller tolerance have it as well.
const PrecisionSample* fastest(const std::vector<PrecisionSample>& all, double error) {
    const PrecisionSample* best = nullptr;
    for (const PrecisionSample& tried : all) {
        const bool holds = std::all_of(all.begin(), all.end(), [&](const PrecisionSample& other) {
            const bool neighbor = other.setting.cut == tried.setting.cut &&
                                  other.setting.tolerance <= 1.01 * tried.setting.tolerance &&
                                  other.setting.tolerance >= 0.099 * tried.setting.tolerance;
            return !neighbor || other.error <= error;
        });
        if (holds && (best == nullptr || tried.seconds < best->seconds)) best = &tried;
    }
    return best;
}

struct Entry {
    const Contestant* contestant = nullptr;
    const PrecisionSample* tried = nullptr;
    std::function<void()> certificates;
    std::vector<double> whole, certifying, net;
};

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

void compare(const std::vector<Contestant>& contestants, const std::vector<std::vector<PrecisionSample>>& tried,
             double error, int rounds) {
    std::vector<Entry> entries;
    fmt::print(" error <= {:g}\n", error);
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const PrecisionSample* best = fastest(tried[i], error);
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
    for (const Method method : methods(model)) contestants.push_back(engine(model, method, Recording::full));
    contestants.push_back(engine(model, Method::taylor, Recording::final_state));
    contestants.push_back(by_hand("Boost.Odeint", by_odeint<Problem>(), start));
    contestants.push_back(by_hand("ARKODE", by_arkode<Problem>(), start));
    std::vector<std::vector<PrecisionSample>> tried;
    for (const Contestant& contestant : contestants) tried.push_back(try_all(contestant, truth));
    fmt::print("{} to t = 20, medians of {} rounds\n", asset, rounds);
    for (const double error : {1e-6, 1e-9, 1e-12, 1e-13}) compare(contestants, tried, error, rounds);
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const auto best =
            std::min_element(tried[i].begin(), tried[i].end(),
                             [](const PrecisionSample& a, const PrecisionSample& b) { return a.error < b.error; });
        fmt::print(" least error of {:<18} {:.1e}\n", contestants[i].name, best->error);
    }
}

}  // namespace

void measure_work_and_precision(int rounds) {
    work_and_precision<Ball>("ball_on_sine", "ball", rounds);
    work_and_precision<Pendulum>("double_pendulum", "double_pendulum", rounds);
}

}  // namespace achilles::bench
