#include "model/unpressed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "algebra/vanishes.hpp"
#include "model/model.hpp"

namespace achilles {

namespace {

std::vector<std::uint32_t> slots_of_state(const Layout& layout) {
    std::vector<std::uint32_t> slots;  // q, then v
    for (std::uint32_t i = 0; i < 2 * layout.dof; ++i) slots.push_back(i);
    return slots;
}

// The decimal that a double stands for, as an exact number: 0.1 is 1/10.
Expression number_of(double value, Graph& graph) {
    const Expression size = graph.decimal(fmt::format("{}", std::abs(value)));
    return value < 0.0 ? -size : size;
}

// Simplifies expressions at states with h = hdot = 0 for a set of contacts.
class ClosedStates {
 public:
    ClosedStates(ContactSet closed, ContactModes& motions, const Layout& layout, const KnownValues& known)
        : closed_(closed), motions_(motions), layout_(layout), known_(known) {
        for (const double value : known.values) values_.push_back(number_of(value, motions.graph()));
        const std::vector<ContactEquations>& free = motions.of({}).contacts;
        for (const bool rate : {true, false})
            for (std::size_t i = 0; i < free.size(); ++i)
                if (closed.contains(i)) (rate ? rates_ : gaps_).push_back(at_known(rate ? free[i].hdot : free[i].gap));
    }

    bool vanishes(Expression expression) {
        std::vector<Expression> zeros = rates_;
        zeros.insert(zeros.end(), gaps_.begin(), gaps_.end());
        if (vanishes_where(at_known(expression), zeros, slots_of_state(layout_))) return true;
        // If the equations hdot = 0 give no velocity in numbers, replace v by v - n hdot, for which the gap rates are 0
        // (theory-gaps.md 2).
        for (const std::uint32_t slot : known_.slots)
            if (slot < 2 * layout_.dof) return false;
        return vanishes_where(at_known(along_surfaces(expression)), gaps_, slots_of_state(layout_));
    }

 private:
    Expression at_known(Expression expression) const { return substitute(expression, known_.slots, values_); }

    // Replaces v by v - n hdot of each contact, the last contact first: that leaves the gap rates of those before
    // unchanged.
    Expression along_surfaces(Expression expression) {
        std::vector<std::uint32_t> v;
        for (std::size_t i = 0; i < layout_.dof; ++i) v.push_back(layout_.v(i));
        ContactSet before = closed_;
        for (std::size_t i = layout_.contacts; i-- > 0;) {
            if (!closed_.contains(i)) continue;
            before = before.without(i);
            expression = substitute(expression, v, motions_.of(Mode::holding(before)).contacts[i].s);
        }
        return expression;
    }

    ContactSet closed_;
    ContactModes& motions_;
    const Layout& layout_;
    const KnownValues& known_;
    std::vector<Expression> values_, rates_, gaps_;
};

}  // namespace

bool needs_no_force(std::size_t contact, Mode mode, ContactModes& motions, const Layout& layout,
                    const KnownValues& known) {
    try {
        return ClosedStates(mode.held().with(contact), motions, layout, known)
            .vanishes(motions.of(mode).contacts.at(contact).hddot);
    } catch (const ExpressionTooLarge&) {
    } catch (const std::domain_error&) {  // linearly dependent contacts, or a division by 0 at these states
    }
    return false;
}

UnpressedContacts::UnpressedContacts(const Model& model, std::span<const double> parameters)
    : model_(&model), parameters_(parameters.begin(), parameters.end()) {}

ContactModes& UnpressedContacts::motions() {
    if (!motions_) motions_ = std::make_unique<ContactModes>(model_->equations(), model_->layout());
    return *motions_;
}

KnownValues UnpressedContacts::known_parameters() const {
    KnownValues known;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
        known.slots.push_back(model_->layout().parameter(i));
        known.values.push_back(parameters_[i]);
    }
    return known;
}

// The parameters, and the coordinates at rest that are proved to stay at rest in this mode: their accelerations vanish
// as long as all of them rest. A coordinate on which the gap of a held contact depends is not fixed at its value.
KnownValues UnpressedContacts::at_rest(Mode mode, const State& state) {
    const Layout& layout = model_->layout();
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < layout.dof; ++i)
        if (state.v[static_cast<Eigen::Index>(i)] == 0.0) rest.push_back(i);
    const auto is_in_a_gap = [&](std::size_t i) {
        const std::uint32_t slot = layout.q(i);
        for (std::size_t contact = 0; contact < layout.contacts; ++contact)
            if (mode.is_held(contact) && depends_on(model_->equations().gaps[contact], {&slot, 1})) return true;
        return false;
    };
    for (;;) {
        KnownValues known = known_parameters();
        const auto add = [&](std::uint32_t slot, double value) {
            known.slots.push_back(slot);
            known.values.push_back(value);
        };
        for (const std::size_t i : rest) {
            if (!is_in_a_gap(i)) add(layout.q(i), state.q[static_cast<Eigen::Index>(i)]);
            add(layout.v(i), 0.0);
        }
        if (rest.empty()) return known;
        ClosedStates closed(mode.held(), motions(), layout, known);
        const auto moves = [&](std::size_t i) { return !closed.vanishes(motions().of(mode).f[i]); };
        if (std::erase_if(rest, moves) == 0) return known;
    }
}

bool UnpressedContacts::needs_no_force(std::size_t contact, Mode mode) {
    if (model_->stays_closed_without_force(contact, mode)) return true;
    const ContactInMode key(mode, contact);
    const auto known = at_all_states_.find(key);
    if (known != at_all_states_.end()) return known->second;
    const bool proved = achilles::needs_no_force(contact, mode, motions(), model_->layout(), known_parameters());
    return at_all_states_.emplace(key, proved).first->second;
}

bool UnpressedContacts::needs_no_force_from(const State& state, std::size_t contact, Mode mode) {
    if ((state.v.array() != 0.0).all()) return false;
    const ContactInMode key(mode, contact);
    try {
        const KnownValues rest = at_rest(mode.with(contact, ContactState::held), state);
        if (rest.slots.size() == parameters_.size()) return false;
        const auto last = from_state_.find(key);
        if (last != from_state_.end() && last->second.at_rest == rest) return last->second.proved;
        const bool proved = achilles::needs_no_force(contact, mode, motions(), model_->layout(), rest);
        from_state_.insert_or_assign(key, StateProof{rest, proved});
        return proved;
    } catch (const ExpressionTooLarge&) {
    } catch (const std::domain_error&) {
    }
    return false;
}

}  // namespace achilles
