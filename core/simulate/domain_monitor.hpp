// Limits steps so that no function reaches the edge of its domain unnoticed (model/domain_boundaries.hpp).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "number/polynomial.hpp"
#include "series/evaluator.hpp"
#include "simulate/stepper.hpp"

namespace achilles {

class DomainMonitor {
 public:
    DomainMonitor(const Model& model, const Run& run);

    // The fraction (0, 1] of the stepper's last step that is safe. Over it, every distance from an edge is known and
    // stays above an eighth of its value at the start, and no monitored exponential grows by more than
    // exp(DomainBoundary::growth). If the motion reaches an edge, the steps shorten to nothing. If it passes close to
    // one, as sqrt(x^2 + y^2) may, the steps resolve the passage.
    double safe_part(const Stepper& stepper, double time);
    // Whether the polynomials of that step were needed, and these polynomials, as from Stepper::coefficients().
    bool has_motion() const { return !motion_.empty(); }
    std::uint32_t append_motion(std::vector<double>& coefficients) const {
        coefficients.insert(coefficients.end(), motion_.begin(), motion_.end() - static_cast<std::ptrdiff_t>(block_));
        return degree_;
    }

 private:
    // A distance along a step as far as its series is expanded.
    struct PartialSum {
        double start, sum, least;    // at the start of the step, at its end, and the smallest partial sum
        const double* output;        // where the series leaves the order that it has reached
        std::array<double, 4> last;  // sizes of the last terms at the end: symmetry may make three in a row 0
        double tail() const { return (last[0] + last[1]) + (last[2] + last[3]); }
    };
    bool is_safe(const Stepper::TimeSeries& motion, double time, double span);
    double safe_part(Polynomial& distance) const;
    double begin_distance(std::size_t i);
    double sign_of(const DomainBoundary& edge, double start) const;

    const std::vector<DomainBoundary>& edges_;
    std::size_t block_;               // q and v
    SeriesEvaluator<double> series_;  // of the distances
    std::vector<Polynomial> distances_;
    std::vector<PartialSum> sums_;
    std::vector<double> signs_;   // factors of the higher terms of each distance
    std::vector<double> motion_;  // the last step as polynomials, and a block of zeros
    std::uint32_t degree_ = 0;    // of those polynomials
};

// ---- messages: the function that becomes undefined just ahead of a state ----

// The first part of the system that cannot be shown to be defined on the straight line along which the state moves. In
// this order: a function outside its domain or a division by zero (in T, V, h or the forces), a function at an edge
// where it is not smooth (sqrt(x^2) at x = 0), a mass matrix that is not positive definite, and an undefined part of
// the equations of motion. Several durations up to 1e-9 max(1e-3, |t|) are tried; the shortest one counts. Interval
// evaluation over the box of the line does not miss a pole between two floating-point numbers. Returns a sentence
// without a period; empty if nothing is found.
std::string edge_of_domain(const Model& model, const Run& run, const State& state);

// The same at the state itself, for a contact that has no normal. Empty if the reason is that dh vanishes.
std::string edge_of_contact(const Model& model, const Run& run, const State& state);

}  // namespace achilles
