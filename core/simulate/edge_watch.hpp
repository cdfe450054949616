// How far a step may go before a function comes to its edge (model/edges.hpp).
#pragma once

#include <vector>

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

}  // namespace achilles
