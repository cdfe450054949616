// Figure 4 of the paper from our own runs, and a comparison of its numbers with ours.
#pragma once

#include "figure/figure.hpp"
#include "run/trajectory.hpp"

namespace achilles {

struct NamedFigure {
    std::string name;           // file name without extension
    int width = 0, height = 0;  // pixels at scale 1
    Figure figure;
};

// Panels (a) x, (b) y, (c) h over t and (d) path over the surface, for the ball; (e) theta1 and (f) theta2 for the
// double pendulum. Then one page with all six, and one page with results beyond the paper. Both runs must be of the
// asset systems with the paper's parameters.
std::vector<NamedFigure> paper_figures(const Trajectory& ball, const Trajectory& pendulum);

// Time at which the ball comes to rest in the second valley with a velocity threshold instead of a certificate: every
// impact sequence is cut at the first impact with hddot < 0 and a speed below `speed` (m/s). NaN if it never comes to
// rest.
double contact_time_with_velocity_threshold(const Trajectory& ball, double speed);

// Width of the certified interval of the Zeno time as a function of the impact speed at the cut. Computed by repeating
// the run with the sharp conditions and tolerances from 0.1 to 1e-8. One list per Zeno event of the run.
struct CertifiedWidth {
    double speed, low, high;  // m/s or rad/s; bounds of the interval, s
};
std::vector<std::vector<CertifiedWidth>> certified_widths(const Trajectory& run);

// Text table for a terminal: the paper's numbers, ours, the difference and its reason; then the certified intervals.
std::string paper_table(const Trajectory& ball, const Trajectory& pendulum);

}  // namespace achilles
