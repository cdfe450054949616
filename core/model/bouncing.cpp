#include "model/bouncing.hpp"

#include <algorithm>

#include "model/rows.hpp"

namespace achilles {

Bouncing derive_bouncing(const ContactEquations& contact, const Equations& equations, const Layout& layout) {
    Graph graph(contact.gap.graph());
    const std::size_t count = layout.dof;
    std::vector<std::uint32_t> q, v;
    Row s;
    for (std::size_t i = 0; i < count; ++i) {
        q.push_back(layout.q(i));
        v.push_back(layout.v(i));
        s.push_back(graph.symbol(layout.v(i)));
    }
    const Expression sigma = graph.symbol(layout.sigma()), half = graph.number(1, 2);
    const Row A = adopt(graph, contact.f_c), n = adopt(graph, contact.direction);
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
              shadow = ShadowTerms<NoOutputs>::list(A, n, B, D, ndot, Bdot, dA_dq, dA_ds, drift);
    return {variables,
            Program(Row{hddot}, slots),
            Program(slope_of_hddot, slots),
            ProgramOf<BouncingRates>::of(slots, velocity, rate),
            ProgramOf<TrendTerms>::of(slots, hddot_of_v, rate_along, by_sigma),
            Program(joined({slope_of_hddot, shadow}), slots)};
}

Neighbours derive_neighbours(const std::vector<std::size_t>& bouncing, Mode mode, const Expressions& velocity,
                             ContactModes& motions, const Layout& layout) {
    const std::vector<ContactEquations>& contacts = motions.of(mode).contacts;
    std::vector<std::uint32_t> v;
    for (std::size_t i = 0; i < layout.dof; ++i) v.push_back(layout.v(i));
    Neighbours result;
    result.bouncing = bouncing;
    Row outputs, gaps;
    for (const std::size_t k : bouncing) outputs.push_back(contacts[k].W);
    for (std::size_t j = 0; j < contacts.size(); ++j) {
        if (mode.is_held(j)) {
            result.held.push_back(j);
            outputs.push_back(substitute(contacts[j].hddot, v, velocity));
            outputs.push_back(contacts[j].W);
            for (const std::size_t k : bouncing) outputs.push_back(-(contacts[j].delassus[k] / contacts[j].W));
        } else if (std::find(bouncing.begin(), bouncing.end(), j) == bouncing.end()) {
            result.open.push_back(j);
            gaps.push_back(contacts[j].gap);
        }
    }
    result.program = Program(joined({outputs, gaps}), layout.slots());
    return result;
}

Neighbours derive_neighbours(std::size_t contact, Mode mode, ContactModes& motions, const Layout& layout) {
    const Row& n = motions.of(mode).contacts.at(contact).direction;
    Row velocity;
    for (std::size_t i = 0; i < layout.dof; ++i)
        velocity.push_back(motions.graph().symbol(layout.v(i)) + n[i] * motions.graph().symbol(layout.sigma()));
    return derive_neighbours({contact}, mode, velocity, motions, layout);
}

}  // namespace achilles
