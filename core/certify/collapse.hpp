// Proves how long two contacts with W_12 < 0 bounce in turn until both have lost their speeds, and how far the motion
// that holds both is from theirs (theory-collapse.md 3). No force needs to press them.
#pragma once

#include "certify/two_contacts.hpp"
#include "contacts/collapse.hpp"

namespace achilles {

// Enclosures over a neighborhood, in units in which W_11 = W_22 = 1 at the cut.
struct AlternationBounds {
    std::array<Interval, 2> k, e;  // only the lower ends of k are used
    Interval acceleration;         // encloses |hddot|; only its upper end is used
};
// The pair just after an impact of contact `landed`, at the approach speed u. The other one approaches at the speed v;
// its gap is H.
struct AlternationStart {
    std::size_t landed;
    Interval u, v, H;
};
// Upper bound T (s) on the time until both are at rest, and the product q q' < 1 of the factors of two flight times.
struct CollapseTime {
    Interval T;
    double contraction;
};
// Returns nullopt and the name of the inequality that fails (contacts/collapse.hpp) if nothing is proved.
std::optional<CollapseTime> collapse_time(const AlternationBounds& bounds, const AlternationStart& start,
                                          std::string_view& failed);

class CollapseConditions : private TwoContactConditions {
 public:
    using TwoContactConditions::set_states;
    // As for TwoContactConditions. Two contacts may slide, each with one sign, while nothing else is held.
    CollapseConditions(const Model& model, const Run& run, const std::array<Interval, 2>& e, std::size_t first,
                       std::size_t second, Mode closed, ContactSet unpressed, const FloatEnvironmentGuard& ground);

    // `collision.before` is the state after an impact of the contact `landed` (0 or 1), at approach speed `speed`.
    struct CollapseStart {
        PairCollision collision;
        std::size_t landed;
        double speed;
    };
    // The certificate for a truncation at this impact, and the state after it. nullopt if the proof fails or its bounds
    // exceed the tolerances of the run; `failed` is then the inequality. With `cut_at_resolution` the tolerances do not
    // matter: time or position cannot resolve the flights any more.
    std::optional<PairCompletion> certify(const CollapseStart& start, bool cut_at_resolution, std::string_view& failed);

 private:
    // The terms at the cut that do not change with the box. Gaps have the units `size`, and impulses the units in which W
    // at the cut is nearly W0, with W0_11 = W0_22 = 1 and W0_12 = W0_21 (theory-collapse.md 3).
    struct AtCut {
        PairLaw<double> law;
        std::array<Interval, 2> size, impulse;
        PairMatrix W0;
        Interval r0;  // sqrt(sigma' W0^-1 sigma)
    };
    Interval W(std::size_t k, std::size_t l) const { return has_skew_ && k > l ? terms_.W_10() : terms_.W(k, l); }
    std::optional<AtCut> at_cut(const PairCollision& collision, const State& tangential);
    std::optional<MotionBounds> bounds_over(const PairBox& box, const AtCut& cut, const CollapseStart& start,
                                            std::string_view& failed);
    bool decides_who_stays(const PairBox& box, bool& both_held);
    bool keeps_sliding(const PairBox& box, const AtCut& cut);

    bool has_skew_;        // the contacts slide, and W is not symmetric
    std::size_t sliding_;  // contacts with friction
    std::optional<Evaluator<Interval>> slips_;
    double contraction_ = 0.0;  // q q' of the last bounds
};

}  // namespace achilles
