#include "check/flat_gap.hpp"

#include <cmath>
#include <random>

#include "model/flat.hpp"

namespace achilles {

namespace {

// A step of Newton's method for h = 0 along dh: |h| before it. Nothing where dh = 0.
std::optional<double> newton_step(ContactTerms<Evaluator<double>>& terms, State& state) {
    set_state(terms, state);
    terms.run();
    const auto dof = static_cast<std::size_t>(state.q.size());
    double slope = 0.0;
    for (std::size_t i = 0; i < dof; ++i) slope += terms.gradient(i) * terms.gradient(i);
    if (!(slope > 0.0)) return std::nullopt;
    for (std::size_t i = 0; i < dof; ++i)
        state.q[static_cast<Eigen::Index>(i)] -= terms.h() / slope * terms.gradient(i);
    return std::abs(terms.h());
}

// True if |h| has fallen, for the last few steps, by the factor (1 - 1/m)^m of a zero of order m > 1: 1/4 and a little more, short
// of the 1/e of a gap that never closes. Where dh stays it falls faster and faster. Then the state is brought near to the zero:
// steps shorten by 1 - 1/m.
bool falls_to_flat(const Model& model, const Run& run, std::size_t contact, State& state) {
    constexpr int steps = 12, looked_at = 4, until_near = 60;
    constexpr double least = 0.2, most = 0.35;
    auto terms = model.evaluator(model.programs_of(contact).contact_terms, run.parameters);
    double before = 0.0;
    State near = state;  // after `steps`
    for (int round = 0; round <= steps; ++round) {
        near = state;
        const auto h = newton_step(terms, state);
        const double share = h.value_or(0.0) / before;
        if (round > steps - looked_at && !(share > least && share < most)) return false;
        before = h.value_or(0.0);
        if (!h) break;
    }
    if (!(before > 0.0 && is_flat(model, run.parameters, near, contact))) return false;
    for (int round = 0; round < until_near && newton_step(terms, state); ++round) {
    }
    return true;
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
