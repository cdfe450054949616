// Frames of an animation of a run: the mechanism with its trail, and beside or below it plots that fill as time passes.
// Static parts have the same position in every frame.
#pragma once

#include "figure/compose.hpp"
#include "figure/figure.hpp"
#include "figure/layout.hpp"
#include "figure/mechanism_scene.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Areas of the mechanism view and of the plots in a frame, in pixels.
struct StillAreas {
    Rectangle world, plots;  // plots: zero size if there are none
    int columns = 1;         // columns of the plot grid
};

// Places the plots to the right of the mechanism view or below it, whichever shows the view larger. `shape`: width /
// height of the visible world.
StillAreas still_areas(double shape, std::size_t plots, Rectangle area);

struct StillSize {
    int width = 1600, height = 1000;  // pixels
    double scale = 1.0;               // of text and strokes, relative to the automatic scale
    bool dark = false;
};
constexpr double still_title_size = 17.0;  // pixels at scale 1
constexpr double still_margin = 16.0;      // pixels at scale 1, on all sides of the mechanism but the top

// Scale of text and strokes in a frame. It grows with the picture, so that a small film is a large one reduced, but
// never drops below a readable size.
double still_scale(const StillSize& size);

// What is shown of a system without a drawing: the plane of its first two coordinates, or the phase plane of its only one.
ViewDescription plane_of(const SystemDescription& description);

// One frame of an animation.
struct AnimationFrame {
    Sheet heading;  // and the background
    Drawing world;
    Figure plane;  // the plane of two coordinates with the boundary, if the system has no drawing; else empty
    Figure plots;
    StillAreas areas;
    double scale = 1.0;
    std::string unit;  // unit of length in the world
    Color faint;       // color of the scale bar
};

// The frame as text for tests. Moving parts have 9 significant digits.
std::string to_text(const AnimationFrame& still);

class Animation {
 public:
    // Keeps a reference to the trajectory. `step`: time between two frames (s of the run), which decides the digits of
    // the clock. `direction`: from where a system in space is seen; empty: as its file draws it. Throws InputError if a
    // view cannot be evaluated.
    Animation(const Trajectory& trajectory, std::span<const ViewDescription> views, const StillSize& size, double step,
              CameraMode camera = CameraMode::fit, const std::optional<ViewAngles>& direction = {});
    // The frame at time t (s), which must lie within the run.
    AnimationFrame at(double t);

 private:
    void add_present(Panel& panel, const PreparedView& view, const Sample& now) const;

    const Trajectory& trajectory_;
    std::optional<double> horizon_;  // horizon of the run (s), if it comes before the end
    StillSize size_;
    int decimals_;
    Sampler sampler_;
    std::vector<Sample> samples_;
    std::vector<PreparedView> views_;
    Mechanism mechanism_;
    MechanismScene stage_;
    CameraMode camera_;
    Figure figure_;  // plots of the whole run, pale
    std::optional<PreparedView> plane_view_;
    Figure plane_;
    StillAreas areas_;
};

}  // namespace achilles
