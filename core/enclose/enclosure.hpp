// A whole run as a theorem (theory-enclosure.md 1 to 8): boxes that contain the completed execution of every member of a set of
// starts and parameters, until the end time or until something cannot be decided.
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

// What is to be proved: the run from every start and with all parameters in these boxes. Of `run` the options count, and what
// it says of the start is not looked at.
struct Claim {
    Run run;
    Intervals q, v, parameters;  // parameters in the order of the description, the derived ones left out
    std::vector<double> times;   // at which the state is asked for, besides the end; s
    // A bouncing is cut where a Zeno time is known within this (s), or nearly as well as the set itself lets it be known.
    double eps_t = 0.0;
    // The cut is not put off until its error is small beside the set's own width: for tests of that error.
    bool cut_early = false;
};

struct EnclosedEvent : EventBase {
    std::size_t contact = 0;
    Mode mode;          // after it
    ContactSet opened;  // by it
    Interval t;
    Intervals q, v_before, v_after;  // v_after = v_before but at impacts
    // zeno: impacts of its contact before the proof's cut of the bouncing, and of parts the fewest of any part and the most.
    // 0 is a landing without a bounce.
    int impacts = 0, most_impacts = 0;
};

struct EnclosedState {
    double t = 0.0;
    Intervals q, v;
};

struct Enclosure {
    struct Outcome {
        enum class Kind { end_time, undecided, cancelled };
        Kind kind = Kind::undecided;
        std::string message;
    };
    double proved_until = 0.0;  // s: until then everything here holds of every member
    // In time: every member has these, and no others until then, but for the impacts of a bouncing after its last one here.
    std::vector<EnclosedEvent> events;
    bool events_differ = false;          // of parts: their lists begin with these, and go on differently
    std::vector<EnclosedState> samples;  // at the claim's times, those before proved_until
    std::optional<EnclosedState> end;    // nothing where it is undecided
    Outcome outcome;
    struct Statistics {
        long steps = 0, impacts = 0;
        double seconds = 0.0;
    } statistics;
    std::string assumptions;  // what the proof stands on
};

// A proof as another thread sees it.
struct ProofWatch {
    std::stop_token stop;           // once asked for, it ends at its next step, as "cancelled"
    std::atomic<double> time{0.0};  // s, proved so far; of parts only once all are
};

// Throws InputError for a system or a claim that is not covered, which the message says.
Enclosure prove(const std::shared_ptr<const Model>& model, const Claim& claim, ProofWatch* watch = nullptr);

// The same of the box cut into so many parts along each of its sides that has a width, on all cores: each part is a theorem, and
// this is what they say together. Parts may cut a bouncing after different numbers of impacts: of these the first are kept, which
// all have, and then the Zeno point. Throws InputError for more than a million parts.
Enclosure prove_in_parts(const std::shared_ptr<const Model>& model, const Claim& claim, int parts,
                         ProofWatch* watch = nullptr);

// The doubles of a run by themselves.
Claim claim_of(const Run& run);
// What a person wrote: a double that no decimal is stands for those around it, 4 ulp either way, which hold pi/6 or 0.1.
Claim claim_as_written(const Run& run);
Interval as_written(double x);
// All coordinates and rates of the start by so much either way.
void widen(Claim& claim, double half);
// The enclosure of the restitution of a contact over a claim. Throws InputError if it may lie outside of [0, 1].
Interval restitution_over(const Model& model, const Claim& claim, std::size_t contact);
// What is impossible about a part of a claim's starts and parameters, where that is proved: a gap below zero, a restitution
// outside [0, 1]. Throws InputErrors.
void check(const Model& model, const Claim& claim);

}  // namespace achilles
