#include "model/friction_bouncing.hpp"

#include "model/rows.hpp"

namespace achilles {

namespace {

// Whether the contact sticks at its impacts, rather than sliding or having no friction.
bool sticks(const BouncingKey& key, const FrictionLaws& laws) {
    return key.state == ContactState::held && laws.contains(key.contact);
}

// n_sigma = M^-1 (g' - sigma mu d')/W_sigma and W_sigma, with the coefficient at a given speed.
struct SlidingDirection {
    Row n;
    Expression W;
};
SlidingDirection sliding_direction(const ModeEquations& flight, std::size_t contact, int sign, Expression coefficient) {
    const ContactEquations& c = flight.contacts[contact];
    const SlipEquations& s = flight.slips.at(contact);
    const Expression factor = c.hddot.graph().number(sign) * coefficient;
    SlidingDirection result{{}, c.delassus[contact] - factor * s.on_gaps[contact]};
    for (std::size_t i = 0; i < c.impulse.size(); ++i) {
        const Expression impulse = c.impulse[i] - factor * s.impulse[i];
        result.n.push_back(impulse.is_zero() ? impulse : cancelled(impulse / result.W));
    }
    return result;
}

struct SlidingContact {
    BouncingContact contact;
    Expression W;
};
// The contact while it slides with this sign at its impacts. They take the coefficient at the slip of s.
SlidingContact sliding_contact(const BouncingKey& key, ContactModes& modes, const Layout& layout) {
    const ModeEquations& flight = modes.of(key.mode);
    const FrictionLaw& law = modes.friction().at(key.contact);
    const int sign = slip_sign(key.state);
    const std::uint32_t speed[] = {layout.sliding_speed()};
    const Expression value[] = {modes.graph().number(sign) * law.slip};
    const SlidingDirection general = sliding_direction(flight, key.contact, sign, law.level);
    const auto at_slip = [&](Expression x) { return substitute(x, speed, value); };
    SlidingContact result{{flight.contacts[key.contact].hddot, flight.f, {}, {}, {}, {}}, at_slip(general.W)};
    BouncingContact& contact = result.contact;
    for (std::size_t i = 0; i < general.n.size(); ++i) {
        contact.n.push_back(at_slip(general.n[i]));
        contact.f_c.push_back(flight.f[i] - contact.n[i] * contact.hddot);
    }
    if (!depends_on(law.level, speed)) return result;
    contact.d = law.d;
    for (const Expression n : general.n)
        contact.n_u.push_back(modes.graph().number(sign) * at_slip(derivative(n, speed[0])));
    return result;
}

// N = M^-1 [g', d'] W^-1, so that (hdot, u) = (G; D) N sigma = sigma.
struct StickingDirections {
    std::array<Row, 2> N;
    Row W;  // W_NN, W_NT, W_TT
};
StickingDirections sticking_directions(const BouncingKey& key, ContactModes& modes) {
    const ModeEquations& flight = modes.of(key.mode);
    const ContactEquations& c = flight.contacts[key.contact];
    const SlipEquations& s = flight.slips.at(key.contact);
    StickingDirections result;
    result.W = {c.delassus[key.contact], s.on_gaps[key.contact], s.on_slips.at(key.contact)};
    const Row& W = result.W;
    if (W[1].is_zero()) {
        for (std::size_t i = 0; i < c.impulse.size(); ++i) {
            result.N[0].push_back(c.impulse[i].is_zero() ? c.impulse[i] : cancelled(c.impulse[i] / W[0]));
            result.N[1].push_back(s.impulse[i].is_zero() ? s.impulse[i] : cancelled(s.impulse[i] / W[2]));
        }
        return result;
    }
    const Expression det = W[0] * W[2] - W[1] * W[1];
    for (std::size_t i = 0; i < c.impulse.size(); ++i) {
        result.N[0].push_back((c.impulse[i] * W[2] - s.impulse[i] * W[1]) / det);
        result.N[1].push_back((s.impulse[i] * W[0] - c.impulse[i] * W[1]) / det);
    }
    return result;
}

BouncingModel sticking_model(const BouncingKey& key, ContactModes& modes, const Equations& equations,
                             const Layout& layout) {
    const ModeEquations& flight = modes.of(key.mode);
    const Row& A = modes.of(key.mode.with(key.contact, ContactState::held)).f;
    const StickingDirections directions = sticking_directions(key, modes);
    const std::vector<std::uint32_t> q = slots_from(layout.q(0), layout.dof), v = slots_from(layout.v(0), layout.dof);
    const Row s = symbols(v, modes.graph()), velocity = pair_velocity(directions.N, layout);
    const Expression hddot = flight.contacts[key.contact].hddot;
    const Row accelerations = at_velocity({hddot, flight.slips.at(key.contact).udot}, v, velocity);
    const Row by_v = gradient(hddot, v);
    const Expression rate = product(gradient(hddot, q), s) + product(by_v, A) + derivative(hddot, layout.t());
    BouncingModel result;
    result.variables = q;
    result.variables.insert(result.variables.end(), v.begin(), v.end());
    result.variables.insert(result.variables.end(), {layout.sigma(), layout.second_sigma()});
    if (!equations.autonomous) result.variables.push_back(layout.t());
    result.trend = TypedProgram<TrendTerms>::of(layout.slots(), hddot, rate, product(by_v, directions.N[0]),
                                                Row{product(by_v, directions.N[1])});
    result.sticking =
        derive_pair_terms(A, directions.N, accelerations, directions.W, !equations.quadratic_in_rates, layout);
    return result;
}

}  // namespace

bool has_bouncing(const BouncingKey& key, ContactModes& modes) {
    if (!key.mode.is_free()) return false;
    const bool has_law = modes.friction().contains(key.contact);
    const Mode sliding = key.mode.without(key.mode.elements_in(ContactState::held).within(key.mode.joints()));
    const ModeEquations& free = modes.of(sliding);
    for (const std::size_t joint : key.mode.joints()) {
        if (slip_sign(key.mode.state(joint)) != 0) continue;
        if (!free.contacts[key.contact].on_slips.at(joint).is_zero()) return false;
        if (has_law && !free.slips.at(key.contact).on_slips.at(joint).is_zero()) return false;
    }
    return true;
}

BouncingModel derive_bouncing(const BouncingKey& key, ContactModes& modes, const Equations& equations,
                              const Layout& layout) {
    if (sticks(key, modes.friction())) return sticking_model(key, modes, equations, layout);
    if (slip_sign(key.state) != 0)
        return derive_bouncing(sliding_contact(key, modes, layout).contact, equations, layout);
    const ContactEquations& c = modes.of(key.mode).contacts.at(key.contact);
    return derive_bouncing({c.hddot, {}, c.f_c, c.direction, {}, {}}, equations, layout);
}

OtherContactTerms derive_other_contacts(const BouncingKey& key, ContactModes& modes, const Layout& layout) {
    if (modes.friction().empty()) return derive_other_contacts(key.contact, key.mode, modes, layout);
    Graph& graph = modes.graph();
    const std::vector<std::uint32_t> v = slots_from(layout.v(0), layout.dof);
    const Expression sigma = graph.symbol(layout.sigma());
    Row velocity, positive;
    if (sticks(key, modes.friction())) {
        velocity = pair_velocity(sticking_directions(key, modes).N, layout);
    } else {
        Row n = modes.of(key.mode).contacts.at(key.contact).direction;
        const int sign = slip_sign(key.state);
        std::optional<SlidingContact> sliding;
        if (sign != 0) {
            sliding = sliding_contact(key, modes, layout);
            n = sliding->contact.n;
        }
        for (std::size_t i = 0; i < layout.dof; ++i) velocity.push_back(graph.symbol(v[i]) + n[i] * sigma);
        if (sliding) {
            const Expression slip = modes.friction().at(key.contact).slip;
            positive = {sliding->W, graph.number(sign) * substitute(slip, v, velocity)};
            if (!sliding->contact.n_u.empty())
                positive.push_back(graph.number(1) + sigma * product(sliding->contact.d, sliding->contact.n_u));
        }
    }
    for (const Expression function : modes.watched_friction(modes.of(key.mode)).functions)
        positive.push_back(substitute(function, v, velocity));
    return derive_other_contacts({key.contact}, key.mode, velocity, modes, layout, positive);
}

}  // namespace achilles
