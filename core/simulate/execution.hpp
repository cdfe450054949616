// State machine of one completed execution (Defs. 4 and 5 of the paper). It requests integration steps and handles
// everything between them: impacts, completion at Zeno points, releases, and the end of the run.
//
//     while (const StepRequest* request = execution.next()) execution.accept(stepper.step(*request));
//
// In free flight it waits for an impact. After an impact it bounces or, if the truncation is certified, continues in
// contact toward the Zeno point. In contact it waits for the contact force to reach zero, then releases the contact.
// With several contacts, each does this while others are held (theory-gaps.md 2). If several contacts are closed at an
// event, they are decided together.
#pragma once

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "certify/collapse.hpp"
#include "certify/truncation.hpp"
#include "certify/two_contacts.hpp"
#include "contacts/collapse.hpp"
#include "contacts/complementarity.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/event_stepper.hpp"
#include "simulate/recorder.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

// contacts/friction_modes.hpp
struct FrictionProblem;
struct FrictionImpactProblem;
struct FrictionImpact;
// simulate/sliding_collapse.cpp
struct SlidingPair;

// Text of a state, for messages.
std::string where(const State& state);

class ExecutionAutomaton {
 public:
    // What to do if a step cannot decide whether an event occurs: redo the segment from its start, once, at
    // exact_tolerance; or end the run with outcome `undecided`.
    enum class AmbiguityPolicy { retry_tight, stop };

    // Starts the run, in free flight, in contact or with an impact. Model::check() must accept it. `surfaces` must
    // belong to the same model and run. They and `watch`, which may be null, must outlive this object.
    ExecutionAutomaton(std::shared_ptr<const Model> model, const Run& run, ContactCache& surfaces, RunMonitor* watch,
                       Recording keep, AmbiguityPolicy ambiguity_policy);

    // Prepares this object for another run, reusing its buffers. The run must have the same tolerance, method and
    // truncation, and parameters that differ only where restitution depends on them. Returns false and changes nothing
    // if tolerance, method or truncation differ, or if a system of several contacts has other parameters.
    bool restart(const Run& run);

    // The next step to make. Null once the run is over: at its end time, at a limit, cancelled, or stopped by accept().
    // The pointer is valid until accept(); until then, next() returns the same request.
    const StepRequest* next();

    // Processes the result of the last request. The run continues from the result's state:
    //     no_event        the next step
    //     impact          Newton's impact law, or contact until the Zeno point if the truncation is certified
    //     force_vanishes  release of the contact if h''' > 0 is proved
    //     ambiguous       the segment is redone at exact_tolerance if that is allowed; otherwise the run ends
    //     gap_rises       an inactive contact counts again
    //     guard_event     a jump, the end of a latch, or only a change of sign
    //     off_surface, step_failed    the run ends
    // It also ends if an event cannot be decided. Then the run has an outcome and next() returns null.
    void accept(const StepResult& result);

    // Whether the run is in contact after a truncation, before the Zeno point.
    bool completing() const { return completion_.has_value(); }
    const Run& run() const { return run_; }

    // The recorded trajectory; call it once next() returns null.
    Trajectory finish();
    // Ends the run with outcome `out of memory`. What was recorded so far is kept.
    void run_out_of_memory();

 private:
    // Data to restore the start of the current segment.
    struct SegmentStart {
        StepRequest next;
        Recorder::Checkpoint recorded;
        double last_step;
        int stalled;
    };

    // Contacts that are closed at the start or after a jump and do not count: at rest, and those that close, with hdot.
    struct UncountedContacts {
        ContactSet resting;
        std::vector<std::pair<std::size_t, double>> closing;
    };
    void begin();
    void decide_at_start();
    void open_first_phase(const UncountedContacts& uncounted);
    void begin_with_friction(ContactSet landing, ContactSet resting, const UncountedContacts& uncounted);
    void start_at_rest(ContactSet resting);
    bool is_time_left() const;
    bool is_cancelled();
    void note_beginning();
    double state_error() const;
    void advance(const StepResult& result);
    void begin_stretch(Mode mode, double until);
    void prepare_stretch(Mode mode, double until);
    void change_rates(const Vector& v_before, ContactSet but) {
        if (surfaces_->count() > 1) change_other_rates(v_before, but);
    }
    void change_other_rates(const Vector& v_before, ContactSet but);
    void note_scale();
    bool can_retry_tight() const;
    void retry_tight();
    std::string ambiguity_text(const StepResult& result) const;
    void stop_at(StepFailure failure);
    void fail_projection();
    void stop(Outcome::Kind kind, std::string message);

    // ---- events (completion.cpp) ----
    void land(std::size_t which, const Contact& contact);
    void land_alone(const Contact& contact);
    // The work and loss of an impact, including the impulses transmitted to held contacts.
    Exchange exchange_of(const Contact& contact, double e) {
        const Exchange own = exchange(contact, e);
        return next_.mode.is_free() ? own : exchange_beside(contact, e, own);
    }
    Exchange exchange_beside(const Contact& contact, double e, Exchange own);
    double restitution(std::size_t contact) const { return surfaces_->restitution(contact).value; }
    ContactKinematics& kinematics() { return surfaces_->of(which_, next_.mode); }
    // Calls `work` and adds its duration to the time of proofs.
    template <class WorkIntegrator>
    auto timed(const WorkIntegrator& work) {
        const auto clock = std::chrono::steady_clock::now();
        auto result = work();
        proving_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
        return result;
    }
    void find_conditions(ContactState state);
    bool could_truncate(const Collision& collision, ContactState state = ContactState::held);
    void bounce(const Contact& contact, double e);
    bool is_well_resolved(double speed) const;
    bool too_short_to_resolve(const Collision& collision, double e);
    void complete(const Contact& contact, const Collision& collision, Certificate certificate);
    void continue_to_zeno_point(const Collision& collision, ContactState state, Certificate certificate,
                                int sticks_from = 0);
    void capture(const Contact& contact, const Collision& collision);
    void pass_zeno_point();
    ContactSet decide_at_zeno_point();
    void release(std::size_t which);
    void leave(ContactSet contacts, bool ends_latch = false);
    void enter_phase();
    void enter_or_stay();
    // ---- several closed contacts (multi_contact.cpp, contact_mode.cpp) ----
    std::optional<ContactSet> landing_with(std::size_t which, const Contact& contact);
    bool is_order_independent(ContactSet landing);
    double rounding_so_far(const Contact& contact) const;
    bool stays_held(std::size_t which, const Contact& contact);
    bool is_pressed(const ClosedContacts& closed, ContactSet held, const State& state);
    double plastic_work(const State& before, ContactSet contacts);
    void note_order(MultiContactInfo& joint, const ClosedContacts& closed, const ContactVector<double>& before,
                    const ContactVector<double>& e, const ContactVector<double>& after) const;
    void collide(ContactSet landing);
    bool complete_pair(ContactSet landing, const Vector& v_after, bool cut_at_resolution);
    bool complete_pair(std::size_t first, std::size_t second, Mode others, ContactSet landing, const Vector& v_after,
                       bool cut_at_resolution);
    bool too_short_to_resolve(std::size_t which, double hdot);
    void decide(ContactSet closed, ContactSet vanishing = {});
    ContactVector<double> accelerations(const ClosedContacts& closed);
    bool judge(ContactSet closed, ContactSet active, ContactSet vanishing);
    bool judge(ContactSet closed, ContactSet active, ContactSet vanishing, ContactSet unpressed);
    ContactSet vanishing_with(std::size_t which);
    ContactSet pressed_by_rates(ContactSet doubtful, Mode mode);
    bool needs_no_force(std::size_t contact, Mode mode) {
        return surfaces_->needs_no_force(contact, model_->unconstrained(mode, contact), next_.state, scale_);
    }
    ContactSet unpressed_of(ContactSet contacts, Mode mode);
    ContactSet always_unpressed(Mode mode);
    ContactSet unpressed_among(ContactSet closed, ContactSet active);
    bool is_chatter() const;
    bool moves_within_rounding(std::size_t which, double speed);
    bool is_at_rounding(std::size_t which, double speed);
    void end_chatter(ContactSet contacts);
    bool stays_closed(std::size_t contact, Mode mode);
    bool is_at_rest(Mode mode);
    void check_touching();
    std::string names_of(ContactSet contacts) const;
    // ---- impacts that collapse (collapse.cpp) ----
    std::optional<PairLaw<Interval>> law_of_pair(ContactSet pair, ContactSet held);
    bool is_collapse_at_tie(ContactSet landing);
    AlternateImpacts law_of_tie(ContactSet landing);
    // Two contacts, of which the first impacts: its speed, and the rate and the gap of the other just before. Both are
    // held, or slide, in the mode `closed`.
    struct CollapsingPair {
        std::array<std::size_t, 2> which;
        PairLaw<double> law;
        double speed, rate, gap;
        Mode closed;
    };
    bool complete_collapse(std::size_t which, const Contact& contact, bool at_rounding);
    bool complete_collapse(const std::array<std::size_t, 2>& pair, const std::array<Contact, 2>& contacts, double W12,
                           bool at_rounding);
    std::optional<PairCompletion> certify_collapse(const CollapsingPair& pair, const State& after, bool at_rounding);
    CollapseConditions& collapse_conditions(std::size_t first, std::size_t second, Mode closed);
    std::shared_ptr<CollapseInfo> collapse_info(ContactSet pair, const AlternateImpacts& law);
    void continue_to_collapse(const CollapsingPair& pair, const State& after, const State& restart,
                              PairCompletion completion, std::shared_ptr<const CollapseInfo> info);
    void record_collapse_at_tie(ContactSet pair, std::shared_ptr<const CollapseInfo> info);
    void pass_collapse(Event&& event);
    void finish_collapse(Event&& event, ContactSet held, Mode resting);
    void stop_at_collapse(ContactSet pair);
    std::string collapse_failure_text() const;
    // ---- friction (friction.cpp, friction_impact.cpp, friction_completion.cpp) ----
    // A contact or joint that leaves its cone, and the sign of its slip.
    struct SlipStart {
        std::size_t which;
        int sign;
    };
    void start_friction_functions();
    void accept_friction_event(std::size_t event);
    bool is_pivot(std::size_t event) const;
    void end_slip(std::size_t which);
    void start_slip(const SlipStart& start, std::size_t event);
    bool open_together(ContactSet together);
    void release_with_friction(std::size_t which);
    bool decide_with_friction(ContactSet closed, Mode sliding, std::optional<SlipStart> start = {});
    FrictionProblem friction_problem(const ContactRows& rows, ContactSet decided, Mode sliding, Mode base,
                                     const std::optional<SlipStart>& start);
    void stop_at_paradox(const FrictionProblem& problem, const std::string& slips, bool none);
    void stop_in_doubt(const FrictionProblem& problem, bool are_forces_unique);
    bool is_proved(Mode mode, ContactSet closed, Mode sliding);
    ContactSet at_zero_slip(ContactSet contacts_and_joints);
    Mode sliding_mode(ContactSet contacts_and_joints);
    void enter_friction_mode(Mode before, ContactSet released = {}, ContactSet unlatched = {});
    void record_friction(Event::Kind kind, ContactSet contacts, bool ends_latch = false);
    bool check_friction_levels(ContactSet contacts_and_joints);
    std::string slips_text(const ContactRows& rows, Mode sliding) const;
    void collide_with_friction(ContactSet landing);
    ContactSet closing_with(ContactSet landing);
    ContactRows rows_before_impact(ContactSet contacts, ContactSet still);
    FrictionImpactProblem impact_problem(const ContactRows& rows, ContactSet contacts);
    bool check_impact(const FrictionImpact& impact, ContactSet landing, ContactSet contacts);
    std::optional<Mode> mode_after_impact(const ContactRows& rows, const FrictionImpact& impact, ContactSet contacts);
    // An impact with friction, before it is recorded.
    struct ImpactWithFriction {
        ContactSet landing;
        const ContactRows& rows;
        const FrictionImpactProblem& problem;
        const FrictionImpact& solved;
        std::shared_ptr<const MultiContactInfo> joint;
        std::shared_ptr<const Event::FrictionImpulses> friction;
    };
    bool complete_with_friction(const ImpactWithFriction& impact);
    // Two sliding contacts whose impacts collapse (sliding_collapse.cpp).
    std::optional<SlidingPair> sliding_pair(std::size_t first, std::size_t second);
    bool slides_into_collapse(ContactSet landing);
    std::shared_ptr<CollapseInfo> sliding_collapse_info(ContactSet two);
    bool complete_sliding_collapse(const ImpactWithFriction& impact);
    bool complete_sliding_collapse(const ImpactWithFriction& impact, std::size_t other);
    std::optional<BouncingObstacle> change_at_impact(const ImpactWithFriction& impact) const;
    std::optional<BouncingObstacle> obstacle_to_completion(const ImpactWithFriction& impact);
    std::string obstacle_text() const;
    Exchange exchange_of_cut(const ImpactWithFriction& impact, const Eigen::VectorXd& plastic,
                             const Collision& collision);
    void record_plastic_landing(std::size_t contact, const State& before, double speed);
    std::string name_of(std::size_t contact_or_joint) const;
    ContactSet all_joints() const;
    // ---- jumps, and contacts that count only sometimes (jump.cpp) ----
    // Jumps of the file by number, in its order; watched guards by their own number.
    using Jumps = std::vector<std::size_t>;
    bool has_guards() const { return model_->has_guards(); }
    ContactSet all_watched_guards() const;
    // "the jump 'strike'", or "the latch of 'knee'"
    std::string text_of_guard(std::size_t watched) const;
    // The signs of the guards of the model over the rounding box of the state; 0 where one may vanish.
    int sign_of_guard(std::size_t guard);
    bool does_count(std::size_t contact);
    void start_guards();
    int sign_after_zero(std::size_t watched, Interval rate, EventStart& start);
    ContactSet passing(ContactSet guards, int sign);
    ContactSet falling_jumps();
    ContactSet ending_latches();
    bool may_jump(ContactSet landing, ContactSet falling) const;
    Jumps jumps_after(ContactSet landing, ContactSet falling);
    void locate(ContactSet guards);
    void accept_guard_event(std::size_t event);
    bool impacts_first(std::size_t watched, bool is_known);
    double resolution(const Interval& rate) const;
    double rounding_of_guard(std::size_t watched);
    double closed_within(ContactKinematics& surface, const Contact& contact) const;
    bool is_just_after_jump() const {
        constexpr double few_ulps = 0x1p-46;
        return next_.state.t - last_jump_ <= few_ulps * std::abs(next_.state.t);
    }
    void go_on_in_mode();
    void jump_after_impact(const Jumps& jumps, ContactSet landing, ContactSet opened);
    void jump(const Jumps& jumps, ContactSet landing);
    bool apply_jump(std::size_t number, ContactSet landing);
    bool is_endless(std::size_t jumps);
    void pass(std::size_t contact, double hdot);
    void pass_alone(std::size_t contact, double hdot);
    void count_again(std::size_t contact);
    void update_inactive();
    void decide_uncounted(ContactSet contacts);
    void set_inactive(ContactSet inactive) {
        next_.inactive = inactive;
        record_.set_inactive(inactive);
    }
    // ---- latches, and forces that depend on contact (latch.cpp) ----
    // The mode in which only the latched contacts are held.
    Mode latched_mode() const { return Mode::holding(next_.latched); }
    // A mode in which the contacts that were held at the last event go on acting on the forces: for decisions.
    Mode with_forces_of_now(Mode mode, ContactSet closed) const { return mode.with_acting(acting_.within(closed)); }
    void latch_held();
    void latch_landed(std::size_t contact);
    Exchange add_impulses_of_latched(MultiContactInfo& joint, const Event::FrictionImpulses* friction,
                                     const Vector& dv);
    ContactSet unlatched_by(ContactSet landing) const;
    void unlatch(ContactSet contacts);
    void end_latches(ContactSet contacts);
    void check_held_forces();
    void start_released(ContactSet contacts);
    bool do_forces_see(ContactSet contacts) const { return !contacts.within(model_->equations().in_forces).empty(); }
    // Whether bouncing of this contact may be cut. The conditions of the paper assume that the motion in contact has one
    // and the same acceleration before and after the Zeno point.
    bool may_cut(std::size_t contact) const {
        return !do_forces_see(ContactSet::of(contact)) || run_.options.truncation.conditions == Conditions::sharp;
    }
    // ---- linearly dependent gradients (load_sharing.cpp) ----
    ContactVector<double> rounding_of(const ClosedContacts& closed);
    struct LoadSharing {
        ContactSet places, opening;  // indices in ClosedContacts; other contacts that leave at once
        double least = 0.0;          // smallest force, as a fraction of the largest
        double most = 0.0;           // largest force
    };
    std::vector<LoadSharing> possible_load_sharings(const ClosedContacts& closed, const ContactVector<double>& hddot);
    bool hold_dependent(const ClosedContacts& closed, const ContactVector<double>& hddot, const Complementarity& forces,
                        ContactSet doubted = {});
    bool share(const ClosedContacts& closed, const ContactVector<double>& hddot, const Complementarity& forces);
    void end_sharing();
    double end_of_sharing() const;
    bool hold_load_sharing(const ClosedContacts& closed, const LoadSharing& sharing);
    void hold(Mode mode, ContactSet touching);
    void update_load_sharing_candidates(const ClosedContacts& closed, ContactSet pressed);
    bool is_stuck(const ClosedContacts& closed, ContactSet pressed);
    ContactSet enough_of(const ClosedContacts& closed, const ContactVector<double>& hddot, ContactSet pressed);
    bool continue_without(std::size_t which, const State& state);
    void forget_held() {
        next_.mode = latched_mode();
        next_.touching = next_.load_sharing_candidates = next_.unwatched = next_.unpressed = {};
    }
    void continue_phase();

    StepRequest next_;        // the current state and the next step
    double last_step_ = 0.0;  // s; duration of the last step, which may be only the end of a flight
    State scale_;             // the largest |q|, |v|, |t| so far
    long evaluations_ = 0;
    int stalled_ = 0;  // consecutive steps as short as the resolution of t
    AmbiguityPolicy ambiguity_policy_;
    CertificateScope proof_scope_;  // of certificates that decide a truncation
    RunMonitor* watch_;
    Run run_;
    std::optional<Outcome> outcome_;
    std::shared_ptr<const Model> model_;
    Recorder record_;
    ContactCache* surfaces_;
    SegmentStart beginning_;           // of the current segment, if it may be redone
    std::optional<Event> completion_;  // the Zeno event ahead, after a truncation
    // Truncation conditions for a contact and the held contacts, created when first needed.
    struct ContactConditions {
        std::size_t contact;
        Mode mode;
        ContactSet unpressed;
        ContactState state;  // with friction: whether it slides or sticks at its impacts
        std::unique_ptr<TruncationConditions> conditions;
    };
    std::vector<ContactConditions> all_conditions_;
    struct PairConditionsCache {
        std::size_t first, second;
        Mode mode;  // of the other contacts
        ContactSet unpressed;
        std::unique_ptr<PairConditions> conditions;
    };
    std::vector<PairConditionsCache> all_pairs_;  // the same for pairs
    struct CollapseConditionsCache {
        std::size_t first, second;
        Mode closed;  // in which both are held, or slide
        ContactSet unpressed;
        std::unique_ptr<CollapseConditions> conditions;
    };
    std::vector<CollapseConditionsCache> all_collapses_;
    struct CollapseFailure {
        std::string_view inequality;  // empty: no pair could collapse
        ContactSet pair;
    } collapse_failure_;                          // at the last impact
    std::optional<BouncingObstacle> obstacle_;    // why the bouncing after the last impact with friction goes on
    TruncationConditions* conditions_ = nullptr;  // the entry for which_ in the current mode; null until needed
    std::size_t which_ = 0;                       // the contact of the current event
    bool not_unique_ = false;                     // whether the contact forces are not unique
    std::map<std::size_t, int> slip_roots_;  // order of the zero of u at the start of a segment, by contact or joint
    int friction_events_ = 0;                // sticks, slips and reversals so far
    std::optional<Evaluator<Interval>> guards_;
    std::map<Mode, Evaluator<Interval>> guard_curvatures_;
    std::optional<Evaluator<double>> guard_slopes_;
    ContactSet spent_;          // held contacts whose latch has ended: they latch again only after they have opened
    Mode base_;                 // of a decision: only latched contacts are held, with the forces of now
    ContactSet acting_;         // those that were held when the last event began and act on the forces
    ContactSet below_;          // watched guards that are negative
    ContactSet known_zeros_;    // those whose zero at the state, if there is one, is no event: the state has jumped
    ContactSet located_zeros_;  // those whose zero has been found at the state
    ContactSet located_here_;   // those found at the time located_at_ (s)
    double located_at_ = 0.0;
    long impacts_before_ = 0;  // impacts at the last start of a segment
    int jumps_ = 0;            // so far
    int jumps_at_once_ = 0;    // since time last advanced
    double last_jump_ = 0.0;   // s
    std::size_t jumped_ = 0;   // jumps just recorded, whose mode is not decided yet
    bool has_moved_ = false;   // whether the last jumps changed coordinates
    // Time of the last change of load-bearing contacts (s), and the number of changes at that time.
    double load_sharing_since_ = 0.0;
    int load_sharing_changes_ = 0;
    double cut_error_ = 0.0;       // error of the state by truncations so far, as certified
    double proving_ = 0.0;         // s, wall-clock time of proofs
    int last_sliding_impact_ = 0;  // the last impact of the phase that did not stop the slip
};

}  // namespace achilles
