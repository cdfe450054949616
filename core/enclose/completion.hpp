// Completion of a set: proves that all members bounce to their Zeno points and stay in contact, and gives this as a map
// with two-sided error bounds (theory-enclosure.md 6).
#pragma once

#include <map>
#include <optional>

#include "certify/range.hpp"
#include "certify/truncation.hpp"
#include "enclose/doubleton.hpp"
#include "model/model.hpp"

namespace achilles {

class Completion {
 public:
    // For a contact while others are held; those in `unpressed` need no contact force.
    Completion(const Model& model, const Coordinates& coordinates, std::size_t contact = 0, Mode mode = {},
               ContactSet unpressed = {});

    // Bounds on the bouncing of all members after a collision.
    struct CompletionProof {
        // The accumulation time (s) of every member: in at_center + by_u (u - c_u), and in `accumulation_time`.
        Interval accumulation_time, at_center, by_u;
        Interval time;      // tau_inf
        double half = 0.0;  // half width of the accumulation time that the bounds leave, s
        double own = 0.0;   // half width of tau_inf by the size of the set, s
        // Upper bound on the accumulation time of every member (s). No member is released before it, nor within a
        // further 2^-42 of it, which leaves room for the rounding of step lengths.
        double window = 0.0;
        Intervals error;               // true minus comparison motion, from tau_inf to T: q, then v
        Intervals position, velocity;  // during the bouncing
    };
    // For a set whose v is the tangential velocity and whose u < 0 is the gap rate at the collision. Returns nullopt if
    // it is not proved that all members bounce to the end.
    std::optional<CompletionProof> prove(const Doubleton& set, const Interval& e);
    // For such a set: kappa of each held contact, by which it receives the impulses of an impact (theory-gaps.md 2.1).
    // It is pressed if kappa >= 0.
    std::map<std::size_t, Interval> passed_on(const Doubleton& set);

 private:
    struct Box;
    bool contain(Box& box, const Interval& e);
    void bound_time(CompletionProof& proof, const Box& box, const Doubleton& set, const Interval& e);
    void bound_error(CompletionProof& proof, const Box& box, const Interval& e);
    Intervals variables(const Box& box) const;

    bool other_contacts_stay(const Intervals& box);
    void evaluate_other_contacts(const Intervals& box);  // evaluates other_contact_program_

    Coordinates z_;
    Layout layout_;
    ContactSet unpressed_;
    std::size_t u_;
    ShadowTerms<Range> hddot_;
    TrendTerms<Evaluator<double>> trend_;
    BouncingRates<Evaluator<double>> rates_;
    // Conditions on the other contacts, if the system has any.
    const OtherContactTerms* other_contact_terms_ = nullptr;
    Evaluator<Interval> other_contact_program_;
    std::vector<std::uint32_t> other_contact_variables_;
};

}  // namespace achilles
