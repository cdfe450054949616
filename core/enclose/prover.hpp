// A completed execution of all members of a set at once: what simulate/execution.hpp is for one, with proofs in place of
// decisions. Where members would do different things, or nothing is proved, it throws Undecided.
#pragma once

#include <optional>

#include "enclose/completion.hpp"
#include "enclose/enclosure.hpp"
#include "enclose/first_root.hpp"
#include "enclose/maps.hpp"
#include "enclose/section.hpp"
#include "enclose/step.hpp"
#include "number/ground.hpp"

namespace achilles {

class Prover {
 public:
    Prover(const Model& model, const Claim& claim, const Coordinates& coordinates, const Intervals& start,
           ProofWatch* watch, const Ground& ground);
    Enclosure run();

 private:
    // What is known of the state at a time that was asked for: a hull, which holds once all members have passed it.
    struct Asked {
        double time;
        std::optional<EnclosedState> state;
        bool is_known = false;
    };
    void begin();
    void begin_on_surface(const Intervals& start);
    void count_step();
    void move();
    void project();
    void land(const Interval& time);
    void capture(const Interval& time, const Intervals& v_before);
    bool complete(const Interval& time, const Interval& e, double radius);
    Intervals zeno_box(const Step& step, const Interval& tau, const Completion::Proof& proof) const;
    void release(const Interval& time);
    void note_event(Event::Kind kind, const Interval& t, const Intervals& v_before, const Intervals& v_after);

    void cover(const Step& step, const Interval& elapsed);
    void cover(const Interval& times, const Intervals& q, const Intervals& v);
    void settle();
    bool is_over() const;
    double now() const;
    double longest() const;
    Intervals positions(const Intervals& box) const { return part(box, z_.q(0)); }
    Intervals velocities(const Intervals& box) const { return part(box, z_.v(0)); }
    Intervals part(const Intervals& box, std::size_t first) const;
    double largest_radius() const;

    Claim claim_;
    Coordinates z_;
    ProofWatch* watch_;
    Stepper flight_, contact_motion_;
    std::unique_ptr<Maps> maps_;
    Completion completion_;
    Doubleton set_;
    bool in_contact_ = false;
    KnownRoot known_ = KnownRoot::none;
    Interval gap_ = Interval::everything();  // in flight, where no root is known
    int doubts_ = 0;                         // steps in a row that ended before what is not decided
    int bounces_ = 0;                        // since the flight began
    std::vector<Asked> asked_;
    double proved_until_;  // the latest time that no member's was below
    Enclosure result_;
};

}  // namespace achilles
