#include "model/bouncing.hpp"

namespace achilles {

namespace {

using Row = std::vector<Expression>;

Row adopt(Graph& graph, const Row& row) {
    Row result;
    for (const Expression e : row) result.push_back(graph.adopt(e));
    return result;
}

// dx/d(slots) times a direction.
Expression along(Expression x, const std::vector<std::uint32_t>& slots, const Row& direction) {
    Expression sum = x.graph().number(0);
    for (std::size_t i = 0; i < slots.size(); ++i) sum = sum + derivative(x, slots[i]) * direction[i];
    return sum;
}

}  // namespace

Bouncing derive_bouncing(const Equations& equations, const Layout& layout) {
    Graph graph(equations.gap.graph());
    const std::size_t count = layout.n;
    std::vector<std::uint32_t> q, v;
    Row s;
    for (std::size_t i = 0; i < count; ++i) {
        q.push_back(layout.q(i));
        v.push_back(layout.v(i));
        s.push_back(graph.symbol(layout.v(i)));
    }
    const Expression sigma = graph.symbol(layout.sigma()), half = graph.number(1, 2);
    const Row A = adopt(graph, equations.f_c), n = adopt(graph, equations.n);
    Row velocity, B, D, rate, ndot, Bdot, jacobian;
    for (std::size_t i = 0; i < count; ++i) {
        velocity.push_back(s[i] + n[i] * sigma);
        const Expression slope = along(A[i], v, n);  // df_c/dv n
        B.push_back(slope - along(n[i], q, s));
        D.push_back(half * along(slope, v, n) - along(n[i], q, n));
        rate.push_back(A[i] + B[i] * sigma + D[i] * power(sigma, 2));
    }
    for (std::size_t i = 0; i < count; ++i) {
        ndot.push_back(along(n[i], q, velocity));
        Bdot.push_back(along(B[i], q, velocity) + along(B[i], v, rate));
    }
    for (const auto& slots : {q, v}) {
        for (const Expression entry : A) {
            const Row row = gradient(entry, slots);
            jacobian.insert(jacobian.end(), row.begin(), row.end());
        }
    }
    const Expression hddot = substitute(graph.adopt(equations.hddot), v, velocity);
    std::vector<std::uint32_t> variables = q;
    variables.insert(variables.end(), v.begin(), v.end());
    variables.push_back(layout.sigma());

    const Slots slots = layout.slots();
    const auto program = [&](std::initializer_list<Row> parts) {
        Row outputs;
        for (const Row& part : parts) outputs.insert(outputs.end(), part.begin(), part.end());
        return Program(outputs, slots);
    };
    return {program({{hddot}}), program({gradient(hddot, variables)}), program({velocity, rate}),
            program({A, n, B, D, ndot, Bdot, jacobian})};
}

}  // namespace achilles
