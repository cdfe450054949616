// How far a step may go before a function comes to its edge (model/edges.hpp).
#pragma once

#include <string>
#include <vector>

#include "model/model.hpp"
#include "number/polynomial.hpp"
#include "series/evaluator.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

class EdgeWatch {
 public:
    EdgeWatch(const Model& model, const Run& run);

    // The part (0, 1] of the stepper's last step, from this time on, along which every distance from an edge stays above an eighth of what
    // it was at the start, or is known at all, and nothing that hides grows by more than exp(Edge::growth). To an edge
    // that is met the steps shorten to nothing; one that is passed closely, as sqrt(x^2 + y^2) may pass its, is passed
    // in steps that see it.
    double safe_part(const Stepper& stepper, double time);

 private:
    double safe_part(Polynomial& distance) const;
    double sign_of(const Edge& edge, double start) const;

    const std::vector<Edge>& edges_;
    std::size_t block_;               // q and v
    SeriesEvaluator<double> series_;  // of the distances
    std::vector<Polynomial> distances_;
    std::vector<double> signs_;   // of a distance's terms, after the first
    std::vector<double> motion_;  // of the last step, as the stepper tells it, and an order of zeros
};

// Why no motion follows a state: what stops being defined just ahead of it.

// The first part of the system that cannot be shown to be defined along the straight line that the state moves on, for
// the shortest of a few times up to 1e-9 max(1e-3, |t|): a function outside its domain, a division by zero (both named
// as they stand in T, V, h or the equations of motion), a function at an edge where it is not smooth (sqrt(x^2) where
// x = 0), or a mass matrix that is not positive definite. Interval evaluation over the box of that line: a pole between
// two floating-point numbers is not missed. A sentence without a full stop; empty if there is none.
std::string edge_of_domain(const Model& model, const Run& run, const State& state);

// The same at the state itself, to within rounding, for a contact. Empty where it is dh that vanishes.
std::string edge_of_contact(const Model& model, const Run& run, const State& state);

}  // namespace achilles
