// Contacts that stay closed though nothing presses them (theory-gaps.md 2.7).
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "model/derive.hpp"
#include "run/state.hpp"

namespace achilles {

class Model;

// Values that some of the slots are known to have.
struct KnownValues {
    std::vector<std::uint32_t> slots;
    std::vector<double> values;
    friend bool operator==(const KnownValues&, const KnownValues&) = default;
};

// Whether hddot of a contact, along the motion in this mode, is proved to be 0 at every state where h = hdot = 0 of it
// and of what is held: then it stays closed with them, and its force is 0.
bool needs_no_force(std::size_t contact, Mode mode, ContactModes& motions, const Layout& layout,
                    const KnownValues& known = {});

// The same at the parameters and states of one run. One per thread; refers to the model.
class UnpressedContacts {
 public:
    UnpressedContacts(const Model& model, std::span<const double> parameters);

    // At the parameters of the run, at all states.
    bool needs_no_force(std::size_t contact, Mode mode);
    // From this state on until a velocity jumps or other contacts are held: coordinates that rest there stay at rest.
    bool needs_no_force_from(const State& state, std::size_t contact, Mode mode);

 private:
    KnownValues known_parameters() const;
    KnownValues at_rest(Mode mode, const State& state);
    ContactModes& motions();

    const Model* model_;
    std::vector<double> parameters_;
    std::unique_ptr<ContactModes> motions_;  // made where it is first asked for
    std::map<ContactInMode, bool> at_all_states_;
    struct FromState {
        KnownValues at_rest;
        bool proved;
    };
    std::map<ContactInMode, FromState> from_state_;  // what was asked last
};

}  // namespace achilles
