// A completed execution (Defs. 4 and 5 of the paper) as data: phases, the events between them, and the outcome. This is
// the central type of Achilles; read it first.
//
// A hybrid phase consists of free flights and impacts. A constrained phase keeps h = 0 for the contacts that it holds.
// A phase ends when its mode changes: at a Zeno point, where a contact becomes held, at a release, or at an impact that
// opens a held contact. With one contact, impacts occur in hybrid phases only; with several, also in constrained
// phases.
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
struct DenseSegment {
    double start = 0.0, end = 0.0;
    std::size_t first = 0;  // into Trajectory::coefficients: degree + 1 blocks of (q, v), ascending powers
    std::uint32_t degree = 0;
    Mode mode;                // mode of its phase; between a cut and its Zeno point, of the next phase
    ContactSet load_bearing;  // held contacts that determine the motion; samples are projected to their h = hdot = 0
    ContactSet inactive;      // contacts that do not count (theory-modes.md 1)
    ContactSet latched;       // contacts that a latch holds (theory-modes.md 4)
    Mode motion() const { return mode.only(load_bearing); }
    double work = 0.0, loss = 0.0, heat = 0.0;  // from the start of the run to the start of this piece
};

// The state by the polynomials of a piece at time t (s), clamped to the piece.
State state_in(const DenseSegment& piece, std::span<const double> coefficients, Eigen::Index dof, double t);

struct Phase {
    enum class Kind { hybrid, constrained };
    Kind kind = Kind::hybrid;  // hybrid if and only if no contact is held
    Mode mode;
    // The held contacts that determine the motion: all of them, or a subset if gradients are linearly dependent. The
    // subset may change within the phase; this is the last one. The distribution of the forces is then not unique
    // (theory-gaps.md 2.5).
    ContactSet load_bearing;
    Mode motion() const { return mode.only(load_bearing); }
    bool is_nonunique() const { return load_bearing != mode.held(); }
    double start = 0.0, end = 0.0;
    int impacts = 0;
    std::size_t first_piece = 0, last_piece = 0;  // pieces [first, last) of the trajectory
};

// One inequality of a truncation condition: satisfied if left < right.
struct Inequality {
    std::string_view name;  // "c1: time", ...: a string literal
    double left = 0.0, right = 0.0;
    double ratio() const { return left / right; }  // used fraction of the limit, if both are positive
};

// What is proved about a truncated impact sequence. Bounds are proved by interval evaluation. They do not include
// errors before tau_k (integration, rounding), nor the accumulation of errors over several truncations.
struct Certificate {
    // With friction: whether the contact slides with one sign at all impacts from the one at the cut on, or sticks. It
    // may stick at all impacts and slide from the Zeno point on.
    enum class Tail : std::uint8_t { none, slip, stick, stick_then_slip };
    bool certified = false;
    Tail tail = Tail::none;
    Conditions conditions = Conditions::sharp;
    Reinitialization reinitialization = Reinitialization::kinetic;
    bool cut_at_resolution = false;                                // completed: further flights cannot be resolved
    double zeno_low = 0.0, zeno_high = 0.0;                        // enclosure of tau_inf
    double zeno_time = 0.0;                                        // best estimate of tau_inf, inside the enclosure
    double position_bound = 0.0;                                   // bound on |q_inf - q*|
    double velocity_bound = 0.0;                                   // bound on |v_inf - v*|
    std::optional<double> shadowing_position, shadowing_velocity;  // theory.md 5.2, at tau_inf
    std::optional<double> uniform_position;                        // bound on |q - q~| from tau_k to tau_inf
    double a_min = 0.0, a_max = 0.0;                               // range of -hddot over the neighborhood
    std::string_view tightest_bound;  // name of the tightest inequality of the decision, or the reason for no decision
    struct Paper {
        double e1 = 0.0, e2 = 0.0;  // e' = e r, e'' = e sqrt(r)
        double beta = 0.0, eta = 0.0, zeta = 0.0, c1 = 0.0, c2 = 0.0, c3 = 0.0;
    };
    std::optional<Paper> paper;
    // Bounds on the other contacts until tau_inf, if there are any. For each held contact: the range of its
    // transmission of impulses and its minimum force. For the open ones: their minimum gap.
    struct OtherContactBounds {
        struct HeldContactBound {
            std::size_t contact;
            double transmission_low, transmission_high, least_force;
        };
        std::vector<HeldContactBound> held;
        std::optional<double> least_gap;
        bool rounded_zero = false;  // a transmission is 0 only within rounding (theory-gaps.md 8)
    };
    std::optional<OtherContactBounds> others;
    // The inequalities that decide whether to truncate. nullopt if no condition is needed.
    struct Decision {
        Inequality time, position, velocity;
        // The tightest inequality: the one with the largest ratio().
        const Inequality& closest() const;
    };
    std::optional<Decision> decision;
    std::vector<Inequality> assumptions;  // prerequisites of the proof
    // All inequalities for a report: those of the decision, then the assumptions.
    std::vector<Inequality> inequalities() const;
};

// Additional data of an event of several contacts.
struct MultiContactInfo {
    std::vector<std::pair<std::size_t, double>> impulses;  // of an impact, by contact
    bool is_nonunique = false;                             // the impulses or forces could also be distributed otherwise
    // True for impacts whose times cannot be separated and whose order changes the outcome. They were resolved together
    // by Moreau's law. `alternatives` lists the gap rates after each order, and after the joint impact.
    bool order_matters = false;
    bool rounded_zero = false;  // for the order, a quantity that is 0 only within rounding was taken as 0
    struct ImpactOrderOutcome {
        std::optional<std::size_t> first;                         // nullopt: all at once
        std::vector<std::pair<std::size_t, double>> rates_after;  // by contact
    };
    std::vector<ImpactOrderOutcome> alternatives;
};

// The limit of the impacts of a pair that collapses (theory-collapse.md 4): one plastic impact on both, in place of all
// impacts after the cut. At a tie it is the impact at the same time.
struct CollapseInfo {
    std::vector<std::pair<std::size_t, double>> impulses;  // by contact
    double loss = 0.0;                                     // of kinetic energy
    double speed_ratio = 0.0, gap_ratio = 0.0;  // mu+ and mu-: factors of the speeds and of the gaps per two impacts
};

// Base of the event records: the kind. Insert new kinds before `last`, each with a row in event_names below.
struct EventBase {
    // stick: the slip of a contact or joint ends; slip: it begins; reversal: it changes its sign. collapse: the impacts
    // of two contacts have used up their speeds without any force (theory-collapse.md 1). jump: the state jumps as a
    // [[jump]] says; pass: a gap closes that does not count, and falls below zero.
    enum class Kind { impact, zeno, release, stick, slip, reversal, collapse, jump, pass, last = pass };
    Kind kind = Kind::impact;
    bool is_impact() const { return kind == Kind::impact; }
    bool is_zeno() const { return kind == Kind::zeno; }
    bool is_release() const { return kind == Kind::release; }
    bool is_collapse() const { return kind == Kind::collapse; }
    bool is_friction() const { return kind == Kind::stick || kind == Kind::slip || kind == Kind::reversal; }
    bool is_jump() const { return kind == Kind::jump; }
    bool is_pass() const { return kind == Kind::pass; }
    friend bool operator==(const EventBase&, const EventBase&) = default;
};

struct Event : EventBase {
    double t = 0.0;
    Vector q, v_before, v_after;  // velocities are equal unless they jump (at impacts and jumps); q after a jump
    double impact_speed = 0.0;    // impact: |hdot| before the impact
    // Those that impact, become held at a Zeno point, collapse, release, or pass; with friction, also joints; of a
    // jump, that whose impact it follows.
    ContactSet contacts;
    Mode mode;                // after the event
    ContactSet opened;        // impact: contacts held before and opened by it; collapse: those that leave after it
    ContactSet inactive;      // contacts that do not count after the event
    ContactSet latched;       // contacts that a latch holds after the event
    bool ends_latch = false;  // release: by an expression that ends the latch
    std::shared_ptr<const MultiContactInfo> joint;  // may be null
    double work = 0.0, loss = 0.0, heat = 0.0;      // from the start of the run, including this event
    int impacts = 0;                                // zeno: impacts of the phase it ends, including the one at the cut
    int sticks_from = 0;                            // zeno: the impact from which on all stick; 0: it slides
    struct TruncationRecord {                       // zeno: the impact at the cut, and the restart
        double t = 0.0;
        Vector q, v_before, v;  // v: after reinitialization
        double impact_speed = 0.0;
    };
    std::optional<TruncationRecord> truncation;         // also collapse
    std::optional<Certificate> certificate;             // zeno, collapse
    std::shared_ptr<const CollapseInfo> collapse_info;  // collapse; else null

    struct FrictionImpulses {                                    // impact
        std::vector<std::pair<std::size_t, double>> tangential;  // by contact
        std::optional<double> energy_cap;  // fraction of the restitutions at which the impact gains no energy
        ContactSet capped;                 // the contacts with these restitutions
    };
    std::shared_ptr<const FrictionImpulses> friction;  // may be null

    struct JumpRecord {
        std::size_t number;  // of the [[jump]] in the file, from 0
        Vector q_before;
    };
    std::shared_ptr<const JumpRecord> jump;  // of a jump; else null
    // The coordinates before the event.
    const Vector& q_before() const { return jump ? jump->q_before : q; }
    // True if the state differs before and after the event.
    bool is_discontinuous() const { return is_impact() || is_jump(); }

    // True if the mode may change: any event but a pass, and an impact that opens no held contact.
    bool changes_held() const { return !is_pass() && (!is_impact() || !opened.empty()); }

    Event() {}  // leaves the storage of the two optional members uninitialized, because most events have neither
};

// A Zeno event without bouncing: with restitution 0 the first impact ends in contact. Nothing is truncated, so only the
// integration before it has an error.
bool is_plastic_landing(const Event& event);
// A Zeno event that ends an impact sequence.
inline bool is_zeno_point(const Event& event) { return event.is_zeno() && !is_plastic_landing(event); }

// Names of the kinds of events, for everything that prints, draws or reads them. Markers and colors are in
// render/figure/palette.cpp.
struct EventNames {
    Event::Kind kind;
    std::string_view word;   // in JSON, CSV and options: "zeno"
    std::string_view name;   // in sentences and legends: "Zeno point"
    std::string_view label;  // before a number or names of contacts: "Zeno 2", "Zeno knee"
};
inline constexpr std::array<EventNames, 9> event_names{{
    {Event::Kind::impact, "impact", "impact", "impact"},
    {Event::Kind::zeno, "zeno", "Zeno point", "Zeno"},
    {Event::Kind::release, "release", "release", "release"},
    {Event::Kind::stick, "stick", "stick", "stick"},
    {Event::Kind::slip, "slip", "start of slip", "slip"},
    {Event::Kind::reversal, "reversal", "reversal of slip", "reversal"},
    {Event::Kind::collapse, "collapse", "collapse", "collapse"},
    {Event::Kind::jump, "jump", "jump", "jump"},
    {Event::Kind::pass, "pass", "pass of a gap that does not count", "pass"},
}};
// A plastic landing is a Zeno event, but has its own names.
inline constexpr EventNames landing_names{Event::Kind::zeno, "landing", "landing", "landing"};

constexpr const EventNames& names_of(Event::Kind kind) { return event_names[static_cast<std::size_t>(kind)]; }
inline const EventNames& names_of(const Event& event) {
    return is_plastic_landing(event) ? landing_names : names_of(event.kind);
}
// True if the table has one row for each kind of event, in the order of the kinds.
template <class Table>
consteval bool has_all_event_kinds(const Table& table) {
    for (std::size_t i = 0; i < table.size(); ++i)
        if (table[i].kind != static_cast<Event::Kind>(i)) return false;
    return table.size() == static_cast<std::size_t>(Event::Kind::last) + 1;
}
static_assert(has_all_event_kinds(event_names));

// Record of an event in a run stored with Recording::final_state: no states, no certificate.
struct EventRecord : EventBase {
    ContactSet contacts;
    double t = 0.0;
    double impact_speed = 0.0;  // impact: |hdot| before the impact
    int jump = -1;              // the number of the [[jump]]
    friend bool operator==(const EventRecord&, const EventRecord&) = default;
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
        simultaneous_impacts,  // their order matters but is unknown, and the options ask to stop
        redundant_contacts,    // they leave no motion, or are too many to decide
        painleve,              // rigid bodies with this friction have no motion, or several
        impact_not_unique,     // no impulses with friction obey the impact law, or several
        energy_gain,           // an impact with friction would gain energy, and the options ask to stop
        too_many_events,       // sticks, slips and reversals, or jumps
        cancelled              // by another thread
    };
    Kind kind = Kind::end_time;
    std::string message;
};

struct Statistics {
    long steps = 0, evaluations = 0, impacts = 0;
    double energy_drift = 0.0;  // largest relative change of energy minus work within a smooth segment, at step ends
    double least_gap = 0.0;     // at step ends only; for the whole run see least_gap(trajectory)
    // Wall-clock times: the only values that may differ between equal runs.
    double seconds = 0.0;
    double certificate_seconds = 0.0;  // part of `seconds` for the proofs of truncation conditions
};

struct Trajectory {
    std::shared_ptr<const Model> model;
    Run run;
    std::vector<Phase> phases;
    std::vector<Event> events;  // ordered by time
    // Event records of a run stored with Recording::final_state; otherwise empty. Use sequence_of() for either kind.
    std::vector<EventRecord> passages;
    std::vector<DenseSegment> pieces;  // ordered by time
    std::vector<double> coefficients;
    double end_time = 0.0;
    State end;
    ContactSet start_inactive, end_inactive;  // contacts that do not count
    ContactSet start_latched, end_latched;    // contacts that a latch holds (theory-modes.md 4)
    Phase::Kind end_phase = Phase::Kind::hybrid;
    Mode end_mode;
    int ambiguous_impacts = 0;  // number of impacts whose order matters but is unknown
    // E(end) - E(start) = work - loss - heat. The work is that of forces, of a time-dependent potential and of moving
    // surfaces; the loss is the energy dissipated at impacts and taken out by jumps. For a run stored with
    // Recording::final_state the work is NaN, unless none can be done; so is the loss if the system has jumps.
    double work = 0.0, loss = 0.0;
    double heat = 0.0;  // of dry friction, in contact and at impacts
    Outcome outcome;
    Statistics statistics;
    // The tighter options of a second run, if a run with the options of `run` was undecided.
    std::optional<Options> rerun_options;
    std::string rerun_reason;  // reason for the second run; else empty

    // State at time t (s), clamped to the run; at an event, the state after it. For many queries use a Sampler
    // (simulate/sampler.hpp).
    Sample operator()(double t) const;
};

// Rough estimate (no bound) of the error of the state after `steps` steps, from their local errors.
inline double integration_error(const Options& options, double steps) { return 0.1 * options.tolerance * steps; }
// Estimated error of a Zeno time (s) from the integration and from earlier cuts. A state error eps moves the first
// impact, of speed v, by eps/v, and prolongs the rest of the sequence in proportion. The estimate is generous: for
// smooth systems the true error was up to 20 times integration_error().
double integration_error_of_time(const Trajectory& trajectory, std::size_t zeno_event);

// Memory used by the stored trajectory, bytes.
double bytes_of(const Trajectory& trajectory);
// The records of all events of a run, whatever was stored.
std::vector<EventRecord> sequence_of(const Trajectory& trajectory);

// The largest |q| and |v| of each coordinate at the start, the events and the end, as a reference for noise.
State scale_of(const Trajectory& trajectory);
// Values below this fraction of a scale are rounding noise.
inline constexpr double noise = 1e-14;
// For printing: 0 if the value is noise relative to the scale, else the value.
double flush_noise_to_zero(double value, double scale);

std::string_view to_text(Phase::Kind);
std::string_view to_text(Certificate::Tail);
std::string_view to_text(Outcome::Kind);

}  // namespace achilles
