// Samples curves along a run for the pixels of a picture: by the error of the chords, not by a number of points.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "figure/axes.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Size of a plot area in pixels. In a picture enlarged by some factor, the errors of the chords grow by that factor.
struct Resolution {
    double width = 1600.0, height = 1200.0;
    friend bool operator==(const Resolution&, const Resolution&) = default;
};

// Evaluates the drawn quantities at a sample: x first, then each y, in the units of the map.
using ReadQuantities = std::function<void(const Sample& sample, std::span<double> values)>;

// A curve of one quantity in all phases of one look (palette.hpp). A NaN point breaks it.
struct PhaseCurve {
    std::vector<Point> points;
    std::vector<double> times;  // s, of each point
    bool is_crowded = false;    // it oscillates so densely that dashes would be invisible
};

struct TraceRequest {
    double from = 0.0, to = 0.0;     // s
    std::vector<std::size_t> shown;  // y quantities, counted from 0
    std::size_t quantities = 1;      // number of y quantities
    bool over_time = true;           // x is time; false: a path in a plane
    bool with_work = false;          // the quantities depend on the work or the heat
    std::vector<double> noise{};     // rounding error of each quantity, x first; empty: 0
    Resolution size{};               // of the plot area that `map` fills, its upper left corner at (0, 0)
    const PanelMap* map = nullptr;
    // Coarse curves go straight through some of these samples. Empty: the motion between steps is traced.
    std::span<const Sample> through{};
};

struct Trace {
    std::vector<PhaseCurve> courses;  // for each y one for each look of a phase, look_count() of them
    // Minimum and maximum of each quantity over the values that its axis can show, x first; low > high if there are
    // none.
    std::vector<std::array<double, 2>> ranges;
};

// Samples the dense output of a run so that every curve deviates from its chords by at most a few tenths of a pixel.
// Over time the deviation is measured vertically, in a plane perpendicular to the chord.
// Invisible detail is left out. Over time, only the first, lowest, highest and last point are kept of each column a
// quarter of a pixel wide. Of a path longer than a picture can show, parts within half a pixel of earlier parts are
// dropped. The number of points therefore depends on the picture, not on the length of the run.
Trace trace(const Trajectory& trajectory, const TraceRequest& request, const ReadQuantities& read);

// Removes the parts of a curve that lie within half a pixel of earlier parts and run along them, because overlapping
// dashes would look like a solid line. A NaN point replaces each removed part. `size`: of the plot area.
std::vector<Point> without_retraced(const std::vector<Point>& points, const Axis& x, const Axis& y,
                                    const Resolution& size);

}  // namespace achilles
