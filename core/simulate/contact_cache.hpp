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

class ContactCache {
 public:
    ContactCache(const Model& model, const Run& run);

    std::size_t count() const { return free_.size(); }
    const Restitution& restitution(std::size_t contact) const { return restitutions_[contact]; }
    // Takes the restitutions of another run, whose other parameters must be the same.
    void bounce_as(const Run& run) { restitutions_ = model_->restitutions(run.parameters); }
    // A contact while all are open, and in a mode in which it is open.
    ContactKinematics& of(std::size_t contact) { return free_[contact]; }
    ContactKinematics& of(std::size_t contact, Mode mode);

    // `contacts` must contain at most max_closed_contacts.
    ClosedContacts at(const State& state, ContactSet contacts);
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
    UnpressedContacts& unpressed();
    bool land_while_held(State& state, std::size_t contact, Mode mode, Contact& landed);

    const Model* model_;
    Run run_;
    std::vector<Restitution> restitutions_;
    std::vector<ContactKinematics> free_;
    std::map<ContactInMode, ContactKinematics> in_modes_;
    std::unique_ptr<UnpressedContacts> unpressed_;  // created at first use
};

// ---- the unit for tolerances of a gap (theory-gaps.md 2.7) ----

// For each contact, the power of 256 nearest to |dh|: the change of its gap per unit change of a coordinate. With it,
// no result depends on the unit of a gap.
class GapUnits {
 public:
    GapUnits(const Model& model, const Run& run);
    // The units at a state. They are recomputed if a coordinate has changed by more than 1, for gaps such as exp(x) y.
    const std::vector<double>& at(const State& state);
    double operator[](std::size_t contact) const { return units_[contact]; }

 private:
    void find(const State& state);

    std::vector<ContactKinematics> surfaces_;
    Vector place_;
    std::vector<double> units_;
};

}  // namespace achilles
