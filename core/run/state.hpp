// The state of a system: coordinates, rates, time. At most 16 coordinates, so that their vectors need no heap
// memory.
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace achilles {

inline constexpr int max_coordinates = 16;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_coordinates, 1>;

struct State {
    Vector q, v;
    double t = 0.0;  // s
};

// Copies a state to the inputs of a program (slots 0 .. 2n - 1 and the clock, see model/derive.hpp).
template <class Evaluator>
void set_state(Evaluator& evaluator, const State& state) {
    const auto n = state.q.size();
    for (Eigen::Index i = 0; i < n; ++i) {
        evaluator.input(static_cast<std::size_t>(i)) = state.q[i];
        evaluator.input(static_cast<std::size_t>(n + i)) = state.v[i];
    }
    evaluator.clock() = state.t;
}

}  // namespace achilles
