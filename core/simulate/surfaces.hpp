// The contacts of one run, each while others are held, and several of them at once.
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

// Closed contacts at one state, in ascending order, with their Delassus matrix: what impacts of several are solved from.
struct Closed {
    std::vector<std::size_t> which;
    std::vector<Contact> contacts;
    ContactMatrix<double> W;

    // These contacts as places in `which`, and back.
    ContactSet places_of(ContactSet contacts) const;
    ContactSet contacts_at(ContactSet places) const;
    ContactVector<double> rates() const;  // hdot
    // v + M^-1 G' p
    Vector after(const Vector& v, const ContactVector<double>& impulses) const;
};

class Surfaces {
 public:
    Surfaces(const Model& model, const Run& run);

    std::size_t count() const { return free_.size(); }
    const Restitution& restitution(std::size_t contact) const { return restitutions_[contact]; }
    // Takes the restitutions of another run. Its other parameters must be those of the present run.
    void bounce_as(const Run& run) { restitutions_ = model_->restitutions(run.parameters); }
    // A contact in free flight, and in a mode in which it is open.
    ContactKinematics& of(std::size_t contact) { return free_[contact]; }
    ContactKinematics& of(std::size_t contact, Mode mode);

    // At most most_contacts of them.
    Closed at(const State& state, ContactSet contacts);
    // Whether hddot of a contact, in this mode, may be 0 but for roundings of `scale`, which is what the coordinates,
    // the rates and the time have come to so far.
    bool is_nearly_free(std::size_t contact, Mode mode, const State& state, const State& scale);
    // Whether a contact that is closed beside what is held is proved to stay so without a force (theory-gaps.md 2.7).
    bool needs_no_force(std::size_t contact, Mode mode, const State& state, const State& scale);
    // The same at every state of the run.
    bool never_needs_force(std::size_t contact, Mode mode) { return unpressed().needs_no_force(contact, mode); }
    // Moves q onto the surfaces of all these contacts in one solve, until every |h| is at rounding level, and v so that
    // hdot = 0 of those that are still. The least gap of these; nothing where that fails: dh = 0, gaps that contradict one
    // another, or more than most_contacts.
    std::optional<double> project(State& state, ContactSet onto, ContactSet still) {
        if (!onto.has_one()) return project_several(state, onto, still);
        Contact contact;
        return free_[onto.only()].project(state, still.empty(), contact) ? std::optional(contact.h) : std::nullopt;
    }
    // Lands a contact beside what is held: on all of their surfaces, its hdot kept. Gives it as that motion sees it;
    // false where that fails.
    bool land(State& state, std::size_t contact, Mode mode, Contact& landed) {
        return mode.is_free() ? free_[contact].project(state, true, landed) : land_beside(state, contact, mode, landed);
    }

 private:
    std::optional<double> project_several(State& state, ContactSet onto, ContactSet still);
    UnpressedContacts& unpressed();
    bool land_beside(State& state, std::size_t contact, Mode mode, Contact& landed);

    const Model* model_;
    Run run_;
    std::vector<Restitution> restitutions_;
    std::vector<ContactKinematics> free_;
    std::map<ContactInMode, ContactKinematics> in_modes_;
    std::unique_ptr<UnpressedContacts> unpressed_;  // made where it is first asked for
};

// The unit that tolerances of a gap are meant in (theory-gaps.md 2.7).

// Of each contact the power of 256 that is nearest to |dh|: what 1 m of a coordinate makes of its gap. With it no course depends on
// the unit that a gap is written in.
class GapUnits {
 public:
    GapUnits(const Model& model, const Run& run);
    // At a state. They are found anew where a coordinate has moved on by more than 1, for a gap such as exp(x) y.
    const std::vector<double>& at(const State& state);
    double operator[](std::size_t contact) const { return units_[contact]; }

 private:
    void find(const State& state);

    std::vector<ContactKinematics> surfaces_;
    Vector place_;
    std::vector<double> units_;
};

}  // namespace achilles
