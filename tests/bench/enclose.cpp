// Width and cost of enclosures: every gallery system, its own run and boxes around it, tested with random members.
// usage: bench_enclose [MEMBERS]    default 1000; 0: only the table of own runs
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "certify/members.hpp"
#include "core/systems.hpp"

using namespace achilles;
using namespace achilles::test;

namespace {

double widest(const Enclosure& proof) {
    double result = 0.0;
    for (const Intervals* box : {&proof.end->q, &proof.end->v})
        for (const Interval& entry : *box) result = std::max(result, width(entry));
    return result;
}

double widest_zeno(const Enclosure& proof) {
    double result = 0.0;
    for (const EnclosedEvent& event : proof.events)
        if (event.kind == Event::Kind::zeno) result = std::max(result, width(event.t));
    return result;
}

// A row of the table in assets/manual/accuracy.md; a missing value is a dash.
void tell(const std::string& name, const Enclosure& proof) {
    const auto size = [](double x) { return x > 0.0 ? fmt::format("{:.1e}", x) : "-"; };
    const auto count = [&](Event::Kind kind) {
        return std::count_if(proof.events.begin(), proof.events.end(),
                             [&](const EnclosedEvent& event) { return event.kind == kind; });
    };
    fmt::print("| {:<25} | {:>8.4g} | {:>7} | {:>4} | {:>9} | {:>9} | {:>5} | {:>6.3f} | {}\n", "`" + name + "`",
               proof.proved_until, proof.statistics.impacts, count(Event::Kind::zeno), size(widest_zeno(proof)),
               size(proof.end ? widest(proof) : 0.0), proof.statistics.steps, proof.statistics.seconds,
               proof.end ? "" : "undecided: " + proof.outcome.message);
}

}  // namespace

int main(int argc, char** argv) {
    const int count = argc > 1 ? std::atoi(argv[1]) : 1000;
    long outside = 0;
    fmt::print(
        "| {:<25} | until, s | impacts | Zeno | Zeno time | state     | steps | CPU, s |\n"
        "|---------------------------|---------:|--------:|-----:|----------:|----------:|------:|-------:|\n",
        "own run");
    std::string refused;
    for (const std::string& name : all_systems()) {
        const auto model = load(name);
        try {
            const EnclosureProblem problem = problem_from_decimals(model->default_run());
            check(*model, problem);
            tell(name, prove(model, problem));
        } catch (const InputError& refusal) {
            refused += fmt::format("{}: {}\n", name, refusal.message);
        }
    }
    if (!refused.empty()) fmt::print("\nrefused\n{}", refused);
    if (count == 0) return EXIT_SUCCESS;
    fmt::print("\n{} members of random boxes of half width 1e-6\n", count);
    for (const std::string& name : all_systems()) {
        const auto model = load(name);
        const Membership members = members_of(model, claim_around(*model, 20.0, 1e-6, 0.0, 5), count, 1);
        fmt::print("{:<24} {:>9} compared {:>3} outside, enclosed/observed {:.2f}, until {:.4g} s {}\n", name,
                   members.compared, members.outside, members.width_over_observed, members.proved.proved_until,
                   members.first);
        outside += members.outside;
    }
    return outside == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
