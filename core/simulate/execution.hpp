// A completed execution as an automaton (Defs. 4 and 5 of the paper): it says which step of smooth motion it needs
// next, is told what came of it, and does what lies between: impacts, completions, releases, the end.
//
//     while (const StepRequest* request = execution.next()) execution.accept(stepper.step(*request));
//
// It flies to an impact, and bounces or, where that is certified, is on its way to the Zeno point, in contact; from
// there it stays in contact until the contact force vanishes, and flies. With several contacts it does so with each, while
// others are held (theory-gaps.md 2); where several are closed at an event, all of them decide what follows.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "certify/pair.hpp"
#include "certify/truncation.hpp"
#include "contacts/complementarity.hpp"
#include "simulate/recorder.hpp"
#include "simulate/simulate.hpp"
#include "simulate/event_stepper.hpp"
#include "simulate/surfaces.hpp"

namespace achilles {

// A state in words, for messages.
std::string where(const State& state);

class Execution {
 public:
    // What follows where a step cannot tell whether an event comes: the same stretch of motion from its beginning,
    // once, as exactly as double precision allows; or the end, undecided.
    enum class InDoubt { ask_exactly, end };

    // At the start of the run, which Model::check() allows: in flight, in contact, or after an impact there.
    // `surfaces` are of the same model and run; they and `watch`, which may be null, outlive this.
    Execution(std::shared_ptr<const Model> model, const Run& run, Surfaces& surfaces, Watch* watch, Keep keep,
              InDoubt in_doubt);

    // As if it were made anew, for another run of the same tolerance, method and truncation, whose parameters differ at most in
    // what restitutions alone depend on. False, and nothing is done, where one of the first differs.
    bool restart(const Run& run);

    // The step that is needed; null once the run is over: at its end time, at a bound on what it may take, cancelled,
    // or by what accept() was told. It stands until accept(), and until then next() says the same.
    const StepRequest* next();

    // Takes what came of the last request: the motion stands at the result's state, and then
    //     no_event        goes on from there
    //     impact          goes on by Newton's law, or in contact to the Zeno point, where that is certified
    //     force_vanishes  goes on without that contact, where h''' > 0 is proved
    //     doubt           is put back to where its stretch began and asked for exactly, if that may be; else it ends
    //     off_surface, no_step    ends
    // Where an event cannot be decided, it ends as well. Ended, the run has an outcome and next() is null.
    void accept(const StepResult& result);

    // Whether the run is on its way to a Zeno point: in contact, for bouncing that was cut.
    bool completing() const { return completion_.has_value(); }
    const Run& run() const { return run_; }

    // What was recorded, once next() has nothing left to ask.
    Trajectory finish();
    // There is no memory for what comes next: the run ends with what was recorded.
    void run_out_of_memory();

 private:
    // Where a stretch of motion began.
    struct Beginning {
        StepRequest next;
        Recorder::Mark recorded;
        double last_step;
        int stalled;
    };

    void begin();
    void start_at_rest(ContactSet resting);
    bool is_time_left() const;
    bool is_cancelled();
    void note_beginning();
    double state_error() const;
    void advance(const StepResult& result);
    void begin_stretch(Mode mode, double until);
    void change_rates(const Vector& v_before, ContactSet but) {
        if (surfaces_->count() > 1) change_other_rates(v_before, but);
    }
    void change_other_rates(const Vector& v_before, ContactSet but);
    void note_scale();
    bool may_ask_exactly() const;
    void ask_exactly();
    std::string doubt(const StepResult& result) const;
    void stop_at(StepFailure failure);
    void fail_projection();
    void stop(Outcome::Kind kind, std::string message);

    // At events.
    void land(std::size_t which, const Contact& contact);
    void land_alone(const Contact& contact);
    // What the impact does to the energy, also by what it passes on to held contacts.
    Exchange exchange_of(const Contact& contact, double e) {
        const Exchange own = exchange(contact, e);
        return next_.mode.is_free() ? own : exchange_beside(contact, e, own);
    }
    Exchange exchange_beside(const Contact& contact, double e, Exchange own);
    double restitution(std::size_t contact) const { return surfaces_->restitution(contact).value; }
    ContactKinematics& kinematics() { return surfaces_->of(which_, next_.mode); }
    // What some work gives; its time counts as that of proofs.
    template <class Work>
    auto timed(const Work& work) {
        const auto clock = std::chrono::steady_clock::now();
        auto result = work();
        proving_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
        return result;
    }
    bool could_truncate(const Collision& collision);
    std::optional<Certificate> prove(std::optional<Certificate> (TruncationConditions::*question)(const Collision&),
                                     const Collision& collision);
    void bounce(const Contact& contact, double e);
    bool is_well_resolved(double speed) const;
    bool too_short_to_resolve(const Collision& collision, double e);
    void complete(const Contact& contact, const Collision& collision, Certificate certificate);
    void capture(const Contact& contact, const Collision& collision);
    void pass_zeno_point();
    void release(std::size_t which);
    void leave(ContactSet contacts);
    void enter_phase();
    void enter_or_stay();
    // Where several contacts are closed (several.cpp).
    std::optional<ContactSet> landing_with(std::size_t which, const Contact& contact);
    bool is_order_independent(ContactSet landing);
    double rounding_so_far(const Contact& contact) const;
    bool stays_held(std::size_t which, const Contact& contact);
    bool is_pressed(const Closed& closed, ContactSet held, const State& state);
    double plastic_work(const State& before, ContactSet contacts);
    void collide(ContactSet landing);
    bool complete_pair(ContactSet landing, const Vector& v_after, bool below_rounding);
    bool complete_pair(std::size_t first, std::size_t second, Mode others, ContactSet landing, const Vector& v_after,
                       bool below_rounding);
    bool too_short_to_resolve(std::size_t which, double hdot);
    void decide(ContactSet closed, ContactSet vanishing = {});
    ContactVector<double> accelerations(const Closed& closed);
    bool judge(ContactSet closed, ContactSet active, ContactSet vanishing);
    bool judge(ContactSet closed, ContactSet active, ContactSet vanishing, ContactSet unpressed);
    ContactSet vanishing_with(std::size_t which);
    ContactSet pressed_by_rates(ContactSet doubtful, Mode mode);
    bool needs_no_force(std::size_t contact, Mode mode) {
        return surfaces_->needs_no_force(contact, mode.without(contact), next_.state, scale_);
    }
    ContactSet unpressed_of(ContactSet contacts, Mode mode);
    ContactSet always_unpressed(Mode mode);
    ContactSet unpressed_among(ContactSet closed, ContactSet active);
    bool is_chatter() const;
    bool moves_within_rounding(std::size_t which, double speed);
    void end_chatter(ContactSet contacts);
    bool stays_closed(std::size_t contact, Mode mode);
    bool is_at_rest(Mode mode);
    void check_touching();
    std::string names_of(ContactSet contacts) const;
    // Where gradients of closed contacts depend on one another (carriers.cpp).
    ContactVector<double> rounding_of(const Closed& closed);
    struct Carriers {
        ContactSet places, opening;  // in what is closed; others that leave at once
        double least = 0.0;          // of their forces, as a part of the largest,
        double most = 0.0;           // this
    };
    std::vector<Carriers> carriers_of(const Closed& closed, const ContactVector<double>& hddot);
    bool hold_dependent(const Closed& closed, const ContactVector<double>& hddot, const Complementarity& forces,
                        ContactSet doubted = {});
    bool share(const Closed& closed, const ContactVector<double>& hddot, const Complementarity& forces);
    void end_sharing();
    double end_of_sharing() const;
    bool carry(const Closed& closed, const Carriers& carriers);
    void hold(Mode mode, ContactSet touching);
    void note_carried(const Closed& closed, ContactSet pressed);
    bool is_stuck(const Closed& closed, ContactSet pressed);
    ContactSet enough_of(const Closed& closed, const ContactVector<double>& hddot, ContactSet pressed);
    bool carry_on_without(std::size_t which, const State& state);
    void forget_held() {
        next_.mode = {};
        next_.touching = next_.carried = next_.unwatched = next_.unpressed = {};
    }
    void carry_on();

    StepRequest next_;        // where the motion stands, and how it goes on
    double last_step_ = 0.0;  // s
    State scale_;             // the largest |q|, |v|, |t| so far
    long evaluations_ = 0;
    int stalled_ = 0;  // steps in a row that were as short as the resolution of t
    InDoubt in_doubt_;
    Watch* watch_;
    Run run_;
    std::optional<Outcome> outcome_;
    std::shared_ptr<const Model> model_;
    Recorder record_;
    Surfaces* surfaces_;
    Beginning beginning_;              // of the stretch, where it may be asked for again
    std::optional<Event> completion_;  // the Zeno event that the run is on its way to
    // The truncation conditions of contacts while others are held, those met so far.
    struct OfContact {
        std::size_t contact;
        Mode mode;
        ContactSet unpressed;
        std::unique_ptr<TruncationConditions> conditions;
    };
    std::vector<OfContact> all_conditions_;
    struct PairOf {
        std::size_t first, second;
        Mode mode;  // of the others
        ContactSet unpressed;
        std::unique_ptr<PairConditions> conditions;
    };
    std::vector<PairOf> all_pairs_;               // the same of two contacts
    TruncationConditions* conditions_ = nullptr;  // of them, those of which_; null: not met yet
    std::size_t which_ = 0;                       // the contact whose event this is
    bool not_unique_ = false;                     // the forces that hold what is held could be shared otherwise
    double carriers_since_ = 0.0;                 // s; who carries was last changed then, and so often at that time
    int changes_of_carriers_ = 0;
    double cut_error_ = 0.0;  // of the state, by the cuts so far: what is certified at their Zeno times
    double proving_ = 0.0;    // s, the clock's
};

}  // namespace achilles
