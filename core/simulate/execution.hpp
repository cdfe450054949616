// The parts of the completed execution that simulate() calls in turn: flight, impact, completion, contact, release.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "certify/truncation.hpp"
#include "simulate/flow.hpp"
#include "simulate/impact.hpp"
#include "simulate/recorder.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

// An instant and a state in words, for messages.
std::string where(double t, const State& state);

class Execution {
 public:
    static constexpr double least_tolerance = 1e-14;  // below that steps are rounding

    // `watch` may be null; otherwise it lives as long as this.
    Execution(std::shared_ptr<const Model> model, const Run& run, Watch* watch, Keep keep);

    // As if it were made anew, for another run of the same parameters, tolerance, method and truncation. False, and
    // nothing is done, where these differ.
    bool restart(const Run& run);

    // Decides how the run starts: in flight, in contact, or at an impact.
    void begin();
    bool running() const { return !outcome_; }
    bool constrained() const { return constrained_; }

    // Free motion to the next impact (or the end time), and that impact: Newton's law, or completion.
    void fly_to_impact();
    // After an impact whose bouncing is cut: motion on the surface to the Zeno point (or the end time).
    bool completing() const { return completion_.has_value(); }
    void wait_for_zeno_point();
    // Motion on the surface until the contact force vanishes (or the end time), and the release.
    void stay_until_release();

    Trajectory finish();

 private:
    friend class SideBySide;

    // How the gap leaves zero at the start of a flight, or of a step of it: h, hdot, and how many of h, hdot, hddot are
    // zero there.
    struct FlightStart {
        Gap gap;
        int multiplicity = 0;
        bool asked_again = false;  // the step before was ended where the gap entered its remainder
    };
    // The same of the contact force in a constrained motion.
    struct ConstrainedStart {
        int known = 0;  // 1 where it starts from zero
        bool asked_again = false;
    };
    // Where a stretch of motion began.
    struct Beginning {
        State state;
        FlightStart flight_start;
        ConstrainedStart constrained_start;
        Recorder::Mark recorded;
        double t, last_step, first_step, state_error;
        int stalled;
    };

    void start_in_contact(const ContactKinematics::Normal& normal);
    Polynomial gap_along();
    bool find_impact();
    bool end_step_at(double theta);
    bool end_step_after(double duration);
    bool land_under();
    bool end_flight();
    bool doubt_gap(double theta);
    bool land_here();
    bool locate_impact(double theta);
    void land();
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
    void complete(const Collision& collision, Certificate certificate);
    void capture(const Collision& collision);
    double contact_until() const;
    bool advance_constrained(double until);
    bool constrained_step(double until);
    Descent force_descent();
    bool doubt_force(double theta);
    bool accept_constrained_step();
    bool locate_release(double theta);
    void release();

    Flow& flow();
    bool knows_its_start() const;
    double state_error() const;
    Beginning beginning() const;
    void go_back(const Beginning& to);
    bool try_exactly(const Beginning& since);
    void settle();
    bool is_cancelled();
    bool advance(double until);
    void accept_step(const Contact& contact);
    void advance_clock(double duration, double t);
    void stop_at(StepFailure failure);
    void fail_projection(double t, const State& state);
    void stop(Outcome::Kind kind, std::string message);

    std::shared_ptr<const Model> model_;
    Watch* watch_;
    Run run_;
    State state_;
    Contact contact_;  // at state_, in flight and where it ends
    Flow flow_;
    Recorder record_;
    std::optional<Event> completion_;  // the Zeno event that the run is on its way to
    std::unique_ptr<Flow> exact_;      // made where a stretch is first in doubt
    std::unique_ptr<TruncationConditions> conditions_;
    ContactKinematics kinematics_;
    double restitution_;
    double t_ = 0.0;
    double last_step_ = 0.0;      // s
    double first_step_ = 0.0;     // of the next flight: the predicted flight; 0: not known
    double proving_ = 0.0;        // s, the clock's
    double cut_error_ = 0.0;      // of the state, by the cuts so far: what is certified at their Zeno times
    long other_evaluations_ = 0;  // than those of the flow since it was made
    FlightStart flight_start_;
    std::optional<Outcome> outcome_;
    std::optional<std::string> doubt_;  // what cannot be told in the stretch that is made
    ConstrainedStart constrained_start_;
    int stalled_ = 0;         // steps in a row that were as short as the resolution of t
    bool exactly_ = false;    // the stretch is made for the second time
    bool asks_again_ = true;  // whether it may be
    bool constrained_ = false;
    bool at_impact_ = false;  // the next flight has length zero: the run starts in a collision
};

}  // namespace achilles
