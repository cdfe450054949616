// The ensemble of bench_engine; see engine.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>

#include "bench/engine.hpp"
#include "bench/measure.hpp"
#include "certify/execution.hpp"
#include "model/read_system.hpp"
#include "simulate/batch.hpp"
#include "simulate/batch_simulator.hpp"

namespace achilles::bench {
namespace {

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
    // Writes the final states and returns the time that certificates took, s.
    std::function<double(std::vector<Values>& ends)> run;
    std::vector<double> whole, net;
    std::vector<Values> ends;
};

std::string name_of(Vectors vectors) {
    switch (vectors) {
        case Vectors::portable:
            return ", by portable eight";
        case Vectors::portable_with_machine_code:
            return ", and AVX2 machine code";
        case Vectors::avx2:
            return ", by AVX2";
        case Vectors::avx2_with_machine_code:
            return ", by AVX2 and machine code";
        case Vectors::avx512:
            return ", by AVX-512";
        case Vectors::avx512_with_machine_code:
            return ", and machine code";
    }
    return "";
}

// Single runs, or batches of eight with these vectors. The time of certificates is from the runs' statistics.
Ensemble ensemble_of(const std::shared_ptr<const Model>& model, Method method, const std::vector<Values>& from,
                     Setting setting, std::optional<Vectors> vectors = {}) {
    const auto run_of = [=, &from](std::size_t i) {
        Run run = run_with(*model, method, setting);
        run.q << from[i][0], from[i][1];
        run.v << from[i][2], from[i][3];
        return run;
    };
    const auto all = [=](std::vector<Values>& ends) {
        double certifying = 0.0;
        const auto take = [&](std::size_t i, RunResult&& attempt) {
            const auto& trajectory = std::get<Trajectory>(attempt);
            certifying += trajectory.statistics.certificate_seconds;
            ends[i] = values_of(trajectory.end);
            if (trajectory.outcome.kind != Outcome::Kind::end_time)
                ends[i].fill(std::numeric_limits<double>::quiet_NaN());
        };
        if (vectors) {
            std::atomic<std::size_t> next = 0;
            BatchSimulator(model, *vectors).work({ends.size(), next, run_of, take});
        } else {
            simulate_many(model, ends.size(), run_of, take, 1, Recording::final_state);
        }
        return certifying;
    };
    return {fmt::format("engine {}{}", to_text(method), vectors ? name_of(*vectors) : std::string()), all, {}, {}, {}};
}

Ensemble ensemble_of(const std::string& name, std::shared_ptr<Program> program, const std::vector<Values>& from,
                     const Settings& settings) {
    const auto all = [=, &from](std::vector<Values>& ends) {
        for (std::size_t i = 0; i < from.size(); ++i) ends[i] = program->run(from[i], settings).end;
        return 0.0;
    };
    return {name, all, {}, {}, {}};
}

// The number of invalid final states: under the floor, NaN, or an outcome other than the end time.
long count_lost(const std::vector<Values>& ends) {
    return std::count_if(ends.begin(), ends.end(), [](const Values& y) { return !(Ball::gap(y) >= -1e-6); });
}

// Final states of the first balls in 34 digits.
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

}  // namespace

void measure_ensemble(int count, int rounds) {
    const auto model =
        std::make_shared<const Model>(read_system(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_sine.toml"));
    const std::vector<Values> from = starts(count);
    const std::vector<Values> truth = truths(*model, from, 200);
    std::vector<Ensemble> all;
    for (const Method method : methods(model)) all.push_back(ensemble_of(model, method, from, {1e-9, 1e-9}));
    for (const Vectors vectors : possible_vectors())
        all.push_back(ensemble_of(model, Method::taylor, from, {1e-9, 1e-9}, vectors));
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
        fmt::print("  {:<33} {:8.0f} runs/s  {}   error: median {:.1e}, 95 percent below {:.1e}; lost {}", one.name,
                   count / median(one.whole), ratio(reference, one.whole), errors[errors.size() / 2],
                   errors[errors.size() * 95 / 100], count_lost(one.ends));
        if (median(one.net) < median(one.whole))
            fmt::print("   without certificates {:.0f} runs/s {}", count / median(one.net), ratio(reference, one.net));
        fmt::print("   ({})\n", processor_name());
        std::fflush(stdout);
    }
}

}  // namespace achilles::bench
