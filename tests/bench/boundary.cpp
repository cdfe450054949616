// bench_boundary [SHARE] [crest|known|waves|fine|post|bumps]: compares runs near boundaries, where the course of events
// changes, with 34-digit references. - crest: the contact force has a minimum of -0.3 of the tolerance, so the run must
// release. 6000 starts for each way of   simulating. - other families: starts on both sides of boundaries found by
// bisection, in flight and in contact, at distances of 1e-2   to 1e-13. Each runs with Taylor series, with dopri5 and
// in batches of eight, at tolerances from 1e-4 to 1e-13. A run may be right, undecided, or wrong if its own error
// explains it. It is a fault if the distance from the boundary is more than ten times that error, or if the first
// impact is off by a thousand tolerances. Faults are printed with commands that repeat them, and the program exits with
// 1. SHARE (1) scales the numbers of starts.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <string_view>

#include "boundary/families.hpp"

namespace {

using namespace achilles;
using namespace achilles::test;

class Table {
 public:
    void add(Way way, double tolerance, Verdict verdict) { ++counts_[{way, tolerance}][verdict]; }
    void print() const {
        for (const auto& [key, verdicts] : counts_) {
            fmt::print("  {:<7} {:>6.0e}:", to_text(key.first), key.second);
            for (const auto& [verdict, count] : verdicts) fmt::print("  {} {}", count, to_text(verdict));
            fmt::print("\n");
        }
        std::fflush(stdout);
    }

 private:
    std::map<std::pair<Way, double>, std::map<Verdict, long>> counts_;
};

// Prints the first faults and counts the others.
class Faults {
 public:
    void add(const std::string& what, const std::string& repeat) {
        if (++count < 10) fmt::print("  FAULT {}\n       {}\n", what, repeat);
        if (count == 10) fmt::print("  (more faults are counted only)\n");
        std::fflush(stdout);
    }
    long count = 0;
};

// Finds errors of a trajectory that need no reference. They are counted apart from the verdicts.
void look(const Question& question, Way way, double tolerance, Faults& faults) {
    if (way == Way::eight) return;  // only the final state is recorded
    Run run = question.run;
    run.options.method = way == Way::dopri5 ? Method::dopri5 : Method::taylor;
    run.options.tolerance = tolerance;
    try {
        const std::string wrong = impossible(simulate(question.model, run));
        if (!wrong.empty()) faults.add(wrong, repeat(question, way, tolerance));
    } catch (const InputError&) {  // counted by judge() as refused
    }
}

Verdict ask(Judge34& judge, const Question& question, Way way, double tolerance, Faults& faults) {
    const Judgement judgement = judge.judge(way, tolerance);
    // `unmeasured` is only counted. The cases examined so far are dopri5 runs with flights of take-off speed 1e-12.
    const bool fault = judgement.verdict == Verdict::blatant || judgement.verdict == Verdict::failed ||
                       judgement.verdict == Verdict::refused;
    if (fault)
        faults.add(fmt::format("{}: {}", to_text(judgement.verdict), judgement.told), repeat(question, way, tolerance));
    return judgement.verdict;
}

long crest(long count) {
    fmt::print("crest: {} starts for each way, least force -0.3 of the tolerance\n", count);
    const Crest crest;
    Faults faults;
    for (const Way way : ways) {
        Dice dice(15);
        std::map<double, std::array<long, 3>> counts;  // by Hold
        for (long i = 0; i < count; ++i) {
            const double tolerance = tolerances[i % 5];
            const Question question = crest.attack(dice, i / 5, tolerance);
            const Hold held = hold(question, way, tolerance);
            ++counts[tolerance][static_cast<std::size_t>(held)];
            if (held == Hold::held) faults.add("false contact", repeat(question, way, tolerance));
        }
        for (const auto& [tolerance, numbers] : counts)
            fmt::print("  {:<7} {:>6.0e}:  {} released  {} undecided  {} FALSE CONTACT\n", to_text(way), tolerance,
                       numbers[0], numbers[1], numbers[2]);
        std::fflush(stdout);
    }
    return faults.count;
}

long known() {
    fmt::print("cases known to have been decided wrongly\n");
    long wrong = 0;
    for (const KnownCase& known : known_cases()) {
        Judge34 judge(known.question);
        Judgement judgement = judge.judge(known.way, known.tolerance);
        Faults faults;
        look(known.question, known.way, known.tolerance, faults);
        std::string told = judgement.told;
        if (judgement.verdict == Verdict::undecided && judgement.end < known.min_end) {
            told = fmt::format("gave up at t = {:.9g}, nothing is in doubt before {}", judgement.end, known.min_end);
            ++wrong;
        }
        const bool right = judgement.verdict == Verdict::right || judgement.verdict == Verdict::undecided;
        wrong += right ? faults.count : faults.count + 1;
        fmt::print("  {:<42} {:<7} {:>6.0e}  {}{}{}\n", known.name, to_text(known.way), known.tolerance,
                   to_text(judgement.verdict), told.empty() ? "" : ": ", told);
        std::fflush(stdout);
    }
    return wrong;
}

long boundaries(Family family, bool in_contact, long count) {
    fmt::print("{}, {}: {} boundaries\n", to_text(family), in_contact ? "from contact" : "in the air", count);
    const auto clock = std::chrono::steady_clock::now();
    Boundaries source(family, in_contact, 34 + static_cast<unsigned>(family));
    Table table;
    Faults faults;
    long starts = 0, unknown = 0;
    for (long i = 0; i < count; ++i) {
        for (const Question& question : source.next()) {
            std::optional<Judge34> judge;
            try {
                judge.emplace(question);
            } catch (const std::runtime_error&) {
                ++unknown;
                continue;
            }
            ++starts;
            for (const Way way : ways) {
                for (const double tolerance : tolerances) {
                    table.add(way, tolerance, ask(*judge, question, way, tolerance, faults));
                    look(question, way, tolerance, faults);
                }
            }
        }
    }
    table.print();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    fmt::print("  {} starts, {} of unknown truth, {} faults, {:.0f} s\n", starts, unknown, faults.count, seconds);
    std::fflush(stdout);
    return faults.count;
}

}  // namespace

int main(int count, char** arguments) {
    const double share = count > 1 ? std::atof(arguments[1]) : 1.0;
    const std::string_view only = count > 2 ? arguments[2] : "";
    if (!(share > 0.0) || count > 3) {
        fmt::print(stderr, "usage: bench_boundary [SHARE] [crest|known|waves|fine|post|bumps]\n");
        return 2;
    }
    const auto scaled = [&](double runs) { return std::max(1L, std::lround(share * runs)); };
    long faults = 0;
    if (only.empty() || only == "known") faults += known();
    if (only.empty() || only == "crest") faults += crest(scaled(6000));
    for (const Family family : families) {
        if (!only.empty() && to_text(family).substr(0, 4) != only.substr(0, 4)) continue;
        for (const bool in_contact : {false, true}) faults += boundaries(family, in_contact, scaled(25));
    }
    fmt::print("{} faults\n", faults);
    return faults == 0 ? 0 : 1;
}
