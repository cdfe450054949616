// The contacts of one run: their quantities in any mode, and several of them at once.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "contacts/delassus.hpp"
#include "model/unpressed.hpp"
#include "simulate/impact.hpp"
#include "simulate/mode_kinematics.hpp"

namespace achilles {

// Closed contacts at one state, in ascending order, with their Delassus matrix; simultaneous impacts are solved from
// them.
struct ClosedContacts {
    std::vector<std::size_t> which;
    std::vector<Contact> contacts;
    ContactMatrix<double> W;

    // Conversion of contacts to places in `which`, and back.
    ContactSet places_of(ContactSet contacts) const;
    ContactSet contacts_at(ContactSet places) const;
    ContactVector<double> rates() const;  // hdot
    // v + M^-1 G' p
    Vector after(const Vector& v, const ContactVector<double>& impulses) const;
};

// The slip of a contact or joint at one state (SlipTerms).
struct Slip {
    double u = 0.0, c = 0.0, udot = 0.0;
    double coefficient = 0.0, static_coefficient = 0.0;  // the first at the given speed
    Vector d, impulse;
};

// Gaps and slips at one state: the rows of G and D, the accelerations of the coordinates by unit forces along them, and
// the matrix W of all rows (theory-friction.md 2). The gaps come first, each in ascending order of the contacts.
struct ContactRows {
    struct Row {
        std::size_t which;  // contact or joint
        bool is_slip;
        double rate, drift, acceleration;  // hdot or u; dh/dt or c; hddot or udot in the mode
        Vector gradient, impulse;
    };
    std::vector<Row> rows;
    Eigen::MatrixXd W;
    std::map<std::size_t, Slip> slips;  // those in `rows`, with coefficients at the speeds of the state

    Eigen::Index size() const { return static_cast<Eigen::Index>(rows.size()); }
    Eigen::Index gap_of(std::size_t contact) const { return find(contact, false); }
    Eigen::Index slip_of(std::size_t which) const { return find(which, true); }  // -1 if there is none
    // v + M^-1 (G' p + D' p_T)
    Vector after(const Vector& v, const Eigen::VectorXd& impulses) const;

 private:
    Eigen::Index find(std::size_t which, bool is_slip) const;
};

// The energy balance of an impact with friction: normal impulses dissipate by restitution, tangential ones turn energy
// into heat, and both move surfaces.
Exchange energy_of_impact(const ContactRows& rows, const Eigen::VectorXd& impulses);

class ContactCache {
 public:
    ContactCache(const Model& model, const Run& run);

    std::size_t count() const { return free_.size(); }
    // The run, for all that belong to it and do not outlive this.
    const Run& run() const { return run_; }
    const Restitution& restitution(std::size_t contact) const { return restitutions_[contact]; }
    // Takes the restitutions of another run, whose other parameters must be the same.
    void bounce_as(const Run& run) {
        restitutions_ = model_->restitutions(run.parameters);
        for (ContactKinematics& contact : free_) contact.begin_run();
    }
    // A contact while all are open, and in a mode in which it is open.
    ContactKinematics& of(std::size_t contact) { return free_[contact]; }
    ContactKinematics& of(std::size_t contact, Mode mode);

    // The event functions of a mode.
    ModeKinematics& motion(Mode mode);
    // The slip in a mode in which the contact or joint is open; coefficients at this speed, or at |u|.
    Slip slip(std::size_t which, const State& state, Mode mode = {}, std::optional<double> speed = {});
    // Error bound of u over the rounding box of a state.
    double slip_error(std::size_t which, const State& state) { return rad(slip_at_rest(which, state).u()); }
    // Coefficients over that box: at the present |u|, at |u| = 0, and of sticking.
    struct FrictionLevels {
        Interval present, at_rest, sticking;
        // Whether they may be in the domain of the law: 0 <= mu, mu(0) <= mu_s.
        bool are_allowed() const { return !certainly_negative(present) && !certainly_less(sticking, at_rest); }
    };
    FrictionLevels friction_levels(std::size_t which, const State& state);
    // The gaps of these contacts and the slips of those among `sliding`, contacts and joints. Accelerations are those
    // of the mode, in which they are all open.
    ContactRows rows(const State& state, ContactSet gaps, ContactSet sliding, Mode mode);
    // All contacts and joints with friction.
    ContactSet rough() const { return rough_; }
    // The contacts and joints whose coefficients depend on the state.
    ContactSet varying() const { return varying_; }
    // Those with coefficients that are 0 for the parameters of this run. They slide, and their slip is not watched: the
    // events are those of a system without this friction.
    ContactSet frictionless() const { return frictionless_; }
    bool never_slides(std::size_t which) const { return model_->equations().friction.at(which).never_slides; }
    bool has_friction() const { return !rough_.empty(); }
    // Projects q onto the surfaces of the held contacts, and v so that hdot = 0 for them and u = 0 for all that stick.
    std::optional<double> settle(State& state, Mode mode) {
        return rough_.empty() ? project(state, mode.held(), mode.held()) : settle_with_friction(state, mode);
    }

    // `contacts` must contain at most max_closed_contacts.
    ClosedContacts at(const State& state, ContactSet contacts, Mode others = {});
    // Whether hddot of a contact in this mode may be 0 within rounding. `scale` has the largest coordinates, rates and
    // time so far.
    bool is_nearly_free(std::size_t contact, Mode mode, const State& state, const State& scale);
    // Whether a closed contact is proved to stay closed in this mode without a force (theory-gaps.md 2.7).
    bool needs_no_force(std::size_t contact, Mode mode, const State& state, const State& scale);
    // The same for every state of the run.
    bool never_needs_force(std::size_t contact, Mode mode) { return unpressed().needs_no_force(contact, mode); }
    // Projects q onto the surfaces of the contacts `onto` in one solve, until every |h| is at rounding level, and v so
    // that hdot = 0 for the contacts `still`. Returns the smallest gap of `onto`. Returns nullopt if it fails: dh = 0,
    // contradicting gaps, or more than max_closed_contacts.
    std::optional<double> project(State& state, ContactSet onto, ContactSet still) {
        if (!onto.has_one()) return project_several(state, onto, still);
        Contact contact;
        return free_[onto.only()].project(state, still.empty(), contact) ? std::optional(contact.h) : std::nullopt;
    }
    // Projects an impacting contact and the held contacts onto their surfaces; its hdot is kept. Returns its contact
    // quantities in this mode in `landed`; false if it fails.
    bool land(State& state, std::size_t contact, Mode mode, Contact& landed) {
        return mode.is_free() ? free_[contact].project(state, true, landed)
                              : land_while_held(state, contact, mode, landed);
    }

 private:
    std::optional<double> project_several(State& state, ContactSet onto, ContactSet still);
    std::optional<double> settle_with_friction(State& state, Mode mode);
    // Terms of the slip over the rounding box of a state, with coefficients at |u| = 0.
    SlipTerms<Evaluator<Interval>>& slip_at_rest(std::size_t which, const State& state);
    UnpressedContacts& unpressed();
    bool land_while_held(State& state, std::size_t contact, Mode mode, Contact& landed);

    const Model* model_;
    Run run_;
    std::vector<Restitution> restitutions_;
    std::vector<ContactKinematics> free_;
    std::map<ContactInMode, ContactKinematics> in_modes_;
    ContactSet rough_, varying_, frictionless_;
    std::map<Mode, ModeKinematics> motions_;
    std::map<ContactInMode, SlipTerms<Evaluator<double>>> slips_;
    std::map<std::size_t, SlipTerms<Evaluator<Interval>>> slip_enclosures_;
    std::unique_ptr<UnpressedContacts> unpressed_;  // created at first use
};

// ---- the unit for tolerances of a gap (theory-gaps.md 2.7) ----

// For each contact, the power of 256 nearest to |dh|: the change of its gap per unit change of a coordinate. With it,
// no result depends on the unit of a gap.
class GapUnits {
 public:
    // `surfaces` of this run; it must outlive this.
    GapUnits(const Model& model, const Run& run, ContactCache& surfaces);
    // The units at a state. They are recomputed if a coordinate has changed by more than 1, for gaps such as exp(x) y.
    const std::vector<double>& at(const State& state);
    double operator[](std::size_t contact) const { return units_[contact]; }
    // The unit of what friction watches. The slip of a contact has the unit of its gap (theory-friction.md 1).
    double operator[](const FrictionEvent& event) const;
    // The unit of a watched guard, by its slope in q and v.
    double of_guard(std::size_t watched) const { return guard_units_[watched]; }

 private:
    void find(const State& state);

    ContactCache* surfaces_;
    Vector place_;
    std::vector<double> units_, guard_units_;
    std::optional<Evaluator<double>> guard_slopes_;
};

}  // namespace achilles
