// A completed execution of all members of a set at once: what simulate/execution.hpp is for one, with proofs in place of
// decisions. Where members would do different things, or nothing is proved, it throws Undecided.
#pragma once

#include <map>
#include <optional>

#include "enclose/completion.hpp"
#include "enclose/enclosure.hpp"
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
    // What happens next to one of the contacts, and until when nothing does.
    struct Next {
        std::optional<std::size_t> contact;
        Interval elapsed;
        double clear;
        std::string doubt;
    };
    void begin();
    void begin_on_surface(const Intervals& start, std::size_t contact);
    void measure_others(ContactSet but);
    void count_step();
    void move();
    double longest_step();
    Next next_in(const Step& step) const;
    void pass(const Step& step, const Interval& elapsed);
    void project(std::size_t contact);
    void retract(Mode onto);
    ContactSet opened_by(std::size_t contact);
    void check_opened(ContactSet opened);
    Section section_of(std::size_t contact, WatchedFunction watched);
    void happen(Transition transition, std::size_t contact, const Interval& time);
    void land(std::size_t contact, const Interval& time);
    void capture(std::size_t contact, const Interval& time, const Intervals& v_before, ContactSet opened);
    bool complete(std::size_t contact, const Interval& time, const Interval& e, double radius);
    Intervals zeno_box(std::size_t contact, const Step& step, const Interval& tau,
                       const Completion::Proof& proof) const;
    void release(std::size_t contact, const Interval& time);
    void enter(Mode mode);
    void note_event(Event::Kind kind, std::size_t contact, const Interval& t, const Intervals& v_before,
                    const Intervals& v_after);

    // Of the mode, and of a contact in the mode in which it is open.
    Stepper& motion();
    Maps& maps(std::size_t contact);
    Completion& completion(std::size_t contact);

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

    const Model* model_;
    Claim claim_;
    Coordinates z_;
    ProofWatch* watch_;
    Intervals restitutions_;  // of each contact, over the claim
    std::map<Mode, std::unique_ptr<Stepper>> motions_;
    std::map<ContactInMode, std::unique_ptr<Maps>> maps_;
    std::map<std::pair<ContactSet, ContactInMode>, std::unique_ptr<Completion>> completions_;  // by the unpressed ones
    Doubleton set_;
    Mode mode_;
    ContactSet unpressed_;           // of the held ones, those that need no force (theory-gaps.md 2.7)
    std::vector<Opening> openings_;  // by contact
    std::size_t last_ = 0;           // contact of which there was an event
    int doubts_ = 0;                 // steps in a row that ended before what is not decided
    std::vector<int> bounces_;       // of each contact since its flight began
    std::vector<Asked> asked_;
    double proved_until_;  // the latest time that no member's was below
    Enclosure result_;
};

}  // namespace achilles
