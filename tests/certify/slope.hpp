// Order of the error of a cut in the impact speed (theory.md 5, theory-gaps.md 6).
#pragma once

#include <memory>
#include <vector>

#include "certify/bouncing.hpp"

namespace achilles::test {

struct Slope {
    double order = 0.0;   // slope of log(error) over log(w)
    double factor = 0.0;  // error/w^3 at the smallest w
};

// Measures the error of the state at a time `later` after a collision, if the impact sequence is replaced by this
// restart. The collisions have (q, s) of Zeno point number `zeno` (from 0) of the default run and these speeds, in
// descending order. Returns zeros if a sequence has no Zeno point.
Slope restart_slope(const std::shared_ptr<const Model>& model, Reinitialization kind, std::size_t zeno = 0,
                    const std::vector<double>& speeds = {3e-2, 3e-3, 3e-4, 3e-5, 3e-6}, double later = 0.5);

}  // namespace achilles::test
