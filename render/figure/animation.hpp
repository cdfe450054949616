// An animation of a run, still by still: the mechanism with its trail, and beside or below it plots that fill as time
// passes. Whatever does not move stands in every still at the same place.
#pragma once

#include "figure/compose.hpp"
#include "figure/figure.hpp"
#include "figure/layout.hpp"
#include "figure/stage.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Two parts of a picture, in pixels.
struct StillAreas {
    Rectangle world, plots;  // plots without extent: there are none
    int columns = 1;         // of the plots
};

// The plots to the right of a world or below it, as shows a world of this shape (width over height) larger.
StillAreas still_areas(double shape, std::size_t plots, Rectangle area);

struct StillSize {
    int width = 1600, height = 1000;  // pixels
    double scale = 1.0;               // of text and strokes, over what fits the size
    bool dark = false;
};
constexpr double still_title_size = 17.0;  // pixels at scale 1
constexpr double still_margin = 16.0;      // the same, around the mechanism but above it

// The scale of everything in a still: a small film is a large one made smaller, as long as it can be read.
double still_scale(const StillSize& size);

// One picture of an animation.
struct Still {
    Sheet heading;  // and the background
    Drawing world;
    Figure plane;  // in place of a world that nothing draws: that of two coordinates, with the boundary; else empty
    Figure plots;
    StillAreas areas;
    double scale = 1.0;
    std::string unit;  // of lengths in the world
    Color faint;       // of its scale bar
};

// The still as text, what moves with 9 significant digits: for tests.
std::string to_text(const Still& still);

class Animation {
 public:
    // Refers to the trajectory. `step`: seconds of the run from one still to the next, which decide the digits of the
    // clock. Throws InputError for a view that cannot be evaluated.
    Animation(const Trajectory& trajectory, std::span<const ViewDescription> views, const StillSize& size, double step,
              CameraMode camera = CameraMode::fit);
    // At a time within the run.
    Still at(double t);

 private:
    void add_present(Panel& panel, const PreparedView& view, const Sample& now) const;

    const Trajectory& trajectory_;
    std::optional<double> horizon_;  // of the run, where it comes before its end
    StillSize size_;
    int decimals_;
    Sampler sampler_;
    std::vector<Sample> samples_;
    std::vector<PreparedView> views_;
    Mechanism mechanism_;
    Stage stage_;
    CameraMode camera_;
    Figure figure_;  // the whole run, pale
    std::optional<PreparedView> plane_view_;
    Figure plane_;
    StillAreas areas_;
};

}  // namespace achilles
