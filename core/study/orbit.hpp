// Periodic runs (theory-derivatives.md 9): a start that a run comes back to, once or moved on by a shift, with what a period makes
// of a change, and how far it is from where it could not be.
//
//     const OrbitSearch found = find_orbit(model, {run, guess, closing});
//     found.orbit->period, found.orbit->multipliers[0], ...        or  found.why
#pragma once

#include <array>
#include <atomic>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "../depend/derivatives.hpp"
#include "../run/trajectory.hpp"
#include "../system/description.hpp"

namespace achilles {

class ReturnMap;
struct ClosedLap;
struct Shot;

// For whoever waits: how many runs have been tried, and a stop, which is a reason why there is no periodic run.
struct OrbitWatch {
    std::stop_token stop;
    std::atomic<int> runs = 0;
};

// When a run closes: after a period, with coordinates moved on by a shift. Expressions in the parameters.
struct Closing {
    Text period;              // a drive's; without a drive a guess; empty: not known
    std::vector<Text> shift;  // by coordinate, empty ones are 0; or none at all
};

// What an orbit's runs are made by unless somebody says otherwise: as exactly as double precision serves.
Options exact_options();

struct OrbitAsked {
    Run run;  // its parameters and options; the search begins at its start
    Closing closing;
    bool is_guess = false;  // the start: it may lie below a surface, and then begins on it
    OrbitWatch* watch = nullptr;
};

// What is told of a periodic run wherever it stands, in a list or along a branch.
struct OrbitPoint {
    std::vector<double> parameters;
    double period = 0.0;  // s
    // Where the period begins: at the release past its first Zeno point, without a drive; of a drive at the start time.
    State state;
    State flight;  // of it, in the middle of a flight: what can begin a run
    // 2n of them, the greatest first, but the flow's 1 before all: how much of a change is left after a period.
    std::vector<std::complex<double>> multipliers;
    // So many are exactly 0: two for every contact that is held at one time, counted by the dimensions of what is left.
    std::size_t zero_multipliers = 0;
    bool has_flow = false;  // one of them is that of a shift in time, exactly 1
    bool stable = false;    // all others are less than 1 in size
    DerivativeMargins margins;
    // a_inf^(1/kappa(e)) of the Zeno point that has least: linear in a parameter where it is lost.
    std::optional<double> psi;
    double shortest_contact = 0.0;  // s, past one of these Zeno points
    std::uint64_t word = 0;         // of its events
};

struct Orbit : OrbitPoint {
    bool is_at_release = false;
    int iterations = 0;
    double error = 0.0;  // of the state, of its own size: Newton's last step
    Trajectory run;      // one period, from a flight to that flight: its events are the orbit's
    // What the parameters change: rows q, v of the state and the period; columns in the description's order.
    Eigen::MatrixXd by_parameters;
};

struct OrbitSearch {
    std::optional<Orbit> orbit;
    std::string why;  // where there is none: a sentence
};

// Throws InputError for what is no question: a drive without a period, a period that is none, Euclidean reinitialization. What
// happens on the way is `why`. The run's tolerances are how exactly it closes.
OrbitSearch find_orbit(const std::shared_ptr<const Model>& model, const OrbitAsked& asked);

// kappa of theory-derivatives.md 9: how a_inf vanishes where a release overtakes a Zeno point of this restitution, 0 < e < 1.
double loss_exponent(double restitution);

// For those that follow a branch.
Orbit orbit_of(const ReturnMap& map, const ClosedLap& closed);
// The multipliers of a lap that closes, not counting the flow's 1 and the zeros.
std::vector<std::complex<double>> free_multipliers(const ReturnMap& map, const Shot& shot, std::size_t& zeros);

// The branch of a periodic run in a parameter, by pseudo-arclength continuation (theory-derivatives.md 9), with what happens
// along it.

struct Branch {
    std::size_t parameter = 0;
    std::vector<OrbitPoint> points;   // along it, that where the search has ended among them
    std::vector<OrbitPoint> folds;    // where the parameter turns back
    std::vector<OrbitPoint> flips;    // a multiplier is -1: the period doubles
    std::vector<OrbitPoint> circles;  // two conjugate ones are 1 in size
    std::vector<OrbitPoint> lost;     // a release overtakes a Zeno point, a_inf = 0: here the branch ends
    // Where the sequence of events changes on the way, and the branch goes on: the first point past it.
    std::vector<OrbitPoint> changes;
    std::array<std::string, 2> ends;  // why it goes no further, at its first point and at its last
    double value(const OrbitPoint& point) const { return point.parameters[parameter]; }
};

// Follows it both ways from an orbit that find_orbit() found, while the parameter lies in [low, high], as its value now does.
Branch follow(const std::shared_ptr<const Model>& model, const OrbitAsked& asked, const Orbit& orbit,
              std::size_t parameter, double low, double high);

// What is asked about a periodic run as a person writes it, on the command line, in a journal, in Python; and the answer.
//
//     const OrbitQuestion question = make_orbit_question({.from = "end", .along = "e=0.1:0.9"}, run, model);
//     const OrbitAnswer answer = answer_to(question, model);
//     answer.orbit->period, answer.branch->flips, ...        or  answer.why

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
