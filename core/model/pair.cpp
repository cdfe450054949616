#include "model/pair.hpp"

#include <array>

#include "model/rows.hpp"

namespace achilles {

PairPrograms derive_pair(std::size_t first, std::size_t second, Mode mode, ContactModes& motions,
                         const Equations& equations, const Layout& layout) {
    const ModeEquations& both = motions.of(mode.with(ContactSet::of(first).with(second), ContactState::held));
    const ModeEquations& open = motions.of(mode);
    Graph& graph = motions.graph();
    const std::size_t n = layout.dof;
    const std::array<std::size_t, 2> pair{first, second};
    const std::array<Expression, 2> sigma{graph.symbol(layout.sigma()), graph.symbol(layout.second_sigma())};
    std::vector<std::uint32_t> q, v;
    Row s, velocity;
    for (std::size_t i = 0; i < n; ++i) {
        q.push_back(layout.q(i));
        v.push_back(layout.v(i));
        s.push_back(graph.symbol(layout.v(i)));
        Expression rate = s[i];
        for (std::size_t k = 0; k < 2; ++k) rate = rate + both.contacts[pair[k]].direction[i] * sigma[k];
        velocity.push_back(rate);
    }
    const Row& A = both.f;
    const bool bent = !equations.quadratic_in_rates;
    const auto at_state = [&](const Row& row) { return bent ? at_velocity(row, v, velocity) : row; };
    std::array<Row, 2> N, slope, N_t, B;
    for (std::size_t k = 0; k < 2; ++k) {
        N[k] = both.contacts[pair[k]].direction;
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
    const auto hddot = [&](std::size_t k) { return substitute(open.contacts[pair[k]].hddot, v, velocity); };
    const Row delassus{open.contacts[first].W, open.contacts[first].delassus[second], open.contacts[second].W};
    PairPrograms result;
    result.terms =
        ProgramOf<PairTerms>::of(layout.slots(), Row{hddot(0), hddot(1)}, delassus, A, joined({N[0], N[1]}),
                                 joined({B[0], B[1]}), joined({Ndot[0], Ndot[1]}), joined({Bdot[0], Bdot[1]}),
                                 joined({D[0], D[1], D[2]}), row_by_row(A, q), row_by_row(A, v));
    result.others = derive_neighbours({first, second}, mode, velocity, motions, layout);
    return result;
}

}  // namespace achilles
