#include "model/degenerate_gap.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "expression/graph.hpp"

namespace achilles {

namespace {

// Appends, as text, the factors of a product that depend on coordinates or time.
void add_factors(const Model& model, Expression product, std::vector<std::string>& factors) {
    const Graph::Node& node = Builder::node(product);
    if (node.operation == Operation::multiply) {
        add_factors(model, {&product.graph(), node.a}, factors);
        return add_factors(model, {&product.graph(), node.b}, factors);
    }
    const Layout& layout = model.layout();
    std::vector<std::uint32_t> moving{layout.t()};
    for (std::size_t i = 0; i < layout.dof; ++i) moving.push_back(layout.q(i));
    if (depends_on(product, moving)) factors.push_back(to_text(product, model.slot_names()));
}

}  // namespace

std::string product_hint(const Model& model, std::size_t contact) {
    std::vector<std::string> factors;
    add_factors(model, model.equations().gaps[contact], factors);
    if (factors.size() < 2) return "";
    return fmt::format("the gap is a product; write one [[constraint]] for each factor: gap = \"{}\"",
                       fmt::join(factors, "\", gap = \""));
}

bool is_flat(const Model& model, std::span<const double> parameters, const State& state, std::size_t contact) {
    const Layout& layout = model.layout();
    const Expression gap = model.equations().gaps[contact];
    Graph graph(gap.graph());  // a copy, because threads share the model
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
    // A gap with high curvature, such as a distance near its center, is not flat where it closes. Unlike x^2, it no
    // longer looks flat after a Newton step toward h = 0.
    State nearer = state;
    for (std::size_t i = 0; i < layout.dof; ++i)
        nearer.q[static_cast<Eigen::Index>(i)] -= gap_at() * value.output(i) / slope;
    return looks_flat(nearer);
}

}  // namespace achilles
