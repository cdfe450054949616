// Fig. 4 of the paper from our own runs, and its numbers beside ours.
#pragma once

#include "figure/figure.hpp"
#include "run/trajectory.hpp"

namespace achilles {

struct NamedFigure {
    std::string name;           // of the file, without ending
    int width = 0, height = 0;  // pixels at scale 1
    Figure figure;
};

// (a) x, (b) y, (c) h against t and (d) the path over the surface, of the ball; (e) theta1 and (f) theta2 of the double
// pendulum; then one page with all six, and one with what the paper could not show. Both runs are of the systems in
// assets with the paper's numbers.
std::vector<NamedFigure> paper_figures(const Trajectory& ball, const Trajectory& pendulum);

// When the ball comes to rest in the second valley if every bouncing is cut at the first impact with hddot < 0 and a
// speed below `speed` (m/s), as a simulator with a velocity threshold does. Not a number if it never happens.
double rest_time_with_threshold(const Trajectory& ball, double speed);

// How wide the certified interval of every Zeno time is, by the speed of the impact that the bouncing was cut at: the
// runs again with the sharp conditions and tolerances from 0.1 to 1e-8. One list for each Zeno event of the run.
struct CertifiedWidth {
    double speed, low, high;  // m/s or rad/s; the interval, s
};
std::vector<std::vector<CertifiedWidth>> certified_widths(const Trajectory& run);

// What the paper states, what we find, the difference, and why; the certified intervals: text for a terminal.
std::string paper_table(const Trajectory& ball, const Trajectory& pendulum);

}  // namespace achilles
