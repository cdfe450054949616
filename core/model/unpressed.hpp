// Contacts that stay closed with a contact force of 0 (theory-gaps.md 2.7).
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "model/derive.hpp"
#include "run/state.hpp"

namespace achilles {

class Model;

// Known values of some slots.
struct KnownValues {
    std::vector<std::uint32_t> slots;
    std::vector<double> values;
    friend bool operator==(const KnownValues&, const KnownValues&) = default;
};

// Whether hddot of a contact in this mode is proved to be 0 at every state where h = hdot = 0 for this contact and the
// held ones. It then stays closed with them, and its force is 0.
bool needs_no_force(std::size_t contact, Mode mode, ContactModes& motions, const Layout& layout,
                    const KnownValues& known = {});

// The same at the parameters and states of one run. Use one object per thread; it refers to the model.
class UnpressedContacts {
 public:
    UnpressedContacts(const Model& model, std::span<const double> parameters);

    // For the parameters of the run, at all states.
    bool needs_no_force(std::size_t contact, Mode mode);
    // From this state on, until a velocity jumps or the mode changes; coordinates that are proved to stay at rest keep
    // their values.
    bool needs_no_force_from(const State& state, std::size_t contact, Mode mode);

 private:
    KnownValues known_parameters() const;
    KnownValues at_rest(Mode mode, const State& state);
    ContactModes& motions();

    const Model* model_;
    std::vector<double> parameters_;
    std::unique_ptr<ContactModes> motions_;  // created at first use
    std::map<ContactInMode, bool> at_all_states_;
    struct StateProof {
        KnownValues at_rest;
        bool proved;
    };
    std::map<ContactInMode, StateProof> from_state_;  // the last result of each
};

}  // namespace achilles
