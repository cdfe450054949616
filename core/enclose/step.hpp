// One validated Taylor step of a set of states (theory-enclosure.md 2): for every member z and every tau in [0, length]
//     z(tau) = T(tau, c) + S(tau) (z - c) + rho,    S in the derivatives of T over the hull,  rho in R tau^(K+1)
#pragma once

#include <memory>

#include "contacts/contact_law.hpp"
#include "enclose/doubleton.hpp"
#include "model/model.hpp"
#include "series/series.hpp"

namespace achilles {

// The Taylor coefficients of a motion at a point, over a box of states, or with their derivatives.
class Expansion {
 public:
    virtual ~Expansion() = default;
    // Of hddot the orders 0 .. last, of q and v 0 .. last + 1, over a box of all coordinates.
    virtual void expand(const Intervals& box, int last) = 0;
    // Order k of row i: q and v, then hddot of each contact.
    virtual Interval value(int k, std::size_t i) const = 0;
    // Its derivative by variable j of Coordinates::of_motion().
    virtual Interval slope(int k, std::size_t i, std::size_t j) const = 0;
    // M is positive definite all over the box.
    virtual bool has_mass() = 0;
};

// At a point the numbers are Fine, so that what a step loses there is the rounding of its end alone.
enum class Expanded { at_a_point, over_a_box, with_derivatives };
// `series` is that of Model::hddot_series() and outlives the result.
std::unique_ptr<Expansion> make_expansion(const SeriesProgram& series, const Coordinates& coordinates, Expanded what);

// Which of the orders of h that lead are exactly 0 in every member: h and hdot after an impact or a take-off, hddot besides
// after a release.
enum class KnownRoot { none = 0, landed = 1, at_rest = 2, released = 3 };

// What is known of an open contact's gap where a step starts, besides the set: its root, or where it has none a bound, which may
// be narrower than what the set says.
struct Opening {
    KnownRoot known = KnownRoot::none;
    Interval gap = Interval::everything();
};

class Step {
 public:
    double length() const { return length_; }
    // T, its derivative, S and rho of all coordinates; 0 <= tau <= length.
    Intervals centre_at(const Interval& tau) const;
    Intervals rate_at(const Interval& tau) const;
    IntervalMatrix slope_at(const Interval& tau) const;
    Intervals remainder_at(const Interval& tau) const;
    // A box around all members at all these times.
    Intervals box_over(const Doubleton& set, const Interval& tau) const;
    // The members after exactly this time.
    void advance(Doubleton& set, double tau) const;
    // What the law of a contact watches: it must stay positive until the next event, over all members, the last
    // coefficient the remainder's. The gap with the known root divided out, or, for the force, -hddot of the mode in
    // which it is open.
    const Intervals& watched(std::size_t contact) const { return watched_[contact]; }

 private:
    friend class Stepper;
    const Interval* coefficients(const Intervals& table, int k) const {
        return table.data() + static_cast<std::size_t>(k) * size_;
    }
    Intervals along(const Intervals& table, const Interval& tau) const;

    std::size_t size_ = 0;
    double length_ = 0.0;
    // By order: a row of each coordinate; at the centre, over the hull, and its derivatives by all coordinates over the hull.
    Intervals centre_, hull_;
    std::vector<IntervalMatrix> slopes_;
    Intervals remainder_;             // R
    std::vector<Intervals> watched_;  // by contact
};

class Stepper {
 public:
    static constexpr int order = 20;  // K

    // Of the motion in this mode.
    Stepper(const Model& model, const Coordinates& coordinates, Mode mode);

    // A step that is at most so long; `openings` by contact. Throws Undecided where no a-priori box is found.
    Step make(const Doubleton& set, double longest, const std::vector<Opening>& openings);
    // The next step may be as long as it likes.
    void forget() { last_ = 0.0; }

 private:
    void tabulate(Step& step, const Doubleton& set, const std::vector<Opening>& openings);
    Intervals watch(const Step& step, const Doubleton& set, std::size_t contact, const Opening& opening) const;
    Intervals watch_gap(const Step& step, const Doubleton& set, std::size_t contact, const Opening& opening) const;
    Intervals watch_force(const Doubleton& set, std::size_t contact) const;
    bool keeps_gap(std::size_t contact) const { return law_of(mode_.state(contact)).kept == Constraint::gap; }
    std::size_t event(std::size_t contact) const { return 2 * coordinates_.dof + contact; }  // the row of its hddot
    bool enclose(Step& step, const Intervals& hull, double length);
    double first_length(const Doubleton& set, const Intervals& hull, double longest) const;
    std::vector<double> scales(const Intervals& hull, double length) const;

    Coordinates coordinates_;
    Mode mode_;
    std::vector<std::size_t> variables_;
    std::unique_ptr<Expansion> at_centre_, over_hull_, over_box_;
    double last_ = 0.0;  // s
};

}  // namespace achilles
