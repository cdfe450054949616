// The completion of a set: all members bounce to their Zeno points and stay in contact, as a map with its error on both sides
// (theory-enclosure.md 6).
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
    // Of a contact while others are held, of which `unpressed` need no force.
    Completion(const Model& model, const Coordinates& coordinates, std::size_t contact = 0, Mode mode = {},
               ContactSet unpressed = {});

    // What is proved of the bouncing of all members from a collision on.
    struct Proof {
        // The wait until the Zeno point: in at_centre + by_u (u - c_u) for every member, and in `wait` (s).
        Interval wait, at_centre, by_u;
        Interval time;      // tau_inf itself
        double half = 0.0;  // by how much the bounds leave the wait open, s
        double own = 0.0;   // by how much the set does
        // No member waits as long, and none lets go before, nor in the 2^-42nd part of it that follows: so many roundings may
        // be in what it is stepped through by.
        double window = 0.0;
        Intervals error;               // true less comparison motion at tau_inf and until T: q, then v
        Intervals position, velocity;  // on the way
    };
    // Of a set whose v is the tangential velocity and whose u < 0 is the rate at the collision. Nothing where it cannot be
    // proved that all of them bounce to the end.
    std::optional<Proof> prove(const Doubleton& set, const Interval& e);
    // Of such a set: whether what an impact passes on to each held contact, by contact, presses it (theory-gaps.md 2.1): kappa.
    std::map<std::size_t, Interval> passed_on(const Doubleton& set);

 private:
    struct Box;
    bool contain(Box& box, const Interval& e);
    void bound_time(Proof& proof, const Box& box, const Doubleton& set, const Interval& e);
    void bound_error(Proof& proof, const Box& box, const Interval& e);
    Intervals variables(const Box& box) const;

    bool others_stay(const Intervals& box);
    void look(const Intervals& box);  // at the others

    Coordinates z_;
    Layout layout_;
    ContactSet unpressed_;
    std::size_t u_;
    ShadowTerms<Range> hddot_;
    TrendTerms<Evaluator<double>> trend_;
    BouncingRates<Evaluator<double>> rates_;
    // What the other contacts do, of a system that has any.
    const Neighbours* neighbours_ = nullptr;
    Evaluator<Interval> neighbours_program_;
    std::vector<std::uint32_t> neighbours_variables_;
};

}  // namespace achilles
