// The point of a mechanism that stands for it (see Grip): where its trail, its velocity and the contact force are
// drawn, and where a hand takes hold.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "figure/mechanism.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

class Body {
 public:
    // At a time and a state, with p = p(q) its place in the world and J = dp/dq by central differences. Nothing where these are
    // not finite.
    static std::optional<Body> of(Grip& grip, double t, const State& state);

    const Point& at() const { return at_; }
    double radius() const { return radius_; }  // of its disc, in world units; 0 without one
    // Whether any coordinate moves it here.
    bool moves() const { return jx_.norm() + jy_.norm() > 1e-9; }
    // J v.
    Point velocity(const Vector& v) const;
    // The force F at the body that does what the generalised force Q does, J'F = Q; nothing where no force there can.
    std::optional<Point> force(const Vector& Q) const;
    // The rates nearest to v that give the body this velocity; nothing where it cannot have it.
    std::optional<Vector> rates(const Vector& v, const Point& velocity) const;

 private:
    Point at_;
    double radius_ = 0.0;
    Vector jx_, jy_;  // rows of J
};

// The coordinates nearest to the state's that bring the body at this time to this place, by Gauss and Newton; as near as it can be
// where the body moves on a line. Nothing where it does not get there.
std::optional<Vector> held_at(Grip& grip, double t, State state, const Point& place);

// A place on the way of the body. One that is not finite breaks the way.
struct WayPoint {
    double t = 0.0;
    Phase::Kind phase = Phase::Kind::hybrid;
    Point at;
};
// Where a sample of a run is in a plane.
using PlaceOf = std::function<Point(const Sample&)>;
// The way of a place during [from, to] (s), as fine as a picture of `seen` needs (trace.hpp): in hybrid phases, then in
// constrained ones, each in time.
std::vector<WayPoint> way_of(const Trajectory& trajectory, double from, double to, const Drawing& seen,
                             const PlaceOf& place);

// The body along a whole run.
struct Trail {
    std::vector<Point> points;  // one a sample; none where the mechanism has no body
    std::vector<WayPoint> way;  // as it is drawn
    double fastest = 0.0;       // largest speed of the body
    double strongest = 0.0;     // largest contact force at it
    struct Arrows {             // of some of the samples, as shares of the two above
        Point at, velocity, force;
    };
    std::vector<Arrows> arrows;
};
// `limits`: the world that the run needs.
Trail trail_of(const Mechanism& mechanism, const Trajectory& trajectory, std::span<const Sample> samples,
               const Drawing& limits);

// Puts the present into a way: in its phase, between the points before and after it.
void add_present(std::vector<WayPoint>& way, const WayPoint& now);
// Puts the way of the body among a mechanism's shapes, each phase in its colour, what is to come after t faintly: over the
// world, where a motion in contact would be hidden by the surface, and under what moves.
void add_way(std::vector<Shape>& shapes, std::span<const WayPoint> way, double t, const Theme& theme);

// The contact force of a sample, sum lambda_i g_i' over what is held, as a generalised force; zero in flight.
Vector contact_force(const Trajectory& trajectory, const Sample& sample);

}  // namespace achilles
