// bench_floor [SHARE] [METHOD] [eight] [TOLERANCE|every]: never under the floor. Over every system of assets/systems,
// from random starts: the least gap of a run, where its impacts are stored, its outcome; for a random 1000 of them the
// times of events and the end state against 34 digits; and grazing starts. With "eight" runs are simulated eight at a
// time, of which the ends are known. Random starts are asked at the tolerance of their system, at a given one, or at
// every one of 1e-4, 1e-6, 1e-8, 1e-10 and 1e-13; the truth and grazing starts have tolerances of their own and are
// left out where one is given. SHARE (1) scales the numbers of runs. Prints every fault with the options that repeat
// it, and exits with 1 if there is one.
#include <fmt/format.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string_view>

#include "floor/floor.hpp"
#include "model/read_system.hpp"
#include "simulate/many.hpp"

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

// summarize(i, attempt) of every run.
template <class Summarize>
auto simulate_all(const std::shared_ptr<const Model>& model, const std::vector<Run>& runs, const Way& way,
                  const Summarize& summarize) {
    if (!way.eight_at_a_time) return simulate_many(model, std::span<const Run>(runs), summarize);
    std::vector<std::invoke_result_t<const Summarize&, std::size_t, Attempt&&>> results(runs.size());
    simulate_ends(
        model, runs.size(), [&](std::size_t i) { return runs[i]; },
        [&](std::size_t i, Attempt&& attempt) { results[i] = summarize(i, std::move(attempt)); });
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
        const auto summaries = simulate_all(model, runs, way, [&](std::size_t, Attempt&& attempt) {
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

long against_truth(const std::shared_ptr<const Model>& model, long count, const Way& way) {
    Starts starts(model, 4104);
    Faults faults;
    auto runs = runs_from(*model, starts, count, way);
    for (Run& run : runs) {
        run.options.tolerance = 1e-12;
        run.options.truncation.eps_q = run.options.truncation.eps_v = 1e-9;
    }
    const auto all = simulate_all(model, runs, way, [&](std::size_t i, Attempt&& attempt) {
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

// A dip is right if it is met when it is below the floor, and only then. Undecided is right at the default tolerance.
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
    std::vector<std::optional<double>> tolerances{std::nullopt};
    if (count > next && std::string_view(arguments[next]) == "every") {
        tolerances = {1e-4, 1e-6, 1e-8, 1e-10, 1e-13};
    } else if (count > next) {
        tolerances = {std::atof(arguments[next])};
    }
    if (!(share > 0.0) || !method || count > next + 1 || (tolerances[0] && !(*tolerances[0] > 0.0))) {
        fmt::print(stderr, "usage: bench_floor [SHARE] [dopri5|taylor] [eight] [TOLERANCE|every]\n");
        return 2;
    }
    const auto scaled = [&](double runs) { return std::max(1L, std::lround(share * runs)); };
    long faults = 0;
    std::vector<std::filesystem::path> systems;
    for (const auto& entry : std::filesystem::directory_iterator(ACHILLES_SOURCE_DIR "/assets/systems"))
        if (entry.path().extension() == ".toml") systems.push_back(entry.path());
    std::sort(systems.begin(), systems.end());
    for (const auto& path : systems) {
        const auto model = std::make_shared<const Model>(read_system(path));
        const std::string name = path.stem();
        fmt::print("{}, {}{}\n", name, to_text(*method), eight ? ", eight at a time" : "");
        for (const auto& tolerance : tolerances) {
            const Way way{*method, eight, tolerance};
            const double runs = name == "ball_on_sine" ? 1e6 : 1e5;
            faults += random_starts(model, scaled(runs / static_cast<double>(tolerances.size())), way);
            if (tolerance) continue;
            faults += against_truth(model, scaled(1000), way);
            faults += grazing(model, scaled(100), way);
        }
    }
    return faults == 0 ? 0 : 1;
}
