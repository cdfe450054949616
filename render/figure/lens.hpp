// The Zeno lens: the bouncing before a Zeno point, with time as -log(tau_inf - t) and every flight's gap divided by the
// square of the speed it took off from. In these coordinates the infinitely many flights, each e times as long as the
// one before, become an evenly spaced row of equal arcs that never ends.
#pragma once

#include <optional>

#include "figure/figure.hpp"
#include "figure/palette.hpp"
#include "run/trajectory.hpp"

namespace achilles {

// What the lens looks at: the impacts of one contact that lead to a Zeno event, while the same others are held.
class Lens {
 public:
    // Of the trajectory's event number `event` (from 0). Nothing where it is no Zeno event, where no impact leads to
    // it, where several contacts come to rest together, or where e = 0, which takes one impact and leaves no row.
    static std::optional<Lens> at(const Trajectory& trajectory, std::size_t event);

    // x = -log10(tau_inf - t), t in seconds. The first impact; where the run was cut (tau_k); where the certified
    // interval of tau_inf begins; and the distance between neighbours in the row, -log10(e).
    double restitution() const { return e_; }
    double first() const { return flights_.front().x; }
    double cut() const { return cut_; }
    std::optional<double> interval() const { return interval_; }
    double spacing() const { return spacing_; }

    // As much of the row as shows the cut and where the interval begins.
    struct Part {
        double low, high;
    };
    Part overview() const;

    // The row from x = low to high, and as a band the certified interval of tau_inf: it begins at zeno_low, and as
    // tau_inf is infinitely far to the right, it has no end. Up to the cut it is the run's own: gap over the square of
    // the impact speed. From there on it is drawn as the limit it approaches, arcs of height e^2/(2 a), a = -hddot at
    // the Zeno point (while the others are held), for as long as anyone scrolls.
    Panel panel(double low, double high, const Theme& theme) const;

 private:
    struct Flight {
        double x = 0.0, speed = 0.0;  // of the impact it starts from
        std::vector<Point> points;    // (x, h/speed^2)
    };
    std::vector<Flight> flights_;
    double cut_ = 0.0, spacing_ = 0.0, e_ = 0.0, height_ = 0.0;
    std::optional<double> interval_;
};

}  // namespace achilles
