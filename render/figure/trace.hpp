// Curves along a run, sampled in the pixels of the picture that shows them: by how far a chord is off, not by count.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "figure/axes.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// The size of a plot area, pixels. In a picture that is larger by a factor chords are off by that factor more.
struct Resolution {
    double width = 1600.0, height = 1200.0;
    friend bool operator==(const Resolution&, const Resolution&) = default;
};

// The quantities that are drawn at a sample: x first, then each y, in the units of the map.
using ReadQuantities = std::function<void(const Sample& sample, std::span<double> values)>;

// A curve of one quantity in phases of one kind. A NaN point breaks it.
struct Course {
    std::vector<Point> points;
    std::vector<double> times;  // s, of each point
    bool is_crowded = false;    // it runs to and fro so closely that dashes would not be seen
};

struct TraceRequest {
    double from = 0.0, to = 0.0;     // s
    std::vector<std::size_t> shown;  // y quantities, counted from 0
    std::size_t quantities = 1;      // all y quantities
    bool over_time = true;           // x is the time; else a path in a plane
    bool with_work = false;          // the quantities depend on the work
    std::vector<double> noise{};     // rounding of each quantity, x first; empty: 0
    Resolution size{};               // of the plot area that `map` fills, its upper left corner at (0, 0)
    const PanelMap* map = nullptr;
};

struct Trace {
    std::vector<Course> courses;  // of each y two: hybrid phases, constrained ones
    // The lowest and highest value of each quantity that has a place on its axis, x first; low > high where there is none.
    std::vector<std::array<double, 2>> ranges;
};

// Samples the run's dense output so that between two points a curve is off its chord by at most a few tenths of a pixel:
// over time measured upwards, in a plane across the chord. What the picture cannot show is left out: over time, of a quarter of
// a pixel's width only the first, lowest, highest and last point is kept; of a path that is longer than a picture holds, what lies
// on its earlier parts, within half a pixel. So the number of points depends on the picture, not on the run's length.
Trace trace(const Trajectory& trajectory, const TraceRequest& request, const ReadQuantities& read);

// A curve without the parts that lie within half a pixel of earlier ones and go along them: dashes over dashes would look like a
// solid line. Where parts are left out a NaN point breaks it. `size` is that of the plot area.
std::vector<Point> without_retraced(const std::vector<Point>& points, const Axis& x, const Axis& y,
                                    const Resolution& size);

}  // namespace achilles
