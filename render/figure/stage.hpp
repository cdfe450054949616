// One run of a mechanism as it is looked at: what is solid, the way of the body, the poses at events, the camera. All that
// a run decides is found out once.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "figure/body.hpp"
#include "figure/camera.hpp"
#include "figure/field.hpp"
#include "figure/touch.hpp"

namespace achilles {

// What is drawn besides the mechanism.
struct Layers {
    bool way = true;      // of the body: passed, and faintly to come
    bool strobe = false;  // the poses at the events that have passed, as far as they can be told apart
};

// The phase at an instant as a line beside the picture says it, and whose color it has. Between a cut and its Zeno point the
// hybrid phase goes on, but the motion is the restarted one in contact, and the picture shows that.
struct PhaseLabel {
    Phase::Kind color = Phase::Kind::hybrid;
    std::string text;
};
PhaseLabel phase_label(const Sample& now);

class Stage {
 public:
    // Refers to what it is given.
    Stage(const Mechanism& mechanism, const Trajectory& trajectory, std::span<const Sample> samples);
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    // The world that the run needs (Mechanism::limits).
    const Drawing& limits() const { return limits_; }
    const Trail& trail() const { return trail_; }
    const Camera& camera() const { return camera_; }
    const Touch& touch() const { return touch_; }
    const std::string& unit() const { return unit_; }  // of lengths

    // The mechanism at an instant of the run, and what else is asked for, in the part of the world that is seen.
    Drawing draw(const Sample& now, const Drawing& seen, const Theme& theme, const Layers& layers);
    // The instants of the strobe's poses.
    std::vector<double> poses() const;

 private:
    void find_poses();
    std::vector<WayPoint> way(const Sample& now, const Drawing& seen);
    std::optional<std::pair<double, double>> close_part(const Sample& now, const Drawing& seen,
                                                        const std::optional<Body>& body) const;
    Point rest_below(const Sample& now, const Drawing& seen, Grip& grip, const std::optional<Body>& body) const;

    const Mechanism& mechanism_;
    const Trajectory& trajectory_;
    Sampler sampler_;
    Drawing limits_;
    Trail trail_;
    Touch touch_;
    Camera camera_;
    std::vector<Sample> poses_;
    std::string unit_;
};

// A system in space from two sides: of coordinates x, y and z the planes x-z and y-z, cut where the point is.
//
// A [[drawing]] has two coordinates; what it shows of a system in space is a picture that its file made up. Here every
// system of three Cartesian coordinates is seen as it is: what is solid is the side h < 0 of its gaps, in the plane through
// the point; the way is seen from there whole.

class Sides {
 public:
    // Refers to what it is given.
    Sides(const Trajectory& trajectory, std::span<const Sample> samples);
    // Whether the system has these coordinates, and no others.
    bool exist() const { return exist_; }
    struct Side {
        std::string name;  // "x", "z": what is across, what is up
        std::array<std::size_t, 2> pair;
    };
    static std::array<Side, 2> all();
    // What the whole run needs of both, of the same size.
    std::array<Drawing, 2> limits() const;
    // One of them in the part of its plane that is seen.
    Drawing draw(std::size_t side, const Sample& now, const Drawing& seen, const Theme& theme, bool with_way) const;

 private:
    const Trajectory& trajectory_;
    std::span<const Sample> samples_;
    bool exist_ = false;
};

}  // namespace achilles
