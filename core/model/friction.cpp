#include "model/friction.hpp"

#include <array>
#include <stdexcept>

#include "model/derive.hpp"
#include "model/rows.hpp"

namespace achilles {

namespace {

// A force column: the accelerations of coordinates, gaps and slips by its unit force.
struct ForceColumn {
    Row impulse, on_gaps;
    std::map<std::size_t, Expression> on_slips;
};

ForceColumn normal_column(const ModeEquations& e, std::size_t contact) {
    const ContactEquations& c = e.contacts[contact];
    return {c.impulse, c.delassus, c.on_slips};
}
ForceColumn tangential_column(const ModeEquations& e, std::size_t which) {
    const SlipEquations& s = e.slips.at(which);
    return {s.impulse, s.on_gaps, s.on_slips};
}

void subtract_product(Expression& to, Expression factor, Expression x) { to = to - factor * x; }

void subtract_column(ForceColumn& to, Expression factor, const ForceColumn& x) {
    for (std::size_t i = 0; i < to.impulse.size(); ++i) subtract_product(to.impulse[i], factor, x.impulse[i]);
    for (std::size_t i = 0; i < to.on_gaps.size(); ++i) subtract_product(to.on_gaps[i], factor, x.on_gaps[i]);
    for (auto& [which, entry] : to.on_slips) subtract_product(entry, factor, x.on_slips.at(which));
}

// The force of this column, given with its sign reversed, changes all accelerations.
void apply_force(ModeEquations& e, const ForceColumn& column, Expression minus_force) {
    for (std::size_t i = 0; i < e.f.size(); ++i) subtract_product(e.f[i], minus_force, column.impulse[i]);
    for (std::size_t i = 0; i < e.contacts.size(); ++i)
        subtract_product(e.contacts[i].hddot, minus_force, column.on_gaps[i]);
    for (auto& [which, slip] : e.slips) subtract_product(slip.udot, minus_force, column.on_slips.at(which));
}

// Keeps a row at acceleration 0 by the force of a column: a' = a - P a_r/P_r, and the same for every other column.
// `entry` gives a column's acceleration of that row.
template <class Entry>
void keep_row(ModeEquations& e, ForceColumn column, Expression row_acceleration, const Entry& entry) {
    const Expression pivot = entry(column);
    if (pivot.is_zero()) throw std::domain_error("contacts with linearly dependent gradients cannot all be held");
    for (Expression& x : column.impulse)
        if (!x.is_zero()) x = cancelled(x / pivot);
    for (Expression& x : column.on_gaps)
        if (!x.is_zero()) x = cancelled(x / pivot);
    for (auto& [which, x] : column.on_slips)
        if (!x.is_zero()) x = cancelled(x / pivot);
    apply_force(e, column, row_acceleration);
    for (ContactEquations& c : e.contacts) {
        ForceColumn other{c.impulse, c.delassus, c.on_slips};
        subtract_column(other, entry(other), column);
        c.impulse = std::move(other.impulse);
        c.delassus = std::move(other.on_gaps);
        c.on_slips = std::move(other.on_slips);
    }
    for (auto& [which, s] : e.slips) {
        ForceColumn other{s.impulse, s.on_gaps, s.on_slips};
        subtract_column(other, entry(other), column);
        s.impulse = std::move(other.impulse);
        s.on_gaps = std::move(other.on_gaps);
        s.on_slips = std::move(other.on_slips);
    }
}

// mu or F while it slips with this sign.
Expression sliding_coefficient(const FrictionLaw& law, int sign, const Layout& layout) {
    Graph& graph = law.slip.graph();
    const std::uint32_t speed = layout.sliding_speed();
    const Expression value = graph.number(sign) * law.slip;
    return substitute(law.level, {&speed, 1}, {&value, 1});
}

// g' - sigma mu d'
ForceColumn sliding_column(const ModeEquations& e, std::size_t contact, int sign, const FrictionLaw& law,
                           const Layout& layout) {
    ForceColumn column = normal_column(e, contact);
    subtract_column(column, law.slip.graph().number(sign) * sliding_coefficient(law, sign, layout),
                    tangential_column(e, contact));
    return column;
}

bool varies(Expression x, const Layout& layout) {
    std::vector<std::uint32_t> slots{layout.t()};
    for (std::uint32_t i = 0; i < 2 * layout.dof; ++i) slots.push_back(i);
    return depends_on(x, slots);
}

}  // namespace

void derive_slips(const FrictionLaws& laws, const Layout& layout, const MassSolver& solve, ModeEquations& free) {
    for (const auto& [which, law] : laws) {
        const std::vector<std::uint32_t> q_slots = slots_from(layout.q(0), layout.dof);
        const Row v = symbols(slots_from(layout.v(0), layout.dof), law.slip.graph());
        SlipEquations& s = free.slips[which];
        s.u = law.slip;
        s.d = law.d;
        s.c = law.c;
        s.udot = product(gradient(s.u, q_slots), v) + derivative(s.u, layout.t()) + product(s.d, free.f);
        s.impulse = solve(s.d);
    }
    for (auto& [which, s] : free.slips) {
        for (ContactEquations& c : free.contacts) {
            s.on_gaps.push_back(product(c.g, s.impulse));
            c.on_slips.emplace(which, product(s.d, c.impulse));
        }
        for (const auto& [other, row] : free.slips) s.on_slips.emplace(other, product(row.d, s.impulse));
    }
}

void add_to_mode(ModeEquations& e, std::size_t which, Mode mode, const FrictionLaws& laws, const Layout& layout) {
    const auto law = laws.find(which);
    const int sign = slip_sign(mode.state(which));
    const auto gap_entry = [which](const ForceColumn& x) { return x.on_gaps[which]; };
    const auto slip_entry = [which](const ForceColumn& x) { return x.on_slips.at(which); };
    const auto stick = [&] { keep_row(e, tangential_column(e, which), e.slips.at(which).udot, slip_entry); };
    if (is_joint(which)) {
        if (sign == 0) return stick();
        const Expression minus_force =
            law->second.slip.graph().number(sign) * sliding_coefficient(law->second, sign, layout);
        return apply_force(e, tangential_column(e, which), minus_force);
    }
    const ContactEquations& last = e.contacts[which];
    const Row g = last.g;
    const Expression square = product(g, g);
    keep_row(e, sign != 0 ? sliding_column(e, which, sign, law->second, layout) : normal_column(e, which), last.hddot,
             gap_entry);
    if (law != laws.end() && sign == 0 && !mode.implied().contains(which)) stick();
    for (std::size_t i = 0; i < e.contacts.size(); ++i) {
        if (i == which) continue;
        Row& other = e.contacts[i].g;
        const Expression along = product(g, other) / square;
        for (std::size_t j = 0; j < g.size(); ++j) other[j] = other[j] - g[j] * along;
    }
}

FrictionForce reaction(const ModeEquations& before, std::size_t which, Mode mode, const FrictionLaws& laws,
                       const Layout& layout, const RowAccelerations& a) {
    const auto law = laws.find(which);
    const int sign = slip_sign(mode.state(which));
    if (is_joint(which)) {
        const SlipEquations& s = before.slips.at(which);
        return {s.on_slips.at(which), -a.slip, s.on_slips.at(which)};
    }
    const ContactEquations& c = before.contacts[which];
    Graph& graph = c.hddot.graph();
    if (law == laws.end() || mode.implied().contains(which)) return {-a.gap, graph.number(0), c.delassus[which]};
    if (sign != 0) {
        const Expression mu = sliding_coefficient(law->second, sign, layout);
        return {-a.gap, graph.number(sign) * mu * a.gap,
                sliding_column(before, which, sign, law->second, layout).on_gaps[which]};
    }
    const SlipEquations& s = before.slips.at(which);
    const Expression W_NN = c.delassus[which], W_NT = s.on_gaps[which], W_TN = c.on_slips.at(which),
                     W_TT = s.on_slips.at(which);
    // With uncoupled rows each force follows from its own row.
    if (W_NT.is_zero() && W_TN.is_zero()) return {-a.gap * W_TT, -a.slip * W_NN, W_NN * W_TT};
    return {W_NT * a.slip - W_TT * a.gap, W_TN * a.gap - W_NN * a.slip, W_NN * W_TT - W_NT * W_TN};
}

RowAccelerations by_normal_force(const ModeEquations& before, std::size_t which, std::size_t contact) {
    const ContactEquations& c = before.contacts[contact];
    RowAccelerations result;
    if (!is_joint(which)) result.gap = c.delassus[which];
    if (before.slips.contains(which)) result.slip = c.on_slips.at(which);
    return result;
}

RowAccelerations by_friction_force(const ModeEquations& before, std::size_t which, std::size_t contact) {
    const SlipEquations& s = before.slips.at(contact);
    RowAccelerations result;
    if (!is_joint(which)) result.gap = s.on_gaps[which];
    if (before.slips.contains(which)) result.slip = s.on_slips.at(which);
    return result;
}

FrictionForce friction_force(const ModeEquations& before, std::size_t which, Mode mode, const FrictionLaws& laws,
                             const Layout& layout) {
    const int sign = slip_sign(mode.state(which));
    if (is_joint(which) && sign != 0) {
        Graph& graph = before.slips.at(which).u.graph();
        return {graph.number(1), graph.number(-sign) * sliding_coefficient(laws.at(which), sign, layout),
                graph.number(1)};
    }
    RowAccelerations accelerations;
    if (!is_joint(which)) accelerations.gap = before.contacts[which].hddot;
    if (before.slips.contains(which)) accelerations.slip = before.slips.at(which).udot;
    return reaction(before, which, mode, laws, layout, accelerations);
}

Expression negative_force(const ModeEquations& before, std::size_t contact, Mode mode, const FrictionLaws& laws) {
    const ContactEquations& c = before.contacts[contact];
    const bool sticks = mode.state(contact) == ContactState::held && !mode.implied().contains(contact);
    if (!sticks || !laws.contains(contact)) return c.hddot;
    const SlipEquations& s = before.slips.at(contact);
    const Expression W_NT = s.on_gaps[contact];
    return W_NT.is_zero() ? c.hddot : c.hddot - s.udot * cancelled(W_NT / s.on_slips.at(contact));
}

// These are the next contacts of higher number, up to the next one that sticks by itself.
ContactSet sharing_with(Mode mode, std::size_t contact, const FrictionLaws& laws) {
    ContactSet sharing;
    if (is_joint(contact)) return sharing;
    for (const std::size_t i : mode.contacts_in(ContactState::held)) {
        if (i <= contact || !laws.contains(i)) continue;
        if (!mode.implied().contains(i)) break;
        sharing = sharing.with(i);
    }
    return sharing;
}

WatchedFriction watched_friction(const ModeEquations& motion, const FrictionLaws& laws, const Layout& layout,
                                 const EquationsWithout& without) {
    WatchedFriction result;
    const auto watch = [&](std::size_t which, FrictionFunction watched, int power, Expression function) {
        result.events.push_back({which, watched, is_joint(which) ? 0 : power});
        result.functions.push_back(function);
    };
    const ContactSet slipping = motion.mode.slipping();
    for (const std::size_t i : motion.mode.held().with(motion.mode.joints())) {
        const auto law = laws.find(i);
        const int sign = slip_sign(motion.mode.state(i));
        const bool has_law = law != laws.end();
        if (has_law && sign != 0) {
            watch(i, FrictionFunction::slip, 1, law->second.slip.graph().number(sign) * law->second.slip);
        } else if (has_law && !law->second.never_slides && !motion.mode.implied().contains(i)) {
            FrictionForce force = friction_force(without(i), i, motion.mode, laws, layout);
            Expression most = law->second.static_level * force.lambda;
            // lambda and tau have the power -1, their common factor det W the power 4.
            int power = 3;
            // Contacts with an implied slip share the friction force, up to the sum of what each can bear.
            const ContactSet sharing = sharing_with(motion.mode, i, laws);
            if (!sharing.empty()) {
                power = -1;
                most = most / force.scale;
                force.tau = force.tau / force.scale;
            }
            for (const std::size_t k : sharing) {
                const FrictionForce other = friction_force(without(k), k, motion.mode, laws, layout);
                most = most + laws.at(k).static_level * other.lambda / other.scale;
            }
            watch(i, FrictionFunction::upper_limit, power, most - force.tau);
            watch(i, FrictionFunction::lower_limit, power, most + force.tau);
        }
        if (is_joint(i) || (sign == 0 && slipping.within(motion.mode.held()).without(i).empty())) continue;
        const Expression pivot = friction_force(without(i), i, motion.mode, laws, layout).scale;
        const bool is_determinant = has_law && sign == 0 && !motion.mode.implied().contains(i);
        if (varies(pivot, layout)) watch(i, FrictionFunction::pivot, is_determinant ? 4 : 2, pivot);
    }
    return result;
}

FrictionPower friction_power(const ModeEquations& motion, const FrictionLaws& laws, const Layout& layout,
                             const EquationsWithout& without) {
    Graph& graph = motion.f.front().graph();
    FrictionPower power{graph.number(0), graph.number(0)};
    for (const std::size_t i : motion.mode.held().with(motion.mode.joints())) {
        if (!laws.contains(i)) continue;
        const FrictionForce force = friction_force(without(i), i, motion.mode, laws, layout);
        const Expression tau = force.tau / force.scale;
        const SlipEquations& s = motion.slips.at(i);
        if (slip_sign(motion.mode.state(i)) != 0) power.heat = power.heat - tau * s.u;
        if (!s.c.is_zero()) power.work = power.work - tau * s.c;
    }
    return power;
}

}  // namespace achilles
