// One validated Taylor step of a set of states (theory-enclosure.md 2): for every member z and every tau in [0, length]
//     z(tau) = T(tau, c) + S(tau) (z - c) + rho,    S in the derivatives of T over the hull,  rho in R tau^(K+1)
#pragma once

#include <memory>

#include "contacts/contact_law.hpp"
#include "enclose/doubleton.hpp"
#include "model/model.hpp"
#include "series/series.hpp"

namespace achilles {

// The Taylor coefficients of a motion at a point, or over a box of states with or without derivatives.
class Expansion {
 public:
    virtual ~Expansion() = default;
    // Expands over a box of all coordinates: hddot to the orders 0 .. last, q and v to 0 .. last + 1.
    virtual void expand(const Intervals& box, int last) = 0;
    // Coefficient k of row i: q and v, then hddot of each contact.
    virtual Interval value(int k, std::size_t i) const = 0;
    // Its derivative by variable j of Coordinates::of_motion().
    virtual Interval slope(int k, std::size_t i, std::size_t j) const = 0;
    // Whether M is proved positive definite on the box.
    virtual bool has_mass() = 0;
};

// At a point, the numbers are Fine: a step then loses only the rounding of its end there.
enum class ExpansionMode { point, box, box_with_derivatives };
// `series` is that of Model::hddot_series() and must outlive the result.
std::unique_ptr<Expansion> make_expansion(const SeriesProgram& series, const Coordinates& coordinates,
                                          ExpansionMode what);

// Number of leading coefficients of h that are exactly 0 in every member: h after an impact; h and hdot after contact
// with hddot > 0; h, hdot and hddot after a release.
enum class KnownRoot { none = 0, landed = 1, at_rest = 2, released = 3 };

// Information about an open contact's gap at the start of a step, in addition to the set: its known root, or a bound
// that may be narrower than the set's.
struct OpenGapBound {
    KnownRoot known = KnownRoot::none;
    Interval gap = Interval::everything();
};

class EnclosureStep {
 public:
    double length() const { return length_; }
    // T, its derivative, S and rho for all coordinates; 0 <= tau <= length.
    Intervals center_at(const Interval& tau) const;
    Intervals rate_at(const Interval& tau) const;
    IntervalMatrix slope_at(const Interval& tau) const;
    Intervals remainder_at(const Interval& tau) const;
    // A box that contains all members at all these times.
    Intervals box_over(const Doubleton& set, const Interval& tau) const;
    // Advances all members by exactly this time (s).
    void advance(Doubleton& set, double tau) const;
    // Coefficients of the function that the law of a contact watches, over all members; the last one is that of the
    // remainder. It is positive until the next event: the gap divided by its known root, or for the force -hddot in the
    // mode in which the contact is open.
    const Intervals& watched(std::size_t contact) const { return watched_[contact]; }

 private:
    friend class EnclosureStepper;
    const Interval* coefficients(const Intervals& table, int k) const {
        return table.data() + static_cast<std::size_t>(k) * size_;
    }
    Intervals along(const Intervals& table, const Interval& tau) const;

    std::size_t size_ = 0;
    double length_ = 0.0;
    // By order, a row with all coordinates: at the center, over the hull, and the derivatives over the hull.
    Intervals center_, hull_;
    std::vector<IntervalMatrix> slopes_;
    Intervals remainder_;             // R
    std::vector<Intervals> watched_;  // by contact
};

class EnclosureStepper {
 public:
    static constexpr int order = 20;  // K

    // A stepper for the motion in this mode.
    EnclosureStepper(const Model& model, const Coordinates& coordinates, Mode mode);

    // Makes a step of at most `longest` (s); `openings` has an entry for each contact. Throws ProofStopped if no
    // a-priori box is found.
    EnclosureStep make(const Doubleton& set, double longest, const std::vector<OpenGapBound>& openings);
    // Removes the limit that the last step sets to the length of the next.
    void forget() { last_ = 0.0; }

 private:
    void tabulate(EnclosureStep& step, const Doubleton& set, const std::vector<OpenGapBound>& openings);
    // Enclosures of the coefficients in time of the function whose zero is the event of this contact: the gap if it is
    // open, -hddot of the mode without it if it is held.
    Intervals watch(const EnclosureStep& step, const Doubleton& set, std::size_t contact,
                    const OpenGapBound& opening) const;
    Intervals watch_gap(const EnclosureStep& step, const Doubleton& set, std::size_t contact,
                        const OpenGapBound& opening) const;
    Intervals watch_force(const Doubleton& set, std::size_t contact) const;
    bool keeps_gap(std::size_t contact) const { return law_of(mode_.state(contact)).kept == Constraint::gap; }
    std::size_t event(std::size_t contact) const { return 2 * coordinates_.dof + contact; }  // the row of its hddot
    bool enclose(EnclosureStep& step, const Intervals& hull, double length);
    double first_length(const Doubleton& set, const Intervals& hull, double longest) const;
    std::vector<double> scales(const Intervals& hull, double length) const;

    Coordinates coordinates_;
    Mode mode_;
    std::vector<std::size_t> variables_;
    std::unique_ptr<Expansion> at_center_, over_hull_, over_box_;
    double last_ = 0.0;  // s
};

}  // namespace achilles
