// Friction in the drawing of a mechanism: the force of every held contact in its friction cone.
//
// The cone is a triangle with its apex at the contact. Its height is the normal force N and half its base is mu N, the
// largest friction force. The arrow of the contact force ends on the base: inside while the contact sticks, on a side
// while it slides. A second arrow, below the contact, is the friction force alone. A joint with friction has no normal
// force: a bar from minus to plus its level takes the place of the cone. Colors are those of the phases (palette.hpp).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "figure/contact_geometry.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/contact_forces.hpp"

namespace achilles {

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

}  // namespace achilles
