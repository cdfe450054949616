// What is asked about a periodic run as a person writes it, on the command line, in a journal, in Python; and the answer.
//
//     const OrbitQuestion question = make_orbit_question({.from = "end", .along = "e=0.1:0.9"}, run, model);
//     const OrbitAnswer answer = answer_to(question, model);
//     answer.orbit->period, answer.branch->flips, ...        or  answer.why
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "study/branch.hpp"

namespace achilles {

// A state near a periodic run, and its period where that is known.
struct OrbitGuess {
    State state;
    std::optional<double> period;
};

// The texts behind --from, --period, --shift and --continue.
struct AskedOrbit {
    std::string from{};                 // "start" or "end" of the run; empty: [orbit] of the system, else the start
    std::string period{};               // an expression in the parameters
    std::vector<std::string> shifts{};  // NAME=EXPRESSION
    std::string along{};                // NAME=LOW:HIGH
    std::optional<OrbitGuess> guess{};  // where the search begins, whatever `from` says
    // What was said of the run besides, as --set has it, and the keys of options: they stay over a guess, and over options as
    // exact as they can be.
    std::vector<std::string> settings{};
    std::set<std::string_view> options{};

    friend bool operator==(const AskedOrbit& a, const AskedOrbit& b) {
        return a.from == b.from && a.period == b.period && a.shifts == b.shifts && a.along == b.along;
    }
};

// "--from end --shift x=2*pi --continue e=0.1:0.9"; no more than these flags.
std::string to_text(const AskedOrbit& asked);
// Throws InputError.
AskedOrbit read_orbit(std::string_view text);

struct OrbitQuestion {
    OrbitAsked asked;
    bool from_end = false;  // of the run, which has to be made first
    // The branch that is to be followed.
    struct Along {
        std::size_t parameter = 0;
        double low = 0.0, high = 0.0;
    };
    std::optional<Along> along;
};

// About runs like this one, which can start. Throws InputError for what is no question.
OrbitQuestion make_orbit_question(const AskedOrbit& asked, const Run& run, const std::shared_ptr<const Model>& model);

struct OrbitAnswer : OrbitSearch {
    std::optional<Branch> branch;  // where one was asked for
};

// Throws InputError where the end of the run is no start. What `watch` stops has no answer: `why` says so, or the branch's ends.
OrbitAnswer answer_to(OrbitQuestion question, const std::shared_ptr<const Model>& model, OrbitWatch* watch = nullptr);

}  // namespace achilles
