// Proof of a whole run (theory-enclosure.md 1 to 8): boxes that contain the completed execution of every member of a
// set of initial states and parameters. They reach to the end time, or until something cannot be decided.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "enclose/doubleton.hpp"
#include "model/model.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// Input of prove(): boxes of initial states and parameters. Only the options of `run` are used; its initial state is
// ignored.
struct EnclosureProblem {
    Run run;
    Intervals q, v, parameters;  // parameters in the order of the description, without derived ones
    std::vector<double> times;   // at which the state is reported, in addition to the end; s
    // A bouncing is truncated if the half width of its Zeno time is within this (s), or nearly as small as the set
    // allows.
    double eps_t = 0.0;
    // Truncate even if the error of the truncation is not small compared with the set; for tests of that error.
    bool cut_early = false;
};

struct EnclosedEvent : EventBase {
    std::size_t contact = 0;
    Mode mode;          // after it
    ContactSet opened;  // held contacts that the event opened
    Interval t;
    Intervals q, v_before, v_after;  // v_after = v_before except at impacts
    // For a Zeno point: the number of impacts of its contact before the truncation; with parts, the minimum and maximum
    // over the parts. 0: a plastic impact without a bounce.
    int impacts = 0, most_impacts = 0;
};

struct EnclosedState {
    double t = 0.0;
    Intervals q, v;
};

struct Enclosure {
    struct ProofOutcome {
        enum class Kind { end_time, undecided, cancelled };
        Kind kind = Kind::undecided;
        std::string message;
    };
    double proved_until = 0.0;  // s: up to here everything in this result holds for every member
    // In order of time. Every member has these events and no others until proved_until, except the impacts of a
    // bouncing after the last one listed.
    std::vector<EnclosedEvent> events;
    bool events_differ = false;          // with parts: their lists start with these events and then differ
    std::vector<EnclosedState> samples;  // at the times of the claim before proved_until
    std::optional<EnclosedState> end;    // empty if the run is undecided
    ProofOutcome outcome;
    struct ProofStatistics {
        long steps = 0, impacts = 0;
        double seconds = 0.0;
    } statistics;
    std::string assumptions;  // assumptions of the proof
};

// Progress and cancellation of a proof, shared with another thread.
struct ProofMonitor {
    std::stop_token stop;           // ends the proof at its next step, as "cancelled"
    std::atomic<double> time{0.0};  // s, proved so far; with parts, set at the end
};

// Proves a claim. Throws InputError for a system or a claim that is not covered, with the reason.
Enclosure prove(const std::shared_ptr<const Model>& model, const EnclosureProblem& claim,
                ProofMonitor* watch = nullptr);

// Splits the box into `parts` intervals along each side that has a width, proves each part, on all cores, and joins the
// results. Parts may truncate a bouncing after different numbers of impacts; the common first ones are kept, then the
// Zeno point. Throws InputError for more than a million parts.
Enclosure prove_in_parts(const std::shared_ptr<const Model>& model, const EnclosureProblem& claim, int parts,
                         ProofMonitor* watch = nullptr);

// The exact doubles of a run, as boxes of zero width.
EnclosureProblem problem_of(const Run& run);
// Intervals of the decimal numbers as typed: +-4 ulp around a double that is not exactly representable, which covers
// 0.1 and pi/6.
EnclosureProblem problem_from_decimals(const Run& run);
Interval interval_of_decimal(double x);
// Widens all initial coordinates and rates by +-half.
void inflate(EnclosureProblem& claim, double half);
// The enclosure of a contact's restitution over a claim. Throws InputError if it may lie outside of [0, 1].
Interval restitution_over(const Model& model, const EnclosureProblem& claim, std::size_t contact);
// Throws InputErrors if part of a claim is proved to be impossible: a negative gap at a corner of the initial box, or a
// restitution outside [0, 1].
void check(const Model& model, const EnclosureProblem& claim);

}  // namespace achilles
