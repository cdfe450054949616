// The Zeno lens: the bounces before a Zeno point, over -log10(tau_inf - t), with the gap of each flight divided by the
// square of its initial speed. In these coordinates the infinitely many flights, each shorter than the last by the
// factor e, are evenly spaced arcs of equal height.
#pragma once

#include <optional>

#include "figure/figure.hpp"
#include "figure/palette.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// The impacts of one contact that lead to a Zeno event while the same other contacts are held.
class Lens {
 public:
    // The lens of the trajectory's event number `event` (from 0). nullopt if it is no Zeno event, if no impact precedes
    // it, if several contacts come to rest together, or if e = 0 (a single plastic impact).
    static std::optional<Lens> at(const Trajectory& trajectory, std::size_t event);

    // Coefficient of restitution e, and positions on the axis x = -log10(tau_inf - t), t in seconds: the first impact;
    // the cut (tau_k); the start of the certified interval of tau_inf; and the spacing of impacts, -log10(e).
    double restitution() const { return e_; }
    double first() const { return flights_.front().x; }
    double cut() const { return cut_; }
    std::optional<double> interval() const { return interval_; }
    double spacing() const { return spacing_; }

    // An interval of x that shows the cut and the start of the certified interval.
    struct LensPart {
        double low, high;
    };
    LensPart overview() const;

    // The flights between x = low and x = high, and the certified interval of tau_inf as a band. The band starts at
    // zeno_low and has no end, because tau_inf is infinitely far to the right. Up to the cut the flights are those of
    // the run: gap divided by the square of the impact speed. After the cut the limit is drawn for any x: arcs of
    // height e^2/(2 a), where a = -hddot at the Zeno point (with the other contacts held).
    Panel panel(double low, double high, const Theme& theme) const;

 private:
    struct FlightCurve {
        double x = 0.0, speed = 0.0;  // of the impact at its start
        std::vector<Point> points;    // (x, h/speed^2)
    };
    std::vector<FlightCurve> flights_;
    double cut_ = 0.0, spacing_ = 0.0, e_ = 0.0, height_ = 0.0;
    std::optional<double> interval_;
};

}  // namespace achilles
