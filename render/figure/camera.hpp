// Where the picture of a mechanism looks, and how closely: a function of the run, the time and the picture's size alone.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "figure/body.hpp"
#include "figure/touch.hpp"

namespace achilles {

// The ways to look at a mechanism.
//
//     fit     all that the run needs, arrows included
//     fixed   where the user looks
//     follow  a part of the world, so large that the body is seen well; it moves with the body's mean place, and never
//             loses it
//     zeno    fit, but towards a Zeno point the picture shrinks about the place that is touched, by the height that
//             the bounces still reach, so that they look the same all the way; after it the picture grows back

enum class CameraMode { fit, fixed, follow, zeno };
std::string_view to_text(CameraMode mode);
std::optional<CameraMode> camera_mode_from(std::string_view text);

// A picture in pixels, and how long the longest arrow of the run is in it; 0 where none is drawn.
struct CameraPicture {
    double width = 1.0, height = 1.0;
    double velocity = 0.0, force = 0.0;
};

class Camera {
 public:
    // Refers to what it is given.
    Camera(const Mechanism& mechanism, const Touch& touch, const Trajectory& trajectory,
           std::span<const Sample> samples, const Trail& trail, const Drawing& limits);

    // What is to be seen, as limits of a drawing without shapes. Fixed: as fit.
    Drawing at(CameraMode mode, const Sample& now, const CameraPicture& picture) const;

    // The height (world units) that the bounces on the way to the next Zeno point still reach; nothing where the run is on no
    // such way.
    std::optional<double> height_left(double t) const;

 private:
    // The way to a Zeno point.
    struct Approach {
        double begin = 0.0, zeno = 0.0;
        std::size_t contact = 0, grip = 0;
        bool on_ground = false;  // that is drawn: there is something to see however near
        // Of every flight on the way the time that is left when it begins and the height it reaches, first to last; none
        // reaches higher than the one before.
        struct Flight {
            double left, height;
        };
        std::vector<Flight> flights;
        double height(double t) const;
    };
    std::optional<Approach> approach_to(std::size_t event) const;
    std::size_t grip_for(std::size_t contact, const Sample& near) const;
    struct Bounce {
        double gap = 0.0;  // h
        Point rise;        // dp/dh of a point of the mechanism, along the direction of the impact
    };
    Bounce bounce(std::size_t grip, std::size_t contact, const Sample& sample) const;
    Point focus(const Approach& approach, const Sample& now, double size) const;
    double size_at(std::size_t approach, double t, double full) const;
    Drawing fit(const CameraPicture& picture) const;
    Drawing follow(const Sample& now, const CameraPicture& picture) const;
    Drawing near_zeno(const Sample& now, const CameraPicture& picture) const;
    double smallest(const Approach& approach) const { return (approach.on_ground ? 1e-10 : 0.4) * limits_.size; }
    Point mean_place(double t, double reach) const;

    const Touch& touch_;
    const Trajectory& trajectory_;
    std::span<const Sample> samples_;
    const Trail& trail_;
    const Drawing& limits_;
    std::vector<Grip> grips_;      // of the mechanism; a copy of one is asked
    std::vector<Point> integral_;  // of the body's place over the time, sample by sample
    std::vector<Approach> approaches_;
};

// The part of the world that a picture of this size shows around limits that must be seen, with equal axes.
Drawing widened(const Drawing& limits, double width, double height);

// A length that is 1, 2 or 5 times a power of ten, at most `most`.
double round_length(double most);
// The unit of lengths in a system's drawing: that of the coordinates and parameters that it names, if these are of one
// unit of length; else none.
std::string length_unit(const SystemDescription& description);
// "0.5 m", "2·10⁻⁹ m".
std::string length_label(double length, const std::string& unit);

}  // namespace achilles
