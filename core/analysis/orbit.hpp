// Periodic orbits (theory-derivatives.md 9): an initial state to which a run returns after a period, possibly up to a
// shift, with multipliers and margins.
//
//     const OrbitSearchResult found = find_orbit(model, {run, guess, closing});
//     found.orbit->period, found.orbit->multipliers[0], ...        or  found.reason
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

#include "../run/trajectory.hpp"
#include "../sensitivity/derivatives.hpp"
#include "../system/description.hpp"

namespace achilles {

class ReturnMap;
struct ConvergedOrbit;
struct ShootingResult;

// Progress and cancellation of an orbit search, for another thread. A stopped search finds no orbit.
struct OrbitMonitor {
    std::stop_token stop;
    std::atomic<int> runs = 0;
};

// The condition of return: the period, and the shift of the coordinates. Expressions in the parameters.
struct ReturnCondition {
    Text period;  // that of the drive; without a drive it is a guess, and may be empty
    // One for each coordinate, or none. An empty entry means 0; free_shift means that any shift will do.
    std::vector<Text> shift;
};

// Default options for orbit searches: the tightest tolerances that double precision supports.
Options tightest_options();

struct OrbitProblem {
    Run run;  // its parameters and options are used; the search begins at its start
    ReturnCondition closing;
    bool is_guess = false;  // the start is a guess: if a gap is negative, it is projected onto the surface
    OrbitMonitor* watch = nullptr;
};

// Data of a periodic orbit in a list or along a branch.
struct OrbitPoint {
    std::vector<double> parameters;
    double period = 0.0;  // s
    // Initial state of the period: without a drive at the release after its first Zeno point, with a drive at the start
    // time.
    State state;
    State flight;  // the state in the middle of a flight, where a run can start
    // Coordinates whose shift is free (ReturnMap), and their shift over a period.
    std::vector<std::pair<std::string, double>> free;
    // The 2n eigenvalues of the monodromy matrix, in decreasing size, after the flow's 1 and that of each free
    // coordinate.
    std::vector<std::complex<double>> multipliers;
    // Number of multipliers that are exactly 0: two for every contact held at one time, one for every contact or joint
    // that sticks at one time, by the rank of the monodromy matrix.
    std::size_t zero_multipliers = 0;
    bool is_autonomous = false;  // without a drive: one multiplier, that of a shift in time, is exactly 1
    // How many multipliers belong to shifts in time and of free coordinates.
    std::size_t shifts() const { return free.size() + (is_autonomous ? 1 : 0); }
    bool stable = false;  // all others are less than 1 in size
    DerivativeMargins margins;
    // a_inf^(1/kappa(e)), the smallest over the Zeno points; linear in a parameter near the loss of a Zeno point.
    std::optional<double> psi;
    double shortest_contact = 0.0;      // s, after one of these Zeno points
    std::uint64_t event_signature = 0;  // signature of its events
};

struct Orbit : OrbitPoint {
    bool is_at_release = false;
    int iterations = 0;
    double error = 0.0;  // relative error of the state: the last Newton step
    Trajectory run;      // one period, from a flight to the same flight
    // Derivatives by the parameters: rows q, v of the state, and the period; columns in the description's order.
    Eigen::MatrixXd parameter_derivatives;
};

struct OrbitSearchResult {
    std::optional<Orbit> orbit;
    std::string reason;  // the reason if there is none: a sentence
};

// Searches for a periodic orbit. Throws InputError if the request is ill-posed: a driven system without a period, a
// non-positive period, or Euclidean reinitialization. Failure to converge is reported in `reason`. The run's tolerances
// determine how exactly the orbit closes.
OrbitSearchResult find_orbit(const std::shared_ptr<const Model>& model, const OrbitProblem& problem);

// kappa of theory-derivatives.md 9: the exponent with which a_inf vanishes if a release overtakes a Zeno point of this
// restitution, 0 < e < 1.
double loss_exponent(double restitution);

// ---- used by the continuation of branches ----
Orbit orbit_of(const ReturnMap& map, const ConvergedOrbit& closed);
// The multipliers of a converged orbit, without the flow's 1 and the zeros.
std::vector<std::complex<double>> free_multipliers(const ReturnMap& map, const ShootingResult& shot,
                                                   std::size_t& zeros);

// ---- branches: pseudo-arclength continuation of a periodic orbit in a parameter (theory-derivatives.md 9) ----

struct Branch {
    std::size_t parameter = 0;
    std::vector<OrbitPoint> points;          // along the branch, including the orbit where it started
    std::vector<OrbitPoint> folds;           // the parameter turns back
    std::vector<OrbitPoint> flips;           // a multiplier is -1: the period doubles
    std::vector<OrbitPoint> neimark_sacker;  // two complex conjugate multipliers have size 1
    std::vector<OrbitPoint> zeno_lost;       // a release overtakes a Zeno point, a_inf = 0; the branch ends
    // Changes of the sequence of events, where the branch continues: the first point after each.
    std::vector<OrbitPoint> changes;
    std::array<std::string, 2> ends;  // reasons for its end, at its first and last point
    double value(const OrbitPoint& point) const { return point.parameters[parameter]; }
};

// Follows the branch in both directions from an orbit found by find_orbit(), as long as the parameter is in [low,
// high], which must contain its present value.
Branch follow(const std::shared_ptr<const Model>& model, const OrbitProblem& problem, const Orbit& orbit,
              std::size_t parameter, double low, double high);

// ---- text form of an orbit request (command line, journal, Python) and its result ----
//
//     const OrbitRequest question = parse_orbit_request({.from = "end", .along = "e=0.1:0.9"}, run, model);
//     const OrbitResult answer = solve_orbit_request(question, model);
//     answer.orbit->period, answer.branch->flips, ...        or  answer.reason

// A state near a periodic orbit, and its period if known.
struct OrbitGuess {
    State state;
    std::optional<double> period;
};

// The values of --from, --period, --shift and --continue.
struct OrbitOptions {
    std::string from{};                 // "start" or "end" of the run; empty: [orbit] of the system, or else the start
    std::string period{};               // expression in the parameters
    std::vector<std::string> shifts{};  // NAME=EXPRESSION
    std::string along{};                // NAME=LOW:HIGH
    std::optional<OrbitGuess> guess{};  // initial guess; takes precedence over `from`
    // Other overrides (--set, keys of options). They take precedence over the guess and over tightest_options().
    std::vector<std::string> settings{};
    std::set<std::string_view> options{};

    friend bool operator==(const OrbitOptions& a, const OrbitOptions& b) {
        return a.from == b.from && a.period == b.period && a.shifts == b.shifts && a.along == b.along;
    }
};

// For example "--from end --shift x=2*pi --continue e=0.1:0.9"; contains only these flags.
std::string to_text(const OrbitOptions& typed);
// Throws InputError.
OrbitOptions read_orbit(std::string_view text);

struct OrbitRequest {
    OrbitProblem problem;
    bool from_end = false;  // start at the end of the run, which must be simulated first
    // Parameter range of the branch to follow.
    struct ContinuationRange {
        std::size_t parameter = 0;
        double low = 0.0, high = 0.0;
    };
    std::optional<ContinuationRange> along;
};

// Parses a request about a run, which must be able to start. Throws InputError if it is ill-posed.
OrbitRequest parse_orbit_request(const OrbitOptions& typed, const Run& run, const std::shared_ptr<const Model>& model);

struct OrbitResult : OrbitSearchResult {
    std::optional<Branch> branch;  // if requested
};

// Solves a request. Throws InputError if the end of the run is not a valid start. After a cancellation, `reason` or the
// branch's `ends` say so.
OrbitResult solve_orbit_request(OrbitRequest question, const std::shared_ptr<const Model>& model,
                                OrbitMonitor* watch = nullptr);

}  // namespace achilles
