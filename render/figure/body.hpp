// The body point of a mechanism (see Grip): its position, velocity and contact force, its trail, and dragging by the
// mouse.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "figure/mechanism.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Functions of the coordinates that are kept at 0 while a point is dragged, such as gaps; gradients row by row.
struct KeptFunctions {
    Eigen::VectorXd values;
    Eigen::MatrixXd gradients;
};
using KeptFunctionsAt = std::function<KeptFunctions(const Vector& q)>;

class Body {
 public:
    // The body at a time and state: position p = p(q) in the world and Jacobian J = dp/dq by central differences.
    // nullopt if these are not finite.
    static std::optional<Body> of(AnchorPoint& grip, double t, const State& state);

    const Point& at() const { return at_; }
    double radius() const { return radius_; }  // of its disc, in world units; 0 without a disc
    // Whether p depends on any coordinate at this state.
    bool moves() const { return jx_.norm() + jy_.norm() > 1e-9; }
    // J v.
    Point velocity(const Vector& v) const;
    // Force F at the body that is equivalent to the generalized force Q: J'F = Q, least squares. nullopt if no force at
    // the body is equivalent.
    std::optional<Point> force(const Vector& Q) const;
    // Only rates along which these functions do not change count from now on.
    void keep(const KeptFunctions& kept);
    // Rates nearest to v that give the body this velocity, or the nearest velocity that it can have. nullopt if they
    // are not finite.
    std::optional<Vector> rates(const Vector& v, const Point& velocity) const;

 private:
    Point at_;
    double radius_ = 0.0;
    Vector jx_, jy_;  // rows of J
    Vector jz_;       // in space: that of the depth; else empty
};

// Coordinates that move the body to `place` at time t, starting from those of `state` (Gauss-Newton, each step nearer
// than the one before). A body that moves on a line, or that cannot reach the place, gets as close as it can. nullopt
// if a position or a step is not finite.
std::optional<Vector> held_at(AnchorPoint& grip, double t, const State& state, const Point& place,
                              const KeptFunctionsAt& kept = {});

// A point of the trail. A point that is not finite breaks the trail.
struct WayPoint {
    double t = 0.0;
    PhaseLook look = PhaseLook::flight;
    Point at;
};
// Position of a sample in a plane.
using PlaceOf = std::function<Point(const Sample&)>;
// Trail of a place during [from, to] (s), as fine as the picture `seen` needs (trace.hpp), or straight `through` some
// of these samples. The list contains all points of the first look in order of time, then those of the next look.
std::vector<WayPoint> way_of(const Trajectory& trajectory, double from, double to, const Drawing& seen,
                             const PlaceOf& place, std::span<const Sample> through = {});

// The body point along a whole run.
struct Trail {
    std::vector<Point> points;  // one per sample; empty if the mechanism has no body
    std::vector<WayPoint> way;  // the trail as it is drawn
    double fastest = 0.0;       // largest speed of the body
    double strongest = 0.0;     // largest contact force at it
    struct Arrows {             // at some of the samples, as fractions of the two maxima above
        Point at, velocity, force;
    };
    std::vector<Arrows> arrows;
};
// `limits`: the part of the world that the run needs. A coarse trail goes straight through some samples.
Trail trail_of(const Mechanism& mechanism, const Trajectory& trajectory, std::span<const Sample> samples,
               const Drawing& limits, bool is_coarse = false);

// Inserts the present point into the trail of its phase, in order of time.
void add_present(std::vector<WayPoint>& way, const WayPoint& now);
// Inserts the trail into the shapes of a mechanism, each phase in its color, the part after t faint. The trail lies
// over the static shapes, whose lines would hide motion in contact, and under the moving ones.
void add_body_trail(std::vector<DrawnShape>& shapes, std::span<const WayPoint> way, double t, const Theme& theme);

// Contact force of a sample as a generalized force: sum of lambda_i times the gap gradient over the held contacts, with
// their friction; zero in free flight.
Vector contact_force(const Trajectory& trajectory, const Sample& sample);

}  // namespace achilles
