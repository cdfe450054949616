// Proves the completed execution of all members of a set at once: like simulate/execution.hpp, with proofs in place of
// decisions. Throws ProofStopped if members would behave differently, or if nothing can be proved.
#pragma once

#include <map>
#include <optional>

#include "enclose/completion.hpp"
#include "enclose/crossing_surface.hpp"
#include "enclose/enclosure.hpp"
#include "enclose/event_maps.hpp"
#include "enclose/step.hpp"
#include "number/float_environment.hpp"

namespace achilles {

class Prover {
 public:
    Prover(const Model& model, const EnclosureProblem& claim, const Coordinates& coordinates, const Intervals& start,
           ProofMonitor* watch, const FloatEnvironmentGuard& ground);
    Enclosure run();

 private:
    // The state at a requested time: a hull, which is complete once all members have passed that time.
    struct SampleRequest {
        double time;
        std::optional<EnclosedState> state;
        bool is_known = false;
    };
    // The next event of all members of the set. Times are elapsed since the start of the step, in s.
    struct NextEvent {
        std::optional<std::size_t> contact;  // nullopt if no event is proved to come first
        Interval elapsed;                    // time of the event
        double clear;                        // until then no member has an event
        std::string doubt;                   // why the step cannot decide; "" if it can
    };
    void begin();
    void begin_on_surface(const Intervals& start, std::size_t contact);
    void measure_other_gaps(ContactSet but);
    void count_step();
    void move();
    double longest_step();
    NextEvent next_in(const EnclosureStep& step) const;
    void pass(const EnclosureStep& step, const Interval& elapsed);
    void project(std::size_t contact);
    void retract(Mode onto);
    ContactSet opened_by(std::size_t contact);
    void check_opened(ContactSet opened);
    CrossingSurface section_of(std::size_t contact, WatchedFunction watched);
    void handle_event(Transition transition, std::size_t contact, const Interval& time);
    void land(std::size_t contact, const Interval& time);
    void capture(std::size_t contact, const Interval& time, const Intervals& v_before, ContactSet opened);
    bool complete(std::size_t contact, const Interval& time, const Interval& e, double radius);
    Intervals zeno_box(std::size_t contact, const EnclosureStep& step, const Interval& tau,
                       const Completion::CompletionProof& proof) const;
    void release(std::size_t contact, const Interval& time);
    void enter(Mode mode);
    void note_event(Event::Kind kind, std::size_t contact, const Interval& t, const Intervals& v_before,
                    const Intervals& v_after);

    // The programs of the current mode, and those of a contact in the mode in which it is open.
    EnclosureStepper& motion();
    EventMaps& maps(std::size_t contact);
    Completion& completion(std::size_t contact);

    void cover(const EnclosureStep& step, const Interval& elapsed);
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
    EnclosureProblem claim_;
    Coordinates z_;
    ProofMonitor* watch_;
    Intervals restitutions_;  // of each contact, over the claim
    std::map<Mode, std::unique_ptr<EnclosureStepper>> motions_;
    std::map<ContactInMode, std::unique_ptr<EventMaps>> maps_;
    std::map<std::pair<ContactSet, ContactInMode>, std::unique_ptr<Completion>> completions_;  // and by unpressed_
    Doubleton set_;
    Mode mode_;
    ContactSet unpressed_;                // held contacts that need no force (theory-gaps.md 2.7)
    std::vector<OpenGapBound> openings_;  // by contact
    std::size_t last_ = 0;                // contact of the last event
    int doubts_ = 0;                      // consecutive steps shortened to before an undecided event
    std::vector<int> bounces_;            // of each contact since its flight began
    std::vector<SampleRequest> sample_requests_;
    double proved_until_;  // s; all members have reached this time
    Enclosure result_;
};

}  // namespace achilles
