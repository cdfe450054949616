#include "model/flat.hpp"

#include <cmath>

namespace achilles {

bool is_flat(const Model& model, std::span<const double> parameters, const State& state, std::size_t contact) {
    const Layout& layout = model.layout();
    const Expression gap = model.equations().gaps[contact];
    Graph graph(gap.graph());  // a copy: a model is shared between threads and never changes
    std::vector<std::uint32_t> slots;
    for (std::size_t i = 0; i < layout.dof; ++i) slots.push_back(layout.q(i));
    std::vector<Expression> outputs = gradient(graph.adopt(gap), slots);
    for (const auto& row : jacobian(outputs, slots)) outputs.insert(outputs.end(), row.begin(), row.end());
    outputs.push_back(graph.adopt(gap));
    const Program program(outputs, layout.slots());
    auto value = model.evaluator(program, parameters);
    const auto gap_at = [&] { return value.output(outputs.size() - 1); };
    double slope = 0.0;
    const auto looks_flat = [&](const State& at) {
        set_state(value, at);
        value.run();
        slope = 0.0;
        double bend = 0.0;
        for (std::size_t i = 0; i + 1 < outputs.size(); ++i)
            (i < layout.dof ? slope : bend) += value.output(i) * value.output(i);
        return slope <= 4.0 * std::abs(gap_at()) * std::sqrt(bend);
    };
    if (!looks_flat(state)) return false;
    if (slope == 0.0) return true;
    // A gap that bends much on the way, as a distance near its centre, is not flat where it closes: x^2 is nearer, too.
    State nearer = state;
    for (std::size_t i = 0; i < layout.dof; ++i)
        nearer.q[static_cast<Eigen::Index>(i)] -= gap_at() * value.output(i) / slope;
    return looks_flat(nearer);
}

}  // namespace achilles
