// bench_floor [SHARE] [METHOD] [eight] [TOLERANCE|every|random] [SYSTEM...]: tests that no run penetrates the floor,
// from random starts of all systems of assets/systems or of those named. - Every run: the smallest gap, the gaps at
// stored impacts, and the outcome. - Systems with one gap: event times and final states of 1000 random runs against 34
// digits, and grazing starts. Both   have their own tolerances and are omitted if a tolerance is given. - "eight"
// simulates batches of eight, with final states only. - The tolerance is that of the system, a given one, or with
// "every" each of 1e-4, 1e-6, 1e-8, 1e-10 and 1e-13. - "random" tests only runs with random parameters and times at
// 1e-12: all laws (floor/laws.hpp), the agreement of both   methods, and the statistics of outcomes. SHARE (1) scales
// the numbers of runs. Prints every fault with the options that repeat it, and exits with 1 if there is one.
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string_view>
#include <thread>

#include "floor/floor.hpp"
#include "model/read_system.hpp"
#include "simulate/batch.hpp"

namespace {

using namespace achilles;
using namespace achilles::test;

struct Faults {
    std::mutex mutex;
    long count = 0;
    void add(const std::string& text) {
        const std::lock_guard lock(mutex);
        if (++count <= 10) fmt::print("  FAULT {}\n", text);
        if (count == 11) fmt::print("  (more faults are counted only)\n");
        std::fflush(stdout);
    }
};

// How runs are simulated.
struct Way {
    Method method;
    bool eight_at_a_time;
    std::optional<double> tolerance;  // the system's own if empty
};

// Simulates all runs and returns summarize(i, attempt) for each.
template <class Summarize>
auto simulate_all(const std::shared_ptr<const Model>& model, const std::vector<Run>& runs, const Way& way,
                  const Summarize& summarize) {
    if (!way.eight_at_a_time) return simulate_many(model, std::span<const Run>(runs), summarize);
    std::vector<std::invoke_result_t<const Summarize&, std::size_t, RunResult&&>> results(runs.size());
    simulate_ends(
        model, runs.size(), [&](std::size_t i) { return runs[i]; },
        [&](std::size_t i, RunResult&& attempt) { results[i] = summarize(i, std::move(attempt)); });
    return results;
}

std::vector<Run> runs_from(const Model& model, Starts& starts, long count, const Way& way) {
    std::vector<Run> runs;
    for (long i = 0; i < count; ++i) {
        Run run = model.default_run();
        run.options.method = way.method;
        if (way.tolerance) run.options.tolerance = *way.tolerance;
        const State start = starts.next();
        run.q = start.q;
        run.v = start.v;
        runs.push_back(std::move(run));
    }
    return runs;
}

long random_starts(const std::shared_ptr<const Model>& model, long count, const Way& way) {
    Starts starts(model, 1729);
    Faults faults;
    double least = 0.0;
    long impacts = 0, zenos = 0;
    std::atomic<long> refused = 0;
    for (long done = 0; done < count; done += 10000) {
        const auto runs = runs_from(*model, starts, std::min(10000L, count - done), way);
        struct Summary {
            double least_gap;
            long impacts, zenos;
        };
        const auto summaries = simulate_all(model, runs, way, [&](std::size_t, RunResult&& attempt) {
            if (std::holds_alternative<InputError>(attempt)) {
                ++refused;
                return Summary{0.0, 0, 0};
            }
            const auto& trajectory = std::get<Trajectory>(attempt);
            const std::string wrong = fault(trajectory, 100.0 * trajectory.run.options.tolerance);
            if (!wrong.empty()) faults.add(wrong + "\n       " + start_of(trajectory));
            long ends = 0;
            for (const Phase& phase : trajectory.phases) ends += phase.kind == Phase::Kind::constrained ? 1 : 0;
            return Summary{trajectory.statistics.least_gap, trajectory.statistics.impacts, ends};
        });
        for (const Summary& summary : summaries) {
            least = std::min(least, summary.least_gap);
            impacts += summary.impacts;
            zenos += summary.zenos;
        }
    }
    fmt::print("  {} random starts{}: {} impacts, {} Zeno points, {} starts refused, least gap {:.1e}, {} faults\n",
               count, way.tolerance ? fmt::format(" at {:.0e}", *way.tolerance) : "", impacts, zenos, refused.load(),
               least, faults.count);
    std::fflush(stdout);
    return faults.count;
}

// Ends the program and prints the options of the run if a run takes more than a minute.
class Patience {
 public:
    Patience(const Model& model, const std::vector<Run>& runs)
        : model_(model), runs_(runs), watch_([this] { watch(); }) {}
    ~Patience() {
        {
            const std::lock_guard lock(mutex_);
            done_ = true;
        }
        wake_.notify_all();
        watch_.join();
    }
    void begin(std::size_t i) {
        const std::lock_guard lock(mutex_);
        since_[i] = std::chrono::steady_clock::now();
    }
    void end(std::size_t i) {
        const std::lock_guard lock(mutex_);
        since_.erase(i);
    }

 private:
    void watch() {
        std::unique_lock lock(mutex_);
        while (!wake_.wait_for(lock, std::chrono::seconds(1), [this] { return done_; }))
            for (const auto& [i, since] : since_)
                if (std::chrono::steady_clock::now() - since > std::chrono::minutes(1)) {
                    fmt::print("  FAULT a run takes more than a minute\n       {}\n", start_of(model_, runs_[i]));
                    std::fflush(stdout);
                    std::_Exit(1);
                }
    }

    const Model& model_;
    const std::vector<Run>& runs_;
    bool done_ = false;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::map<std::size_t, std::chrono::steady_clock::time_point> since_;
    std::thread watch_;
};

// The message of an outcome without its numbers, for statistics.
std::string kind_of(const Outcome& outcome) {
    if (outcome.kind == Outcome::Kind::end_time) return "finished";
    std::string text(to_text(outcome.kind));
    text += ": ";
    for (const char c : outcome.message.substr(0, outcome.message.find(" t = ")))
        if (!(c >= '0' && c <= '9') && c != '.') text += c;
    return text;
}

RunResult attempt(const std::shared_ptr<const Model>& model, const Run& run) {
    try {
        return simulate(model, run);
    } catch (const InputError& error) {
        return error;
    }
}

// Compares both methods with sequences cut late. The allowed difference is that of runs with starts or parameters
// changed by 1e-9.
std::string disagreement(const std::shared_ptr<const Model>& model, Run run) {
    run.options.truncation.eps_q = run.options.truncation.eps_v = 1e-9;
    const Trajectory trajectory = simulate(model, run);
    run.options.method = run.options.method == Method::taylor ? Method::dopri5 : Method::taylor;
    const Trajectory other = simulate(trajectory.model, run);
    if (trajectory.outcome.kind != Outcome::Kind::end_time || other.outcome.kind != Outcome::Kind::end_time) return {};
    // If a run ends between a cut and its Zeno point, the other may not have cut yet, and they are not compared.
    for (const Trajectory* one : {&trajectory, &other})
        if (!one->pieces.empty() && one->pieces.back().mode.held() != one->end_mode.held()) return {};
    const Distance apart = between(outline_of(trajectory), outline_of(other));
    if (apart.size <= 1e-8) return {};
    double sensitive = 1.0;
    // A Zeno point forgets a part of the start, so parameters are changed as well.
    const auto n = static_cast<std::size_t>(run.q.size());
    for (std::size_t i = 0; i < 2 * n + run.parameters.size(); ++i) {
        Run moved = trajectory.run;
        const auto k = static_cast<Eigen::Index>(i % n);
        if (i < 2 * n) {
            (i < n ? moved.q[k] : moved.v[k]) += 1e-9;
        } else {
            moved.parameters[i - 2 * n] *= 1.0 + 1e-9;
        }
        const RunResult there = attempt(model, moved);
        if (!std::holds_alternative<Trajectory>(there)) return {};
        sensitive =
            std::max(sensitive, between(outline_of(trajectory), outline_of(std::get<Trajectory>(there))).size / 1e-9);
    }
    if (apart.size <= 1e-8 * sensitive) return {};
    return fmt::format("methods are {:.1e} apart, sensitivity {:.1e}, at {}", apart.size, sensitive, apart.where);
}

// Runs with random parameters and times, at tolerance 1e-12.
long random_runs(const std::shared_ptr<const Model>& model, long count, const Way& way) {
    Starts starts(model, 271828);
    Faults faults;
    std::vector<Run> runs;
    for (long i = 0; i < count; ++i) {
        Run& run = runs.emplace_back(starts.next_run());
        run.options.method = way.method;
        run.options.tolerance = 1e-12;
    }
    Patience patience(*model, runs);
    std::mutex mutex;
    std::map<std::string, std::pair<long, std::size_t>> kinds;
    long impacts = 0, events = 0;
    const auto take = [&](std::size_t i, RunResult&& attempt) {
        patience.end(i);
        std::string kind = "refused";
        if (const auto* trajectory = std::get_if<Trajectory>(&attempt)) {
            kind = kind_of(trajectory->outcome);
            std::string wrong = way.eight_at_a_time ? "" : broken_law(*trajectory);
            if (!trajectory->end.q.allFinite() || !trajectory->end.v.allFinite()) wrong = "the end is no number";
            if (wrong.empty() && !(trajectory->statistics.least_gap >= -1e-12))
                wrong = fmt::format("least gap {:.3g} at the end of a step", trajectory->statistics.least_gap);
            if (wrong.empty() && !way.eight_at_a_time && i % 10 == 0) wrong = disagreement(model, runs[i]);
            if (!wrong.empty()) faults.add(wrong + "\n       " + start_of(*model, runs[i]));
        }
        const std::lock_guard lock(mutex);
        auto& [number, example] = kinds[kind];
        if (number++ == 0 || i < example) example = i;
        if (const auto* trajectory = std::get_if<Trajectory>(&attempt)) {
            impacts += trajectory->statistics.impacts;
            events += static_cast<long>(trajectory->phases.size()) - 1;
        }
    };
    const auto run_of = [&](std::size_t i) {
        patience.begin(i);
        return runs[i];
    };
    if (way.eight_at_a_time) {
        simulate_ends(model, runs.size(), run_of, take);
    } else {
        simulate_many(model, runs.size(), run_of, take);
    }
    fmt::print("  {} random runs: {} impacts, {} changes of phase, {} faults\n", count, impacts, events, faults.count);
    for (const auto& [kind, number] : kinds)
        fmt::print("    {:7} {}{}\n", number.first, kind,
                   kind == "finished" ? "" : "\n           " + start_of(*model, runs[number.second]));
    std::fflush(stdout);
    return faults.count;
}

long against_truth(const std::shared_ptr<const Model>& model, long count, const Way& way) {
    Starts starts(model, 4104);
    Faults faults;
    auto runs = runs_from(*model, starts, count, way);
    for (Run& run : runs) {
        run.options.tolerance = 1e-12;
        run.options.truncation.eps_q = run.options.truncation.eps_v = 1e-9;
    }
    const auto all = simulate_all(model, runs, way, [&](std::size_t i, RunResult&& attempt) {
        if (std::holds_alternative<InputError>(attempt)) return Comparison{};
        const auto& trajectory = std::get<Trajectory>(attempt);
        const Comparison comparison = Judge(model, runs[i]).compare(trajectory);
        if (!comparison.agrees())
            faults.add(fmt::format("{:.1e} off, sensitivity {:.1e}, at {}\n       {}", comparison.error,
                                   comparison.sensitivity, comparison.where, start_of(trajectory)));
        return comparison;
    });
    std::vector<double> errors, sensitivities;
    long unstable = 0;
    for (const Comparison& comparison : all) {
        if (!std::isfinite(comparison.sensitivity)) ++unstable;
        errors.push_back(comparison.error / comparison.sensitivity);
        sensitivities.push_back(comparison.sensitivity);
    }
    std::sort(errors.begin(), errors.end());
    std::sort(sensitivities.begin(), sensitivities.end());
    fmt::print(
        "  {} against 34 digits: error over sensitivity median {:.1e}, largest {:.1e}; sensitivity median {:.1e}; "
        "{} whose phases a start 1e-7 away changes; {} faults\n",
        count, errors[errors.size() / 2], errors.back(), sensitivities[errors.size() / 2], unstable, faults.count);
    std::fflush(stdout);
    return faults.count;
}

// A run is right if it has an impact exactly when the minimum of the gap is negative. Undecided is right at the default
// tolerance.
long grazing(const std::shared_ptr<const Model>& model, long count, const Way& way) {
    long wrong = 0;
    GrazingStarts source(model, 96);
    for (const double least : {1e-10, -1e-10, 1e-13}) {
        std::map<std::string, long> seen;
        for (long i = 0; i < count; ++i) {
            const auto found = source.next(least);
            if (!found) break;
            const Grazing& grazing = *found;
            for (const double tolerance : {1e-14, model->default_run().options.tolerance}) {
                Run run = model->default_run();
                run.options.method = way.method;
                run.options.tolerance = tolerance;
                run.options.end_time = static_cast<double>(grazing.dip.t) + (way.eight_at_a_time ? 0.005 : 0.01);
                run.q = grazing.start.q;
                run.v = grazing.start.v;
                const Trajectory trajectory = way.eight_at_a_time ? by_eight(model, run) : simulate(model, run);
                const bool undecided = trajectory.outcome.kind == Outcome::Kind::undecided;
                const bool met = way.eight_at_a_time
                                     ? trajectory.statistics.impacts > 0
                                     : !trajectory.events.empty() &&
                                           trajectory.events[0].t < static_cast<double>(grazing.dip.t) + 0.005;
                const bool right = !undecided && met == (grazing.dip.gap < 0);
                const bool allowed = right || (undecided && tolerance != 1e-14);
                ++seen[fmt::format("{} at {:.0e}", right ? "right" : undecided ? "undecided" : "WRONG", tolerance)];
                if (!allowed && ++wrong <= 10)
                    fmt::print("  FAULT dip to {:.3e} at t = {:.9g} {}\n       {}\n",
                               static_cast<double>(grazing.dip.gap), static_cast<double>(grazing.dip.t),
                               undecided ? "is undecided"
                               : met     ? "is met"
                                         : "is not met",
                               start_of(trajectory));
            }
        }
        fmt::print("  dips to {:.0e}:", least);
        for (const auto& [what, number] : seen) fmt::print("  {} {}", number, what);
        fmt::print("{}\n", seen.empty() ? "  no start found" : "");
        std::fflush(stdout);
    }
    return wrong;
}

}  // namespace

int main(int count, char** arguments) {
    const double share = count > 1 ? std::atof(arguments[1]) : 1.0;
    const auto method = count > 2 ? method_from(arguments[2]) : std::optional(Method::dopri5);
    const bool eight = count > 3 && std::string_view(arguments[3]) == "eight";
    const int next = eight ? 4 : 3;
    const bool random = count > next && std::string_view(arguments[next]) == "random";
    std::vector<std::optional<double>> tolerances{std::nullopt};
    if (count > next && std::string_view(arguments[next]) == "every") {
        tolerances = {1e-4, 1e-6, 1e-8, 1e-10, 1e-13};
    } else if (count > next && !random) {
        tolerances = {std::atof(arguments[next])};
    }
    if (!(share > 0.0) || !method || (tolerances[0] && !(*tolerances[0] > 0.0))) {
        fmt::print(stderr, "usage: bench_floor [SHARE] [dopri5|taylor] [eight] [TOLERANCE|every|random] [SYSTEM...]\n");
        return 2;
    }
    const std::vector<std::string_view> named(arguments + std::min(count, next + 1), arguments + count);
    const auto scaled = [&](double runs) { return std::max(1L, std::lround(share * runs)); };
    long faults = 0;
    std::vector<std::filesystem::path> systems;
    for (const auto& entry : std::filesystem::directory_iterator(ACHILLES_SOURCE_DIR "/assets/systems"))
        if (entry.path().extension() == ".toml") systems.push_back(entry.path());
    std::sort(systems.begin(), systems.end());
    for (const auto& path : systems) {
        const auto model = std::make_shared<const Model>(read_system(path));
        const std::string name = path.stem();
        if (!named.empty() && std::find(named.begin(), named.end(), name) == named.end()) continue;
        fmt::print("{}, {}{}\n", name, to_text(*method), eight ? ", eight at a time" : "");
        if (random) {
            faults += random_runs(model, scaled(1e5 / static_cast<double>(systems.size())), {*method, eight, 1e-12});
            continue;
        }
        for (const auto& tolerance : tolerances) {
            const Way way{*method, eight, tolerance};
            const double runs = name == "ball_on_sine" ? 1e6 : 1e5;
            faults += random_starts(model, scaled(runs / static_cast<double>(tolerances.size())), way);
            if (tolerance || model->contacts() > 1) continue;  // the reference has one contact
            faults += against_truth(model, scaled(1000), way);
            faults += grazing(model, scaled(100), way);
        }
    }
    return faults == 0 ? 0 : 1;
}
