// A completed execution (Defs. 4 and 5 of the paper), as data: phases, the events between them, and how it ended.
// The central noun of Achilles; read this first.
//
// A hybrid phase is free flight and impacts; a constrained phase keeps h = 0 of the contacts that it holds. A phase ends
// where its mode changes: at the Zeno point of a contact, which joins it, at a release, at an impact that opens a held
// contact. With one contact impacts happen inside hybrid phases; with several a constrained phase may have its own.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mode.hpp"
#include "options.hpp"
#include "state.hpp"

namespace achilles {

class Model;
struct Sample;

// Dense output of one step: q and v are polynomials in theta = (t - start)/(end - start), 0 <= theta <= 1.
struct Piece {
    double start = 0.0, end = 0.0;
    std::size_t first = 0;  // into Trajectory::coefficients: degree + 1 blocks of (q, v), ascending powers
    std::uint32_t degree = 0;
    Mode mode;            // of its phase, or of the phase to come: the way to a Zeno point is in contact
    ContactSet carriers;  // of what is held, whose motion it is: a sample is projected to their h = 0, hdot = 0
    Mode motion() const { return mode.only(carriers); }
    double work = 0.0, loss = 0.0;  // of the run, until it starts
};

// The state of a piece's polynomials at a time (s), clamped to the piece.
State state_in(const Piece& piece, std::span<const double> coefficients, Eigen::Index dof, double t);

struct Phase {
    enum class Kind { hybrid, constrained };
    Kind kind = Kind::hybrid;  // exactly where none is held
    Mode mode;
    // Of what is held, whose motion it is: all, or where gradients depend on one another some, which may change inside
    // the phase (the last ones). The forces could be shared otherwise, then (theory-gaps.md 2.5).
    ContactSet carriers;
    Mode motion() const { return mode.only(carriers); }
    bool not_unique() const { return carriers != mode.held(); }
    double start = 0.0, end = 0.0;
    int impacts = 0;
    std::size_t first_piece = 0, last_piece = 0;  // pieces [first, last) of the trajectory, in time
};

// One inequality of a truncation condition: satisfied when left < right.
struct Inequality {
    std::string_view name;  // "c1: time", ...: a literal
    double left = 0.0, right = 0.0;
    double share() const { return left / right; }  // of what is allowed, where both are positive
};

// What is proved about a truncated bouncing. Bounds are proved by interval evaluation, except that errors made before
// tau_k (integration, rounding) and the accumulation over several truncations are not covered.
struct Certificate {
    bool certified = false;
    Conditions conditions = Conditions::sharp;
    Reinitialization reinitialization = Reinitialization::kinetic;
    bool below_rounding = false;                                   // completed since no further flight can be resolved
    double zeno_low = 0.0, zeno_high = 0.0;                        // encloses tau_inf
    double zeno_time = 0.0;                                        // its best estimate, inside
    double position_bound = 0.0;                                   // on |q_inf - q*|
    double velocity_bound = 0.0;                                   // on |v_inf - v*|
    std::optional<double> shadowing_position, shadowing_velocity;  // theory.md 5.2, at tau_inf
    std::optional<double> uniform_position;                        // on |q - q~| at all times from tau_k to tau_inf
    double a_min = 0.0, a_max = 0.0;                               // of -hddot over the neighbourhood
    std::string_view decisive;  // the decision's inequality that has least room, or why there is no decision
    struct Paper {
        double e1 = 0.0, e2 = 0.0;  // e' = e r, e'' = e sqrt(r)
        double beta = 0.0, eta = 0.0, zeta = 0.0, c1 = 0.0, c2 = 0.0, c3 = 0.0;
    };
    std::optional<Paper> paper;
    // Of the other contacts until tau_inf, where there are any: what impulses are passed on to held ones by, the least force
    // that holds each, the least gap of those that are open.
    struct Others {
        struct Held {
            std::size_t contact;
            double transmission_low, transmission_high, least_force;
        };
        std::vector<Held> held;
        std::optional<double> least_gap;
        bool rounded_zero = false;  // what is passed on is 0 only within its rounding (theory-gaps.md 8)
    };
    std::optional<Others> others;
    // By which it is decided whether the bouncing may be cut. Nothing where that needs no condition.
    struct Decision {
        Inequality time, position, velocity;
        // The one that has least room.
        const Inequality& closest() const;
    };
    std::optional<Decision> decision;
    std::vector<Inequality> assumptions;  // what the proof stands on
    // All of them, for a person: the decision's, then the others.
    std::vector<Inequality> inequalities() const;
};

// What an event of several contacts has besides.
struct Joint {
    std::vector<std::pair<std::size_t, double>> impulses;  // of an impact, contact by contact
    bool not_unique = false;                               // another share of the same impulses, or forces, would do
    // Landings that cannot be ordered, and whose order matters: what was done is Moreau's law, all at once. The rates of
    // the gaps that would follow if one contact was first, and together.
    bool order_matters = false;
    bool rounded_zero = false;  // for the order something counted as 0 that is 0 only within its rounding
    struct Alternative {
        std::optional<std::size_t> first;                         // nothing: all at once
        std::vector<std::pair<std::size_t, double>> rates_after;  // of the gaps
    };
    std::vector<Alternative> alternatives;
};

// Base of the records of an event: its kind. A new kind stands before `last` and has a row in event_names below.
struct EventBase {
    enum class Kind { impact, zeno, release, last = release };
    Kind kind = Kind::impact;
    bool is_impact() const { return kind == Kind::impact; }
    bool is_zeno() const { return kind == Kind::zeno; }
    bool is_release() const { return kind == Kind::release; }
    friend bool operator==(const EventBase&, const EventBase&) = default;
};

struct Event : EventBase {
    double t = 0.0;
    Vector q, v_before, v_after;         // equal velocities where nothing jumps (release, zeno)
    double impact_speed = 0.0;           // impact: |hdot| before
    ContactSet contacts;                 // that land, come to rest, or leave
    Mode mode;                           // after it
    ContactSet opened;                   // of an impact: those that were held before and leave
    std::shared_ptr<const Joint> joint;  // may be null
    double work = 0.0, loss = 0.0;       // of the run until then, what happens here included
    int impacts = 0;     // zeno: impacts of the phase it ends, the one at which the bouncing was cut included
    struct Truncation {  // zeno: the impact where the bouncing was cut, and what restarted from it
        double t = 0.0;
        Vector q, v_before, v;  // v: after reinitialization
        double impact_speed = 0.0;
    };
    std::optional<Truncation> truncation;
    std::optional<Certificate> certificate;  // zeno

    // Whether another set of contacts is held after it: an impact may open held contacts.
    bool changes_held() const { return !is_impact() || !opened.empty(); }

    Event() {}  // the room for the two that most events have not need not be zero
};

// A Zeno event without bouncing: restitution 0 ends the fall in contact at once. Nothing is cut short, so nothing is to be
// bounded but the integration before it.
bool is_plastic_landing(const Event& event);
// A Zeno event after bouncing.
inline bool is_zeno_point(const Event& event) { return event.is_zeno() && !is_plastic_landing(event); }

// The names of a kind of event. The one table for everything that prints, draws or reads them; the marker and color of
// a kind are in render/figure/palette.cpp.
struct EventNames {
    Event::Kind kind;
    std::string_view word;   // in JSON, CSV and options: "zeno"
    std::string_view name;   // in sentences and legends: "Zeno point"
    std::string_view label;  // before a number or the names of contacts: "Zeno 2", "Zeno knee"
};
inline constexpr std::array<EventNames, 3> event_names{{
    {Event::Kind::impact, "impact", "impact", "impact"},
    {Event::Kind::zeno, "zeno", "Zeno point", "Zeno"},
    {Event::Kind::release, "release", "release", "release"},
}};
// A plastic landing is a Zeno event, but named for what is seen.
inline constexpr EventNames landing_names{Event::Kind::zeno, "landing", "landing", "landing"};

constexpr const EventNames& names_of(Event::Kind kind) { return event_names[static_cast<std::size_t>(kind)]; }
inline const EventNames& names_of(const Event& event) {
    return is_plastic_landing(event) ? landing_names : names_of(event.kind);
}
// Whether a table has a row for each kind of event, in the order of the kinds.
template <class Table>
consteval bool has_all_event_kinds(const Table& table) {
    for (std::size_t i = 0; i < table.size(); ++i)
        if (table[i].kind != static_cast<Event::Kind>(i)) return false;
    return table.size() == static_cast<std::size_t>(Event::Kind::last) + 1;
}
static_assert(has_all_event_kinds(event_names));

// What is kept of an event where of a run the end alone is: no states, no certificate.
struct Passage : EventBase {
    ContactSet contacts;
    double t = 0.0;
    double impact_speed = 0.0;  // impact: |hdot| before
    friend bool operator==(const Passage&, const Passage&) = default;
};

struct Outcome {
    enum class Kind {
        end_time,
        too_many_impacts,
        too_many_steps,
        out_of_memory,
        not_a_number,
        left_the_domain,
        step_too_small,
        undecided,
        simultaneous_impacts,  // their order matters and cannot be told, and the run is to stop there
        redundant_contacts,    // that leave no motion, or are more than can be decided
        cancelled              // another thread told it to stop
    };
    Kind kind = Kind::end_time;
    std::string message;
};

struct Statistics {
    long steps = 0, evaluations = 0, impacts = 0;
    double energy_drift = 0.0;  // largest relative change of energy less work inside a smooth stretch, at step ends
    double least_gap = 0.0;     // at step ends alone; of the whole run: least_gap(trajectory)
    // Wall clock: the only values that may differ between two runs.
    double seconds = 0.0;
    double certificate_seconds = 0.0;  // of these, for the truncation conditions' proofs
};

struct Trajectory {
    std::shared_ptr<const Model> model;
    Run run;
    std::vector<Phase> phases;
    std::vector<Event> events;  // in time
    // Of a run of which the end alone was kept, in place of its events; else empty. Of either: sequence_of().
    std::vector<Passage> passages;
    std::vector<Piece> pieces;  // in time
    std::vector<double> coefficients;
    double end_time = 0.0;
    State end;
    Phase::Kind end_phase = Phase::Kind::hybrid;
    Mode end_mode;
    int by_convention = 0;  // impacts whose order matters and could not be told
    // E(end) - E(start) = work - loss: what forces, a potential that changes with time and moving surfaces have done on the
    // system, and what impacts have taken. The work is no number where the ends of steps alone were kept.
    double work = 0.0, loss = 0.0;
    Outcome outcome;
    Statistics statistics;
    // Where the options of `run` left it undecided: those that it was made again by, as exactly as double precision allows.
    std::optional<Options> made_again_by;
    std::string undecided;  // what was, then; else empty

    // The state at a time (s), clamped to the run; at an event that after it. Who asks often asks a Sampler (simulate/sampler.hpp).
    Sample operator()(double t) const;
};

// What the local errors of so many steps may have grown to in the state, roughly: a measure, no bound.
inline double integration_error(const Options& options, double steps) { return 0.1 * options.tolerance * steps; }
// What the integration and the cuts before may have made a Zeno time (s) wrong by: a state that is wrong by eps moves the
// first impact, of speed v, by eps/v, and what follows takes longer in proportion to v. An estimate, and a generous one:
// of smooth systems the true error was up to 20 times what integration_error() says.
double integration_error_of_time(const Trajectory& trajectory, std::size_t zeno_event);

// How many bytes what is kept of a run takes.
double bytes_of(const Trajectory& trajectory);
// The events of a run, whatever was kept of it.
std::vector<Passage> sequence_of(const Trajectory& trajectory);

// The largest |q| and |v|, coordinate by coordinate, at the start, the events and the end: what is much smaller is noise.
State scale_of(const Trajectory& trajectory);
// What is rounding noise beside a scale: below so much of it.
inline constexpr double noise = 1e-14;
// For a person, 0 where a value is noise beside such a scale.
double without_noise(double value, double scale);

std::string_view to_text(Phase::Kind);
std::string_view to_text(Outcome::Kind);

}  // namespace achilles
