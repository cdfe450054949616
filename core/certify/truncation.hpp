// May the bouncing be cut short at this collision? Two sets of conditions answer with a certificate, or not at all.
#pragma once

#include <memory>
#include <optional>

#include "model/model.hpp"
#include "trajectory.hpp"

namespace achilles {

// Everything the conditions may look at.
struct Collision {
    double t = 0.0;      // tau_k
    State before;        // (q, v-), h(q) = 0
    double speed = 0.0;  // w = |hdot| before
    Vector tangential;   // s = v- - n hdot
    Vector restart;      // after re-initialisation: s, or v*
};

class TruncationConditions {
 public:
    virtual ~TruncationConditions() = default;
    // The certificate if the conditions hold for the run's tolerances; nothing if they do not, or cannot be proved.
    virtual std::optional<Certificate> hold(const Collision& collision) = 0;
    // What can be proved here whatever the tolerances, for a collision after which no further flight can be resolved.
    virtual std::optional<Certificate> widest(const Collision& collision) = 0;
};

// The conditions that the run asks for.
std::unique_ptr<TruncationConditions> truncation_conditions(const Model& model, const Run& run);

// Euclidean norm of an enclosed vector.
Interval norm(const std::vector<Interval>& x);

}  // namespace achilles
