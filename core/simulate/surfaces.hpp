// The contacts of one run, each while others are held, and several of them at once.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "contacts/delassus.hpp"
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
    // A contact while none is held, and while these are.
    ContactKinematics& of(std::size_t contact) { return free_[contact]; }
    ContactKinematics& of(std::size_t contact, ContactSet held);

    // At most most_contacts of them.
    Closed at(const State& state, ContactSet contacts);
    // Moves q onto the surfaces of all these contacts in one solve, until every |h| is at rounding level, and v so that
    // hdot = 0 of those that are still. The least gap of these; nothing where that fails: dh = 0, gaps that contradict one
    // another, or more than most_contacts.
    std::optional<double> project(State& state, ContactSet onto, ContactSet still) {
        if (!onto.has_one()) return project_several(state, onto, still);
        Contact contact;
        return free_[onto.only()].project(state, still.empty(), contact) ? std::optional(contact.h) : std::nullopt;
    }
    // Lands a contact while others are held: on all of their surfaces, its hdot kept. Gives it as that motion sees it; false
    // where that fails.
    bool land(State& state, std::size_t contact, ContactSet held, Contact& landed) {
        return held.empty() ? free_[contact].project(state, true, landed) : land_beside(state, contact, held, landed);
    }

 private:
    std::optional<double> project_several(State& state, ContactSet onto, ContactSet still);
    bool land_beside(State& state, std::size_t contact, ContactSet held, Contact& landed);

    const Model* model_;
    Run run_;
    std::vector<ContactKinematics> free_;
    std::map<std::pair<ContactSet, std::size_t>, ContactKinematics> while_held_;
};

}  // namespace achilles
