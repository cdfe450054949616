// The scene of one run of a mechanism: solid ground, trail of the body, poses at events, camera. What depends on the
// run only is computed once.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "figure/body.hpp"
#include "figure/camera.hpp"
#include "figure/contact_geometry.hpp"
#include "figure/field.hpp"
#include "figure/space_view.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/contact_forces.hpp"

namespace achilles {

// What is drawn besides the mechanism.
struct Layers {
    bool way = true;       // trail of the body: past, and faintly future
    bool strobe = false;   // poses at past events, as far as they can be distinguished
    bool friction = true;  // with dry friction: contact forces in their friction cones
};

// Color and text of the phase at an instant, for a line beside the picture. Between a cut and its Zeno point the hybrid
// phase continues, but the motion is the restarted one in contact, and the picture shows that.
struct PhaseLabel {
    PhaseLook color = PhaseLook::flight;
    std::string text;
};
PhaseLabel phase_label(const Model& model, const Sample& now);

// Friction in the drawing of a mechanism (friction_marks.cpp): the force of every held contact in its friction cone.
// The cone is a triangle with its apex at the contact. Its height is the normal force N and half its base is mu N, the
// largest friction force. The arrow of the contact force ends on the base: inside while the contact sticks, on a side
// while it slides. A second arrow, below the contact, is the friction force alone. A joint with friction has no normal
// force: a bar from minus to plus its level takes the place of the cone. Colors are those of the phases (palette.hpp).
//
// Evaluates its programs, so use one per thread.
class FrictionMarks {
 public:
    // Keeps references to its arguments, except the samples.
    FrictionMarks(const Mechanism& mechanism, const Trajectory& trajectory, const ContactGeometry& touch,
                  std::span<const Sample> samples);

    // The force at a contact or joint, as a force in the plane of the drawing.
    struct Mark {
        std::size_t which = 0;
        PhaseLook look = PhaseLook::contact;
        Point at;                       // the contact
        Point normal, tangent;          // unit vectors: out of the solid, and along a positive slip
        double pressing = 0.0;          // normal force N; 0 for a joint
        double friction = 0.0;          // friction force along `tangent`
        std::optional<double> limit{};  // largest friction force: mu N, or the level; nullopt: no friction, or no limit
        Point tip(double scale) const;  // of the force
    };
    std::vector<Mark> at(const Sample& now);
    // An arrow as it is drawn in the visible part of the world.
    struct ForceArrow {
        std::size_t which = 0;  // contact or joint
        Point from, to;
    };
    std::vector<ForceArrow> arrows(const Drawing& seen, const Sample& now);
    // The largest force of the run; 0 if no mark can be drawn.
    double strongest() const { return strongest_; }
    // Appends the marks to a drawing. The largest force of the run is as long as this fraction of the smaller side.
    static constexpr double longest = 0.16;
    void add(Drawing& drawing, const Sample& now, const Theme& theme);

 private:
    std::vector<ForceArrow> arrows_of(const Mark& mark, double side) const;
    std::optional<Mark> of_contact(std::size_t contact, const Sample& now);
    std::optional<Mark> of_joint(std::size_t joint, const Sample& now);

    const Model& model_;
    const ContactGeometry& touch_;
    std::vector<AnchorPoint> grips_;
    ContactForces forces_;
    ContactCache cache_;
    double strongest_ = 0.0;
};

class MechanismScene {
 public:
    // Keeps references to its arguments. A coarse trail goes straight through some samples.
    MechanismScene(const Mechanism& mechanism, const Trajectory& trajectory, std::span<const Sample> samples,
                   bool has_coarse_trail = false);
    MechanismScene(const MechanismScene&) = delete;
    MechanismScene& operator=(const MechanismScene&) = delete;

    // The part of the world that the run needs (Mechanism::limits).
    const Drawing& limits() const { return limits_; }
    const Trail& trail() const { return trail_; }
    // Replaces a coarse trail by the exact one.
    void refine(Trail trail) { trail_ = std::move(trail); }
    const Camera& camera() const { return camera_; }
    const ContactGeometry& touch() const { return touch_; }
    const std::string& unit() const { return unit_; }  // of length
    // Whether it draws contact forces, in their friction cones.
    bool has_friction_marks() const { return friction_ && friction_->strongest() > 0.0; }

    // The arrows of the forces that it draws in a part of the world.
    std::vector<FrictionMarks::ForceArrow> force_arrows(const Drawing& seen, const Sample& now) {
        return friction_ ? friction_->arrows(seen, now) : std::vector<FrictionMarks::ForceArrow>();
    }

    // The mechanism at an instant of the run with the requested layers, in the visible part of the world.
    Drawing draw(const Sample& now, const Drawing& seen, const Theme& theme, const Layers& layers);
    // Moves the discs of a drawing of this mechanism to where they rest.
    void rest(Drawing& drawing, double t, const State& state) const;
    // Times of the strobe poses, s.
    std::vector<double> poses() const;

 private:
    void find_poses();
    std::vector<WayPoint> way(const Sample& now, const Drawing& seen);
    std::optional<std::pair<double, double>> close_part(const Sample& now, const Drawing& seen,
                                                        const std::optional<Body>& body) const;
    Point rest_below(const Sample& now, const Drawing& seen, AnchorPoint& grip, const std::optional<Body>& body) const;

    const Mechanism& mechanism_;
    const Trajectory& trajectory_;
    Sampler sampler_;
    Drawing limits_;
    Trail trail_;
    ContactGeometry touch_;
    Camera camera_;
    std::optional<FrictionMarks> friction_;  // only with friction
    std::optional<SpaceSurfaces> surfaces_;  // only in space
    std::vector<Sample> poses_;
    std::string unit_;
};

// A system with coordinates x, y and z in two views: the planes x-z and y-z, cut at the point.
//
// A [[drawing]] has two coordinates; for a system in space it is a picture that its file made up. These views show any
// system of three Cartesian coordinates as it is. The solid is the side h < 0 of its gaps in the plane through the
// point; the trail is projected as a whole.

class TwoViews {
 public:
    // Keeps references to its arguments.
    TwoViews(const Trajectory& trajectory, std::span<const Sample> samples);
    // Whether the coordinates of the system are x, y and z.
    bool exist() const { return exist_; }
    struct Side {
        std::string name;  // names of the horizontal and the vertical axis, such as "x", "z"
        std::array<std::size_t, 2> pair;
    };
    static std::array<Side, 2> all();
    // Limits that the whole run needs in both views, of equal size.
    std::array<Drawing, 2> limits() const;
    // One of the views, in the visible part of its plane.
    Drawing draw(std::size_t side, const Sample& now, const Drawing& seen, const Theme& theme, bool with_way) const;

 private:
    const Trajectory& trajectory_;
    std::span<const Sample> samples_;
    bool exist_ = false;
};

}  // namespace achilles
