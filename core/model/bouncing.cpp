#include "model/bouncing.hpp"

#include <algorithm>
#include <array>

#include "model/rows.hpp"

namespace achilles {

namespace {

// B, D and the rate F of s, if n depends on the slip u = d v + c (theory-friction.md 4.1):
//     F = R - n_u (d R) sigma/(1 + sigma d n_u),   R = f - n hddot - (n_q v + n_t) sigma at v = s + n sigma
//     B = dF/dsigma at sigma = 0,   D = 1/2 d2F/dsigma2
struct SlipDependentRate {
    Row B, D, rate;
};
SlipDependentRate slip_dependent_rate(const BouncingContact& contact, const Row& velocity,
                                      const std::vector<std::uint32_t>& q, const std::vector<std::uint32_t>& v,
                                      const Layout& layout, Graph& graph) {
    const Expression sigma = graph.symbol(layout.sigma()), half = graph.number(1, 2);
    const std::uint32_t slots[] = {layout.sigma()};
    const Expression at_zero[] = {graph.number(0)};
    const Row n = adopt(graph, contact.n), d = adopt(graph, contact.d), n_u = adopt(graph, contact.n_u),
              f = at_velocity(adopt(graph, contact.f), v, velocity);
    const Expression hddot = substitute(graph.adopt(contact.hddot), v, velocity);
    const Row turning = sum(along(n, q, velocity), derivative(n, layout.t()));
    Row R;
    for (std::size_t i = 0; i < n.size(); ++i) R.push_back(f[i] - n[i] * hddot - turning[i] * sigma);
    const Expression share = product(d, R) * sigma / (graph.number(1) + sigma * product(d, n_u));
    SlipDependentRate result;
    for (std::size_t i = 0; i < n.size(); ++i) {
        result.rate.push_back(R[i] - n_u[i] * share);
        const Expression slope = derivative(result.rate[i], layout.sigma());
        result.B.push_back(substitute(slope, slots, at_zero));
        result.D.push_back(half * derivative(slope, layout.sigma()));
    }
    return result;
}

}  // namespace

BouncingModel derive_bouncing(const BouncingContact& contact, const Equations& equations, const Layout& layout) {
    Graph graph(contact.hddot.graph());
    const std::size_t count = layout.dof;
    std::vector<std::uint32_t> q, v;
    Row s;
    for (std::size_t i = 0; i < count; ++i) {
        q.push_back(layout.q(i));
        v.push_back(layout.v(i));
        s.push_back(graph.symbol(layout.v(i)));
    }
    const Expression sigma = graph.symbol(layout.sigma()), half = graph.number(1, 2);
    const Row A = adopt(graph, contact.f_c), n = adopt(graph, contact.n);
    Row velocity;
    for (std::size_t i = 0; i < count; ++i) velocity.push_back(s[i] + n[i] * sigma);
    const Row slope = along(A, v, n);  // df_c/dv n
    const Row turn = along(n, q, s), twist = along(n, q, n), n_t = derivative(n, layout.t());
    Row bend = along(slope, v, n), B, D, rate;
    if (!equations.quadratic_in_rates) bend = at_velocity(bend, v, velocity);
    for (std::size_t i = 0; i < count; ++i) {
        B.push_back(slope[i] - turn[i] - n_t[i]);
        D.push_back(half * bend[i] - twist[i]);
        rate.push_back(A[i] + B[i] * sigma + D[i] * power(sigma, 2));
    }
    if (!equations.quadratic_in_rates) {
        const Row acceleration = at_velocity(A, v, velocity);
        for (std::size_t i = 0; i < count; ++i)
            rate[i] = acceleration[i] - (turn[i] + twist[i] * sigma + n_t[i]) * sigma;
    }
    const bool depends_on_slip = !contact.n_u.empty();
    if (depends_on_slip) {
        SlipDependentRate all = slip_dependent_rate(contact, velocity, q, v, layout, graph);
        B = std::move(all.B);
        D = std::move(all.D);
        rate = std::move(all.rate);
    }
    const Row ndot = sum(along(n, q, velocity), n_t);
    const Row Bdot = sum(sum(along(B, q, velocity), along(B, v, rate)), derivative(B, layout.t()));
    const Row dA_dq = row_by_row(A, q), dA_ds = row_by_row(A, v);
    const Expression hddot_of_v = graph.adopt(contact.hddot), hddot = substitute(hddot_of_v, v, velocity);
    const Row by_q = gradient(hddot_of_v, q), by_v = gradient(hddot_of_v, v);
    const Expression by_sigma = product(by_v, n),
                     rate_along = product(by_q, s) + product(by_v, A) + derivative(hddot_of_v, layout.t());
    const Row drift{rate_along, product(by_q, n) + product(by_v, B), product(by_v, D)};
    std::vector<std::uint32_t> variables = q;
    variables.insert(variables.end(), v.begin(), v.end());
    variables.push_back(layout.sigma());
    if (!equations.autonomous) variables.push_back(layout.t());

    const Slots slots = layout.slots();
    const Row slope_of_hddot = gradient(hddot, variables),
              shadow = ShadowTerms<NoOutputs>::list(A, n, B, D, depends_on_slip ? sum(ndot, along(n, v, rate)) : ndot,
                                                    Bdot, dA_dq, dA_ds, drift);
    return {variables,
            Program(Row{hddot}, slots),
            Program(slope_of_hddot, slots),
            TypedProgram<BouncingRates>::of(slots, velocity, rate),
            TypedProgram<TrendTerms>::of(slots, hddot_of_v, rate_along, by_sigma),
            Program(joined({slope_of_hddot, shadow}), slots),
            {}};
}

OtherContactTerms derive_other_contacts(const std::vector<std::size_t>& bouncing, Mode mode,
                                        const Expressions& velocity, ContactModes& motions, const Layout& layout,
                                        const FrictionConditions& friction) {
    const std::vector<ContactEquations>& contacts = motions.of(mode).contacts;
    std::vector<std::uint32_t> v;
    for (std::size_t i = 0; i < layout.dof; ++i) v.push_back(layout.v(i));
    OtherContactTerms result;
    result.bouncing = bouncing;
    Row outputs, gaps;
    for (const std::size_t k : bouncing) outputs.push_back(contacts[k].W);
    for (std::size_t j = 0; j < contacts.size(); ++j) {
        if (mode.is_held(j)) {
            result.held.push_back(j);
            if (const auto known = friction.held.find(j); known != friction.held.end()) {
                outputs.insert(outputs.end(), {known->second.hddot, known->second.W, known->second.kappa});
                continue;
            }
            outputs.push_back(substitute(contacts[j].hddot, v, velocity));
            outputs.push_back(contacts[j].W);
            for (const std::size_t k : bouncing) outputs.push_back(-(contacts[j].delassus[k] / contacts[j].W));
        } else if (std::find(bouncing.begin(), bouncing.end(), j) == bouncing.end()) {
            result.open.push_back(j);
            gaps.push_back(contacts[j].gap);
        }
    }
    Row conditions = friction.positive, nonzero;
    for (const std::size_t k : bouncing)
        if (const auto& when = motions.when()[k]) conditions.push_back(substitute(*when, v, velocity));
    for (const Expression guard : motions.watched_guards()) nonzero.push_back(substitute(guard, v, velocity));
    result.positive = conditions.size();
    result.nonzero = nonzero.size();
    result.conditions = friction.conditions;
    result.cones = friction.contacts_with_cone;
    result.program = Program(joined({outputs, gaps, conditions, nonzero, friction.cones}), layout.slots());
    return result;
}

OtherContactTerms derive_other_contacts(std::size_t contact, Mode mode, ContactModes& motions, const Layout& layout) {
    const Row& n = motions.of(mode).contacts.at(contact).direction;
    Row velocity;
    for (std::size_t i = 0; i < layout.dof; ++i)
        velocity.push_back(motions.graph().symbol(layout.v(i)) + n[i] * motions.graph().symbol(layout.sigma()));
    return derive_other_contacts({contact}, mode, velocity, motions, layout);
}

Expressions pair_velocity(const std::array<Expressions, 2>& N, const Layout& layout) {
    Graph& graph = N[0].front().graph();
    Row velocity;
    for (std::size_t i = 0; i < layout.dof; ++i)
        velocity.push_back(graph.symbol(layout.v(i)) + N[0][i] * graph.symbol(layout.sigma()) +
                           N[1][i] * graph.symbol(layout.second_sigma()));
    return velocity;
}

TypedProgram<PairTerms> derive_pair_terms(const Expressions& A, const std::array<Expressions, 2>& N,
                                          const Expressions& accelerations, const Expressions& delassus, bool bent,
                                          const Layout& layout, const Expressions& skew) {
    const std::size_t n = layout.dof;
    Graph& graph = A.front().graph();
    const std::array<Expression, 2> sigma{graph.symbol(layout.sigma()), graph.symbol(layout.second_sigma())};
    const std::vector<std::uint32_t> q = slots_from(layout.q(0), n), v = slots_from(layout.v(0), n);
    const Row s = symbols(v, graph), velocity = pair_velocity(N, layout);
    const auto at_state = [&](const Row& row) { return bent ? at_velocity(row, v, velocity) : row; };
    std::array<Row, 2> slope, N_t, B;
    for (std::size_t k = 0; k < 2; ++k) {
        slope[k] = along(A, v, N[k]);
        N_t[k] = derivative(N[k], layout.t());
        const Row turn = along(N[k], q, s);
        for (std::size_t i = 0; i < n; ++i) B[k].push_back(slope[k][i] - turn[i] - N_t[k][i]);
    }
    // 1/2 d2F/dsigma_k dsigma_l, the mixed one twice
    const auto curvature = [&](std::size_t k, std::size_t l) {
        const Row bend = at_state(along(slope[k], v, N[l])), by_k = along(N[k], q, N[l]), by_l = along(N[l], q, N[k]);
        const Expression share = k == l ? graph.number(1, 2) : graph.number(1);
        Row D;
        for (std::size_t i = 0; i < n; ++i) D.push_back(share * bend[i] - (k == l ? by_k[i] : by_k[i] + by_l[i]));
        return D;
    };
    const std::array<Row, 3> D{curvature(0, 0), curvature(0, 1), curvature(1, 1)};
    std::array<Row, 2> Ndot, Bdot;
    for (std::size_t k = 0; k < 2; ++k) Ndot[k] = sum(along(N[k], q, velocity), N_t[k]);
    Row rate = at_velocity(A, v, velocity);  // F
    for (std::size_t i = 0; i < n; ++i) rate[i] = rate[i] - Ndot[0][i] * sigma[0] - Ndot[1][i] * sigma[1];
    for (std::size_t k = 0; k < 2; ++k) {
        Bdot[k] = sum(sum(along(B[k], q, velocity), along(B[k], v, rate)), derivative(B[k], layout.t()));
    }
    return TypedProgram<PairTerms>::of(layout.slots(), accelerations, delassus, A, joined({N[0], N[1]}),
                                       joined({B[0], B[1]}), joined({Ndot[0], Ndot[1]}), joined({Bdot[0], Bdot[1]}),
                                       joined({D[0], D[1], D[2]}), row_by_row(A, q), row_by_row(A, v), skew);
}

PairPrograms derive_pair(std::size_t first, std::size_t second, Mode closed, ContactModes& motions,
                         const Equations& equations, const Layout& layout) {
    const Mode mode = closed.without(ContactSet::of(first).with(second));
    const ModeEquations& both = motions.of(closed);
    const ModeEquations& open = motions.of(mode);
    const std::array<Row, 2> N{both.contacts[first].direction, both.contacts[second].direction};
    const Row velocity = pair_velocity(N, layout);
    const Row hddot = at_velocity({open.contacts[first].hddot, open.contacts[second].hddot},
                                  slots_from(layout.v(0), layout.dof), velocity);
    const Row delassus{open.contacts[first].W, open.contacts[first].delassus[second], open.contacts[second].W};
    PairPrograms result;
    result.terms = derive_pair_terms(both.f, N, hddot, delassus, !equations.quadratic_in_rates, layout);
    result.others = derive_other_contacts({first, second}, mode, velocity, motions, layout);
    return result;
}

}  // namespace achilles
