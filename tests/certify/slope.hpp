// How the error of a cut falls with the impact speed (theory.md 5, theory-gaps.md 6).
#pragma once

#include <memory>
#include <vector>

#include "certify/bouncing.hpp"

namespace achilles::test {

struct Slope {
    double order = 0.0;   // of log(error) against log(w)
    double factor = 0.0;  // error/w^3 at the least w
};

// The error at a time `later` after collisions at the place of a Zeno point of the default run (the first is 0),
// which share (q, s) and differ in their speed, `speeds` in descending order; of the state there, when the bouncing
// is replaced by this restart. Zeros where some bouncing has no Zeno point.
Slope restart_slope(const std::shared_ptr<const Model>& model, Reinitialization kind, std::size_t zeno = 0,
                    const std::vector<double>& speeds = {3e-2, 3e-3, 3e-4, 3e-5, 3e-6}, double later = 0.5);

}  // namespace achilles::test
