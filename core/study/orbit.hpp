// Periodic runs (theory-derivatives.md 9): a start that a run comes back to, once or moved on by a shift, with what a period makes
// of a change, and how far it is from where it could not be.
//
//     const OrbitSearch found = find_orbit(model, {run, guess, closing});
//     found.orbit->period, found.orbit->multipliers[0], ...        or  found.why
#pragma once

#include <atomic>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "depend/margins.hpp"
#include "run/trajectory.hpp"
#include "system/description.hpp"

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

}  // namespace achilles
