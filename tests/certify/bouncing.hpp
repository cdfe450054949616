// What really happens after a collision, in 34 digits: the bouncing to its Zeno point, impact by impact, and the
// constrained motion from a restart. Certificates (core/certify) are judged by it.
#pragma once

#include <optional>

#include "certify/taylor.hpp"
#include "model/model.hpp"
#include "trajectory.hpp"

namespace achilles::test {

struct Point {
    Reals q, v;
};

struct ZenoPoint {
    Real time;  // tau_inf - tau_k
    Point point;
    int impacts = 0;
    std::vector<Reals> velocities;  // after each impact and before the next: the largest excursions on the way
};

class TrueMotion {
 public:
    TrueMotion(const Model& model, const Run& run);

    // The collision that a computed state stands for: q moved along n until h = 0 to working precision, v as it is.
    Point collision(const State& before);
    // Where Def. 7 (Euclidean) or the plastic impact (kinetic) restarts from it.
    Point restart(const Point& collision, Reinitialization kind);
    // Follows the impacts until their speed has fallen by the factor `until`; what is left is a geometric series, up to
    // terms in the square of that speed. Nothing if the bouncing does not behave like one.
    std::optional<ZenoPoint> zeno(const Point& collision, double until = 1e-8);
    // The motion that keeps contact, for a time.
    Point constrained(Point start, const Real& duration, double tolerance);

 private:
    struct Contact {
        Real h, hdot;
        Reals n, g;
    };
    using Coefficients = std::vector<Point>;  // by order
    Contact contact(const Point& point);
    Coefficients expand(Evaluator<Series>& motion, const Point& from, double duration, double tolerance);
    // Flies until the next impact; adds the time that takes. False if there is none.
    bool fly(Point& point, Real& time, double expected, double tolerance);
    std::optional<Real> landing(const Coefficients& path, const Real& step);

    std::size_t n_;
    Real e_;
    Evaluator<Series> flight_, contact_motion_, gap_;
    Evaluator<Real> surface_, acceleration_;
};

Real distance(const Reals& a, const Reals& b);

}  // namespace achilles::test
