#include "check/flat_gap.hpp"

#include <cmath>
#include <random>

#include "model/flat.hpp"

namespace achilles {

namespace {

// Newton's method for h = 0 along dh. True if |h| has fallen, for the last few steps, by the factor (1 - 1/m)^m of a zero of order
// m > 1: 1/4 and a little more, short of the 1/e of a gap that never closes. Where dh stays it falls faster and faster.
bool falls_to_flat(const Model& model, const Run& run, std::size_t contact, State& state) {
    constexpr int steps = 12, looked_at = 4;
    constexpr double least = 0.2, most = 0.35;
    auto terms = model.evaluator(model.programs_of(contact).contact_terms, run.parameters);
    double before = 0.0;
    for (int round = 0; round <= steps; ++round) {
        set_state(terms, state);
        terms.run();
        const double h = terms.h(), share = std::abs(h) / before;
        if (round > steps - looked_at && !(share > least && share < most)) return false;
        before = std::abs(h);
        double slope = 0.0;
        const auto dof = static_cast<std::size_t>(state.q.size());
        for (std::size_t i = 0; i < dof; ++i) slope += terms.gradient(i) * terms.gradient(i);
        if (round == steps || !(slope > 0.0)) break;
        for (std::size_t i = 0; i < dof; ++i) state.q[static_cast<Eigen::Index>(i)] -= h / slope * terms.gradient(i);
    }
    return before > 0.0 && is_flat(model, run.parameters, state, contact);
}

}  // namespace

std::optional<State> flat_place(const Model& model, const Run& run, std::size_t contact) {
    constexpr int tries = 8;
    std::mt19937_64 engine(4);
    for (int i = 0; i < tries; ++i) {
        State state = run.start();
        for (Eigen::Index k = 0; i > 0 && k < state.q.size(); ++k) {
            const auto& range = model.description().coordinates[static_cast<std::size_t>(k)].range;
            state.q[k] = range[0] + (range[1] - range[0]) * (static_cast<double>(engine() >> 11) * 0x1p-53);
        }
        if (falls_to_flat(model, run, contact, state)) return state;
    }
    return std::nullopt;
}

}  // namespace achilles
