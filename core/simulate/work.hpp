// What is done on a system along its run: E(t) - E(0) = work - loss (theory-gaps.md 1).
#pragma once

#include <map>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// Integrates the power along pieces: v'Q + dV/dt, in contact less lambda dh/dt.
class Work {
 public:
    Work(const Model& model, const Run& run);

    // Whether there is any: not where all forces have a potential that, as the gap, does not depend on the time.
    bool any() const { return any_; }
    // Over [from, to] inside a piece, in units of the energy: by Gauss's rule with as many points as the piece has powers, so that
    // a product of two such polynomials is met exactly.
    double along(const Piece& piece, std::span<const double> coefficients, double from, double to);

 private:
    bool any_;
    Eigen::Index dof_;
    const Model* model_;
    std::vector<double> parameters_;
    std::map<Mode, Evaluator<double>> powers_;  // of the motions met so far
};

}  // namespace achilles
