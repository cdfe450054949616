// Maps of a set at events, with their derivatives over the hull (theory-enclosure.md 5), and contact quantities over a
// box of states.
#pragma once

#include <memory>

#include "enclose/doubleton.hpp"
#include "model/model.hpp"

namespace achilles {

class EventMaps {
 public:
    virtual ~EventMaps() = default;
    // h := h(q), u := hdot(q, v).
    virtual void measure_gap(Doubleton& set) = 0;
    // v -= n u; u of this contact is unchanged.
    virtual void take_rate_out(Doubleton& set) = 0;
    // Newton's impact law for members with h = 0: v -= (1 + e) n u, u := -e u; the rates of other open gaps are
    // updated.
    virtual void impact(Doubleton& set) = 0;
    // q -= n (h(q) - h), then v -= n (hdot(q, v) - u), the identity on all members. It removes the part of the set
    // where h and u are not the gap and gap rate of (q, v), which no member occupies.
    virtual void project(Doubleton& set) = 0;
    // The same for members with h = hdot = 0, whatever u is: q -= n h(q), v -= n hdot(q, v).
    virtual void retract(Doubleton& set) = 0;

    // Over a box of all coordinates: hddot and its derivatives; h''' along the constrained motion.
    struct GapAcceleration {
        Interval hddot, jerk;
        Intervals slope;
    };
    virtual GapAcceleration normal(const Intervals& box) = 0;
    struct GapValues {
        Interval h, hdot;
        Intervals n, gradient;
    };
    virtual GapValues surface(const Intervals& box) = 0;
};

// The maps of a contact while others are held; n keeps these held.
std::unique_ptr<EventMaps> make_maps(const Model& model, const Coordinates& coordinates, std::size_t contact = 0,
                                     Mode mode = {});

}  // namespace achilles
