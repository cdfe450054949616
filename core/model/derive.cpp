#include "model/derive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "model/rate_polynomial.hpp"

namespace achilles {

namespace {

using Row = std::vector<Expression>;

// M = L D L' with unit lower triangular L. Square roots are not needed and zeros stay zeros; L D is kept beside L,
// because it is there before the division.
class Factorisation {
 public:
    Factorisation(const Row& M, std::size_t n, Graph& graph) : dof_(n), lower_(n * n, graph.number(0)), pivots_(n) {
        Row product(n * n, graph.number(0));  // L D
        for (std::size_t j = 0; j < n; ++j) {
            pivots_[j] = M[j * n + j];
            for (std::size_t k = 0; k < j; ++k) pivots_[j] = pivots_[j] - lower_[j * n + k] * product[j * n + k];
            if (pivots_[j].is_zero()) throw std::domain_error(fmt::format("pivot {} is 0", j + 1));
            for (std::size_t i = j + 1; i < n; ++i) {
                Expression entry = M[i * n + j];
                for (std::size_t k = 0; k < j; ++k) entry = entry - lower_[i * n + k] * product[j * n + k];
                product[i * n + j] = entry;
                lower_[i * n + j] = entry / pivots_[j];
            }
        }
    }

    const Row& pivots() const { return pivots_; }

    // M^-1 right
    Row solve(Row x) const {
        for (std::size_t i = 0; i < dof_; ++i)
            for (std::size_t k = 0; k < i; ++k) x[i] = x[i] - lower_[i * dof_ + k] * x[k];
        for (std::size_t i = 0; i < dof_; ++i) x[i] = x[i] / pivots_[i];
        for (std::size_t i = dof_; i-- > 0;)
            for (std::size_t k = i + 1; k < dof_; ++k) x[i] = x[i] - lower_[k * dof_ + i] * x[k];
        return x;
    }

 private:
    std::size_t dof_;
    Row lower_, pivots_;
};

Expression dot(const Row& a, const Row& b, Graph& graph) {
    Expression sum = graph.number(0);
    for (std::size_t i = 0; i < a.size(); ++i) sum = sum + a[i] * b[i];
    return sum;
}

// b_i = sum_jk (dM_ij/dq_k - 1/2 dM_jk/dq_i) v_j v_k + dV/dq_i, with the two terms of v_j v_k gathered: half the
// products.
Row bias(const Row& M, Expression potential, const Row& v, const std::vector<std::uint32_t>& q, Graph& graph) {
    const std::size_t n = v.size();
    const std::vector<Row> dM = jacobian(M, q);  // dM[i n + j][k] = dM_ij/dq_k
    Row b = gradient(potential, q);
    for (std::size_t i = 0; i < n; ++i) {
        const auto of = [&](std::size_t j, std::size_t k) {
            return dM[i * n + j][k] - graph.number(1, 2) * dM[j * n + k][i];
        };
        for (std::size_t j = 0; j < n; ++j) {
            Expression inner = of(j, j) * v[j];
            for (std::size_t k = 0; k < j; ++k) inner = inner + (of(j, k) + of(k, j)) * v[k];
            b[i] = b[i] + inner * v[j];
        }
    }
    return b;
}

// Of degree 2 or less in these symbols, as far as a polynomial can be told.
bool is_quadratic(Expression expression, const std::vector<std::uint32_t>& slots) {
    Expression offender;
    const auto expanded = expand_in_rates(expression, slots, offender);
    if (!expanded) return false;
    return std::all_of(expanded->begin(), expanded->end(),
                       [](const auto& term) { return std::accumulate(term.first.begin(), term.first.end(), 0) <= 2; });
}

// A quotient whose divisor is never zero: a factor that it shares with the dividend goes.
Expression cancelled(Expression quotient, Graph& graph) {
    const auto at = [&](std::uint32_t id) { return Expression(&graph, id); };
    const Graph::Node node = graph.node(quotient.id());  // a copy: what follows makes nodes
    if (node.operation == Operation::multiply && at(node.a).is_number())
        return at(node.a) * cancelled(at(node.b), graph);
    if (node.operation == Operation::multiply && at(node.b).is_number())
        return at(node.b) * cancelled(at(node.a), graph);
    if (node.operation != Operation::divide) return quotient;
    const Graph::Node dividend = graph.node(node.a);
    if (dividend.operation != Operation::multiply) return quotient;
    if (dividend.a == node.b) return at(dividend.b);
    return dividend.b == node.b ? at(dividend.a) : quotient;
}

}  // namespace

void derive(Equations& e, const Layout& layout, Graph& graph) {
    const std::size_t n = layout.dof;
    std::vector<std::uint32_t> q_slots, v_slots;
    Row v;
    for (std::size_t i = 0; i < n; ++i) {
        q_slots.push_back(layout.q(i));
        v_slots.push_back(layout.v(i));
        v.push_back(graph.symbol(layout.v(i)));
    }
    const std::uint32_t t = layout.t();
    const Factorisation mass(e.M, n, graph);
    e.pivots = mass.pivots();
    e.bias = bias(e.M, e.potential, v, q_slots, graph);
    Row against(n);  // b - Q
    for (std::size_t i = 0; i < n; ++i) against[i] = e.bias[i] - e.Q[i];
    e.f = mass.solve(against);
    for (Expression& f : e.f) f = -f;

    e.g = gradient(e.gap, q_slots);
    e.gap_t = derivative(e.gap, t);
    e.hdot = dot(e.g, v, graph) + e.gap_t;
    Expression curvature = graph.number(0);  // v'Hv
    const std::vector<Row> H = jacobian(e.g, q_slots);
    for (std::size_t i = 0; i < n; ++i) {
        const Row& row = H[i];
        e.H.insert(e.H.end(), row.begin(), row.end());
        curvature = curvature + v[i] * dot(row, v, graph);
    }
    const Row impulse = mass.solve(e.g);  // M^-1 g'
    e.W = dot(e.g, impulse, graph);
    if (e.W.is_zero()) throw std::domain_error("dh M^-1 dh' is 0");
    for (const Expression u : impulse) e.impulse_direction.push_back(u.is_zero() ? u : cancelled(u / e.W, graph));

    const Expression turning = graph.number(2) * dot(derivative(e.g, t), v, graph) + derivative(e.gap_t, t);
    e.hddot = curvature + turning + dot(e.g, e.f, graph);
    e.lambda = -(e.hddot / e.W);
    for (std::size_t i = 0; i < n; ++i) {
        e.f_c.push_back(e.f[i] - e.impulse_direction[i] * e.hddot);
        e.f_by_force.push_back(e.f[i] + impulse[i] * e.lambda);
        e.s.push_back(v[i] - e.impulse_direction[i] * e.hdot);
    }
    e.energy = e.kinetic + e.potential;
    e.jerk = dot(gradient(e.hddot, q_slots), v, graph) + dot(gradient(e.hddot, v_slots), e.f_c, graph) +
             derivative(e.hddot, t);
    e.power = dot(v, e.Q, graph) + derivative(e.potential, t);
    const auto is_steady = [&](Expression x) { return !depends_on(x, {&t, 1}); };
    e.autonomous = is_steady(e.gap) && is_steady(e.potential) && std::all_of(e.Q.begin(), e.Q.end(), is_steady);
    for (const Expression force : e.Q) e.quadratic_in_rates = e.quadratic_in_rates && is_quadratic(force, v_slots);
}

}  // namespace achilles
