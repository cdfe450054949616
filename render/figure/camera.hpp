// The part of the world that a picture of a mechanism shows: a function of the run, the time and the picture's size
// only.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "figure/body.hpp"
#include "figure/contact_geometry.hpp"

namespace achilles {

// Camera modes.
//
//     fit     everything the run needs, including arrows
//     fixed   the view that the user has chosen
//     follow  a part of the world in which the body is well visible; it moves with the mean position of the body and
//             always contains the body
//     zeno    as fit, but before a Zeno point the picture zooms in on the contact point in proportion to the remaining
//             bounce height, so that all bounces look alike; from the cut on, with nothing more to see, it stays; after
//             the Zeno point it zooms out again

enum class CameraMode { fit, fixed, follow, zeno };
std::string_view to_text(CameraMode mode);
std::optional<CameraMode> camera_mode_from(std::string_view text);

// Size of a picture and lengths of the run's longest velocity and force arrows, all in pixels; 0 if such arrows are not
// drawn.
struct CameraPicture {
    double width = 1.0, height = 1.0;
    double velocity = 0.0, force = 0.0;
};

class Camera {
 public:
    // Keeps references to its arguments.
    Camera(const Mechanism& mechanism, const ContactGeometry& touch, const Trajectory& trajectory,
           std::span<const Sample> samples, const Trail& trail, const Drawing& limits);

    // The visible part of the world, as limits of a drawing without shapes. Mode `fixed` is treated as `fit`.
    Drawing at(CameraMode mode, const Sample& now, const CameraPicture& picture) const;

    // Height (world units) that the bounces before the next Zeno point still reach at time t. nullopt outside a
    // bouncing sequence.
    std::optional<double> height_left(double t) const;

    // What the mode `zeno` shows at an instant of a bouncing sequence; nullopt outside one.
    struct ZenoView {
        double enlargement = 1.0;     // relative to the mode `fit`
        double gap = 0.0;             // world units
        double bounce = 0.0;          // height of this bounce or, after the cut, of the last one, world units
        bool is_cut = false;          // no more bounces are computed
        bool is_inside_body = false;  // the disc of the body is larger than the picture
    };
    std::optional<ZenoView> zeno_view(const Sample& now, const CameraPicture& picture) const;

 private:
    // A bouncing sequence that ends in a Zeno point.
    struct Approach {
        double begin = 0.0, cut = 0.0, zeno = 0.0;
        std::size_t contact = 0, grip = 0;
        bool on_ground = false;  // the ground is drawn, so that the picture may zoom in without limit
        // For every flight of the sequence, in order: time from its start to the Zeno point (s), and height. Heights do
        // not increase.
        struct FlightHeight {
            double left, height;
        };
        std::vector<FlightHeight> flights;
        double height(double t) const;
    };
    std::optional<Approach> approach_to(std::size_t event) const;
    std::size_t grip_for(std::size_t contact, const Sample& near) const;
    struct Bounce {
        double gap = 0.0;  // gap h
        Point rise;        // dp/dh of a point of the mechanism along the impact direction
    };
    Bounce bounce(std::size_t grip, std::size_t contact, const Sample& sample) const;
    Point focus(const Approach& approach, const Sample& now, double size) const;
    double size_at(std::size_t approach, double t, double full) const;
    Drawing fit(const CameraPicture& picture) const;
    Drawing follow(const Sample& now, const CameraPicture& picture) const;
    struct ZenoZoom {
        const Approach* approach = nullptr;  // null: the whole run is shown
        double size = 0.0, full = 0.0;       // smaller side of the picture and of that of the whole run, world units
    };
    ZenoZoom zoom(double t, const Drawing& all) const;
    Drawing near_zeno(const Sample& now, const CameraPicture& picture) const;
    double smallest(const Approach& approach) const { return (approach.on_ground ? 1e-10 : 0.4) * limits_.size; }
    Point mean_place(double t, double reach) const;

    const ContactGeometry& touch_;
    const Trajectory& trajectory_;
    std::span<const Sample> samples_;
    const Trail& trail_;
    const Drawing& limits_;
    std::vector<AnchorPoint> grips_;  // of the mechanism; copied before use, because evaluation changes them
    std::vector<Point> integral_;     // time integral of the body position, sample by sample
    std::vector<Approach> approaches_;
};

// Limits widened to the aspect ratio of a picture of this size (pixels), with equal axes.
Drawing widened(const Drawing& limits, double width, double height);

// The largest length 1, 2 or 5 times a power of ten that is at most `most`.
double round_length(double most);
// Unit of length of a system's drawing: the unit of the coordinates and parameters that it names, if all of them have
// the same unit of length; else "".
std::string length_unit(const SystemDescription& description);
// "0.5 m", "2·10⁻⁹ m".
std::string length_label(double length, const std::string& unit);

}  // namespace achilles
